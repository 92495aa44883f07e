#include "experiment/run.h"
#include "cli/commands.h"
#include "cli/device_options.h"
#include "util/error.h"

namespace oitlab {
namespace {

struct RunOptions {
  std::string file, results, shard = "1/1";
  bool dryRun = false;
  Device::Options device;
};

std::vector<CellSpec> cellsOf(const Experiment& experiment, const RunOptions& options) {
  for (const std::string& note : experiment.notes) fmt::print(stderr, "{}\n", note);
  return shardCells(experiment.cells, parseShard(options.shard));
}

int dryRun(const RunOptions& options, const std::filesystem::path& results) {
  const auto devices = Device::listDevices();
  const int index = options.device.index >= 0 ? options.device.index : Device::bestDevice(devices);
  if (index < 0 || index >= int(devices.size()))
    throw DeviceError("no usable Vulkan device; see `oitlab info`");
  const DeviceInfo& device = devices[std::size_t(index)];
  const Experiment experiment = readExperiment(options.file, device.isCpu());
  const auto cells = cellsOf(experiment, options);
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
  // Mistakes in the file are told before a device is looked for.
  Experiment experiment = readExperiment(options.file);
  const std::filesystem::path results = options.results.empty()
                                            ? std::filesystem::path("results") / experiment.name
                                            : std::filesystem::path(options.results);
  parseShard(options.shard);
  if (options.dryRun) return dryRun(options, results);

  const Device device(options.device);
  if (device.info().isCpu()) experiment = readExperiment(options.file, true);
  const auto cells = cellsOf(experiment, options);
  fmt::print(stderr, "{}: {} cells on {}\n", experiment.title, cells.size(), device.info().name);
  const RunSummary summary = runExperiment(device, experiment, cells, results);
  fmt::print(stderr,
             "{} measured, {} there before, {} failed, {} skipped; `oitlab report {}` shows them\n",
             summary.done, summary.present, summary.failed, summary.skipped, results.string());
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
  verb->add_flag("--dry-run", options->dryRun, "List the cells and measure nothing");
  addDeviceOptions(*verb, options->device);
  verb->callback([=, &action] { action = [=] { return run(*options); }; });
}

}  // namespace oitlab
