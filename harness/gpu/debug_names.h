#pragma once

#include <string>

#include "gpu/device.h"

namespace oitlab {

/// Names for RenderDoc, Nsight and the validation layer: buffers by the names of the memory table,
/// pipelines by shader and definitions, stages by the names of the results. Nothing is called
/// where Device::showsNames() is false, so that a measurement does not pay for them.

/// Names an object of the device, of any kind.
template <typename Handle>
void nameObject(const Device& device, Handle handle, const std::string& name) {
  if (!device.showsNames()) return;
  const auto raw = reinterpret_cast<std::uint64_t>(static_cast<typename Handle::CType>(handle));
  device.vk().setDebugUtilsObjectNameEXT({Handle::objectType, raw, name.c_str()});
}

/// Puts what is recorded in its lifetime under `name`.
class DebugLabel {
 public:
  DebugLabel(const Device& device, const Commands& commands, const std::string& name)
      : commands_(device.showsNames() ? &commands : nullptr) {
    if (commands_ != nullptr) commands_->beginDebugUtilsLabelEXT({name.c_str()});
  }
  ~DebugLabel() {
    if (commands_ != nullptr) commands_->endDebugUtilsLabelEXT();
  }
  DebugLabel(const DebugLabel&) = delete;
  DebugLabel& operator=(const DebugLabel&) = delete;

 private:
  const Commands* commands_;
};

}  // namespace oitlab
