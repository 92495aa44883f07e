#include "measure/measure.h"

#include "util/error.h"
#include "util/random.h"

namespace oitlab {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Subject {
  Method* method = nullptr;
  StopRule rule;
  Measurement result;
  int warmupFrames = 1;
  int blockFrames = 1;
  bool finished = false;
};

/// The first frames grow memory and compile what drivers compile late; the last of them tells how
/// many frames make a block.
void prepareSubject(Renderer& renderer, const Camera& camera, const MeasureSettings& settings,
                    Subject& subject) {
  renderer.render(*subject.method, camera);
  const double ms = renderer.render(*subject.method, camera).frameMs.value_or(1.0);
  const double frames = settings.blockSeconds * 1000.0 / std::max(ms, 1e-3);
  subject.blockFrames =
      int(std::clamp(frames, double(settings.minFrames), double(settings.maxFrames)));
  subject.warmupFrames = 1 + subject.blockFrames / 10;
}

void measureBlock(Renderer& renderer, const Camera& camera, Subject& subject) {
  const auto start = Clock::now();
  Measurement& result = subject.result;
  for (int i = 0; i < subject.warmupFrames; ++i) renderer.render(*subject.method, camera);
  std::vector<double> block;
  for (int i = 0; i < subject.blockFrames; ++i) {
    const FrameResult frame = renderer.render(*subject.method, camera);
    if (!frame.frameMs || frame.recordings > 1) {
      ++result.rejectedSamples;
      continue;
    }
    block.push_back(*frame.frameMs);
    result.frame.add(*frame.frameMs, result.blocks);
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

/// The image of the timed configuration, then the labelled run of its stages.
void finishSubject(Renderer& renderer, const Camera& camera, const MeasureSettings& settings,
                   Subject& subject) {
  Measurement& result = subject.result;
  if (result.frame.ms.empty()) throw DeviceError("the device gave no usable timestamps");
  result.stopReason = subject.rule.stopReason();
  result.relativeSpread = subject.rule.relativeSpread();
  renderer.render(*subject.method, camera);
  result.image = renderer.target().readBytes(renderer.device());
  const auto start = Clock::now();
  for (int i = 0; i < settings.stageFrames; ++i) {
    const FrameResult frame = renderer.render(*subject.method, camera, true);
    result.counters = frame.counters;
    if (result.stageOrder.empty())
      for (const auto& [name, ms] : frame.stageMs) result.stageOrder.push_back(name);
    for (const auto& [name, ms] : frame.stageMs) result.stages[name].add(ms, 0);
    // Stages explain the headline and are not it: on a slow device a few frames will do.
    if (secondsSince(start) > 0.25 * settings.stop.timeLimitSeconds && i >= 2) break;
  }
}

}  // namespace

void measureInterleaved(Renderer& renderer, const Camera& camera,
                        const std::vector<Method*>& methods, const MeasureSettings& settings,
                        const std::function<void(std::size_t, Measurement)>& done) {
  std::vector<Subject> subjects;
  for (Method* method : methods) subjects.push_back({method, StopRule(settings.stop), {}});
  Pcg32 random(settings.seed);

  auto guarded = [&](std::size_t i, auto&& step) {
    Subject& subject = subjects[i];
    try {
      step(subject);
    } catch (const DeviceError& error) {
      subject.result.failure = error.what();
      subject.finished = true;
    }
    if (subject.finished) done(i, std::move(subject.result));
  };
  for (std::size_t i = 0; i < subjects.size(); ++i)
    guarded(i, [&](Subject& subject) { prepareSubject(renderer, camera, settings, subject); });

  for (;;) {
    std::vector<std::size_t> turn;
    for (std::size_t i = 0; i < subjects.size(); ++i)
      if (!subjects[i].finished) turn.push_back(i);
    if (turn.empty()) return;
    for (std::size_t i = turn.size(); i > 1; --i) std::swap(turn[i - 1], turn[random.next() % i]);
    for (const std::size_t i : turn)
      guarded(i, [&](Subject& subject) {
        measureBlock(renderer, camera, subject);
        if (subject.rule.stopReason().empty()) return;
        finishSubject(renderer, camera, settings, subject);
        subject.finished = true;
      });
  }
}

}  // namespace oitlab
