#include "raster/raster_defines.h"

#include <algorithm>

namespace oitlab::raster {
namespace {

const char* flag(bool value) {
  return value ? "1" : "0";
}

/// Whether a vertex has another colour than white.
bool hasColors(const Scene& scene) {
  return std::any_of(scene.vertices.begin(), scene.vertices.end(),
                     [](const Vertex& v) { return v.color != 0xffffffffu; });
}

/// Whether the corners of a triangle differ in colour.
bool hasGradients(const Scene& scene) {
  const auto& v = scene.vertices;
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](const auto& t) {
    return v[t.x].color != v[t.y].color || v[t.x].color != v[t.z].color;
  });
}

/// Whether the corners of a triangle differ in normal.
bool isSmooth(const Scene& scene) {
  const auto& v = scene.vertices;
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](const auto& t) {
    return v[t.x].normal != v[t.y].normal || v[t.x].normal != v[t.z].normal;
  });
}

}  // namespace

bool verifiesLoops(const Device& device) {
  return device.info().isCpu();
}

Defines teamDefines(const Device& device) {
  const std::uint32_t lanes = device.info().subgroupSize;
  return {{"SUBGROUP_SIZE", std::to_string(lanes) + "u"},
          {"SMALL_SUBGROUP", flag(lanes < 32)},
          {"SUBGROUP_BARRIER", flag(device.info().driver != "llvmpipe")},
          {"UNIFORM_CONTROL_FLOW", flag(device.hasSubgroupUniformControlFlow())}};
}

Defines sceneDefines(const GpuScene& gpuScene, bool hasUnsnapped) {
  const Scene& scene = gpuScene.scene();
  const bool textures = !scene.textures.empty();
  return {{"HAS_OPAQUE", flag(gpuScene.opaqueCount() > 0)},
          {"HAS_UNSNAPPED", flag(hasUnsnapped)},
          {"HAS_TEXTURES", flag(textures)},
          {"HAS_GRADIENTS", flag(hasGradients(scene))},
          {"HAS_ATTRIBUTES", flag(textures || hasColors(scene))},
          {"HAS_SMOOTH", flag(isSmooth(scene))}};
}

Defines with(Defines first, const Defines& more) {
  for (const auto& [name, value] : more) first[name] = value;
  return first;
}

Defines only(const Defines& defines, std::initializer_list<const char*> names) {
  Defines some;
  for (const char* name : names) some[name] = defines.at(name);
  return some;
}

}  // namespace oitlab::raster
