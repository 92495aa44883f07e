#pragma once

#include "gpu/device.h"

namespace oitlab {

/// The feature structures that oitlab reads and enables.
using FeatureChain =
    vk::StructureChain<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan11Features,
                       vk::PhysicalDeviceVulkan12Features, vk::PhysicalDeviceVulkan13Features>;

struct NamedFeature {
  std::string name;
  vk::Bool32* value;  ///< points into the chain
  bool baseline;      ///< a device without it cannot be used
};

FeatureChain queryFeatures(const vk::raii::PhysicalDevice& physical);

/// The table of all features that oitlab knows. It says which ones are enabled, which ones
/// `oitlab info` prints, and which ones are the baseline.
std::vector<NamedFeature> namedFeatures(FeatureChain& chain);

bool hasExtension(const vk::raii::PhysicalDevice& physical, std::string_view name);

DeviceInfo describeDevice(const vk::raii::PhysicalDevice& physical);

}  // namespace oitlab
