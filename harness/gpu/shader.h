#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace oitlab {

/// Preprocessor definitions of a shader variant: name -> value.
using Defines = std::map<std::string, std::string>;

/// Compiles GLSL to SPIR-V when a pipeline is made, so that an edited shader needs no rebuild of
/// the program. The result is cached on disk under the hash of everything that it depends on: the
/// text, the files that it includes, the definitions and the compiler's version. A damaged file in
/// the cache is replaced (util/cache_file.h).
class ShaderLibrary {
 public:
  /// `shaderPrintf`: shaders may call debugPrintfEXT, and SHADER_PRINTF is defined. Throws
  /// InputError when the folder shaders/ is missing.
  explicit ShaderLibrary(bool shaderPrintf = false);

  /// `path` is relative to the folder shaders/. Its extension names the stage: .vert, .frag or
  /// .comp. Throws InputError with file, line and the compiler's message when the text does not
  /// compile.
  std::vector<std::uint32_t> compile(const std::string& path, const Defines& defines = {});

  /// Content hashes of the variants that were compiled so far, by path and definitions.
  const std::map<std::string, std::string>& hashes() const { return hashes_; }

 private:
  /// `head` precedes the text; `label` names the variant in messages.
  std::vector<std::uint32_t> compileAnew(const std::string& path, const std::string& head,
                                         const std::string& label) const;

  std::filesystem::path root_;
  std::filesystem::path cache_;
  std::string preamble_;
  std::map<std::string, std::string> hashes_;
};

}  // namespace oitlab
