#pragma once

#include <set>

#include "results/measured_with.h"

namespace oitlab {

/// What a results folder holds of one cell.
struct CellState {
  enum Kind {
    missing,
    damaged,    ///< a file that is no whole cell
    failed,     ///< a row with the reason of a failure
    different,  ///< whole, but measured with other settings, shaders or program
    there       ///< whole and as it would be measured now: ok, or skipped with a reason
  };
  Kind kind = missing;
  std::string reason;  ///< of any but `missing` and `there`: what was found
  std::string group;   ///< GroupRun::group, of whole cells
  std::uint64_t validationMessages = 0;
};

/// What it holds of a group: the cells in the order that was asked for.
struct GroupState {
  std::vector<CellState> cells;

  /// Every cell is there, and all are of one measurement of the group.
  bool isComplete() const { return fromOneRun() && count(CellState::there) == cells.size(); }

  /// Complete but for cells that failed: they may fail again, and then nothing else is to be done.
  bool lacksOnlyFailed() const;

  std::size_t count(CellState::Kind kind) const;

  /// Why what is there has to be measured again, for people: "" where nothing is there.
  std::string whyAgain() const;

 private:
  bool fromOneRun() const;
};

/// The cells/ and images/ of a results folder, as far as one experiment on one device goes.
class ResultsFolder {
 public:
  /// `keep`: cells that were measured otherwise count as there. Makes nothing.
  ResultsFolder(std::filesystem::path path, const DeviceInfo& device, MeasuredWith with, bool keep);

  /// Makes the folders. Throws OutputError where they cannot be written.
  void make() const;

  /// Reads what is there of the cells of a group. Throws InputError where a newer version wrote
  /// one.
  GroupState look(const std::vector<CellSpec>& group);

  const std::filesystem::path& path() const { return path_; }
  const MeasuredWith& with() const { return with_; }

  /// Cells that count as there although they were measured otherwise, with the differences, as
  /// look() met them: a line each.
  const std::set<std::string>& kept() const { return kept_; }

 private:
  CellState look(const CellSpec& cell);

  std::filesystem::path path_;
  DeviceInfo device_;
  MeasuredWith with_;
  bool keep_;
  std::set<std::string> kept_;
};

}  // namespace oitlab
