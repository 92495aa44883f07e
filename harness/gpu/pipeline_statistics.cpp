#include "gpu/pipeline_statistics.h"

namespace oitlab {
namespace {

std::string valueOf(const vk::PipelineExecutableStatisticKHR& statistic) {
  using Format = vk::PipelineExecutableStatisticFormatKHR;
  switch (statistic.format) {
    case Format::eBool32:
      return statistic.value.b32 ? "yes" : "no";
    case Format::eInt64:
      return std::to_string(statistic.value.i64);
    case Format::eUint64:
      return std::to_string(statistic.value.u64);
    case Format::eFloat64:
      return fmt::format("{}", statistic.value.f64);
  }
  return "?";
}

}  // namespace

bool wantsPipelineStatistics() {
  static const bool wanted = std::getenv("OITLAB_PIPELINE_STATISTICS") != nullptr;
  return wanted;
}

void printPipelineStatistics(const Device& device, vk::Pipeline pipeline, const std::string& path) {
  if (!device.hasPipelineStatistics()) return;
  const auto executables = device.vk().getPipelineExecutablePropertiesKHR({pipeline});
  for (std::uint32_t i = 0; i < executables.size(); ++i) {
    std::string line;
    for (const auto& statistic : device.vk().getPipelineExecutableStatisticsKHR({pipeline, i}))
      line += fmt::format("  {} {}", statistic.name.data(), valueOf(statistic));
    fmt::print(stderr, "{}:{}\n", path, line);
  }
}

}  // namespace oitlab
