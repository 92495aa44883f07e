#include "experiment/run.h"

#include <unistd.h>

#include "experiment/describe.h"
#include "experiment/last_scene.h"
#include "image/hash.h"
#include "measure/clock_probe.h"
#include "quality/compare.h"
#include "util/error.h"
#include "util/json_file.h"
#include "util/progress.h"
#include "util/version.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json describeSummary(const Series& series, std::uint64_t seed) {
  const Summary s = summarize(series.ms, series.block, seed);
  return {{"count", s.count}, {"median", s.median}, {"q1", s.q1},
          {"q3", s.q3},       {"mean", s.mean},     {"min", s.min},
          {"max", s.max},     {"p95", s.p95},       {"ci95", {s.ciLow, s.ciHigh}}};
}

/// What was found of an image: many cells of a group have the same.
struct Judged {
  json quality;
  fs::path file;
};

json describeQuality(const Image& image, const Image& reference, const std::string& name) {
  json quality = describeComparison(compareImages(image, reference));
  quality["reference"] = name;
  return quality;
}

/// One run over a results folder.
class Run {
 public:
  Run(const Device& device, const Experiment& experiment, fs::path results, Progress& progress)
      : device_(device),
        experiment_(experiment),
        results_(std::move(results)),
        progress_(progress),
        scene_(device) {
    if (device.info().isCpu()) return;
    probe_.emplace(device);
    probe_->fit();
    clock_.emplace([this] { return probe_->run(); });
  }

  void measureGroup(const std::vector<CellSpec>& cells);

  RunSummary summary;

 private:
  /// What every cell says, measured or not.
  json header(const CellSpec& cell) const;
  void writeCell(const CellSpec& cell, json content);
  void writeUnmeasured(const CellSpec& cell, const std::string& status, const std::string& reason);
  void writeMeasured(const CellSpec& cell, const Renderer& renderer, const Method& method,
                     const Camera& camera, const Measurement& measurement,
                     const std::optional<Image>& reference);
  std::optional<Image> renderReference(Renderer& renderer, const Camera& camera) const;
  void measureOn(const std::vector<CellSpec>& cells);

  const Device& device_;
  const Experiment& experiment_;
  fs::path results_;
  Progress& progress_;
  LastScene scene_;
  // One for all groups, which share what is known of the clock. A CPU's is not the program's to
  // see: its threads compete with all others.
  std::optional<ClockProbe> probe_;
  std::optional<ClockWatch> clock_;
  std::map<std::string, Judged> judged_;  // by hash, of the group that is being measured
  const std::string runId_ =
      fmt::format("{} {}", getpid(), std::chrono::system_clock::now().time_since_epoch().count());
};

json Run::header(const CellSpec& cell) const {
  json content = cell.identity();
  content["schema"] = 1;
  content["id"] = cellId(cell, device_.info());
  content["experiment"] = experiment_.name;
  content["profile"] = experiment_.profile;
  if (!experiment_.overrides.empty()) content["overrides"] = experiment_.overrides;
  content["seed"] = experiment_.measure.seed;
  json group = cell.identity();
  group.erase("method");
  group.erase("parameters");
  // Cells of another run of the program were not measured in turn with these: not the same group.
  const std::string text = group.dump() + device_.info().name + runId_;
  content["group"] = imageHash(std::as_bytes(std::span(text))).substr(0, 16);
  content["scene"]["name"] = fs::path(cell.scene.source).stem().string();
  if (!cell.scene.opacity) content["scene"]["opacity"] = nullptr;
  content["device"] = describeDevice(device_.info());
  content["provenance"] = describeProvenance(device_, cell.method);
  content["reason"] = "";
  return content;
}

void Run::writeCell(const CellSpec& cell, json content) {
  const std::string id = cellId(cell, device_.info());
  writeJsonFile(results_ / "cells" / (id + ".json"), content);
  progress_.finish();
}

void Run::writeUnmeasured(const CellSpec& cell, const std::string& status,
                          const std::string& reason) {
  json content = header(cell);
  content["status"] = status;
  content["reason"] = reason;
  (status == "failed" ? summary.failed : summary.skipped) += 1;
  progress_.clear();
  fmt::print(stderr, "{}: {}: {}\n", status, cell.label(), reason);
  writeCell(cell, std::move(content));
}

void Run::writeMeasured(const CellSpec& cell, const Renderer& renderer, const Method& method,
                        const Camera& camera, const Measurement& m,
                        const std::optional<Image>& reference) {
  const std::uint64_t seed = experiment_.measure.seed;
  const Scene& scene = renderer.scene().scene();
  json content = header(cell);
  content["status"] = "ok";
  content["scene"]["triangles"] = scene.triangles.size();
  content["scene"]["transparent_triangles"] = renderer.scene().transparentCount();
  json repairs = json::object();
  for (const Repair& repair : scene.repairs) repairs[repair.what] = repair.count;
  content["scene"]["repairs"] = repairs;
  content["camera"] = describeCamera(camera);

  json stageMedians = json::object(), stageStatistics = json::object(),
       stageSamples = json::object();
  for (const auto& [name, series] : m.stages) {
    stageStatistics[name] = describeSummary(series, seed);
    stageMedians[name] = stageStatistics[name]["median"];
    stageSamples[name] = {{"ms", series.ms}, {"block", series.block}};
  }
  const json frame = describeSummary(m.frame, seed);
  content["gpu_ms"] = {{"frame", frame["median"]}, {"stages", stageMedians}};
  content["stage_order"] = m.stageOrder;
  content["statistics"] = {{"frame", frame}, {"stages", stageStatistics}};
  content["samples"] = {
      {"frame_ms", m.frame.ms}, {"block", m.frame.block}, {"stages", stageSamples}};
  content["stop"] = {{"reason", m.stopReason},
                     {"relative_spread", m.relativeSpread},
                     {"blocks", m.blocks},
                     {"seconds", m.seconds},
                     {"rejected_samples", m.rejectedSamples}};
  if (m.clock)
    content["clock"] = {{"probe_ms_best", m.clock->bestMs},
                        {"probe_ms_median", m.clock->medianMs},
                        {"rejected_blocks", m.clock->rejectedBlocks},
                        {"unsettled_blocks", m.clock->unsettledBlocks},
                        {"settled", m.clock->settled}};
  content["counters"] = m.counters;
  content["memory_bytes"] = describeMemory(renderer, method);

  const Image image = renderer.target().toImage(m.image);
  const std::string hash = imageHash(m.image);
  const std::string file = "images/" + content["id"].get<std::string>() + ".png";
  const auto same = judged_.find(hash);
  std::error_code error;
  if (same != judged_.end())
    fs::copy_file(same->second.file, results_ / file, fs::copy_options::overwrite_existing, error);
  if (same == judged_.end() || error) writeImage(results_ / file, image);
  if (same != judged_.end()) {
    content["quality"] = same->second.quality;
  } else {
    content["quality"] = nullptr;
    if (reference) content["quality"] = describeQuality(image, *reference, experiment_.reference);
    judged_[hash] = {content["quality"], results_ / file};
  }
  content["image_hash"] = hash;
  content["image"] = {{"file", file}};
  ++summary.done;
  writeCell(cell, std::move(content));
}

/// The image that the group is judged by. Without one the cells are measured all the same, and say
/// nothing about quality.
std::optional<Image> Run::renderReference(Renderer& renderer, const Camera& camera) const {
  if (experiment_.reference.empty()) return std::nullopt;
  const MethodInfo& info = findMethod(experiment_.reference);
  try {
    const auto method = renderer.make(info, Parameters(info.parameters, {}, info.name));
    renderer.render(*method, camera);
    return renderer.target().toImage(renderer.target().readBytes(device_));
  } catch (const DeviceError& error) {
    fmt::print(stderr, "no reference image: {}\n", error.what());
    return std::nullopt;
  }
}

void Run::measureOn(const std::vector<CellSpec>& cells) {
  const CellSpec& first = cells.front();
  const GpuScene& gpuScene = scene_.get(first.scene);
  const Camera camera = findView(gpuScene.scene(), first.view);
  const Target target(device_, first.width, first.height, first.format);
  Renderer renderer(device_, gpuScene, target);
  const auto reference = renderReference(renderer, camera);
  judged_.clear();

  std::vector<CellSpec> ready;
  std::vector<std::unique_ptr<Method>> owned;
  std::vector<Method*> prepared;
  for (const CellSpec& cell : cells) {
    const MethodInfo& info = findMethod(cell.method);
    if (const auto missing = info.missing(device_.info()); !missing.empty()) {
      writeUnmeasured(cell, "skipped",
                      fmt::format("{} lacks {}", device_.info().name, fmt::join(missing, ", ")));
      continue;
    }
    try {
      owned.push_back(renderer.make(info, cell.parameters));
      prepared.push_back(owned.back().get());
      ready.push_back(cell);
    } catch (const DeviceError& error) {
      writeUnmeasured(cell, "failed", error.what());
    }
  }
  measureInterleaved(renderer, camera, prepared, experiment_.measure, clock_ ? &*clock_ : nullptr,
                     [&](std::size_t i, Measurement measurement) {
                       if (!measurement.failure.empty())
                         writeUnmeasured(ready[i], "failed", measurement.failure);
                       else
                         writeMeasured(ready[i], renderer, *prepared[i], camera, measurement,
                                       reference);
                     });
}

void Run::measureGroup(const std::vector<CellSpec>& cells) {
  progress_.begin(cells.size() == 1 ? cells.front().label()
                                    : fmt::format("{} (and {} against it)", cells.front().label(),
                                                  cells.size() - 1));
  // Whatever stops a whole group (a broken file, an unknown view, memory) is the reason of each of
  // its cells that is not there yet, and the next group goes on.
  auto failAll = [&](const std::string& reason) {
    for (const CellSpec& cell : cells)
      if (!fs::exists(results_ / "cells" / (cellId(cell, device_.info()) + ".json")))
        writeUnmeasured(cell, "failed", reason);
  };
  try {
    measureOn(cells);
  } catch (const InputError& error) {
    failAll(error.what());
  } catch (const DeviceError& error) {
    failAll(error.what());
  }
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path probe = folder / ".writable";
  if (error || !std::ofstream(probe))
    fail<InputError>("{}: results cannot be written there{}", folder.string(),
                     error ? ": " + error.message() : "");
  fs::remove(probe, error);
}

}  // namespace

RunSummary runExperiment(const Device& device, const Experiment& experiment,
                         const std::vector<CellSpec>& cells, const fs::path& results,
                         double seconds) {
  const auto start = std::chrono::steady_clock::now();
  for (const CellSpec& cell : cells) checkTargetSize(device.info(), cell.width, cell.height);
  makeFolder(results / "cells");
  makeFolder(results / "images");

  RunSummary before;
  std::vector<CellSpec> wanted;
  for (const CellSpec& cell : cells) {
    const fs::path path = results / "cells" / (cellId(cell, device.info()) + ".json");
    bool present = false;
    if (fs::exists(path)) try {
        const json content = readJsonFile(path);
        present = content.value("status", "") != "failed";
        const std::string commit = content.at("provenance").value("commit", "");
        if (present && commit != builtCommit()) ++before.otherVersion;
      } catch (const std::exception& error) {
        fmt::print(stderr, "{}: measured again: {}\n", path.string(), error.what());
      }
    if (present)
      ++before.present;
    else
      wanted.push_back(cell);
    // A failed or damaged cell is tried again from nothing.
    if (!present) {
      std::error_code ignored;
      fs::remove(path, ignored);
    }
  }

  Progress progress(wanted.size());
  Run run(device, experiment, results, progress);
  for (const auto& group : groupCells(wanted)) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    if (passed.count() < seconds)
      run.measureGroup(group);
    else
      run.summary.left += group.size();
  }
  progress.clear();
  run.summary.present = before.present;
  run.summary.otherVersion = before.otherVersion;
  return run.summary;
}

}  // namespace oitlab
