// Structs that C++ and GLSL both include (scalar block layout on the GLSL side).
// In C++ the vector types are GLM's.
#ifndef OITLAB_SCENE_TYPES_H
#define OITLAB_SCENE_TYPES_H

#ifdef __cplusplus
#include <cstdint>

#include <glm/glm.hpp>
namespace oitlab {
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using mat4 = glm::mat4;
using uint = std::uint32_t;
#endif

// What a material does with alpha (glTF's alphaMode).
#define ALPHA_OPAQUE 0u
#define ALPHA_MASK 1u
#define ALPHA_BLEND 2u

// 32 bytes: one cache-line half a vertex. Vertices are not shared between materials, so that the
// material is a flat attribute and no per-triangle look-up stands between a fragment and its shade.
struct Vertex {
  vec3 position;
  uint normal;    // two 16-bit snorm: octahedral map of the unit normal (x low half, y high half)
  vec2 uv;        // texture coordinates, glTF's convention (v down), repeat
  uint color;     // RGBA8 unorm, linear, r in the lowest byte
  uint material;  // index into the materials
};

// One material, as the shaders read it.
struct GpuMaterial {
  vec4 baseColor;     // linear RGB, alpha = opacity; not premultiplied
  vec4 atlasRect;     // the texture's place in its atlas: offset.xy, extent.zw, in atlas uv
  uint alphaMode;     // ALPHA_*
  float alphaCutoff;  // fragments with less alpha are discarded, in every mode; 0: none
  uint atlas;         // 0: no texture, 1: the opaque atlas, 2: the transparent atlas
  uint ignoreVertexAlpha;  // 1 under an opacity override: alpha = baseColor.a * texture alpha
};

#ifdef __cplusplus
static_assert(sizeof(Vertex) == 32);
static_assert(sizeof(GpuMaterial) == 48);
}  // namespace oitlab
#endif

#endif
