#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace oitlab {

/// Preprocessor definitions of a shader variant: name -> value. Values have no spaces. #include
/// "NAME" includes the file that the definition NAME names, relative to the folder shaders/.
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

  /// Content hashes of variants by label, "lucid/blocks.comp PASS=1 SIZE=8": path and definitions.
  using Hashes = std::map<std::string, std::string>;

  /// The variants compiled so far.
  const Hashes& hashes() const { return hashes_; }

  /// The content hash of the variant with this label as its files are now. Throws InputError where
  /// a file is missing.
  std::string hash(const std::string& label) const;

  /// While it lives, all that is compiled is also added to `into`: what one method uses, of all
  /// that a process compiles. One at a time.
  class Recording {
   public:
    Recording(ShaderLibrary& library, Hashes& into) : library_(library) {
      library_.recorded_ = &into;
    }
    ~Recording() { library_.recorded_ = nullptr; }
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

   private:
    ShaderLibrary& library_;
  };

 private:
  std::string hash(const std::string& path, const Defines& defines) const;

  /// `label` names the variant in messages.
  std::vector<std::uint32_t> compileAnew(const std::string& path, const Defines& defines,
                                         const std::string& label) const;

  std::filesystem::path root_;
  std::filesystem::path cache_;
  std::string preamble_;
  Hashes hashes_;
  Hashes* recorded_ = nullptr;
};

}  // namespace oitlab
