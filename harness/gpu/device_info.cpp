#include "gpu/device_info.h"

#include <fmt/format.h>

namespace oitlab {
namespace {

std::string typeName(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return "discrete";
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return "integrated";
    case vk::PhysicalDeviceType::eVirtualGpu:
      return "virtual";
    case vk::PhysicalDeviceType::eCpu:
      return "cpu";
    default:
      return "other";
  }
}

std::string versionName(std::uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

/// The structures of extensions must not be queried from a device without them.
bool hasPixelInterlock(const vk::raii::PhysicalDevice& physical) {
  using Interlock = vk::PhysicalDeviceFragmentShaderInterlockFeaturesEXT;
  if (!hasExtension(physical, VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME)) return false;
  const auto chain = physical.getFeatures2<vk::PhysicalDeviceFeatures2, Interlock>();
  return chain.get<Interlock>().fragmentShaderPixelInterlock == VK_TRUE;
}

}  // namespace

bool hasExtension(const vk::raii::PhysicalDevice& physical, std::string_view name) {
  const auto all = physical.enumerateDeviceExtensionProperties();
  return std::any_of(all.begin(), all.end(), [&](const auto& extension) {
    return std::string_view(extension.extensionName.data()) == name;
  });
}

FeatureChain queryFeatures(const vk::raii::PhysicalDevice& physical) {
  return physical
      .getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan11Features,
                    vk::PhysicalDeviceVulkan12Features, vk::PhysicalDeviceVulkan13Features>();
}

std::vector<NamedFeature> namedFeatures(FeatureChain& chain) {
  auto& v10 = chain.get<vk::PhysicalDeviceFeatures2>().features;
  auto& v12 = chain.get<vk::PhysicalDeviceVulkan12Features>();
  auto& v13 = chain.get<vk::PhysicalDeviceVulkan13Features>();
  return {
      // The baseline.
      {"bufferDeviceAddress", &v12.bufferDeviceAddress, true},
      {"scalarBlockLayout", &v12.scalarBlockLayout, true},
      {"hostQueryReset", &v12.hostQueryReset, true},
      {"dynamicRendering", &v13.dynamicRendering, true},
      {"synchronization2", &v13.synchronization2, true},
      {"maintenance4", &v13.maintenance4, true},
      {"shaderInt64", &v10.shaderInt64, true},
      // Optional: a method lists the ones it needs.
      {"fragmentStoresAndAtomics", &v10.fragmentStoresAndAtomics, false},
      {"geometryShader", &v10.geometryShader, false},
      {"independentBlend", &v10.independentBlend, false},
      {"occlusionQueryPrecise", &v10.occlusionQueryPrecise, false},
      {"textureCompressionBC", &v10.textureCompressionBC, false},
      {"shaderFloat64", &v10.shaderFloat64, false},
      {"shaderBufferInt64Atomics", &v12.shaderBufferInt64Atomics, false},
      {"vulkanMemoryModel", &v12.vulkanMemoryModel, false},
      {"vulkanMemoryModelDeviceScope", &v12.vulkanMemoryModelDeviceScope, false},
      {"subgroupSizeControl", &v13.subgroupSizeControl, false},
      {"computeFullSubgroups", &v13.computeFullSubgroups, false},
  };
}

DeviceInfo describeDevice(const vk::raii::PhysicalDevice& physical) {
  // The 1.3 structures must not be queried from an older device, so the version is checked first.
  const auto basic = physical.getProperties();
  DeviceInfo info;
  info.name = std::string(basic.deviceName.data());
  info.type = typeName(basic.deviceType);
  info.apiVersion = versionName(basic.apiVersion);
  info.timestampPeriodNs = basic.limits.timestampPeriod;
  info.maxImageSize = std::min({basic.limits.maxImageDimension2D, basic.limits.maxFramebufferWidth,
                                basic.limits.maxFramebufferHeight});
  info.maxSharedMemoryBytes = basic.limits.maxComputeSharedMemorySize;
  info.maxWorkgroupInvocations = basic.limits.maxComputeWorkGroupInvocations;
  for (const auto& family : physical.getQueueFamilyProperties())
    if (family.queueFlags & vk::QueueFlagBits::eGraphics) {
      info.timestampValidBits = family.timestampValidBits;
      break;
    }
  const auto memory = physical.getMemoryProperties();
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal)
      info.deviceLocalBytes = std::max(info.deviceLocalBytes, memory.memoryHeaps[i].size);
  if (basic.apiVersion < VK_API_VERSION_1_3) return info;

  const auto properties =
      physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                              vk::PhysicalDeviceVulkan12Properties,
                              vk::PhysicalDeviceVulkan13Properties>();
  const auto& v11 = properties.get<vk::PhysicalDeviceVulkan11Properties>();
  const auto& v12 = properties.get<vk::PhysicalDeviceVulkan12Properties>();
  const auto& v13 = properties.get<vk::PhysicalDeviceVulkan13Properties>();
  info.driver = std::string(v12.driverName.data());
  info.driverInfo = std::string(v12.driverInfo.data());
  info.subgroupSize = v11.subgroupSize;
  info.minSubgroupSize = v13.minSubgroupSize;
  info.maxSubgroupSize = v13.maxSubgroupSize;
  info.maxAllocationBytes = std::min(v11.maxMemoryAllocationSize, v13.maxBufferSize);
  FeatureChain chain = queryFeatures(physical);
  for (const NamedFeature& feature : namedFeatures(chain))
    info.features[feature.name] = *feature.value == VK_TRUE;
  info.features["fragmentShaderPixelInterlock"] = hasPixelInterlock(physical);
  using Subgroup = vk::SubgroupFeatureFlagBits;
  const vk::SubgroupFeatureFlags wanted = Subgroup::eBasic | Subgroup::eVote |
                                          Subgroup::eArithmetic | Subgroup::eBallot |
                                          Subgroup::eShuffle;
  info.features["subgroupOperations"] =
      (v11.subgroupSupportedOperations & wanted) == wanted &&
      bool(v11.subgroupSupportedStages & vk::ShaderStageFlagBits::eCompute);
  return info;
}

}  // namespace oitlab
