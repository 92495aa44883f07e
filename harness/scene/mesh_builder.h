#pragma once

#include <string>
#include <utility>

#include "scene/scene.h"

namespace oitlab {

/// Puts together the scenes that code makes. Triangles are counter-clockwise from outside.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string name) { scene_.name = std::move(name); }

  std::uint32_t material(Material material) {
    scene_.materials.push_back(std::move(material));
    return std::uint32_t(scene_.materials.size() - 1);
  }

  /// A material that blends, in the colours of its vertices.
  std::uint32_t blendMaterial(float opacity) {
    return material(
        {.name = "blend", .baseColor = {1, 1, 1, opacity}, .alphaMode = AlphaMode::blend});
  }

  /// `normal` of unit length, `color` linear.
  std::uint32_t vertex(glm::vec3 position, glm::vec3 normal, glm::vec2 uv, glm::vec3 color,
                       std::uint32_t material) {
    scene_.vertices.push_back(
        {position, packNormal(normal), uv, packColor(glm::vec4(color, 1.0f)), material});
    return std::uint32_t(scene_.vertices.size() - 1);
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    scene_.triangles.emplace_back(a, b, c);
  }

  /// A flat quad of four vertices and two triangles: `center` and the half edges `right` and `up`;
  /// it faces cross(right, up).
  void quad(glm::vec3 center, glm::vec3 right, glm::vec3 up, glm::vec3 color,
            std::uint32_t material) {
    const glm::vec3 normal = glm::normalize(glm::cross(right, up));
    const std::uint32_t a = vertex(center - right - up, normal, {0, 1}, color, material);
    const std::uint32_t b = vertex(center + right - up, normal, {1, 1}, color, material);
    const std::uint32_t c = vertex(center + right + up, normal, {1, 0}, color, material);
    const std::uint32_t d = vertex(center - right + up, normal, {0, 0}, color, material);
    triangle(a, b, c);
    triangle(a, c, d);
  }

  void view(const std::string& name, const Camera& camera) { scene_.views[name] = camera; }

  Scene take() { return std::move(scene_); }

 private:
  Scene scene_;
};

}  // namespace oitlab
