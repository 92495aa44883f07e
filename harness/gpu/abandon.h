#pragma once

#include <vulkan/vulkan_raii.hpp>

namespace oitlab {

/// Gives up a device that still works on something and may never end. Nobody can wait for it, and
/// nothing may be destroyed that it uses. From now on every call that would destroy or free an
/// object of the device, or itself, does nothing, so that its objects can be dropped as usual.
/// Calls that submit or wait fail with VK_ERROR_DEVICE_LOST. What the device holds stays in memory
/// until the process ends.
///
/// All its objects call the driver through one table of functions, which is changed here. No other
/// thread may use the device at the same time.
void abandon(const vk::raii::Device& device, const vk::raii::Instance& instance);

}  // namespace oitlab
