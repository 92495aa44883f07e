#pragma once

#include <gtest/gtest.h>

#include "image/hash.h"
#include "render/renderer.h"

namespace oitlab::testing {

/// The device of all tests of a process, with validation and synchronization validation.
const Device& sharedDevice();

/// The base of all tests that use the device. A test fails on any message of the validation layer.
/// It is skipped, with the reason, on a machine without a device.
class GpuTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// For tests that ask for pipelines which a driver may refuse: its own words about a refusal do
  /// not fail the test. Messages of the validation layer still do.
  void allowRefusals() { refusalsAllowed_ = true; }

 private:
  std::size_t messagesBefore_ = 0;
  bool refusalsAllowed_ = false;
};

/// A scene, a target and a renderer on the shared device, or another.
class RenderFixture {
 public:
  RenderFixture(Scene scene, std::uint32_t width, std::uint32_t height,
                std::optional<std::uint64_t> shuffleSeed = {},
                TargetFormat format = TargetFormat::rgba32f, const Device& device = sharedDevice());

  struct Result {
    Image image;
    std::string hash;
    FrameResult frame;
    std::map<std::string, std::uint64_t> memory;  ///< bytes by buffer: "method: ..." and others
  };

  /// One instrumented frame with a new `method`, by default from the scene's default view.
  Result render(const std::string& method,
                const std::map<std::string, std::string>& parameters = {},
                std::optional<Camera> camera = {});

  /// A method for several frames: it keeps the buffers that earlier frames enlarged.
  std::unique_ptr<Method> make(const std::string& method,
                               const std::map<std::string, std::string>& parameters = {});
  Result render(Method& method, const Camera& camera, bool instrumented = true);

  Renderer& renderer() { return renderer_; }
  const Target& target() const { return target_; }
  const Scene& scene() const { return scene_; }
  Camera defaultView() const { return findView(scene_, "default"); }

 private:
  const Device& device_;
  Scene scene_;
  GpuScene gpuScene_;
  Target target_;
  Renderer renderer_;
};

/// A scene of separate triangles of one material, with the default view `camera`.
Scene triangleScene(const std::vector<std::array<glm::vec3, 3>>& triangles,
                    const std::vector<glm::vec4>& colors, const Camera& camera);

/// A camera on the z axis that looks along -Z. In the plane z = 0 it sees y from -1 to 1.
Camera frontCamera();

/// Random triangles around the origin from a seed. Some are duplicates, with equal depths.
Scene randomSoup(std::uint64_t seed, int triangles);

}  // namespace oitlab::testing
