#pragma once

#include <gtest/gtest.h>

#include "image/hash.h"
#include "render/renderer.h"

namespace oitlab::testing {

/// One device for all tests of a process, under validation with synchronization validation.
const Device& sharedDevice();

/// Every test that touches the device derives from this: it fails on any word of the validation
/// layers, and is skipped with the reason where there is no device.
class GpuTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

 private:
  std::size_t messagesBefore_ = 0;
};

/// A scene, a target and a renderer on the shared device.
class RenderFixture {
 public:
  RenderFixture(Scene scene, std::uint32_t width, std::uint32_t height,
                std::optional<std::uint64_t> shuffleSeed = {},
                TargetFormat format = TargetFormat::rgba32f);

  struct Result {
    Image image;
    std::string hash;
    FrameResult frame;
    std::map<std::string, std::uint64_t> memory;  ///< bytes by buffer, "method: ..." and others
  };

  /// One instrumented frame with a fresh `method`, by default from the scene's default view.
  Result render(const std::string& method,
                const std::map<std::string, std::string>& parameters = {},
                std::optional<Camera> camera = {});

  /// For several frames with one method: it keeps what the earlier ones made it grow.
  std::unique_ptr<Method> make(const std::string& method,
                               const std::map<std::string, std::string>& parameters = {});
  Result render(Method& method, const Camera& camera, bool instrumented = true);

  Renderer& renderer() { return renderer_; }
  const Scene& scene() const { return scene_; }
  Camera defaultView() const { return findView(scene_, "default"); }

 private:
  Scene scene_;
  GpuScene gpuScene_;
  Target target_;
  Renderer renderer_;
};

/// A scene of separate triangles, one material, all with the default view `camera`.
Scene triangleScene(const std::vector<std::array<glm::vec3, 3>>& triangles,
                    const std::vector<glm::vec4>& colors, const Camera& camera);

/// A camera at the origin of the xy plane that looks down -Z onto z = 0 such that y spans [-1, 1].
Camera frontCamera();

/// Seeded random triangles around the origin, some of them coplanar duplicates at equal depth.
Scene randomSoup(std::uint64_t seed, int triangles);

}  // namespace oitlab::testing
