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

/// A command buffer that brings its own function table, so that the program runs (and explains
/// itself) on a machine without a Vulkan loader.
using Commands = vk::raii::CommandBuffer;

/// What a device can do, as far as oitlab asks. Everything beyond the baseline (see
/// Device::missingBaseline) is optional: a method that needs it says so in its registration.
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
  std::uint32_t maxImageSize = 0;          ///< pixels on a side, of images and render areas
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

  /// Opens a device. Throws DeviceError when there is no Vulkan loader, no device, no such index,
  /// or the device misses part of the baseline; InputError never.
  explicit Device(const Options& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// All devices in the order of the loader, usable or not.
  static std::vector<DeviceInfo> listDevices();

  /// The index that Options{} would open, or -1.
  static int bestDevice(const std::vector<DeviceInfo>& devices);

  /// What the baseline needs and `info` lacks; empty when the device will do. The baseline is
  /// Vulkan 1.3 with the features in device.cpp, all of them common on desktop GPUs and in
  /// lavapipe.
  static std::vector<std::string> missingBaseline(const DeviceInfo& info);

  const DeviceInfo& info() const { return info_; }
  const vk::raii::Device& vk() const { return device_; }
  ShaderLibrary& shaders() const { return *shaders_; }

  /// The pipelines made so far: Pipeline looks here first.
  PipelineCache& pipelines() const { return *pipelines_; }

  /// The validation layer is there: times are not to be trusted.
  bool validation() const { return validation_; }
  /// Objects and stages are given their names (gpu/debug_names.h): under validation, where a tool
  /// says that it shows them (vkGetPhysicalDeviceToolProperties), or where the environment variable
  /// OITLAB_DEBUG_NAMES is set.
  bool showsNames() const { return showsNames_; }
  /// Asked for (gpu/pipeline_statistics.h) and supported.
  bool hasPipelineStatistics() const { return pipelineStatistics_; }
  /// VK_KHR_shader_subgroup_uniform_control_flow is enabled: shaders may ask that the lanes of a
  /// subgroup come together again after a branch.
  bool hasSubgroupUniformControlFlow() const { return subgroupUniformControlFlow_; }

  /// Messages of the validation layers so far (warnings and errors). A clean run has none.
  std::vector<std::string> validationMessages() const { return instance_.validationMessages(); }

  /// Whether there is memory that is the device's own and mapped by the CPU.
  bool canMapItsMemory() const;

  /// Index of a memory type that `typeBits` allows and that has `wanted`, preferring `preferred`.
  /// Throws DeviceError when there is none.
  std::uint32_t memoryType(std::uint32_t typeBits, vk::MemoryPropertyFlags wanted,
                           vk::MemoryPropertyFlags preferred = {}) const;

  /// The first of `formats` that optimally tiled images of `uses` can have. Throws DeviceError when
  /// there is none.
  vk::Format supportedFormat(std::initializer_list<vk::Format> formats,
                             vk::FormatFeatureFlags uses) const;

  /// The one layout that all pipelines share: set 0 holds the few images (see shaders/common/
  /// bindings.glsl), and push constants carry buffer addresses.
  vk::PipelineLayout pipelineLayout() const { return *pipelineLayout_; }
  vk::DescriptorSetLayout setLayout() const { return *setLayout_; }

  Commands makeCommandBuffer() const;

  /// Submits and returns at once; `fence` signals when the device is done.
  void submit(const Commands& commands, vk::Fence fence) const;

  /// Waits for a fence. Throws DeviceError after `seconds` without an answer or on device loss.
  void wait(vk::Fence fence, double seconds = 600.0) const;

  /// Records, submits and waits: for set-up work, never inside a measurement.
  void runOnce(const std::function<void(const Commands&)>& record) const;

  /// Images of its own that a method can sample through the common layout.
  static constexpr std::uint32_t methodImageCount = 4;

  /// Push constants: 128 bytes, what Vulkan guarantees.
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
