#include "results/cell_content.h"

#include <filesystem>

#include "results/cell_check.h"
#include "results/describe.h"

namespace oitlab {
namespace {

using nlohmann::json;

json describeSummary(const Series& series, std::uint64_t seed) {
  const Summary s = summarize(series.ms, series.block, seed);
  json summary = {{"count", s.count}, {"blocks", s.blocks}, {"median", s.median},
                  {"q1", s.q1},       {"q3", s.q3},         {"mean", s.mean},
                  {"min", s.min},     {"max", s.max},       {"p95", s.p95}};
  summary["ci95"] = s.ci95 ? json({s.ci95->first, s.ci95->second}) : json();
  return summary;
}

void addScene(json& content, const Renderer& renderer, const Camera& camera) {
  const Scene& scene = renderer.scene().scene();
  content["scene"]["triangles"] = scene.triangles.size();
  content["scene"]["transparent_triangles"] = renderer.scene().transparentCount();
  json repairs = json::object();
  for (const Repair& repair : scene.repairs) repairs[repair.what] = repair.count;
  content["scene"]["repairs"] = repairs;
  content["camera"] = describeCamera(camera);
}

void addTimes(json& content, const Measurement& m, std::uint64_t seed) {
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
}

}  // namespace

json describeCell(const CellSpec& cell, const DeviceInfo& device, const Experiment& experiment,
                  const MeasuredWith& with, const GroupRun& run,
                  const ShaderLibrary::Hashes& shaders) {
  json content = cell.identity();
  content["schema"] = cellSchema;
  content["id"] = cellId(cell, device);
  content["experiment"] = experiment.name;
  if (!experiment.overrides.empty()) content["overrides"] = experiment.overrides;
  content["seed"] = experiment.measure.seed;
  content["run"] = run.run;
  content["group"] = run.group;
  content["group_cells"] = run.cells;
  content["scene"]["name"] = std::filesystem::path(cell.scene.source).stem().string();
  if (!cell.scene.opacity) content["scene"]["opacity"] = nullptr;
  content["device"] = describeDevice(device);
  content["provenance"] = describeProvenance(with.validation(), shaders);
  content["reason"] = "";
  with.describe(content);
  return content;
}

void addMeasurement(json& content, const Measurement& m, const Renderer& renderer,
                    const Method& method, const Camera& camera, std::uint64_t seed) {
  addScene(content, renderer, camera);
  addTimes(content, m, seed);
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
}

}  // namespace oitlab
