#include "support/gpu.h"

#include "util/error.h"
#include "util/random.h"

namespace oitlab::testing {

namespace {

/// Destroys the device after the last test. As a static object it would be destroyed at exit, after
/// static objects of the validation layer, which it still needs: layers of 1.4 crash there.
class DeviceEnvironment : public ::testing::Environment {
 public:
  const Device& device() {
    if (!device_) device_.emplace(Device::Options{.validation = true});
    return *device_;
  }
  void TearDown() override { device_.reset(); }

 private:
  std::optional<Device> device_;
};

DeviceEnvironment& environment() {
  static auto* const environment = new DeviceEnvironment;  // GoogleTest's, which deletes it
  return *environment;
}

const auto* const registered = ::testing::AddGlobalTestEnvironment(&environment());

}  // namespace

const Device& sharedDevice() {
  return environment().device();
}

void GpuTest::SetUp() {
  try {
    messagesBefore_ = sharedDevice().validationMessages().size();
  } catch (const DeviceError& error) {
    // CI has a device, so a missing one must fail there and not look like a pass.
    if (std::getenv("CI") != nullptr) FAIL() << error.what();
    GTEST_SKIP() << error.what();
  }
}

namespace {

/// What NVIDIA's driver reports beside the error code when a shader needs more local memory than it
/// gives (seen with 580.159.04). The validation layer begins its messages otherwise.
bool isRefusal(const std::string& message) {
  return message.starts_with("CreatePipeline: failed to validate local memory") ||
         message.find("Pipeline: unexpected failure compiling SPIR-V shader") != message.npos;
}

}  // namespace

void GpuTest::TearDown() {
  if (IsSkipped()) return;
  const auto messages = sharedDevice().validationMessages();
  for (std::size_t i = messagesBefore_; i < messages.size(); ++i)
    if (!refusalsAllowed_ || !isRefusal(messages[i])) ADD_FAILURE() << messages[i];
}

RenderFixture::RenderFixture(Scene scene, std::uint32_t width, std::uint32_t height,
                             std::optional<std::uint64_t> shuffleSeed, TargetFormat format,
                             const Device& device)
    : device_(device),
      scene_(std::move(scene)),
      gpuScene_(device, scene_, shuffleSeed),
      target_(device, width, height, format),
      renderer_(device, gpuScene_, target_) {}

RenderFixture::Result RenderFixture::render(const std::string& name,
                                            const std::map<std::string, std::string>& parameters,
                                            std::optional<Camera> camera) {
  return render(*make(name, parameters), camera.value_or(defaultView()));
}

std::unique_ptr<Method> RenderFixture::make(const std::string& name,
                                            const std::map<std::string, std::string>& parameters) {
  const MethodInfo& info = findMethod(name);
  return renderer_.make(info, Parameters(info.parameters, parameters, name));
}

RenderFixture::Result RenderFixture::render(Method& method, const Camera& camera,
                                            bool instrumented) {
  Result result;
  result.frame = renderer_.render(method, camera, instrumented);
  const auto bytes = target_.readBytes(device_);
  result.image = target_.toImage(bytes);
  result.hash = imageHash(bytes);
  result.memory = renderer_.memoryByBuffer(method);
  return result;
}

Scene triangleScene(const std::vector<std::array<glm::vec3, 3>>& triangles,
                    const std::vector<glm::vec4>& colors, const Camera& camera) {
  Scene scene;
  scene.name = "triangles";
  Material material;
  material.alphaMode = AlphaMode::blend;
  scene.materials = {material};
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto first = std::uint32_t(scene.vertices.size());
    for (const glm::vec3& position : triangles[i])
      scene.vertices.push_back({position,
                                packNormal({0.0f, 0.0f, 1.0f}),
                                {0.0f, 0.0f},
                                packColor(colors[i % colors.size()]),
                                0});
    scene.triangles.emplace_back(first, first + 1, first + 2);
  }
  computeBounds(scene);
  scene.views["default"] = camera;
  return scene;
}

Camera frontCamera() {
  Camera camera;
  camera.eye = {0.0f, 0.0f, 1.0f};
  camera.target = {0.0f, 0.0f, 0.0f};
  camera.fovY = glm::radians(90.0f);  // at distance 1, y spans [-1, 1]
  camera.near = 0.05f;
  return camera;
}

Scene randomSoup(std::uint64_t seed, int count) {
  Pcg32 random(seed);
  auto point = [&] {
    return glm::vec3(random.uniform(-1.2f, 1.2f), random.uniform(-1.2f, 1.2f),
                     random.uniform(-1.0f, 0.5f));
  };
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec4> colors;
  for (int i = 0; i < count; ++i) {
    // Every fourth triangle repeats an earlier one, so that equal depths occur.
    if (i % 4 == 3)
      triangles.push_back(triangles[random.next() % triangles.size()]);
    else
      triangles.push_back({point(), point(), point()});
    colors.emplace_back(random.uniform(), random.uniform(), random.uniform(),
                        random.uniform(0.05f, 0.95f));
  }
  return triangleScene(triangles, colors, frontCamera());
}

}  // namespace oitlab::testing
