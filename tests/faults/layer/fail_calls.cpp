// VK_LAYER_OITLAB_fail_calls: one call of a chosen function fails, or the device is lost.
//
//   OITLAB_FAULT=FUNCTION:N:RESULT   the Nth call (from 1, over all devices of the process) of
//                                    FUNCTION returns RESULT without going on to the driver
//   OITLAB_FAULT=FUNCTION:N+:RESULT  so do all later ones
//   OITLAB_FAULT_CALLS=FILE          at the end of the process FILE gets lines "FUNCTION CALLS",
//                                    and "fault: yes" or "fault: no": whether there was one
//
// RESULT: out_of_host_memory, out_of_device_memory, initialization_failed, device_lost, timeout. A
// lost device stays lost: submissions, waits and queries of it fail from then on, until another is
// opened. After a timeout (of vkWaitForFences) the driver still works on the frame.
#include <array>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <string>

#include "chain.h"

namespace oitlab::layer {
namespace {

struct Fault {
  std::string function;
  std::uint64_t call = 0;  ///< from 1; 0: no fault
  bool andLater = false;
  VkResult result = VK_SUCCESS;
};

/// A test that asks for a fault in words that mean none would prove nothing.
[[noreturn]] void refuse(const std::string& text) {
  std::fprintf(stderr,
               "OITLAB_FAULT=%s: wanted FUNCTION:N:RESULT or FUNCTION:N+:RESULT, as in "
               "tests/faults/layer/fail_calls.cpp\n",
               text.c_str());
  std::abort();
}

VkResult resultOf(const std::string& name, const std::string& whole) {
  static const std::map<std::string, VkResult> results = {
      {"out_of_host_memory", VK_ERROR_OUT_OF_HOST_MEMORY},
      {"out_of_device_memory", VK_ERROR_OUT_OF_DEVICE_MEMORY},
      {"initialization_failed", VK_ERROR_INITIALIZATION_FAILED},
      {"device_lost", VK_ERROR_DEVICE_LOST},
      {"timeout", VK_TIMEOUT}};
  const auto found = results.find(name);
  if (found == results.end()) refuse(whole);
  return found->second;
}

Fault parseFault(const std::string& text) {
  if (text.empty()) return {};
  const auto first = text.find(':'), last = text.rfind(':');
  if (first == last) refuse(text);
  Fault fault{.function = text.substr(0, first), .result = resultOf(text.substr(last + 1), text)};
  std::string number = text.substr(first + 1, last - first - 1);
  if (number.ends_with('+')) {
    fault.andLater = true;
    number.pop_back();
  }
  const char* end = number.data() + number.size();
  const auto parsed = std::from_chars(number.data(), end, fault.call);
  if (parsed.ec != std::errc() || parsed.ptr != end || fault.call == 0) refuse(text);
  return fault;
}

/// The process's calls, counted; written out when it ends.
class Calls {
 public:
  Calls() : fault_(parseFault(variable("OITLAB_FAULT"))), file_(variable("OITLAB_FAULT_CALLS")) {}
  ~Calls() {
    if (file_.empty()) return;
    std::ofstream out(file_);
    for (const auto& [name, count] : counts_) out << name << ' ' << count << '\n';
    out << "fault: " << (happened_ ? "yes" : "no") << '\n';
  }

  /// What this call returns in place of the driver's answer; VK_SUCCESS: let it pass.
  VkResult next(const char* function, const void* device) {
    const std::lock_guard lock(mutex_);
    const std::uint64_t call = ++counts_[function];
    if (device != nullptr && lost_.contains(device) && failsWhenLost(function))
      return VK_ERROR_DEVICE_LOST;
    if (function != fault_.function) return VK_SUCCESS;
    if (call != fault_.call && !(fault_.andLater && call > fault_.call)) return VK_SUCCESS;
    happened_ = true;
    if (fault_.result == VK_ERROR_DEVICE_LOST && device != nullptr) lost_.insert(device);
    return fault_.result;
  }

  /// The loader may give a new device the place of an old one.
  void forget(const void* device) {
    const std::lock_guard lock(mutex_);
    lost_.erase(device);
  }

 private:
  static std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  }
  static bool failsWhenLost(std::string_view function) {
    return function == "vkQueueSubmit" || function == "vkQueueSubmit2" ||
           function == "vkWaitForFences" || function == "vkDeviceWaitIdle" ||
           function == "vkQueueWaitIdle" || function == "vkGetQueryPoolResults";
  }

  const Fault fault_;
  const std::string file_;
  std::mutex mutex_;
  std::map<std::string, std::uint64_t, std::less<>> counts_;
  std::set<const void*> lost_;  ///< by the loader's key of the device
  bool happened_ = false;
};

/// The library stays loaded to the end (see CMakeLists.txt), so that counts span all instances.
Calls& calls() {
  static Calls calls;
  return calls;
}

const void* deviceKey(const void* handle) {
  return *static_cast<const void* const*>(handle);
}

/// In front of the function `name`, which returns a VkResult and has a handle of the device first.
template <Name name, typename Function>
struct Failing;

template <Name name, typename Handle, typename... Arguments>
struct Failing<name, VkResult(VKAPI_PTR*)(Handle, Arguments...)> {
  static VKAPI_ATTR VkResult VKAPI_CALL call(Handle handle, Arguments... arguments) {
    const VkResult fault = calls().next(name.text, deviceKey(handle));
    // A lost device works no more: what the program frees now must not be in use by a driver that
    // knows nothing of the loss.
    if (fault == VK_ERROR_DEVICE_LOST) OITLAB_CALL_NEXT(vkDeviceWaitIdle, deviceOf(handle));
    if (fault != VK_SUCCESS) return fault;
    return callNext<VkResult(VKAPI_PTR*)(Handle, Arguments...)>(name.text, handle, arguments...);
  }
};

#define FAILING(f)                                                           \
  Hook {                                                                     \
#f, reinterpret_cast < PFN_vkVoidFunction>(&Failing <#f, PFN_##f>::call) \
  }

}  // namespace

std::span<const Hook> deviceHooks() {
  // All functions with a result that the program calls.
  static const std::array hooks = {
      FAILING(vkAllocateCommandBuffers),
      FAILING(vkAllocateDescriptorSets),
      FAILING(vkAllocateMemory),
      FAILING(vkBeginCommandBuffer),
      FAILING(vkBindBufferMemory),
      FAILING(vkBindImageMemory),
      FAILING(vkCreateBuffer),
      FAILING(vkCreateCommandPool),
      FAILING(vkCreateComputePipelines),
      FAILING(vkCreateDescriptorPool),
      FAILING(vkCreateDescriptorSetLayout),
      FAILING(vkCreateFence),
      FAILING(vkCreateGraphicsPipelines),
      FAILING(vkCreateImage),
      FAILING(vkCreateImageView),
      FAILING(vkCreatePipelineLayout),
      FAILING(vkCreateQueryPool),
      FAILING(vkCreateSampler),
      FAILING(vkCreateShaderModule),
      FAILING(vkDeviceWaitIdle),
      FAILING(vkEndCommandBuffer),
      FAILING(vkGetQueryPoolResults),
      FAILING(vkMapMemory),
      FAILING(vkQueueSubmit),
      FAILING(vkQueueSubmit2),
      FAILING(vkResetCommandBuffer),
      FAILING(vkResetFences),
      FAILING(vkWaitForFences),
  };
  return hooks;
}

VkResult beforeCreation(const char* function) {
  return calls().next(function, nullptr);
}

void beforeDestruction(VkDevice device) {
  calls().forget(deviceKey(device));
}

PFN_vkVoidFunction otherwise(std::string_view) {
  return nullptr;
}

}  // namespace oitlab::layer
