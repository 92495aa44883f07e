#include "cli/commands.h"
#include "method/method.h"
#include "results/describe.h"
#include "util/json_file.h"

namespace oitlab {
namespace {

struct InfoOptions {
  bool json = false;
};

int info(const InfoOptions& options) {
  const auto devices = Device::listDevices();
  const int best = Device::bestDevice(devices);
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    nlohmann::json entry = describeDevice(devices[i]);
    entry["index"] = i;
    entry["best"] = int(i) == best;
    entry["features"] = devices[i].features;
    entry["missing"] = Device::missingBaseline(devices[i]);
    for (const auto& [name, method] : methods())
      entry["methods"][name] = {{"missing", method.missing(devices[i])}};
    list.push_back(entry);
  }
  if (options.json) {
    fmt::print("{}\n", jsonText(nlohmann::json{{"devices", list}}));
    return devices.empty() ? exitNoDevice : exitDone;
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& d = devices[i];
    fmt::print("device {}: {}{}\n", i, d.name, int(i) == best ? "  (used by default)" : "");
    fmt::print("  type                {}{}\n", d.type,
               d.isCpu() ? "  (its times say nothing about GPUs)" : "");
    fmt::print("  driver              {} {}, Vulkan {}\n", d.driver, d.driverInfo, d.apiVersion);
    fmt::print("  subgroup size       {} (from {} to {})\n", d.subgroupSize, d.minSubgroupSize,
               d.maxSubgroupSize);
    fmt::print("  timestamps          {} bits, {:g} ns a tick\n", d.timestampValidBits,
               d.timestampPeriodNs);
    fmt::print("  largest image       {0} x {0}\n", d.maxImageSize);
    fmt::print("  workgroup           {} invocations, {} KiB shared memory\n",
               d.maxWorkgroupInvocations, d.maxSharedMemoryBytes / 1024);
    fmt::print("  memory              {:.1f} GiB on the device, {:.1f} GiB in one piece\n",
               double(d.deviceLocalBytes) / (1ull << 30),
               double(d.maxAllocationBytes) / (1ull << 30));
    std::vector<std::string> lacking;
    for (const auto& [name, has] : d.features)
      if (!has) lacking.push_back(name);
    fmt::print("  features it lacks   {}\n",
               lacking.empty() ? "none" : fmt::format("{}", fmt::join(lacking, ", ")));
    for (const auto& [name, method] : methods()) {
      const auto missing = method.missing(d);
      fmt::print("  method {:<12} {}\n", name,
                 missing.empty() ? "runs" : fmt::format("lacks {}", fmt::join(missing, ", ")));
    }
  }
  if (devices.empty()) {
    fmt::print(stderr, "no Vulkan device; the package mesa-vulkan-drivers runs on any CPU\n");
    return exitNoDevice;
  }
  return exitDone;
}

}  // namespace

void addInfo(CLI::App& program, Action& action) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* verb =
      program.add_subcommand("info", "Devices, their limits, and what each method lacks there");
  verb->add_flag("--json", options->json, "One JSON object on stdout");
  verb->callback([=, &action] { action = [=] { return info(*options); }; });
}

}  // namespace oitlab
