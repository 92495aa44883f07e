#include "gpu/instance.h"

#include <algorithm>
#include <mutex>
#include <string_view>

#include "util/error.h"

namespace oitlab {
namespace {

constexpr const char* validationLayer = "VK_LAYER_KHRONOS_validation";

vk::raii::Context openLoader() {
  try {
    return vk::raii::Context();
  } catch (const std::exception&) {
    throw DeviceError(
        "no Vulkan loader (libvulkan.so.1) on this machine; install the package libvulkan1 and a "
        "driver (mesa-vulkan-drivers runs on any CPU)");
  }
}

bool hasLayer(const vk::raii::Context& context, std::string_view name) {
  const auto layers = context.enumerateInstanceLayerProperties();
  return std::any_of(layers.begin(), layers.end(),
                     [&](const auto& layer) { return layer.layerName.data() == name; });
}

bool hasExtension(const vk::raii::Context& context, std::string_view name) {
  const auto extensions = context.enumerateInstanceExtensionProperties();
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& extension) { return extension.extensionName.data() == name; });
}

/// Every message of the layer has a name. Those of debugPrintfEXT end like this in all versions.
bool isShaderPrintf(const VkDebugUtilsMessengerCallbackDataEXT& data) {
  return data.pMessageIdName != nullptr &&
         std::string_view(data.pMessageIdName).ends_with("DEBUG-PRINTF");
}

/// What the shader printed, without the text that the layer puts around it: it stands behind the
/// last bar (layers of 1.3), or behind a line that ends in this mark (layers of 1.4). Empty for
/// what the layer says of itself under the same name.
std::string_view printedText(std::string_view message) {
  constexpr std::string_view mark = "DebugPrintf:\n", bar = " | ";
  if (const auto at = message.find(mark); at != message.npos)
    message.remove_prefix(at + mark.size());
  else if (const auto last = message.rfind(bar); last != message.npos)
    message.remove_prefix(last + bar.size());
  else
    return {};
  while (message.ends_with('\n')) message.remove_suffix(1);
  return message;
}

/// The message, with the debug names of its objects: layers of 1.4 do not write them into it.
std::string withNames(const VkDebugUtilsMessengerCallbackDataEXT& data) {
  std::string message = data.pMessage;
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < data.objectCount; ++i)
    if (const char* name = data.pObjects[i].pObjectName;
        name != nullptr && message.find(name) == message.npos)
      names.push_back(fmt::format("'{}'", name));
  if (!names.empty()) message += fmt::format(" (of {})", fmt::join(names, ", "));
  return message;
}

}  // namespace

struct Instance::MessageLog {
  mutable std::mutex mutex;
  std::vector<std::string> messages;

  static VKAPI_ATTR VkBool32 VKAPI_CALL receive(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                VkDebugUtilsMessageTypeFlagsEXT,
                                                const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                void* user) {
    auto* log = static_cast<MessageLog*>(user);
    std::lock_guard lock(log->mutex);
    if (isShaderPrintf(*data)) {
      const std::string_view text = printedText(data->pMessage);
      if (!text.empty()) fmt::print(stderr, "shader: {}\n", text);
    } else if (severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT) {
      log->messages.push_back(withNames(*data));
      fmt::print(stderr, "validation: {}\n", log->messages.back());
    }
    return VK_FALSE;
  }
};

Instance::Instance(const Options& options)
    : log_(std::make_unique<MessageLog>()), context_(openLoader()) {
  if (context_.enumerateInstanceVersion() < VK_API_VERSION_1_3)
    throw DeviceError("the Vulkan loader is older than 1.3; update the package libvulkan1");
  const bool layer = options.validation || options.shaderPrintf;
  if (layer && !hasLayer(context_, validationLayer))
    fail<DeviceError>(
        "{} was asked for, but the layer {} is not installed (package vulkan-validationlayers)",
        options.validation ? "validation" : "printing from shaders", validationLayer);

  const vk::ApplicationInfo application("oitlab", 1, "oitlab", 1, VK_API_VERSION_1_3);
  std::vector<const char*> layers, extensions;
  debugUtils_ = layer || hasExtension(context_, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  if (debugUtils_) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  std::vector<vk::ValidationFeatureEnableEXT> enabled;
  if (options.validation)
    enabled.push_back(vk::ValidationFeatureEnableEXT::eSynchronizationValidation);
  if (options.shaderPrintf) enabled.push_back(vk::ValidationFeatureEnableEXT::eDebugPrintf);
  const vk::ValidationFeaturesEXT features(enabled);
  vk::InstanceCreateInfo info({}, &application);
  if (layer) {
    layers.push_back(validationLayer);
    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    info.setPNext(&features);
  }
  info.setPEnabledLayerNames(layers).setPEnabledExtensionNames(extensions);
  try {
    instance_ = vk::raii::Instance(context_, info);
  } catch (const vk::SystemError& error) {
    fail<DeviceError>(
        "no Vulkan instance: {}; is a driver installed (mesa-vulkan-drivers runs on any CPU)?",
        error.what());
  }
  if (!layer) return;
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  vk::DebugUtilsMessengerCreateInfoEXT messenger;
  messenger.messageSeverity = Severity::eWarning | Severity::eError;
  if (options.shaderPrintf)
    messenger.messageSeverity |= Severity::eInfo;  // the level of printed text
  messenger.messageType = Type::eGeneral | Type::eValidation | Type::ePerformance;
  messenger.pUserData = log_.get();
  // The type of the callback differs between versions of the C++ headers; C's does not.
  VkDebugUtilsMessengerCreateInfoEXT withCallback = messenger;
  withCallback.pfnUserCallback = &MessageLog::receive;
  messenger_ = vk::raii::DebugUtilsMessengerEXT(instance_, withCallback);
}

Instance::~Instance() = default;

std::vector<vk::raii::PhysicalDevice> Instance::devices() const {
  try {
    return instance_.enumeratePhysicalDevices();
  } catch (const vk::SystemError& error) {
    fail<DeviceError>("the Vulkan driver does not answer: {}", error.what());
  }
}

std::vector<std::string> Instance::validationMessages() const {
  std::lock_guard lock(log_->mutex);
  return log_->messages;
}

}  // namespace oitlab
