#include "sweep/run.h"

#include <unistd.h>

#include <thread>

#include "image/hash.h"
#include "results/results_folder.h"
#include "sweep/device_claim.h"
#include "sweep/group.h"
#include "util/error.h"
#include "util/interrupt.h"
#include "util/paths.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;
using Group = std::vector<CellSpec>;
using Clock = std::chrono::steady_clock;

/// A device that is lost so often in a row over one group is not lost by chance.
constexpr int mostLosses = 3;

/// Other processes take at least seconds for a group.
constexpr std::chrono::milliseconds waitForOthers{500};

fs::path paceFile(const DeviceInfo& device) {
  const std::string name = device.name + device.driver + device.driverInfo;
  return cacheRoot() / "pace" / (imageHash(std::as_bytes(std::span(name))).substr(0, 16) + ".json");
}

/// One run of the program over a results folder.
class Sweep {
 public:
  Sweep(const SweepOptions& options, const Experiment& experiment, ResultsFolder& folder,
        const DeviceInfo& device, const std::vector<Group>& groups, Pace& pace,
        Clock::time_point start);

  /// The device is open already: without one there is nothing to begin with.
  void setSession(std::unique_ptr<Session> session) { session_ = std::move(session); }

  void run();

  SweepSummary summary;

 private:
  /// Whether the group is done with. False where another process holds it.
  bool attempt(const Group& group);
  /// Whether nothing is to be measured of the group: it is there, or what failed fails again.
  bool isThere(const Group& group, const GroupState& state);
  void measure(const Group& group, GroupClaim& claim);
  void warnOfOthers();
  void waitFor(std::vector<Group> held);
  bool isOver() const;
  Session& session();

  const SweepOptions& options_;
  ResultsFolder& folder_;
  RunContext context_;
  std::vector<Group> groups_;
  SweepProgress progress_;
  std::unique_ptr<Session> session_;
  std::optional<DeviceClaim> device_;
  bool warnedOfOthers_ = false;
  std::string holder_;  ///< of the last group that another process held
  const Clock::time_point start_;
};

std::vector<GroupSize> sizesOf(const std::vector<Group>& groups) {
  std::vector<GroupSize> sizes;
  sizes.reserve(groups.size());
  for (const Group& group : groups) sizes.push_back(sizeOf(group));
  return sizes;
}

Sweep::Sweep(const SweepOptions& options, const Experiment& experiment, ResultsFolder& folder,
             const DeviceInfo& device, const std::vector<Group>& groups, Pace& pace,
             Clock::time_point start)
    : options_(options),
      folder_(folder),
      context_{experiment, folder.with(), device,
               fmt::format("{} {}", getpid(),
                           std::chrono::system_clock::now().time_since_epoch().count())},
      groups_(groups),
      progress_(sizesOf(groups), pace),
      start_(start) {}

bool Sweep::isOver() const {
  return std::chrono::duration<double>(Clock::now() - start_).count() >= options_.seconds;
}

Session& Sweep::session() {
  if (!session_) session_ = std::make_unique<Session>(options_.device);
  return *session_;
}

void Sweep::run() {
  std::vector<Group> held;
  for (const Group& group : groups_) {
    checkInterrupt();
    if (isOver())
      summary.left += group.size();
    else if (!attempt(group))
      held.push_back(group);
  }
  waitFor(std::move(held));
}

void Sweep::waitFor(std::vector<Group> held) {
  std::string said;
  while (!held.empty()) {
    if (holder_ != said)
      progress_.say(fmt::format("waiting for {} groups of cells that {} measures", held.size(),
                                said = holder_));
    std::this_thread::sleep_for(waitForOthers);
    checkInterrupt();
    if (isOver()) {
      for (const Group& group : held) summary.left += group.size();
      return;
    }
    std::erase_if(held, [&](const Group& group) { return attempt(group); });
  }
}

bool Sweep::attempt(const Group& group) {
  const auto claim =
      GroupClaim::take(folder_.path(), groupKey(group.front(), context_.device), holder_);
  if (!claim) return false;
  // Whoever held it before may have been killed within its commit.
  finishCommits(folder_.path());
  const GroupState state = folder_.look(group);
  if (state.isComplete()) {
    summary.present += group.size();
    progress_.leaveOut(group);
    return true;
  }
  if (const std::string why = state.whyAgain(); !why.empty() && !state.lacksOnlyFailed())
    progress_.say(
        fmt::format("measured again, with all {} cells of its group: {}", group.size(), why));
  progress_.begin(group);
  warnOfOthers();
  if (!isThere(group, state)) measure(group, *claim);
  return true;
}

bool Sweep::isThere(const Group& group, const GroupState& state) {
  if (!state.lacksOnlyFailed()) return false;
  Group failures;
  for (std::size_t i = 0; i < group.size(); ++i)
    if (state.cells[i].kind == CellState::failed) failures.push_back(group[i]);
  try {
    if (!stillFail(session(), context_.experiment, failures)) return false;
  } catch (const DeviceHung&) {
    session_.reset();  // it failed again; another try would take as long
  } catch (const DeviceLost&) {
    session_.reset();
    return false;  // measure() deals with losses
  }
  for (const CellState& cell : state.cells)
    if (cell.kind == CellState::failed) progress_.say("again: " + cell.reason);
  summary.outcome.failed += failures.size();
  summary.present += group.size() - failures.size();
  progress_.end(false);
  return true;
}

void Sweep::warnOfOthers() {
  if (!device_) device_.emplace(session().device.uuid());
  // Asked before each group: the process that has it may end, and a third one may come.
  if (device_->take() || warnedOfOthers_) return;
  progress_.say(fmt::format(
      "another process measures on {} too: the times of both are worth nothing while both run",
      context_.device.name));
  warnedOfOthers_ = true;
}

void Sweep::measure(const Group& group, GroupClaim& claim) {
  Outcome outcome;
  for (int losses = 0;;) {
    GroupRows rows(context_, group, claim, progress_);
    std::string lost;
    try {
      measureGroup(session(), rows);
    } catch (const DeviceHung& error) {
      lost = error.what();  // another try would take as long
      losses = mostLosses - 1;
    } catch (const DeviceLost& error) {
      lost = error.what();
    } catch (const DeviceError& error) {
      lost = error.what();  // it cannot be opened anew
      losses = mostLosses - 1;
    }
    if (!lost.empty()) {
      session_.reset();
      if (++losses < mostLosses) {
        progress_.say(fmt::format("the device was lost ({}): it is opened anew", lost));
        continue;
      }
      rows.failRest(
          fmt::format("the device hangs, cannot be opened, or was lost {} times in a row: {}",
                      mostLosses, lost));
    }
    outcome = rows.outcome();
    break;
  }
  const bool committed = claim.commit();
  if (committed)
    summary.outcome += outcome;
  else
    progress_.say(
        fmt::format("{}: dropped, since another run took the group over while this one stood still",
                    group.front().label()));
  progress_.end(true);
}

}  // namespace

SweepSummary runExperiment(const SweepOptions& options, const Experiment& experiment,
                           const std::vector<CellSpec>& cells, const fs::path& results) {
  const auto start = Clock::now();
  auto session = std::make_unique<Session>(options.device);
  const DeviceInfo device = session->device.info();
  for (const CellSpec& cell : cells) checkTargetSize(device, cell.width, cell.height);

  ResultsFolder folder(results, device, MeasuredWith(experiment, options.device), options.keep);
  folder.make();
  finishCommits(results);
  SweepSummary before;
  std::vector<Group> wanted;
  for (const Group& group : groupCells(cells)) {
    const GroupState state = folder.look(group);
    if (!state.isComplete()) {
      wanted.push_back(group);
      continue;
    }
    before.present += group.size();
    for (const CellState& cell : state.cells)
      before.outcome.withMessages += cell.validationMessages > 0;
  }

  Pace pace(experiment.measure, device.isCpu());
  pace.load(paceFile(device));
  Sweep sweep(options, experiment, folder, device, wanted, pace, start);
  sweep.setSession(std::move(session));
  sweep.run();
  pace.save(paceFile(device));
  sweep.summary.present += before.present;
  sweep.summary.outcome.withMessages += before.outcome.withMessages;
  sweep.summary.kept.assign(folder.kept().begin(), folder.kept().end());
  return sweep.summary;
}

SweepForecast forecast(const SweepOptions& options, const DeviceInfo& device,
                       const Experiment& experiment, const std::vector<CellSpec>& cells,
                       const fs::path& results) {
  ResultsFolder folder(results, device, MeasuredWith(experiment, options.device), options.keep);
  Pace pace(experiment.measure, device.isCpu());
  pace.load(paceFile(device));
  SweepForecast found;
  for (const Group& group : groupCells(cells)) {
    const GroupState state = folder.look(group);
    const bool complete = state.isComplete();
    for (std::size_t i = 0; i < group.size(); ++i)
      found.lines.push_back({group[i], state.cells[i], !complete});
    if (complete) continue;
    found.toMeasure += group.size();
    found.seconds += pace.secondsOf(sizeOf(group));
  }
  return found;
}

}  // namespace oitlab
