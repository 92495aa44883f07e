#pragma once

#include <filesystem>
#include <limits>

#include "results/results_folder.h"
#include "sweep/group_rows.h"

namespace oitlab {

struct SweepOptions {
  Device::Options device;
  double seconds = std::numeric_limits<double>::infinity();  ///< after them no group is begun
  bool keep = false;  ///< cells that were measured otherwise count as there
};

struct SweepSummary {
  Outcome outcome;                ///< of the cells that this run measured
  std::size_t present = 0;        ///< cells that were there, or that another run made meanwhile
  std::size_t left = 0;           ///< not begun, because the time was over
  std::vector<std::string> kept;  ///< that were measured otherwise, with the differences
};

/// Measures the cells that `results` does not hold as they would be measured now. The cells of a
/// group (same scene, view, size and format) are measured in turn and appear all at once, or not at
/// all; a group that is not complete, from one run, is measured again as a whole. Any number of
/// processes may fill one folder: each group is measured by one of them. A cell that cannot be
/// measured is a row with the reason. A device that is lost is opened anew.
///
/// Throws InputError before anything is measured, when a size is beyond the device; DeviceError
/// when there is no device to begin with; OutputError when results cannot be written; Interrupted
/// on a signal: the group in progress is dropped.
SweepSummary runExperiment(const SweepOptions& options, const Experiment& experiment,
                           const std::vector<CellSpec>& cells,
                           const std::filesystem::path& results);

/// What a run would find, device unopened.
struct SweepForecast {
  struct Line {
    CellSpec cell;
    CellState state;
    bool again = false;  ///< to be measured, whatever its own state: its group is not complete
  };
  std::vector<Line> lines;
  std::size_t toMeasure = 0;
  double seconds = 0;  ///< how long measuring them takes (see Pace)
};

SweepForecast forecast(const SweepOptions& options, const DeviceInfo& device,
                       const Experiment& experiment, const std::vector<CellSpec>& cells,
                       const std::filesystem::path& results);

}  // namespace oitlab
