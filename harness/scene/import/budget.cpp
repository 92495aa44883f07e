#include "scene/import/budget.h"

#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "scene/scene.h"
#include "util/error.h"

namespace oitlab {
namespace {

void replaceFromEnvironment(const char* variable, std::uint64_t& limit) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return;
  const std::string_view digits = text;
  std::uint64_t value = 0;
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (error != std::errc{} || stop != end || value == 0)
    fail<InputError>("{}={}: expected a whole number above 0", variable, text);
  limit = value;
}

void add(std::uint64_t& sum, std::uint64_t count, std::uint64_t limit, const std::string& file,
         const std::string& what, const char* unit, const char* variable) {
  sum += count;
  if (sum > limit)
    fail<InputError>("{}: {} brings the scene to {} {}, and it may have {}; {} sets another limit",
                     file, what, sum, unit, limit, variable);
}

}  // namespace

SceneLimits SceneLimits::fromEnvironment() {
  SceneLimits limits;
  limits.bytes = std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE)) / 2;
  replaceFromEnvironment("OITLAB_SCENE_TEXELS", limits.texels);
  replaceFromEnvironment("OITLAB_SCENE_VERTICES", limits.vertices);
  replaceFromEnvironment("OITLAB_SCENE_BYTES", limits.bytes);
  return limits;
}

void SceneBudget::addBytes(std::uint64_t count, const std::string& what) {
  add(bytes_, count, limits_.bytes, file_, what, "bytes", "OITLAB_SCENE_BYTES");
}

void SceneBudget::addTexels(std::uint64_t count, const std::string& what) {
  add(texels_, count, limits_.texels, file_, what, "texels", "OITLAB_SCENE_TEXELS");
  addBytes(4 * count, what);
}

void SceneBudget::addVertices(std::uint64_t vertices, std::uint64_t triangles,
                              const std::string& what) {
  add(vertices_, vertices, limits_.vertices, file_, what, "vertices", "OITLAB_SCENE_VERTICES");
  addBytes(vertices * sizeof(Vertex) + triangles * sizeof(glm::uvec3), what);
}

}  // namespace oitlab
