#pragma once

#include <string>

#include "gpu/device.h"

namespace oitlab {

/// Names that RenderDoc, Nsight and the validation layer show. Buffers and images have the names of
/// the memory table, pipelines those of their shaders and definitions, and stages those of the
/// results. Where Device::showsNames() is false nothing is called, so that a measurement does not
/// pay for names.

/// Names an object of the device, of any kind.
template <typename Handle>
void nameObject(const Device& device, Handle handle, const std::string& name) {
  if (!device.showsNames()) return;
  const auto raw = reinterpret_cast<std::uint64_t>(static_cast<typename Handle::CType>(handle));
  device.vk().setDebugUtilsObjectNameEXT({Handle::objectType, raw, name.c_str()});
}

/// Labels the commands that are recorded while it lives.
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
