#include "gpu/device.h"

#include <cstdlib>

#include "gpu/abandon.h"
#include "gpu/device_info.h"
#include "gpu/pipeline_cache.h"
#include "gpu/pipeline_statistics.h"
#include "gpu/shader.h"
#include "util/error.h"

namespace oitlab {
namespace {

std::string joined(const std::vector<std::string>& parts) {
  return fmt::format("{}", fmt::join(parts, ", "));
}

bool wantsDebugNames() {
  return std::getenv("OITLAB_DEBUG_NAMES") != nullptr;
}

/// Capture tools announce themselves and say whether they use names.
bool hasToolForNames(const vk::raii::PhysicalDevice& physical) {
  const auto tools = physical.getToolProperties();
  return std::any_of(tools.begin(), tools.end(), [](const auto& tool) {
    return bool(tool.purposes & vk::ToolPurposeFlagBits::eDebugMarkersEXT);
  });
}

}  // namespace

std::vector<DeviceInfo> Device::listDevices() {
  const Instance instance({});
  const auto physicals = instance.devices();
  std::vector<DeviceInfo> devices;
  devices.reserve(physicals.size());
  for (const auto& physical : physicals) devices.push_back(describeDevice(physical));
  return devices;
}

std::vector<std::string> Device::missingBaseline(const DeviceInfo& info) {
  std::vector<std::string> missing;
  if (info.features.empty()) {
    missing.push_back(fmt::format("Vulkan 1.3 (it has {})", info.apiVersion));
    return missing;
  }
  FeatureChain chain;
  for (const NamedFeature& feature : namedFeatures(chain))
    if (feature.baseline && !info.has(feature.name)) missing.push_back(feature.name);
  if (info.timestampValidBits == 0) missing.push_back("timestamp queries on the graphics queue");
  return missing;
}

int Device::bestDevice(const std::vector<DeviceInfo>& devices) {
  const std::vector<std::string> order = {"discrete", "integrated", "virtual", "other", "cpu"};
  for (const std::string& type : order)
    for (std::size_t i = 0; i < devices.size(); ++i)
      if (devices[i].type == type && missingBaseline(devices[i]).empty()) return int(i);
  return -1;
}

Device::Device(const Options& options)
    : instance_({.validation = options.validation, .shaderPrintf = options.shaderPrintf}),
      validation_(options.validation || options.shaderPrintf) {
  choosePhysicalDevice(options.index);
  chooseQueueFamily();
  openDevice();
  makeLayouts();
  shaders_ = std::make_unique<ShaderLibrary>(options.shaderPrintf);
  pipelines_ = std::make_unique<PipelineCache>();
  showsNames_ =
      instance_.hasDebugUtils() && (validation_ || wantsDebugNames() || hasToolForNames(physical_));
}

void Device::choosePhysicalDevice(int index) {
  auto physicals = instance_.devices();
  std::vector<DeviceInfo> devices;
  devices.reserve(physicals.size());
  for (const auto& physical : physicals) devices.push_back(describeDevice(physical));
  if (devices.empty())
    throw DeviceError(
        "no Vulkan device on this machine; install a driver (the package mesa-vulkan-drivers runs "
        "on any CPU)");
  if (index >= int(devices.size()))
    fail<DeviceError>("there is no device {}: `oitlab info` lists 0 to {}", index,
                      devices.size() - 1);
  if (index < 0) index = bestDevice(devices);
  if (index < 0) {
    std::vector<std::string> reasons;
    reasons.reserve(devices.size());
    for (const auto& device : devices)
      reasons.push_back(fmt::format("{} lacks {}", device.name, joined(missingBaseline(device))));
    fail<DeviceError>("no usable Vulkan device: {}", fmt::join(reasons, "; "));
  }
  info_ = devices[std::size_t(index)];
  if (const auto missing = missingBaseline(info_); !missing.empty())
    fail<DeviceError>("device {} ({}) lacks {}", index, info_.name, joined(missing));
  physical_ = std::move(physicals[std::size_t(index)]);
  memory_ = physical_.getMemoryProperties();
}

void Device::chooseQueueFamily() {
  const auto families = physical_.getQueueFamilyProperties();
  queueFamily_ = std::uint32_t(families.size());
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    const auto both = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
    if ((families[i].queueFlags & both) == both) {
      queueFamily_ = i;
      break;
    }
  }
  if (queueFamily_ == families.size())
    fail<DeviceError>("{} has no queue for both graphics and compute", info_.name);
}

void Device::openDevice() {
  FeatureChain available = queryFeatures(physical_);
  FeatureChain enabled;
  const auto from = namedFeatures(available);
  const auto to = namedFeatures(enabled);
  for (std::size_t i = 0; i < from.size(); ++i) *to[i].value = *from[i].value;

  const float priority = 1.0f;
  const vk::DeviceQueueCreateInfo queueInfo({}, queueFamily_, 1, &priority);
  vk::DeviceCreateInfo deviceInfo({}, queueInfo);
  deviceInfo.setPNext(&enabled.get<vk::PhysicalDeviceFeatures2>());
  std::vector<const char*> extensions;
  auto enable = [&](const char* name, auto& features) {
    if (!hasExtension(physical_, name)) return false;
    extensions.push_back(name);
    features.pNext = const_cast<void*>(deviceInfo.pNext);
    deviceInfo.setPNext(&features);
    return true;
  };
  vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics(VK_TRUE);
  if (wantsPipelineStatistics())
    pipelineStatistics_ = enable(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME, statistics);
  vk::PhysicalDeviceShaderSubgroupUniformControlFlowFeaturesKHR uniformFlow(VK_TRUE);
  subgroupUniformControlFlow_ =
      enable(VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME, uniformFlow);
  vk::PhysicalDeviceFragmentShaderInterlockFeaturesEXT interlock;
  interlock.fragmentShaderPixelInterlock = VK_TRUE;
  if (info_.has("fragmentShaderPixelInterlock"))
    enable(VK_EXT_FRAGMENT_SHADER_INTERLOCK_EXTENSION_NAME, interlock);
  deviceInfo.setPEnabledExtensionNames(extensions);
  try {
    device_ = vk::raii::Device(physical_, deviceInfo);
  } catch (const vk::SystemError& error) {
    fail<DeviceError>("{} cannot be opened: {}", info_.name, error.what());
  }
  queue_ = vk::raii::Queue(device_, queueFamily_, 0);
  commandPool_ = vk::raii::CommandPool(
      device_, {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, queueFamily_});
}

void Device::makeLayouts() {
  using Type = vk::DescriptorType;
  const auto all = vk::ShaderStageFlagBits::eAll;
  const std::array bindings = {
      vk::DescriptorSetLayoutBinding(0, Type::eCombinedImageSampler, 1, all),  // opaque atlas
      vk::DescriptorSetLayoutBinding(1, Type::eCombinedImageSampler, 1, all),  // transparent atlas
      vk::DescriptorSetLayoutBinding(2, Type::eStorageImage, 1, all),          // colour target
      vk::DescriptorSetLayoutBinding(3, Type::eCombinedImageSampler, 1, all),  // opaque depth
      vk::DescriptorSetLayoutBinding(4, Type::eCombinedImageSampler, methodImageCount, all),
  };
  setLayout_ =
      vk::raii::DescriptorSetLayout(device_, vk::DescriptorSetLayoutCreateInfo({}, bindings));
  const vk::PushConstantRange push(all, 0, pushConstantBytes);
  pipelineLayout_ =
      vk::raii::PipelineLayout(device_, vk::PipelineLayoutCreateInfo({}, *setLayout_, push));
}

Device::~Device() {
  // Work that still runs uses resources that are about to be destroyed. Waiting on a lost device
  // throws, and then there is nothing to wait for.
  try {
    if (*device_) device_.waitIdle();
  } catch (const vk::SystemError&) {
  }
}

std::string Device::uuid() const {
  const auto found =
      physical_.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceIDProperties>();
  const auto& bytes = found.get<vk::PhysicalDeviceIDProperties>().deviceUUID;
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

bool Device::isLost() const {
  try {
    device_.waitIdle();
  } catch (const vk::DeviceLostError&) {
    return true;
  } catch (const vk::SystemError&) {
    // Out of memory, say: not a loss.
  }
  return false;
}

std::uint32_t Device::memoryType(std::uint32_t typeBits, vk::MemoryPropertyFlags wanted,
                                 vk::MemoryPropertyFlags preferred) const {
  for (const vk::MemoryPropertyFlags flags : {wanted | preferred, wanted})
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
      if ((typeBits >> i & 1u) && (memory_.memoryTypes[i].propertyFlags & flags) == flags) return i;
  fail<DeviceError>("{} has no memory of the kind {}", info_.name, to_string(wanted));
}

bool Device::canMapItsMemory() const {
  using Memory = vk::MemoryPropertyFlagBits;
  const auto wanted = Memory::eDeviceLocal | Memory::eHostVisible | Memory::eHostCoherent;
  for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
    if ((memory_.memoryTypes[i].propertyFlags & wanted) == wanted) return true;
  return false;
}

vk::Format Device::supportedFormat(std::initializer_list<vk::Format> formats,
                                   vk::FormatFeatureFlags uses) const {
  for (const vk::Format format : formats)
    if ((physical_.getFormatProperties(format).optimalTilingFeatures & uses) == uses) return format;
  std::vector<std::string> names;
  for (const vk::Format format : formats) names.push_back(to_string(format));
  fail<DeviceError>("{} has none of the formats {} for {}", info_.name, joined(names),
                    to_string(uses));
}

Commands Device::makeCommandBuffer() const {
  const vk::CommandBufferAllocateInfo info(*commandPool_, vk::CommandBufferLevel::ePrimary, 1);
  return std::move(vk::raii::CommandBuffers(device_, info).front());
}

void Device::submit(const Commands& commands, vk::Fence fence) const {
  vk::SubmitInfo info;
  info.setCommandBuffers(*commands);
  queue_.submit(info, fence);
}

void Device::wait(vk::Fence fence, double seconds) const {
  auto result = vk::Result::eSuccess;
  try {
    result = device_.waitForFences(fence, VK_TRUE, static_cast<std::uint64_t>(seconds * 1e9));
    // Layers of 1.4 read what shaders printed in a thread of their own, and a fence does not wait
    // for that. The text is lost when the command buffer is used again or destroyed before.
    if (validation_ && result != vk::Result::eTimeout) queue_.waitIdle();
  } catch (const vk::SystemError& error) {
    const std::string reason = fmt::format("{} failed while working: {}", info_.name, error.what());
    if (isLost()) throw DeviceLost(reason);  // or else it is idle now, and its objects may go
    throw DeviceError(reason);
  }
  if (result != vk::Result::eTimeout) return;
  abandon(device_, instance_.vk());
  fail<DeviceHung>("{} did not finish a frame within {} s", info_.name, seconds);
}

void Device::runOnce(const std::function<void(const Commands&)>& record) const {
  const Commands commands = makeCommandBuffer();
  commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  record(commands);
  commands.end();
  const vk::raii::Fence fence(device_, vk::FenceCreateInfo());
  submit(commands, *fence);
  wait(*fence);
}

}  // namespace oitlab
