#pragma once

#include <memory>
#include <string>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

namespace oitlab {

/// The Vulkan loader, an instance, and the messages of the validation layer.
class Instance {
 public:
  struct Options {
    bool validation = false;    ///< the validation layer, with synchronization validation
    bool shaderPrintf = false;  ///< the validation layer, for debugPrintfEXT in shaders
  };

  /// Throws DeviceError when there is no loader, no driver or no Vulkan 1.3, or when the validation
  /// layer is asked for and not installed.
  explicit Instance(const Options& options);
  ~Instance();

  const vk::raii::Instance& vk() const { return instance_; }

  /// All devices in the order of the loader. Throws DeviceError when the driver does not answer.
  std::vector<vk::raii::PhysicalDevice> devices() const;

  /// VK_EXT_debug_utils is enabled: objects can have names, and commands can have labels.
  bool hasDebugUtils() const { return debugUtils_; }

  /// Warnings and errors of the validation layer so far. A clean run has none. Text that shaders
  /// print goes to stderr and is not among them.
  std::vector<std::string> validationMessages() const;

 private:
  struct MessageLog;

  std::unique_ptr<MessageLog> log_;
  vk::raii::Context context_;
  bool debugUtils_ = false;
  vk::raii::Instance instance_ = nullptr;
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
};

}  // namespace oitlab
