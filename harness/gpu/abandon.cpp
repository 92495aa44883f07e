#include "gpu/abandon.h"

#include <type_traits>

namespace oitlab {
namespace {

/// The functions that all objects of `owner` call. The owner made the table, and not as a constant.
template <typename Owner>
auto& functionsOf(const Owner& owner) {
  using Table = std::remove_const_t<std::remove_pointer_t<decltype(owner.getDispatcher())>>;
  return const_cast<Table&>(*owner.getDispatcher());
}

/// Does nothing, and returns VK_SUCCESS where something is returned.
template <typename Result, typename... Arguments>
VKAPI_ATTR Result VKAPI_CALL ignored(Arguments...) {
  return Result();
}

template <typename Result, typename... Arguments>
void ignore(Result(VKAPI_PTR*& function)(Arguments...)) {
  function = &ignored<Result, Arguments...>;
}

template <typename... Arguments>
VKAPI_ATTR VkResult VKAPI_CALL lost(Arguments...) {
  return VK_ERROR_DEVICE_LOST;
}

template <typename... Arguments>
void lose(VkResult(VKAPI_PTR*& function)(Arguments...)) {
  function = &lost<Arguments...>;
}

}  // namespace

void abandon(const vk::raii::Device& device, const vk::raii::Instance& instance) {
  // All that the program calls.
  auto& functions = functionsOf(device);
  ignore(functions.vkDestroyBuffer);
  ignore(functions.vkDestroyCommandPool);
  ignore(functions.vkDestroyDescriptorPool);
  ignore(functions.vkDestroyDescriptorSetLayout);
  ignore(functions.vkDestroyDevice);
  ignore(functions.vkDestroyFence);
  ignore(functions.vkDestroyImage);
  ignore(functions.vkDestroyImageView);
  ignore(functions.vkDestroyPipeline);
  ignore(functions.vkDestroyPipelineLayout);
  ignore(functions.vkDestroyQueryPool);
  ignore(functions.vkDestroySampler);
  ignore(functions.vkDestroyShaderModule);
  ignore(functions.vkFreeCommandBuffers);
  ignore(functions.vkFreeDescriptorSets);
  ignore(functions.vkFreeMemory);
  ignore(functions.vkUnmapMemory);
  lose(functions.vkDeviceWaitIdle);
  lose(functions.vkGetQueryPoolResults);
  lose(functions.vkQueueSubmit);
  lose(functions.vkQueueWaitIdle);
  lose(functions.vkWaitForFences);
  ignore(functionsOf(instance).vkDestroyInstance);  // an instance must outlive its devices
}

}  // namespace oitlab
