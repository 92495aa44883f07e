#include "experiment/run.h"
#include "cli/commands.h"
#include "cli/device_options.h"
#include "util/error.h"
#include "util/size.h"

namespace oitlab {
namespace {

struct RunOptions {
  std::string file, results, shard = "1/1", profile = "auto", size;
  float detail = 0;  // 0: as the file says
  double stopAfter = std::numeric_limits<double>::infinity();
  bool dryRun = false;
  Device::Options device;
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
  if (options.detail > 0) read.detail = options.detail;
  if (!options.size.empty()) read.size = parseSize(options.size);
  return read;
}

int dryRun(const Experiment& experiment, const std::vector<CellSpec>& cells,
           const std::filesystem::path& results, const DeviceInfo& device) {
  std::size_t present = 0;
  for (const CellSpec& cell : cells) {
    const std::string id = cellId(cell, device);
    const bool there = std::filesystem::exists(results / "cells" / (id + ".json"));
    present += there;
    fmt::print("{}  {}\n", there ? "there  " : "missing", cell.label());
  }
  const double most =
      experiment.measure.stop.timeLimitSeconds * 1.3 * double(cells.size() - present);
  fmt::print(stderr, "{} cells on {}, {} there already, {} to measure: about {:.0f} s at most\n",
             cells.size(), device.name, present, cells.size() - present, most);
  return exitDone;
}

int run(const RunOptions& options) {
  readExperiment(options.file);  // mistakes are told before a device is looked for
  parseShard(options.shard);
  const DeviceInfo info = chosenDevice(options.device);
  const Experiment experiment = readExperiment(options.file, readOptions(options, info));
  const std::filesystem::path results = options.results.empty()
                                            ? std::filesystem::path("results") / experiment.name
                                            : std::filesystem::path(options.results);
  const auto cells = shardCells(experiment.cells, parseShard(options.shard));
  for (const std::string& note : experiment.notes) fmt::print(stderr, "{}\n", note);
  if (options.dryRun) return dryRun(experiment, cells, results, info);

  const Device device(options.device);
  fmt::print(stderr, "{}: {} cells on {}, profile {}\n", experiment.title, cells.size(), info.name,
             experiment.profile);
  const RunSummary summary = runExperiment(device, experiment, cells, results, options.stopAfter);
  fmt::print(stderr,
             "{} measured, {} there before, {} failed, {} skipped; `oitlab report {}` shows them\n",
             summary.done, summary.present, summary.failed, summary.skipped, results.string());
  if (summary.left > 0)
    fmt::print(stderr, "{} not begun when {} s were over: the same command measures them\n",
               summary.left, options.stopAfter);
  if (summary.otherVersion > 0)
    fmt::print(stderr,
               "{} of the cells there before were made by another commit of oitlab; remove {} to "
               "measure all again\n",
               summary.otherVersion, (results / "cells").string());
  return summary.failed > 0 ? exitSomeFailed : exitDone;
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
                   "Only the i-th of n shares; several may share a folder")
      ->capture_default_str()
      ->type_name("I/N");
  verb->add_option("--profile", options->profile,
                   "full, or a profile of the file; auto: cpu on a CPU device, else full")
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
  verb->add_option("--stop-after", options->stopAfter,
                   "Begin nothing after so many seconds, where a job's time is limited; the same "
                   "command goes on from there")
      ->check(CLI::PositiveNumber)
      ->type_name("SECONDS");
  verb->add_flag("--dry-run", options->dryRun, "List the cells and measure nothing");
  addDeviceOptions(*verb, options->device);
  verb->callback([=, &action] { action = [=] { return run(*options); }; });
}

}  // namespace oitlab
