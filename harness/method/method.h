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

/// An order-independent-transparency method. Its life: prepare() once, then any number of frames,
/// each record(), wait for the device, status().
class Method {
 public:
  virtual ~Method() = default;

  /// Makes pipelines and buffers. `scene` and `target` outlive the method. Buffers are made with
  /// `memory`, so that they are listed in the results. May throw DeviceError.
  virtual void prepare(const Device& device, const GpuScene& scene, const Target& target,
                       const Parameters& parameters) = 0;

  /// Records a frame. On entry the target holds the opaque colour and depth, visible to all stages;
  /// on return the target must hold the finished image, writes not yet made visible.
  virtual void record(const Frame& frame) = 0;

  /// Whether record() calls Frame::finishTarget() and leaves the target alone until then.
  virtual bool finishesTarget() const { return false; }

  /// After the device is done with the frame.
  virtual Status status() = 0;

  const MemoryLedger& memory() const { return memory_; }

 protected:
  MemoryLedger memory_;
};

/// The declaration of a method: who it is, what it takes, what it needs.
struct MethodInfo {
  std::string name;     ///< that of its folder
  std::string summary;  ///< one line
  std::string source;   ///< paper or origin
  bool exact = false;   ///< claims the exact image
  std::vector<Parameter> parameters;
  std::vector<std::string> features;  ///< Vulkan features it needs beyond the baseline
  std::function<std::unique_ptr<Method>()> make;

  /// What `device` lacks for this method; empty when it can run there.
  std::vector<std::string> missing(const DeviceInfo& device) const;
};

/// All registered methods by name.
const std::map<std::string, MethodInfo>& methods();

/// Throws InputError with a suggestion when there is no such method.
const MethodInfo& findMethod(const std::string& name);

/// Registers a method: `const RegisterMethod registered(info)` in the method's own file is the
/// whole of it.
struct RegisterMethod {
  explicit RegisterMethod(MethodInfo info);
};

}  // namespace oitlab
