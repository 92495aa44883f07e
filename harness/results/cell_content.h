#pragma once

#include "measure/measure.h"
#include "results/measured_with.h"

namespace oitlab {

/// Which measurement of a group a cell comes from. Cells were measured in turn, and may be compared
/// block by block, when their `group` is the same.
struct GroupRun {
  std::string run;        ///< the run of the program
  std::string group;      ///< this measurement of this group: different each time
  std::size_t cells = 0;  ///< that were measured in it, whatever became of them
};

/// What every cell says, measured or not: what it is, how it was to be measured, where and when.
/// `shaders` are those that its method used. Status and, where it is not "ok", the reason are still
/// to be set.
nlohmann::json describeCell(const CellSpec& cell, const DeviceInfo& device,
                            const Experiment& experiment, const MeasuredWith& with,
                            const GroupRun& run, const ShaderLibrary::Hashes& shaders);

/// Adds to `content` what was measured: times, their statistics, samples, counters, memory, the
/// scene's size. `seed` is of the bootstrap.
void addMeasurement(nlohmann::json& content, const Measurement& measurement,
                    const Renderer& renderer, const Method& method, const Camera& camera,
                    std::uint64_t seed);

}  // namespace oitlab
