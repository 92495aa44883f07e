#include "gpu/shader.h"

#include <cstring>
#include <mutex>
#include <set>
#include <sstream>

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include "image/hash.h"
#include "util/cache_file.h"
#include "util/error.h"
#include "util/paths.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

// Extensions for all shaders. Each is part of Vulkan 1.3, a feature of the baseline, or (subgroup
// operations, 64-bit atomics) used only by shaders whose method checks that the device has it.
constexpr const char* preamble = R"(
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : enable
#extension GL_KHR_shader_subgroup_vote : enable
#extension GL_KHR_shader_subgroup_ballot : enable
#extension GL_KHR_shader_subgroup_arithmetic : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
)";

constexpr const char* printfPreamble = R"(
#extension GL_EXT_debug_printf : require
#define SHADER_PRINTF 1
)";

/// Without an exception for names that no file system can have.
bool isFile(const std::filesystem::path& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none);
}

std::filesystem::path absoluteNormal(const std::filesystem::path& path) {
  std::error_code none;
  const auto absolute = std::filesystem::absolute(path, none);
  return (none ? path : absolute).lexically_normal();
}

/// The file that #include "x" means: if x is a definition, the file that it names.
std::string includedName(const std::string& name, const Defines& defines) {
  const auto defined = defines.find(name);
  return defined == defines.end() ? name : defined->second;
}

/// Resolves #include "x" against the folder of the including file, then against shaders/.
class Includer : public glslang::TShader::Includer {
 public:
  Includer(std::filesystem::path root, const Defines& defines)
      : root_(std::move(root)), defines_(defines) {}

  IncludeResult* includeLocal(const char* written, const char* includer, std::size_t) override {
    const std::string name = includedName(written, defines_);
    for (const auto& folder : {(root_ / includer).parent_path(), root_}) {
      const auto path = folder / name;
      if (!isFile(path)) continue;
      auto* text = new std::string(readTextFile(path));
      return new IncludeResult(path.lexically_relative(root_).generic_string(), text->data(),
                               text->size(), text);
    }
    return nullptr;
  }
  IncludeResult* includeSystem(const char* name, const char* includer, std::size_t depth) override {
    return includeLocal(name, includer, depth);
  }
  void releaseInclude(IncludeResult* result) override {
    if (result == nullptr) return;
    delete static_cast<std::string*>(result->userData);
    delete result;
  }

 private:
  std::filesystem::path root_;
  const Defines& defines_;
};

EShLanguage stageOf(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".vert") return EShLangVertex;
  if (extension == ".frag") return EShLangFragment;
  if (extension == ".comp") return EShLangCompute;
  fail<InputError>("{}: the extension must be .vert, .frag or .comp", path);
}

/// The text of `path` and of everything it includes, in order of first appearance.
void collect(const std::filesystem::path& root, const std::filesystem::path& path,
             const Defines& defines, std::set<std::string>& seen, std::string& text) {
  if (!seen.insert(path.lexically_normal().string()).second) return;
  const std::string content = readTextFile(path);
  text += content;
  std::istringstream lines(content);
  for (std::string line; std::getline(lines, line);) {
    const auto open = line.find('"');
    if (line.rfind("#include", 0) != 0 || open == std::string::npos) continue;
    const std::string name =
        includedName(line.substr(open + 1, line.find('"', open + 1) - open - 1), defines);
    for (const auto& folder : {path.parent_path(), root})
      if (isFile(folder / name)) {
        collect(root, folder / name, defines, seen, text);
        break;
      }
  }
}

std::string definitionLines(const Defines& defines) {
  std::string lines;
  for (const auto& [name, value] : defines) lines += fmt::format("#define {} {}\n", name, value);
  return lines;
}

std::string labelOf(const std::string& path, const Defines& defines) {
  std::string label = path;
  for (const auto& [name, value] : defines) label += fmt::format(" {}={}", name, value);
  return label;
}

}  // namespace

ShaderLibrary::ShaderLibrary(bool shaderPrintf)
    : root_(absoluteNormal(dataRoot() / "shaders")),
      cache_(cacheRoot() / "spirv"),
      preamble_(preamble) {
  if (shaderPrintf) preamble_ += printfPreamble;
  std::error_code none;
  if (!std::filesystem::is_directory(root_, none))
    fail<InputError>("{}: no such folder; set OITLAB_ROOT to the folder that holds shaders/",
                     root_.string());
}

std::string ShaderLibrary::hash(const std::string& path, const Defines& defines) const {
  std::string everything = path + "\n" + preamble_ + definitionLines(defines);
  const auto version = glslang::GetVersion();
  everything += fmt::format("glslang {}.{}.{}\n", version.major, version.minor, version.patch);
  std::set<std::string> seen;
  collect(root_, root_ / path, defines, seen, everything);
  return imageHash(std::as_bytes(std::span(everything)));
}

std::string ShaderLibrary::hash(const std::string& label) const {
  std::istringstream words(label);
  std::string path, definition;
  words >> path;
  Defines defines;
  while (words >> definition) {
    const auto equals = definition.find('=');
    if (equals == std::string::npos) fail<InputError>("'{}' is no shader's label", label);
    defines[definition.substr(0, equals)] = definition.substr(equals + 1);
  }
  return hash(path, defines);
}

std::vector<std::uint32_t> ShaderLibrary::compile(const std::string& path, const Defines& defines) {
  const std::string hash = this->hash(path, defines);
  const std::string label = labelOf(path, defines);
  hashes_[label] = hash;
  if (recorded_ != nullptr) (*recorded_)[label] = hash;

  const auto cached = cache_ / (hash + ".spv");
  if (const auto bytes = readCached(cached, hash); bytes && bytes->size() % 4 == 0) {
    std::vector<std::uint32_t> words(bytes->size() / 4);
    std::memcpy(words.data(), bytes->data(), bytes->size());
    return words;
  }
  std::vector<std::uint32_t> words = compileAnew(path, defines, label);
  writeCached(cached, hash,
              {reinterpret_cast<const char*>(words.data()), words.size() * sizeof words[0]});
  return words;
}

std::vector<std::uint32_t> ShaderLibrary::compileAnew(const std::string& path,
                                                      const Defines& defines,
                                                      const std::string& label) const {
  static std::once_flag once;
  std::call_once(once, [] { glslang::InitializeProcess(); });
  const EShLanguage stage = stageOf(path);
  const std::string head = preamble_ + definitionLines(defines);
  const std::string text = readTextFile(root_ / path);
  glslang::TShader shader(stage);
  const char* source = text.c_str();
  const char* name = path.c_str();
  shader.setStringsWithLengthsAndNames(&source, nullptr, &name, 1);
  shader.setPreamble(head.c_str());
  shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
  Includer includer(root_, defines);
  const auto messages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
  glslang::TProgram program;
  bool good = shader.parse(GetDefaultResources(), 460, false, messages, includer);
  std::string log = shader.getInfoLog();
  if (good) {
    program.addShader(&shader);
    good = program.link(messages);
    log += program.getInfoLog();
  }
  if (!good) fail<InputError>("shaders/{} does not compile:\n{}", label, log);
  std::vector<std::uint32_t> words;
  glslang::GlslangToSpv(*program.getIntermediate(stage), words);
  return words;
}

}  // namespace oitlab
