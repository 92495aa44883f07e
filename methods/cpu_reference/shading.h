#pragma once

// shaders/common/shade.glsl in double precision.

#include <vector>

#include "coverage.h"
#include "scene/atlas.h"

namespace oitlab::cpu_reference {

struct Shaded {
  glm::dvec4 color{0.0};   ///< linear, not premultiplied
  bool discarded = false;  ///< alpha is below the cutoff
  bool nearCutoff =
      false;  ///< alpha is so close to it that filtering in 8 bits may decide otherwise
};

class Shading {
 public:
  /// `scene` must outlive this. Decodes the atlases, which takes four bytes per texel.
  Shading(const Scene& scene, const SceneAtlases& atlases);

  Shaded shade(const glm::uvec3& triangle, const Hit& hit) const;

 private:
  struct Texels {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
  };
  using Levels = std::vector<Texels>;

  glm::dvec4 sample(const Levels& levels, glm::dvec2 uv, glm::dvec2 dx, glm::dvec2 dy) const;
  glm::dvec4 bilinear(const Texels& level, glm::dvec2 uv) const;

  const Scene& scene_;
  std::vector<AtlasPlacement> placements_;
  Levels levels_[2];    // opaque, transparent
  double linear_[256];  // the value of each sRGB code
};

}  // namespace oitlab::cpu_reference
