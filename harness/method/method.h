#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "frame/frame.h"
#include "gpu/pipeline.h"
#include "method/parameters.h"

namespace oitlab {

/// What happened in the last frame, known once the device is done with it.
struct Status {
  /// Memory ran out, the method has made its buffers larger, and the frame is to be recorded again.
  bool recordAgain = false;
  /// By name: "fragments" (transparent fragments in front of the opaque depth) and whatever else
  /// the method counts. Complete after an instrumented frame.
  std::map<std::string, std::uint64_t> counters;
};

/// What a method is made for. All of it but `parameters` outlives the method.
struct MethodContext {
  const Device& device;
  const GpuScene& scene;
  const Target& target;
  MemoryLedger& memory;  ///< buffers made with it are listed in the results
  const Parameters& parameters;
};

/// An order-independent-transparency method. Its constructor makes pipelines and buffers; then come
/// any number of frames, each record(), wait for the device, status().
class Method {
 public:
  virtual ~Method() = default;

  /// Records a frame. On entry the target holds the opaque colour and depth, visible to all stages;
  /// on return the target must hold the finished image, writes not yet made visible.
  virtual void record(const Frame& frame) = 0;

  /// Whether record() calls Frame::finishTarget() and leaves the target alone until then.
  virtual bool finishesTarget() const { return false; }

  /// After the device is done with the frame.
  virtual Status status() = 0;

  /// The buffers of a method that MethodInfo::makeFor() made.
  const MemoryLedger& memory() const { return *ledger_; }

 private:
  friend struct MethodInfo;

  // In the base, so that it outlives the buffers of the method itself.
  std::unique_ptr<MemoryLedger> ledger_ = std::make_unique<MemoryLedger>();
};

/// The declaration of a method: who it is, what it takes, what it needs.
struct MethodInfo {
  std::string name;     ///< that of its folder
  std::string summary;  ///< one line
  std::string source;   ///< paper or origin
  bool exact = false;   ///< claims the exact image
  std::vector<Parameter> parameters;
  std::vector<std::string> features;  ///< Vulkan features it needs beyond the baseline
  std::function<std::unique_ptr<Method>(const MethodContext&)> make;

  /// What `device` lacks for this method; empty when it can run there.
  std::vector<std::string> missing(const DeviceInfo& device) const;

  /// Calls `make` with a ledger for the method's memory. `device`, `scene` and `target` must
  /// outlive the method. Throws DeviceError when the device lacks a feature, memory, or refuses a
  /// shader.
  std::unique_ptr<Method> makeFor(const Device& device, const GpuScene& scene, const Target& target,
                                  const Parameters& parameters) const;
};

/// All registered methods by name.
const std::map<std::string, MethodInfo>& methods();

/// Throws InputError with a suggestion when there is no such method.
const MethodInfo& findMethod(const std::string& name);

/// Constructs a method, as MethodInfo::make.
template <typename T>
std::unique_ptr<Method> makeMethod(const MethodContext& context) {
  return std::make_unique<T>(context);
}

/// Registers a method: `const RegisterMethod registered(info)` in the method's own file is all that
/// it takes.
struct RegisterMethod {
  explicit RegisterMethod(MethodInfo info);
};

}  // namespace oitlab
