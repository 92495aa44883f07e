#include "chain.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <string>

namespace oitlab::layer {
namespace {

/// What the loader tells two handles' owners apart by.
const void* keyOf(const void* handle) {
  return *static_cast<const void* const*>(handle);
}

struct NextDevice {
  PFN_vkGetDeviceProcAddr find = nullptr;
  VkDevice device = VK_NULL_HANDLE;
  std::map<std::string, PFN_vkVoidFunction, std::less<>> functions;  ///< found so far
};

/// Its functions are asked for while the instance is made: later the loader answers with the first
/// layer's.
struct NextInstance {
  PFN_vkGetInstanceProcAddr find = nullptr;
  PFN_vkDestroyInstance destroy = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
};

std::mutex mutex;  // of the two maps
std::map<const void*, NextDevice> devices;
std::map<const void*, NextInstance> instances;

/// The link to the next layer, in the chain of structures that the loader hands down.
template <typename Link, typename Info>
Link* linkOf(const Info* info, VkStructureType type) {
  auto* link = static_cast<const Link*>(info->pNext);
  while (link != nullptr && !(link->sType == type && link->function == VK_LAYER_LINK_INFO))
    link = static_cast<const Link*>(link->pNext);
  // The interface has each layer move the link on for the next one.
  return const_cast<Link*>(link);
}

NextInstance nextInstance(const void* handle) {
  const std::lock_guard lock(mutex);
  return instances.at(keyOf(handle));
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info,
                                              const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
  auto* link =
      linkOf<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  if (const VkResult fault = beforeCreation("vkCreateInstance"); fault != VK_SUCCESS) return fault;
  const PFN_vkGetInstanceProcAddr find = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(find(nullptr, "vkCreateInstance"));
  const VkResult result = create(info, allocator, instance);
  if (result != VK_SUCCESS) return result;
  const auto destroy =
      reinterpret_cast<PFN_vkDestroyInstance>(find(*instance, "vkDestroyInstance"));
  const std::lock_guard lock(mutex);
  instances[keyOf(*instance)] = {find, destroy, *instance};
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroyInstance(VkInstance instance,
                                           const VkAllocationCallbacks* allocator) {
  if (instance == VK_NULL_HANDLE) return;
  const NextInstance next = nextInstance(instance);
  {
    const std::lock_guard lock(mutex);
    instances.erase(keyOf(instance));
  }
  next.destroy(instance, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical,
                                            const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator,
                                            VkDevice* device) {
  auto* link = linkOf<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  if (const VkResult fault = beforeCreation("vkCreateDevice"); fault != VK_SUCCESS) return fault;
  const PFN_vkGetInstanceProcAddr findInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  const PFN_vkGetDeviceProcAddr find = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const VkInstance instance = nextInstance(physical).instance;
  const auto create =
      reinterpret_cast<PFN_vkCreateDevice>(findInstance(instance, "vkCreateDevice"));
  const VkResult result = create(physical, info, allocator, device);
  if (result != VK_SUCCESS) return result;
  {
    const std::lock_guard lock(mutex);
    devices[keyOf(*device)] = {find, *device, {}};
  }
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* allocator) {
  if (device == VK_NULL_HANDLE) return;
  beforeDestruction(device);
  const auto destroy = reinterpret_cast<PFN_vkDestroyDevice>(nextOf(device, "vkDestroyDevice"));
  {
    const std::lock_guard lock(mutex);
    devices.erase(keyOf(device));
  }
  destroy(device, allocator);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name);

template <typename Function>
Hook hook(const char* name, Function* function) {
  return {name, reinterpret_cast<PFN_vkVoidFunction>(function)};
}

PFN_vkVoidFunction findIn(std::span<const Hook> hooks, std::string_view name) {
  const auto found =
      std::find_if(hooks.begin(), hooks.end(), [&](const Hook& h) { return h.name == name; });
  return found == hooks.end() ? nullptr : found->function;
}

PFN_vkVoidFunction ofDevice(std::string_view name) {
  static const Hook own[] = {hook("vkGetDeviceProcAddr", &getDeviceProcAddr),
                             hook("vkDestroyDevice", &destroyDevice)};
  if (const auto found = findIn(own, name); found != nullptr) return found;
  if (const auto found = findIn(deviceHooks(), name); found != nullptr) return found;
  return otherwise(name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
  // A function that the next layer lacks (an extension's, not enabled) stays missing.
  const PFN_vkVoidFunction next = nextOf(device, name);
  const PFN_vkVoidFunction own = ofDevice(name);
  return next != nullptr && own != nullptr ? own : next;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance,
                                                             const char* name) {
  static const Hook own[] = {hook("vkGetInstanceProcAddr", &getInstanceProcAddr),
                             hook("vkCreateInstance", &createInstance),
                             hook("vkDestroyInstance", &destroyInstance),
                             hook("vkCreateDevice", &createDevice)};
  if (const auto found = findIn(own, name); found != nullptr) return found;
  if (const auto found = ofDevice(name); found != nullptr) return found;
  return instance == VK_NULL_HANDLE ? nullptr : nextInstance(instance).find(instance, name);
}

}  // namespace

PFN_vkVoidFunction nextOf(const void* handle, const char* name) {
  const std::lock_guard lock(mutex);
  NextDevice& next = devices.at(keyOf(handle));
  const auto known = next.functions.find(name);
  if (known != next.functions.end()) return known->second;
  return next.functions[name] = next.find(next.device, name);
}

VkDevice deviceOf(const void* handle) {
  const std::lock_guard lock(mutex);
  return devices.at(keyOf(handle)).device;
}

}  // namespace oitlab::layer

extern "C" [[gnu::visibility("default")]] VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
  version->loaderLayerInterfaceVersion = CURRENT_LOADER_LAYER_INTERFACE_VERSION;
  version->pfnGetInstanceProcAddr = oitlab::layer::getInstanceProcAddr;
  version->pfnGetDeviceProcAddr = oitlab::layer::getDeviceProcAddr;
  version->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
