#pragma once

#include <gtest/gtest.h>
#include <stb_image_write.h>

#include "scene/import/gltf.h"
#include "support/glb.h"
#include "support/temporary_folder.h"
#include "util/error.h"

namespace oitlab {

inline const std::vector<float> triangleCorners{0, 0, 0, 1, 0, 0, 0, 1, 0};  // faces +Z
inline const std::vector<float> upNormals{0, 0, 1, 0, 0, 1, 0, 0, 1};

inline std::string png(int width, int height, const std::vector<std::uint8_t>& rgba) {
  std::string bytes;
  stbi_write_png_to_func(
      [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), std::size_t(size));
      },
      &bytes, width, height, 4, rgba.data(), 4 * width);
  return bytes;
}

class Gltf : public TemporaryFolder {
 protected:
  Scene load(GlbBuilder& glb) { return loadGltf(glb.write(folder_ / "x.glb")); }
  std::string error(GlbBuilder& glb) {
    return messageOf<InputError>([&] { load(glb); });
  }
  std::string errorOf(const std::string& bytes, const char* name = "x.glb") {
    const std::string path = GlbBuilder::writeFile(folder_ / name, bytes);
    return messageOf<InputError>([&] { loadGltf(path); });
  }

  // One triangle with a material, drawn by `node`: the start of most tests.
  Scene loadTriangle(const nlohmann::json& material,
                     nlohmann::json node = nlohmann::json::object()) {
    GlbBuilder glb;
    glb.json["materials"] = {material};
    node["mesh"] = glb.mesh(
        {{"POSITION", glb.positions(triangleCorners)}, {"NORMAL", glb.positions(upNormals)}},
        {{"material", 0}});
    glb.node(node);
    return load(glb);
  }
};

inline glm::vec3 at(const Scene& scene, std::size_t triangle, int corner) {
  return scene.vertices[scene.triangles[triangle][corner]].position;
}

inline glm::vec3 faceNormal(const Scene& scene, std::size_t t) {
  return glm::normalize(
      glm::cross(at(scene, t, 1) - at(scene, t, 0), at(scene, t, 2) - at(scene, t, 0)));
}

inline std::uint64_t repairs(const Scene& scene, const std::string& part) {
  std::uint64_t count = 0;
  for (const Repair& repair : scene.repairs)
    if (repair.what.find(part) != std::string::npos) count += repair.count;
  return count;
}

}  // namespace oitlab
