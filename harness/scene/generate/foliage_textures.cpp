#include <algorithm>

#include "scene/generate/foliage.h"

namespace oitlab {
namespace {

// A texture to paint on, in floats until the end. Transparent texels have a colour too, because
// filtering reads it.
class Canvas {
 public:
  Canvas(int size, glm::vec3 ground) : size_(size), texels_(std::size_t(size * size)) {
    for (glm::vec4& texel : texels_) texel = glm::vec4(ground, 0.0f);
  }

  /// Paints with the opacity cover(p) in [0, 1] all texels within `reach` of `center`; positions
  /// are in [0, 1].
  template <typename Cover>
  void paint(glm::vec2 center, float reach, glm::vec3 color, Cover&& cover) {
    const auto texel = [&](float x) { return std::clamp(int(x * float(size_)), 0, size_ - 1); };
    for (int y = texel(center.y - reach); y <= texel(center.y + reach); ++y)
      for (int x = texel(center.x - reach); x <= texel(center.x + reach); ++x) {
        const glm::vec2 p = (glm::vec2(x, y) + 0.5f) / float(size_);
        const float a = std::clamp(cover(p), 0.0f, 1.0f);
        glm::vec4& under = texels_[std::size_t(y * size_ + x)];
        under = glm::vec4(glm::mix(glm::vec3(under), color, a), a + under.a * (1.0f - a));
      }
  }

  Texture texture(std::string name) const {
    Texture texture{.name = std::move(name), .width = size_, .height = size_};
    for (const glm::vec4& texel : texels_)
      for (int i = 0; i < 4; ++i)
        texture.rgba.push_back(std::uint8_t(std::clamp(texel[i], 0.0f, 1.0f) * 255.0f + 0.5f));
    return texture;
  }

 private:
  int size_;
  std::vector<glm::vec4> texels_;  // colour sRGB-encoded, as in the texture
};

// How far p is inside a lens from `a` to `b`, in units of `soft`. The lens is `width` times its
// length wide.
float inLens(glm::vec2 p, glm::vec2 a, glm::vec2 b, float width, float soft) {
  const glm::vec2 along = b - a;
  const float length = glm::length(along);
  const glm::vec2 unit = along / length;
  const float t = glm::dot(p - a, unit) / length;
  const float off = std::abs(unit.x * (p - a).y - unit.y * (p - a).x);
  return 0.5f + (width * length * 2.0f * t * (1.0f - t) - off) / soft;
}

glm::vec2 direction(float angle) {
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

Texture leafClusterTexture(int size, int leaves, float leafLength, glm::vec3 color,
                           std::uint64_t seed) {
  Canvas canvas(size, color);
  Pcg32 random(seed);
  const float soft = 1.5f / float(size);
  for (int i = 0; i < leaves; ++i) {
    // Denser towards the centre, and away from the border: a cut leaf would show as a straight
    // edge.
    const float room = std::max(0.5f - 0.6f * leafLength, 0.0f);
    const glm::vec2 center = glm::vec2(0.5f) + room * std::sqrt(random.uniform()) *
                                                   direction(fullTurn * random.uniform());
    const glm::vec2 half =
        0.5f * leafLength * random.uniform(0.7f, 1.0f) * direction(fullTurn * random.uniform());
    const glm::vec2 a = center - half, b = center + half;
    const glm::vec3 shade = color * random.uniform(0.65f, 1.25f);
    canvas.paint(center, leafLength, shade,
                 [&](glm::vec2 p) { return inLens(p, a, b, 0.5f, soft); });
    canvas.paint(center, leafLength, shade * 0.7f,
                 [&](glm::vec2 p) { return inLens(p, a, b, 0.03f, soft); });
  }
  return canvas.texture("leaves");
}

Texture needleTexture(int size, glm::vec3 color, std::uint64_t seed) {
  Canvas canvas(size, color);
  Pcg32 random(seed);
  const float soft = 1.5f / float(size);
  const glm::vec3 bark(0.35f, 0.25f, 0.18f);
  for (int twig = 0; twig < 9; ++twig) {
    const float angle = fullTurn * (float(twig) + random.uniform(-0.3f, 0.3f)) / 9.0f;
    const glm::vec2 tip = glm::vec2(0.5f) + random.uniform(0.26f, 0.36f) * direction(angle);
    for (int needle = 0; needle < 56; ++needle) {
      const glm::vec2 root = glm::mix(glm::vec2(0.5f), tip, float(needle + 1) / 56.0f);
      const float turn = angle + (needle % 2 ? 0.7f : -0.7f) + random.uniform(-0.25f, 0.25f);
      const glm::vec2 end = root + random.uniform(0.08f, 0.13f) * direction(turn);
      const glm::vec3 shade = color * random.uniform(0.6f, 1.3f);
      canvas.paint(root, 0.14f, shade,
                   [&](glm::vec2 p) { return inLens(p, root, end, 0.1f, soft); });
    }
    canvas.paint(glm::vec2(0.5f), 0.4f, bark,
                 [&](glm::vec2 p) { return inLens(p, glm::vec2(0.5f), tip, 0.03f, soft); });
  }
  return canvas.texture("needles");
}

Texture puffTexture(int size, float opacity, std::uint64_t seed) {
  Canvas canvas(size, glm::vec3(0.85f));
  Pcg32 random(seed);
  // Many faint blobs make the smoke uneven.
  for (int i = 0; i < 60; ++i) {
    const glm::vec2 center =
        glm::vec2(0.5f) + 0.28f * random.uniform() * direction(fullTurn * random.uniform());
    const float radius = random.uniform(0.08f, 0.2f);
    const glm::vec3 shade(random.uniform(0.7f, 1.0f));
    canvas.paint(center, radius, shade, [&](glm::vec2 p) {
      const float r = glm::distance(p, center) / radius;
      return r < 1.0f ? 0.12f * opacity * (1.0f - r * r) * (1.0f - r * r) * 4.0f : 0.0f;
    });
  }
  return canvas.texture("puff");
}

}  // namespace oitlab
