#pragma once

#include <string>
#include <utility>

#include "scene/scene.h"

namespace oitlab {

/// Builds generated scenes. Triangles are counter-clockwise when seen from outside.
///
/// A counting builder takes the same calls and only counts vertices and triangles. Thus the size of
/// a scene is known without making it, and a generator can fit itself to a triangle count. For
/// this, the calls of a generator must not depend on the vertices that it made before.
class MeshBuilder {
 public:
  enum class Mode { build, count };

  explicit MeshBuilder(std::string name, Mode mode = Mode::build) : counting_(mode == Mode::count) {
    scene_.name = std::move(name);
  }

  bool counting() const { return counting_; }
  const std::string& name() const { return scene_.name; }
  std::uint64_t triangleCount() const { return counting_ ? triangles_ : scene_.triangles.size(); }
  std::uint64_t vertexCount() const { return counting_ ? vertices_ : scene_.vertices.size(); }

  /// Adds to the counts at once, for shapes that know their numbers without making their vertices.
  void count(std::uint64_t vertices, std::uint64_t triangles) {
    vertices_ += vertices;
    triangles_ += triangles;
  }

  /// Reserves memory for what comes next: growing step by step would take twice the memory.
  void reserve(std::uint64_t vertices, std::uint64_t triangles) {
    if (counting_) return;
    scene_.vertices.reserve(vertices);
    scene_.triangles.reserve(triangles);
  }

  std::uint32_t material(Material material) {
    scene_.materials.push_back(std::move(material));
    return std::uint32_t(scene_.materials.size() - 1);
  }

  /// A BLEND material with the colours of its vertices.
  std::uint32_t blendMaterial(float opacity) {
    return material(
        {.name = "blend", .baseColor = {1, 1, 1, opacity}, .alphaMode = AlphaMode::blend});
  }

  /// A BLEND material whose opacity is the alpha of the texture that `paint()` returns.
  template <typename Paint>
  std::uint32_t texturedMaterial(Paint&& paint) {
    const int index = int(scene_.textures.size());
    scene_.textures.push_back(counting_ ? Texture{} : paint());
    return material(
        {.name = scene_.textures.back().name, .texture = index, .alphaMode = AlphaMode::blend});
  }

  /// `normal` has unit length, `color` is linear.
  std::uint32_t vertex(glm::vec3 position, glm::vec3 normal, glm::vec2 uv, glm::vec3 color,
                       std::uint32_t material) {
    if (counting_) return std::uint32_t(vertices_++);
    scene_.vertices.push_back(
        {position, packNormal(normal), uv, packColor(glm::vec4(color, 1.0f)), material});
    return std::uint32_t(scene_.vertices.size() - 1);
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (counting_)
      ++triangles_;
    else
      scene_.triangles.emplace_back(a, b, c);
  }

  /// A flat quad of four vertices and two triangles with the half edges `right` and `up`. It faces
  /// cross(right, up).
  void quad(glm::vec3 center, glm::vec3 right, glm::vec3 up, glm::vec3 color,
            std::uint32_t material) {
    if (counting_) return count(4, 2);
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
  bool counting_;
  std::uint64_t vertices_ = 0, triangles_ = 0;
  Scene scene_;
};

}  // namespace oitlab
