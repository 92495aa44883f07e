#include "measure/measure.h"

#include "util/error.h"
#include "util/interrupt.h"
#include "util/random.h"

namespace oitlab {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What all subjects share.
struct Bench {
  Renderer& renderer;
  const Camera& camera;
  const MeasureSettings& settings;
  ClockWatch* clock;

  FrameResult render(Method& method, bool instrumented = false) const {
    checkInterrupt();
    return renderer.render(method, camera, instrumented);
  }
  double settle() const { return clock ? clock->settle() : 0; }
  bool held() const { return !clock || clock->held(); }
};

struct Subject {
  Method* method = nullptr;
  StopRule rule;
  Measurement result;
  std::vector<double> clockLevels;  ///< before each block that was kept
  std::uint32_t rejectedBlocks = 0;
  int warmupFrames = 1;
  int blockFrames = 1;
  bool finished = false;
};

/// The first frames grow memory and compile what drivers compile late; the last of them tells how
/// many frames make a block.
void prepareSubject(const Bench& bench, Subject& subject) {
  bench.render(*subject.method);
  bench.settle();
  const double ms = bench.render(*subject.method).frameMs.value_or(1.0);
  const double frames = bench.settings.blockSeconds * 1000.0 / std::max(ms, 1e-3);
  subject.blockFrames =
      int(std::clamp(frames, double(bench.settings.minFrames), double(bench.settings.maxFrames)));
  subject.warmupFrames = 1 + subject.blockFrames / 10;
}

void measureBlock(const Bench& bench, Subject& subject) {
  const auto start = Clock::now();
  Measurement& result = subject.result;
  const double level = bench.settle();
  for (int i = 0; i < subject.warmupFrames; ++i) bench.render(*subject.method);
  std::vector<double> block;
  for (int i = 0; i < subject.blockFrames; ++i) {
    const FrameResult frame = bench.render(*subject.method);
    if (!frame.frameMs || frame.recordings > 1)
      ++result.rejectedSamples;
    else
      block.push_back(*frame.frameMs);
  }
  if (bench.held()) {
    for (const double ms : block) result.frame.add(ms, result.blocks);
    if (!block.empty()) subject.clockLevels.push_back(level);
  } else {
    ++subject.rejectedBlocks;
    block.clear();
  }
  const double seconds = secondsSince(start);
  result.seconds += seconds;
  ++result.blocks;
  if (block.empty()) {
    subject.rule.addBlock(std::numeric_limits<double>::quiet_NaN(), seconds);  // towards the limits
    return;
  }
  std::sort(block.begin(), block.end());
  subject.rule.addBlock(quantileOfSorted(block, 0.5), seconds);
}

/// The labelled run of the stages. Whether all of it was at full clock.
bool measureStages(const Bench& bench, Subject& subject) {
  Measurement& result = subject.result;
  const MeasureSettings& settings = bench.settings;
  std::vector<double> levels = {bench.settle()};
  const auto start = Clock::now();
  auto settledAt = start;
  bool held = true;
  for (int i = 0; i < settings.stageFrames; ++i) {
    const FrameResult frame = bench.render(*subject.method, true);
    result.counters = frame.counters;
    if (result.stageOrder.empty())
      for (const auto& [name, ms] : frame.stageMs) result.stageOrder.push_back(name);
    for (const auto& [name, ms] : frame.stageMs) result.stages[name].add(ms, 0);
    // Stages explain the headline and are not it: on a slow device a few frames will do.
    if (secondsSince(start) > 0.25 * settings.stop.timeLimitSeconds && i >= 2) break;
    if (secondsSince(settledAt) > settings.blockSeconds) {
      held = bench.held() && held;
      levels.push_back(bench.settle());
      settledAt = Clock::now();
    }
  }
  held = bench.held() && held;
  return held && std::all_of(levels.begin(), levels.end(), [&](double level) {
           return !bench.clock || bench.clock->isFull(level);
         });
}

/// Judged at the end: by then the best is better known than it was at the first block.
ClockRecord describeClock(const ClockWatch& clock, const Subject& subject, bool stagesSettled) {
  ClockRecord record;
  std::vector<double> levels = subject.clockLevels;
  std::sort(levels.begin(), levels.end());
  record.bestMs = clock.bestMs();
  record.medianMs = quantileOfSorted(levels, 0.5);
  record.rejectedBlocks = subject.rejectedBlocks;
  record.unsettledBlocks = std::uint32_t(
      std::count_if(levels.begin(), levels.end(), [&](double ms) { return !clock.isFull(ms); }));
  record.settled = stagesSettled && record.unsettledBlocks == 0;
  return record;
}

/// The image of the timed configuration, then its stages.
void finishSubject(const Bench& bench, Subject& subject) {
  Measurement& result = subject.result;
  if (result.frame.ms.empty() && subject.rejectedBlocks > 0)
    fail<DeviceError>(
        "the device's clock changed by more than {:.0f}% in each of {} blocks; lock it (NVIDIA: "
        "nvidia-smi --lock-gpu-clocks), keep other programs off the device, or raise time_limit",
        100 * bench.clock->limits().blockTolerance, subject.rejectedBlocks);
  if (result.frame.ms.empty()) throw DeviceError("the device gave no usable timestamps");
  result.stopReason = subject.rule.stopReason();
  result.relativeSpread = subject.rule.relativeSpread();
  bench.render(*subject.method);
  result.image = bench.renderer.target().readBytes(bench.renderer.device());
  const bool stagesSettled = measureStages(bench, subject);
  if (bench.clock) result.clock = describeClock(*bench.clock, subject, stagesSettled);
}

std::size_t messageCount(const Device& device) {
  return device.validation() ? device.validationMessages().size() : 0;
}

std::vector<MeasureProgress> progressOf(const std::vector<Subject>& subjects) {
  std::vector<MeasureProgress> progress;
  progress.reserve(subjects.size());
  for (const Subject& subject : subjects)
    progress.push_back({subject.result.blocks, subject.result.seconds, subject.finished});
  return progress;
}

}  // namespace

void measureInterleaved(
    Renderer& renderer, const Camera& camera, const std::vector<Method*>& methods,
    const MeasureSettings& settings, ClockWatch* clock,
    const std::function<void(std::size_t, Measurement)>& done,
    const std::function<void(const std::vector<MeasureProgress>&)>& afterBlock) {
  const Bench bench{renderer, camera, settings, clock};
  std::vector<Subject> subjects;
  subjects.reserve(methods.size());
  for (Method* method : methods) subjects.push_back({method, StopRule(settings.stop), {}});
  Pcg32 random(settings.seed);

  auto guarded = [&](std::size_t i, auto&& step) {
    Subject& subject = subjects[i];
    const Device& device = renderer.device();
    const std::size_t messages = messageCount(device);
    const auto failed = [&](const std::string& reason) {
      if (device.isLost()) throw DeviceLost(reason);
      subject.result.failure = reason;
      subject.finished = true;
    };
    try {
      const ShaderLibrary::Recording recording(device.shaders(), subject.result.shaders);
      step(subject);
    } catch (const DeviceLost&) {
      throw;
    } catch (const DeviceError& error) {
      failed(error.what());
    } catch (const vk::SystemError& error) {
      failed(fmt::format("{} failed while working: {}", device.info().name, error.what()));
    }
    subject.result.validationMessages += messageCount(device) - messages;
    if (subject.finished) done(i, std::move(subject.result));
  };
  for (std::size_t i = 0; i < subjects.size(); ++i)
    guarded(i, [&](Subject& subject) { prepareSubject(bench, subject); });

  for (;;) {
    std::vector<std::size_t> turn;
    for (std::size_t i = 0; i < subjects.size(); ++i)
      if (!subjects[i].finished) turn.push_back(i);
    if (turn.empty()) return;
    for (std::size_t i = turn.size(); i > 1; --i) std::swap(turn[i - 1], turn[random.next() % i]);
    for (const std::size_t i : turn) {
      guarded(i, [&](Subject& subject) {
        measureBlock(bench, subject);
        if (subject.rule.stopReason().empty()) return;
        finishSubject(bench, subject);
        subject.finished = true;
      });
      if (afterBlock) afterBlock(progressOf(subjects));
    }
  }
}

}  // namespace oitlab
