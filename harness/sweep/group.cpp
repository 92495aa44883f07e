#include "sweep/group.h"

#include "util/error.h"
#include "util/interrupt.h"

namespace oitlab {
namespace {

/// Calls `work`; what goes wrong goes to `failed` as a sentence, but for what ends more than the
/// work.
template <typename Work, typename Failed>
void guarded(const Device& device, Work&& work, Failed&& failed) {
  const auto failedOnDevice = [&](const std::string& reason) {
    if (device.isLost()) throw DeviceLost(reason);
    failed(reason);
  };
  try {
    work();
  } catch (const OutputError&) {
    throw;
  } catch (const DeviceLost&) {
    throw;
  } catch (const DeviceError& error) {
    failedOnDevice(error.what());
  } catch (const vk::SystemError& error) {
    failedOnDevice(fmt::format("{} failed: {}", device.info().name, error.what()));
  } catch (const std::bad_alloc&) {
    failed("not enough main memory");
  } catch (const std::exception& error) {
    failed(error.what());
  }
}

/// A group's scene, view and target on the device.
struct Stage {
  Stage(Session& session, const CellSpec& first)
      : scene(session.scene.get(first.scene)),
        camera(findView(scene.scene(), first.view)),
        target(session.device, first.width, first.height, first.format),
        renderer(session.device, scene, target) {}

  const GpuScene& scene;
  Camera camera;
  Target target;
  Renderer renderer;
};

/// The image that the group is judged by; none where the experiment wants none. Throws DeviceError
/// that says so: images without a judgement would pass for good ones.
std::optional<Image> renderReference(const std::string& name, Stage& stage) {
  if (name.empty()) return std::nullopt;
  const MethodInfo& info = findMethod(name);
  try {
    const auto method = stage.renderer.make(info, Parameters(info.parameters, {}, info.name));
    stage.renderer.render(*method, stage.camera);
    const Target& target = stage.target;
    return target.toImage(target.readBytes(stage.renderer.device()));
  } catch (const DeviceLost&) {
    throw;
  } catch (const DeviceError& error) {
    fail<DeviceError>(
        "no reference image: {} (reference = \"\" in the experiment measures without one)",
        error.what());
  }
}

/// A cell whose method is ready, with the shaders it took so far.
struct Ready {
  CellSpec cell;
  std::unique_ptr<Method> method;
  ShaderLibrary::Hashes shaders;
  std::uint64_t messages = 0;
};

std::size_t messageCount(const Device& device) {
  return device.validation() ? device.validationMessages().size() : 0;
}

std::vector<Ready> makeReady(Session& session, Stage& stage, GroupRows& rows,
                             const ShaderLibrary::Hashes& shared) {
  const Device& device = session.device;
  std::vector<Ready> ready;
  for (const CellSpec& cell : rows.cells()) {
    checkInterrupt();
    const MethodInfo& info = findMethod(cell.method);
    if (const auto missing = info.missing(device.info()); !missing.empty()) {
      rows.unmeasured(cell, "skipped",
                      fmt::format("{} lacks {}", device.info().name, fmt::join(missing, ", ")));
      continue;
    }
    Ready next{cell, nullptr, shared, 0};
    const std::size_t messages = messageCount(device);
    guarded(
        device,
        [&] {
          const ShaderLibrary::Recording recording(device.shaders(), next.shaders);
          next.method = stage.renderer.make(info, cell.parameters);
        },
        [&](const std::string& reason) { rows.unmeasured(cell, "failed", reason, next.shaders); });
    next.messages = messageCount(device) - messages;
    if (next.method) ready.push_back(std::move(next));
  }
  return ready;
}

void measureOn(Session& session, GroupRows& rows) {
  const Device& device = session.device;
  const std::size_t messagesBefore = messageCount(device);
  ShaderLibrary::Hashes shared;
  std::optional<Stage> stage;
  {
    const ShaderLibrary::Recording recording(device.shaders(), shared);
    stage.emplace(session, rows.cells().front());
  }
  const std::string& name = rows.experiment().reference;
  Judge judge(renderReference(name, *stage), name, rows.claim());
  const std::uint64_t sharedMessages = messageCount(device) - messagesBefore;

  std::vector<Ready> ready = makeReady(session, *stage, rows, shared);
  std::vector<Method*> methods;
  for (const Ready& each : ready) methods.push_back(each.method.get());
  measureInterleaved(
      stage->renderer, stage->camera, methods, rows.experiment().measure, session.clockWatch(),
      [&](std::size_t i, Measurement measurement) {
        measurement.shaders.merge(ready[i].shaders);
        measurement.validationMessages += sharedMessages + ready[i].messages;
        if (!measurement.failure.empty())
          rows.unmeasured(ready[i].cell, "failed", measurement.failure, measurement.shaders);
        else
          rows.measured(ready[i].cell, measurement, stage->renderer, *ready[i].method,
                        stage->camera, judge);
      },
      [&](const std::vector<MeasureProgress>& progress) { rows.progress().measured(progress); });
}

}  // namespace

void measureGroup(Session& session, GroupRows& rows) {
  guarded(
      session.device, [&] { measureOn(session, rows); },
      [&](const std::string& reason) { rows.failRest(reason); });
}

bool stillFail(Session& session, const Experiment& experiment, const std::vector<CellSpec>& cells) {
  std::size_t failures = 0;
  guarded(
      session.device,
      [&] {
        Stage stage(session, cells.front());
        renderReference(experiment.reference, stage);
        for (const CellSpec& cell : cells)
          guarded(
              session.device,
              [&] {
                const auto method = stage.renderer.make(findMethod(cell.method), cell.parameters);
                checkInterrupt();
                stage.renderer.render(*method, stage.camera);
              },
              [&](const std::string&) { ++failures; });
      },
      [&](const std::string&) { failures = cells.size(); });
  return failures == cells.size();
}

}  // namespace oitlab
