#include <csignal>

#include "cli/commands.h"
#include "cli/device_options.h"
#include "cli/scene_options.h"
#include "experiment/plan.h"
#include "sweep/run.h"
#include "util/error.h"
#include "util/interrupt.h"
#include "util/size.h"

namespace oitlab {
namespace {

struct RunOptions {
  std::string file, results, shard = "1/1", profile = "auto", size;
  float detail = 0;  // 0: as the file says
  bool dryRun = false, allowOutside = false;
  SweepOptions sweep;
};

/// The device that these options choose, without opening it.
DeviceInfo chosenDevice(const Device::Options& options) {
  const auto devices = Device::listDevices();
  const int index = options.index >= 0 ? options.index : Device::bestDevice(devices);
  if (index < 0 || index >= int(devices.size()))
    throw DeviceError("no usable Vulkan device; see `oitlab info`");
  return devices[std::size_t(index)];
}

/// "auto" is "cpu" on a device of that type, where the file has such a profile.
ExperimentOptions readOptions(const RunOptions& options, const DeviceInfo& device) {
  ExperimentOptions read;
  const bool automatic = options.profile == "auto";
  read.profile = automatic ? (device.type == "cpu" ? "cpu" : "full") : options.profile;
  read.profileRequired = !automatic;
  read.allowOutside = options.allowOutside;
  if (options.detail > 0) read.detail = options.detail;
  if (!options.size.empty()) read.size = parseSize(options.size);
  return read;
}

const char* nameOf(const SweepForecast::Line& line) {
  if (!line.again) return "there  ";
  return line.state.kind == CellState::missing ? "missing" : "again  ";
}

int dryRun(const SweepOptions& options, const Experiment& experiment,
           const std::vector<CellSpec>& cells, const std::filesystem::path& results,
           const DeviceInfo& device) {
  const SweepForecast found = forecast(options, device, experiment, cells, results);
  for (const SweepForecast::Line& line : found.lines) {
    fmt::print("{}  {}\n", nameOf(line), line.cell.label());
    if (!line.state.reason.empty()) fmt::print("         {}\n", line.state.reason);
  }
  fmt::print(stderr, "{} cells on {}, {} there already, {} to measure: about {}\n", cells.size(),
             device.name, cells.size() - found.toMeasure, found.toMeasure,
             formatSeconds(found.seconds));
  return exitDone;
}

/// What a run is to be followed by, if anything.
void tell(const SweepSummary& summary, const RunOptions& options,
          const std::filesystem::path& results) {
  const Outcome& outcome = summary.outcome;
  fmt::print(stderr,
             "{} measured, {} there before, {} failed, {} skipped; `oitlab report {}` shows them\n",
             outcome.done, summary.present, outcome.failed, outcome.skipped, results.string());
  if (summary.left > 0)
    fmt::print(stderr, "{} not begun when {} s were over: the same command measures them\n",
               summary.left, options.sweep.seconds);
  for (const std::string& line : summary.kept) fmt::print(stderr, "kept: {}\n", line);
  if (outcome.withMessages > 0)
    fmt::print(stderr,
               "the validation layers had something to say about {} cells: validation_messages in "
               "their files\n",
               outcome.withMessages);
}

/// The cells of the shard; says so where there are none.
std::vector<CellSpec> dealCells(const Experiment& experiment, const Shard& shard) {
  auto cells = shardCells(experiment.cells, shard);
  if (cells.empty() && !experiment.cells.empty())
    fmt::print(
        stderr,
        "--shard {}/{}: nothing to do: there are {} groups of cells, and a group (one scene, "
        "view, size and format) stays together\n",
        shard.index, shard.count, groupCells(experiment.cells).size());
  return cells;
}

int measure(const Experiment& experiment, const std::vector<CellSpec>& cells,
            const std::filesystem::path& results, const DeviceInfo& device,
            const RunOptions& options) {
  fmt::print(stderr, "{}: {} cells on {}, profile {}\n", experiment.title, cells.size(),
             device.name, experiment.profile);
  const InterruptGuard guard;
  try {
    const SweepSummary summary = runExperiment(options.sweep, experiment, cells, results);
    tell(summary, options, results);
    return summary.outcome.failed + summary.outcome.withMessages > 0 ? exitSomeFailed : exitDone;
  } catch (const Interrupted& interrupted) {
    fmt::print(stderr,
               "\nstopped by {}: the cells being measured are dropped, all others are in {}; the "
               "same command goes on from there\n",
               interrupted.signal == SIGINT ? "SIGINT" : "SIGTERM", results.string());
    return exitSignal + interrupted.signal;
  }
}

int run(const RunOptions& options) {
  // Mistakes are told before a device is looked for.
  readExperiment(options.file, {.allowOutside = options.allowOutside});
  const Shard shard = parseShard(options.shard);
  const DeviceInfo info = chosenDevice(options.sweep.device);
  const Experiment experiment = readExperiment(options.file, readOptions(options, info));
  const std::filesystem::path results = options.results.empty()
                                            ? std::filesystem::path("results") / experiment.name
                                            : std::filesystem::path(options.results);
  for (const std::string& note : experiment.notes) fmt::print(stderr, "{}\n", note);
  const auto cells = dealCells(experiment, shard);
  if (cells.empty()) return exitDone;
  return options.dryRun ? dryRun(options.sweep, experiment, cells, results, info)
                        : measure(experiment, cells, results, info, options);
}

}  // namespace

void addRun(CLI::App& program, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* verb = program.add_subcommand(
      "run", "Run an experiment: measures the cells that the results folder does not hold yet");
  verb->add_option("file", options->file, "The experiment, a .toml file (docs/experiments.md)")
      ->required();
  verb->add_option("--results", options->results, "Results folder (default: results/NAME)")
      ->type_name("DIR");
  verb->add_option("--shard", options->shard,
                   "Only the i-th of n shares of the groups, for machines without a common folder")
      ->capture_default_str()
      ->type_name("I/N");
  verb->add_option("--profile", options->profile,
                   "full, brief (the same cells, measured briefly), or a profile of the file; "
                   "auto: cpu on a CPU device, else full")
      ->capture_default_str()
      ->type_name("NAME");
  verb->add_option("--detail", options->detail,
                   "Share of every generated scene's triangles, instead of what the file says")
      ->check(CLI::Range(1e-6, 1.0))
      ->type_name("0..1");
  verb->add_option("--size", options->size, "This image size, instead of those of the file")
      ->check([](const std::string& text) {
        return parseSize(text) ? "" : fmt::format("{}: wanted WxH, such as 1280x720", text);
      })
      ->type_name("WxH");
  verb->add_option("--stop-after", options->sweep.seconds,
                   "Begin nothing after so many seconds, where a job's time is limited; the same "
                   "command goes on from there")
      ->check(CLI::PositiveNumber)
      ->type_name("SECONDS");
  verb->add_flag("--keep", options->sweep.keep,
                 "Leave cells as they are that were measured with another profile, [measure], "
                 "shader or program, and name them");
  verb->add_flag("--dry-run", options->dryRun,
                 "List the cells and how long they would take; measure nothing");
  addAllowOutside(*verb, options->allowOutside);
  addDeviceOptions(*verb, options->sweep.device);
  verb->callback([=, &action] { action = [=] { return run(*options); }; });
}

}  // namespace oitlab
