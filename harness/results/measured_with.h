#pragma once

#include "experiment/experiment.h"
#include "gpu/device.h"
#include "gpu/shader.h"

namespace oitlab {

/// What a cell is measured with besides what it is: a cell that was measured otherwise does not
/// answer the question that is asked now.
class MeasuredWith {
 public:
  MeasuredWith(const Experiment& experiment, const Device::Options& device);

  /// The fields of a cell that say so: "profile", "measure", "reference", and in "provenance"
  /// "build", "source" and "validation". The shaders are those that the method compiled.
  void describe(nlohmann::json& cell) const;

  bool validation() const { return now_.at("provenance").at("validation").get<bool>(); }

  /// In which of them a whole cell differs from what would be measured now, a line each, such as
  /// "measure.time_limit is 2, now 10". Shaders are compared by the hash of their text, what they
  /// include, and their definitions.
  std::vector<std::string> differences(const nlohmann::json& cell);

 private:
  /// The hash of a variant now, by the label that a cell gives it; "" where there is no such file.
  std::string shaderHash(const std::string& label);

  nlohmann::json now_;
  ShaderLibrary shaders_;
  std::map<std::string, std::string> hashes_;
};

}  // namespace oitlab
