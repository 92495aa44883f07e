#pragma once

#include <set>

#include "results/cell_content.h"
#include "results/group_claim.h"
#include "sweep/judge.h"
#include "sweep/sweep_progress.h"

namespace oitlab {

/// How many cells ended how.
struct Outcome {
  std::size_t done = 0, failed = 0, skipped = 0;
  std::size_t withMessages = 0;  ///< about which the validation layers had something to say

  Outcome& operator+=(const Outcome& other) {
    done += other.done;
    failed += other.failed;
    skipped += other.skipped;
    withMessages += other.withMessages;
    return *this;
  }
};

/// What is the same for all groups of a run of the program.
struct RunContext {
  const Experiment& experiment;
  const MeasuredWith& with;
  DeviceInfo device;
  std::string run;  ///< GroupRun::run
};

/// The rows of one group: every cell gets one, measured or not. They are in the results once the
/// claim is committed.
class GroupRows {
 public:
  /// All must outlive this.
  GroupRows(const RunContext& context, const std::vector<CellSpec>& cells, GroupClaim& claim,
            SweepProgress& progress);

  const std::vector<CellSpec>& cells() const { return cells_; }
  const Experiment& experiment() const { return context_.experiment; }
  GroupClaim& claim() { return claim_; }
  SweepProgress& progress() { return progress_; }

  /// `status` is "failed" or "skipped". Tells the user, too.
  void unmeasured(const CellSpec& cell, const std::string& status, const std::string& reason,
                  const ShaderLibrary::Hashes& shaders = {});

  void measured(const CellSpec& cell, const Measurement& measurement, const Renderer& renderer,
                const Method& method, const Camera& camera, Judge& judge);

  /// Every cell without a row failed for this reason.
  void failRest(const std::string& reason);

  const Outcome& outcome() const { return outcome_; }

 private:
  nlohmann::json describe(const CellSpec& cell, const ShaderLibrary::Hashes& shaders) const;
  void write(const CellSpec& cell, const nlohmann::json& content);

  const RunContext& context_;
  const std::vector<CellSpec>& cells_;
  GroupClaim& claim_;
  SweepProgress& progress_;
  std::set<std::string> written_;  ///< ids
  Outcome outcome_;
};

}  // namespace oitlab
