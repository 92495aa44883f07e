// The cache of compiled shaders: whatever its file holds, the SPIR-V is that of the text.
#include <fstream>
#include <stdexcept>

#include "fuzz/targets.h"
#include "gpu/shader.h"

namespace oitlab {
namespace {

/// shaders/x.comp, a cache, and the SPIR-V as it is without one.
struct Fixture {
  Fixture() {
    const auto root = fuzzFolder() / "root";
    std::filesystem::create_directories(root / "shaders");
    std::ofstream(root / "shaders" / "x.comp") << "layout(local_size_x = 1) in;\n"
                                                  "void main() {}\n";
    setenv("OITLAB_ROOT", root.c_str(), 1);
    setenv("OITLAB_CACHE", (fuzzFolder() / "cache").c_str(), 1);
    expected = ShaderLibrary().compile("x.comp");
    file = std::filesystem::directory_iterator(fuzzFolder() / "cache" / "spirv")->path();
  }
  std::vector<std::uint32_t> expected;
  std::filesystem::path file;
};

}  // namespace

void fuzzSpirvCache(std::string_view bytes) {
  static const Fixture fixture;
  std::ofstream(fixture.file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  if (ShaderLibrary().compile("x.comp") != fixture.expected)
    throw std::logic_error("the cache of shaders gave other SPIR-V than the compiler does");
}

}  // namespace oitlab
