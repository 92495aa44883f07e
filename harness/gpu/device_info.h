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
  bool baseline;      ///< no device without it
};

FeatureChain queryFeatures(const vk::raii::PhysicalDevice& physical);

/// The one table of features: it drives what is enabled, what `oitlab info` prints and what the
/// baseline demands.
std::vector<NamedFeature> namedFeatures(FeatureChain& chain);

DeviceInfo describeDevice(const vk::raii::PhysicalDevice& physical);

}  // namespace oitlab
