#include "results/describe.h"

#include <ctime>

#include "util/version.h"

namespace oitlab {
namespace {

std::string& commandLine() {
  static std::string line;
  return line;
}

std::string utcNow() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

nlohmann::json vector3(glm::vec3 v) {
  return {v.x, v.y, v.z};
}

}  // namespace

nlohmann::json describeDevice(const DeviceInfo& info) {
  return {{"name", info.name},
          {"type", info.type},
          {"driver", info.driver},
          {"driver_info", info.driverInfo},
          {"api_version", info.apiVersion},
          {"subgroup_size", info.subgroupSize},
          {"timestamp_period_ns", info.timestampPeriodNs},
          {"timestamp_valid_bits", info.timestampValidBits},
          {"max_image_size", info.maxImageSize},
          {"max_shared_memory_bytes", info.maxSharedMemoryBytes},
          {"max_workgroup_invocations", info.maxWorkgroupInvocations},
          {"max_allocation_bytes", info.maxAllocationBytes},
          {"device_local_bytes", info.deviceLocalBytes}};
}

nlohmann::json describeCamera(const Camera& camera) {
  return {{"eye", vector3(camera.eye)},
          {"target", vector3(camera.target)},
          {"up", vector3(camera.up)},
          {"fov_y_degrees", glm::degrees(camera.fovY)},
          {"near", camera.near}};
}

nlohmann::json describeComparison(const Comparison& c) {
  const auto number = [](const std::optional<double>& value) {
    return value && std::isfinite(*value) ? nlohmann::json(*value) : nlohmann::json();
  };
  return {{"rmse", number(c.rmse)},          {"psnr", number(c.psnr)},
          {"max_error", number(c.maxError)}, {"pixels_off", number(c.pixelsOff)},
          {"ssim", number(c.ssim)},          {"flip", number(c.flip)},
          {"flip_hdr", number(c.flipHdr)}};
}

nlohmann::json describeMemory(const Renderer& renderer, const Method& method) {
  nlohmann::json buffers = nlohmann::json::object();
  std::uint64_t total = 0;
  for (const auto& [name, bytes] : renderer.memoryByBuffer(method)) {
    buffers[name] = bytes;
    total += bytes;
  }
  return {{"total", total}, {"method", method.memory().total()}, {"buffers", buffers}};
}

void setCommandLine(int argc, char** argv) {
  std::string line = "oitlab";
  for (int i = 1; i < argc; ++i) line += std::string(" ") + argv[i];
  commandLine() = line;
}

nlohmann::json describeProvenance(bool validation, const ShaderLibrary::Hashes& shaders) {
  return {{"commit", builtCommit()},           {"source", builtSource()},  {"build", buildType()},
          {"validation", validation},          {"command", commandLine()}, {"date", utcNow()},
          {"shaders", nlohmann::json(shaders)}};
}

nlohmann::json describeMethod(const MethodInfo& info) {
  nlohmann::json parameters = nlohmann::json::array();
  for (const Parameter& parameter : info.parameters) {
    nlohmann::json entry = {{"name", parameter.name},
                            {"type", parameter.typeName()},
                            {"default", toJson(parameter.defaultValue)},
                            {"range", parameter.rangeText()},
                            {"unit", parameter.unit},
                            {"help", parameter.help}};
    if (!parameter.choices.empty()) entry["choices"] = parameter.choices;
    if (parameter.max > parameter.min) {
      entry["min"] = parameter.min;
      entry["max"] = parameter.max;
    }
    parameters.push_back(entry);
  }
  return {{"name", info.name},   {"summary", info.summary},   {"source", info.source},
          {"exact", info.exact}, {"features", info.features}, {"parameters", parameters}};
}

}  // namespace oitlab
