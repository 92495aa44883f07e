#include "sweep/group_rows.h"

namespace oitlab {

GroupRows::GroupRows(const RunContext& context, const std::vector<CellSpec>& cells,
                     GroupClaim& claim, SweepProgress& progress)
    : context_(context), cells_(cells), claim_(claim), progress_(progress) {}

nlohmann::json GroupRows::describe(const CellSpec& cell,
                                   const ShaderLibrary::Hashes& shaders) const {
  return describeCell(cell, context_.device, context_.experiment, context_.with,
                      {context_.run, claim_.token(), cells_.size()}, shaders);
}

void GroupRows::write(const CellSpec& cell, const nlohmann::json& content) {
  const std::string id = cellId(cell, context_.device);
  claim_.writeCell(id, content);
  written_.insert(id);
}

void GroupRows::unmeasured(const CellSpec& cell, const std::string& status,
                           const std::string& reason, const ShaderLibrary::Hashes& shaders) {
  nlohmann::json content = describe(cell, shaders);
  content["status"] = status;
  content["reason"] = reason;
  (status == "failed" ? outcome_.failed : outcome_.skipped) += 1;
  progress_.say(fmt::format("{}: {}: {}", status, cell.label(), reason));
  write(cell, content);
}

void GroupRows::measured(const CellSpec& cell, const Measurement& measurement,
                         const Renderer& renderer, const Method& method, const Camera& camera,
                         Judge& judge) {
  nlohmann::json content = describe(cell, measurement.shaders);
  content["status"] = "ok";
  addMeasurement(content, measurement, renderer, method, camera, context_.experiment.measure.seed);
  content.update(judge.judge(cellId(cell, context_.device), measurement.image,
                             renderer.target().toImage(measurement.image)));
  if (context_.with.validation()) content["validation_messages"] = measurement.validationMessages;
  outcome_.withMessages += measurement.validationMessages > 0;
  ++outcome_.done;
  write(cell, content);
}

void GroupRows::failRest(const std::string& reason) {
  for (const CellSpec& cell : cells_)
    if (!written_.contains(cellId(cell, context_.device))) unmeasured(cell, "failed", reason);
}

}  // namespace oitlab
