#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "gpu/instance.h"

namespace oitlab {

class PipelineCache;
class ShaderLibrary;

/// A command buffer with its own function table. The program does not link to the Vulkan loader, so
/// that it can start on a machine without one and say what is missing.
using Commands = vk::raii::CommandBuffer;

/// The properties of a device that oitlab uses. Features beyond the baseline (see
/// Device::missingBaseline) are optional: a method lists the ones it needs in its MethodInfo.
struct DeviceInfo {
  std::string name;
  std::string type;  ///< "discrete", "integrated", "virtual", "cpu" or "other"
  std::string driver;
  std::string driverInfo;
  std::string apiVersion;
  std::uint32_t subgroupSize = 0;
  std::uint32_t minSubgroupSize = 0;
  std::uint32_t maxSubgroupSize = 0;
  std::uint32_t timestampValidBits = 0;
  float timestampPeriodNs = 0;
  std::uint32_t maxImageSize = 0;          ///< pixels per side, of images and render areas
  std::uint32_t maxSharedMemoryBytes = 0;  ///< of one compute workgroup
  std::uint32_t maxWorkgroupInvocations = 0;
  std::uint64_t maxAllocationBytes = 0;
  std::uint64_t deviceLocalBytes = 0;    ///< size of the largest device-local heap
  std::map<std::string, bool> features;  ///< by the name of the Vulkan feature

  bool isCpu() const { return type == "cpu"; }
  bool has(const std::string& feature) const {
    auto it = features.find(feature);
    return it != features.end() && it->second;
  }
};

/// A Vulkan device with one queue for graphics and compute. Headless: no surface, no window.
class Device {
 public:
  struct Options {
    int index = -1;             ///< as listed by listDevices(); -1 = the best one
    bool validation = false;    ///< validation layers with synchronization validation
    bool shaderPrintf = false;  ///< shaders may print (ShaderLibrary); needs the validation layer
  };

  /// Opens a device. Throws DeviceError when there is no Vulkan loader, no device, no device of
  /// that index, or when the device lacks part of the baseline.
  explicit Device(const Options& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// All devices in the order of the loader, whether or not they can be used.
  static std::vector<DeviceInfo> listDevices();

  /// The index of the device that Options{} opens, or -1 when there is none.
  static int bestDevice(const std::vector<DeviceInfo>& devices);

  /// What `info` lacks of the baseline; empty when the device can be used. The baseline is
  /// Vulkan 1.3 with the features that device_info.cpp marks, all common on desktop GPUs and in
  /// lavapipe.
  static std::vector<std::string> missingBaseline(const DeviceInfo& info);

  const DeviceInfo& info() const { return info_; }
  /// What tells the device from all others of the machine: 32 hexadecimal digits.
  std::string uuid() const;
  const vk::raii::Device& vk() const { return device_; }
  ShaderLibrary& shaders() const { return *shaders_; }

  /// The pipelines that were made so far. Pipeline looks here first.
  PipelineCache& pipelines() const { return *pipelines_; }

  /// The validation layer is active, so times mean nothing.
  bool validation() const { return validation_; }
  /// Objects and stages get names (gpu/debug_names.h): under validation, when a capture tool says
  /// that it shows them (vkGetPhysicalDeviceToolProperties), or when the environment variable
  /// OITLAB_DEBUG_NAMES is set.
  bool showsNames() const { return showsNames_; }
  /// Pipeline statistics are asked for (gpu/pipeline_statistics.h) and supported.
  bool hasPipelineStatistics() const { return pipelineStatistics_; }
  /// VK_KHR_shader_subgroup_uniform_control_flow is enabled: shaders may require that the lanes of
  /// a subgroup reconverge after a branch.
  bool hasSubgroupUniformControlFlow() const { return subgroupUniformControlFlow_; }

  /// Warnings and errors of the validation layer so far. A clean run has none.
  std::vector<std::string> validationMessages() const { return instance_.validationMessages(); }

  /// Whether the device has stopped working. Waits for the work that it still has.
  bool isLost() const;

  /// Whether the CPU can map device-local memory.
  bool canMapItsMemory() const;

  /// The index of a memory type that `typeBits` allows and that has all of `wanted` and, if there
  /// is one, all of `preferred`. Throws DeviceError when there is none.
  std::uint32_t memoryType(std::uint32_t typeBits, vk::MemoryPropertyFlags wanted,
                           vk::MemoryPropertyFlags preferred = {}) const;

  /// The first of `formats` that supports `uses` with optimal tiling. Throws DeviceError when there
  /// is none.
  vk::Format supportedFormat(std::initializer_list<vk::Format> formats,
                             vk::FormatFeatureFlags uses) const;

  /// The layout that all pipelines share. Set 0 holds the few images
  /// (shaders/common/bindings.glsl); push constants hold the addresses of buffers.
  vk::PipelineLayout pipelineLayout() const { return *pipelineLayout_; }
  vk::DescriptorSetLayout setLayout() const { return *setLayout_; }

  Commands makeCommandBuffer() const;

  /// Submits and returns at once. `fence` signals when the device has finished.
  void submit(const Commands& commands, vk::Fence fence) const;

  /// Waits for a fence. Throws DeviceLost when the device is lost, DeviceHung when the fence did
  /// not signal within `seconds`, and DeviceError when waiting failed and the device is idle.
  void wait(vk::Fence fence, double seconds = 600.0) const;

  /// Records, submits and waits. For preparation, never inside a measurement.
  void runOnce(const std::function<void(const Commands&)>& record) const;

  /// The number of its own images that a method can sample through the common layout.
  static constexpr std::uint32_t methodImageCount = 4;

  /// Size of the push constants: what Vulkan guarantees.
  static constexpr std::uint32_t pushConstantBytes = 128;

 private:
  void choosePhysicalDevice(int index);
  void chooseQueueFamily();
  void openDevice();
  void makeLayouts();

  Instance instance_;
  DeviceInfo info_;
  bool validation_ = false, showsNames_ = false;
  bool pipelineStatistics_ = false, subgroupUniformControlFlow_ = false;
  vk::raii::PhysicalDevice physical_ = nullptr;
  vk::PhysicalDeviceMemoryProperties memory_;
  std::uint32_t queueFamily_ = 0;
  vk::raii::Device device_ = nullptr;
  vk::raii::Queue queue_ = nullptr;
  vk::raii::CommandPool commandPool_ = nullptr;
  vk::raii::DescriptorSetLayout setLayout_ = nullptr;
  vk::raii::PipelineLayout pipelineLayout_ = nullptr;
  std::unique_ptr<ShaderLibrary> shaders_;
  std::unique_ptr<PipelineCache> pipelines_;
};

}  // namespace oitlab
