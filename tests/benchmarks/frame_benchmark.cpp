// CPU time of the harness itself. Run it on a quiet machine:
//   build/release/oitlab_benchmarks
#include <benchmark/benchmark.h>

#include "render/renderer.h"
#include "util/error.h"

namespace oitlab {
namespace {

/// CPU time to record and submit one frame, without the wait for the device: from before the frame
/// constants are written until vkQueueSubmit has returned (FrameResult::cpuMs). The target is
/// small, so that the device finishes before the next frame starts. On llvmpipe the device is other
/// threads of the same CPU, which would compete with the recording.
void recordAndSubmit(benchmark::State& state, const char* sceneName, const char* methodName) {
  try {
    const Device device({});
    const Scene scene = loadScene({sceneName, {}, 1.0f});
    const GpuScene gpuScene(device, scene);
    const Target target(device, 64, 36, TargetFormat::rgba16f);
    Renderer renderer(device, gpuScene, target);
    const MethodInfo& info = findMethod(methodName);
    const auto method = renderer.make(info, Parameters(info.parameters, {}, info.name));
    const Camera camera = findView(scene, "default");
    renderer.render(*method, camera);
    for (auto _ : state) state.SetIterationTime(renderer.render(*method, camera).cpuMs * 1e-3);
  } catch (const DeviceError& error) {
    state.SkipWithError(error.what());
  }
}

BENCHMARK_CAPTURE(recordAndSubmit, blend_planes, "planes", "blend")
    ->UseManualTime()
    ->Unit(benchmark::microsecond);
BENCHMARK_CAPTURE(recordAndSubmit, reference_planes, "planes", "reference")
    ->UseManualTime()
    ->Unit(benchmark::microsecond);

}  // namespace
}  // namespace oitlab
