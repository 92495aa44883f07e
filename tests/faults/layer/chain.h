#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan_core.h>

/// What every Vulkan layer needs: its place in the chain that the loader makes of layers, from the
/// program to the driver. A layer of ours is this (chain.cpp) and a file that defines the functions
/// "of the layer" below.
namespace oitlab::layer {

/// A function of the layer in front of the device's function of that name.
struct Hook {
  const char* name;
  PFN_vkVoidFunction function;
};

// Of the layer.

/// The device's functions that the layer stands in front of, in any order.
std::span<const Hook> deviceHooks();

/// Before vkCreateInstance or vkCreateDevice goes on to the next layer. Anything but VK_SUCCESS is
/// what the program gets in its place.
VkResult beforeCreation(const char* function);

/// Before a device goes.
void beforeDestruction(VkDevice device);

/// In front of a device's function that is not among the hooks; nullptr: the next layer's.
PFN_vkVoidFunction otherwise(std::string_view function);

// Of chain.cpp.

/// The next layer's function; nullptr where it has none. `handle` is a device, or a queue or
/// command buffer of it: all that the loader hands out begin with a pointer that tells the device.
PFN_vkVoidFunction nextOf(const void* handle, const char* name);

/// The device that `handle` is or belongs to.
VkDevice deviceOf(const void* handle);

/// A name as a template's argument.
template <std::size_t size>
struct Name {
  char text[size];
  consteval Name(const char (&from)[size]) {  // NOLINT(google-explicit-constructor)
    for (std::size_t i = 0; i < size; ++i) text[i] = from[i];
  }
};

/// The next layer's function, called.
template <typename Function, typename Handle, typename... Arguments>
auto callNext(const char* name, Handle handle, Arguments... arguments) {
  return reinterpret_cast<Function>(nextOf(handle, name))(handle, arguments...);
}

}  // namespace oitlab::layer

/// callNext(vkCmdDraw)(commands, ...): the name and its type are one word.
#define OITLAB_CALL_NEXT(function, ...) \
  ::oitlab::layer::callNext<PFN_##function>(#function, __VA_ARGS__)
