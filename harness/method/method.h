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

/// The result of the last frame, known once the device has finished it.
struct Status {
  /// A buffer was too small, the method has enlarged it, and the frame must be recorded again.
  bool recordAgain = false;
  /// By name: "fragments" (transparent fragments in front of the opaque depth) and what else the
  /// method counts. Complete after an instrumented frame.
  std::map<std::string, std::uint64_t> counters;
};

/// What a method is made for. All of it except `parameters` outlives the method.
struct MethodContext {
  const Device& device;
  const GpuScene& scene;
  const Target& target;
  MemoryLedger& memory;  ///< the method's buffers are made with it, so that the results list them
  const Parameters& parameters;
};

/// A method of order-independent transparency. Its constructor makes pipelines and buffers. Then,
/// for each frame, the harness calls record(), waits for the device and calls status().
class Method {
 public:
  virtual ~Method() = default;

  /// Records a frame. Before it the target holds the opaque colour and depth, visible to all
  /// stages. The commands must leave the finished image in the target; the harness makes it
  /// visible.
  virtual void record(const Frame& frame) = 0;

  /// Whether its fragments come from the compute rasterizer (raster::FrontEnd). Then the opaque
  /// depth that shaders read is of that rasterizer, and record() calls Frame::finishTarget() and
  /// does not touch the target before that.
  virtual bool usesComputeRasterizer() const { return false; }

  /// Called after the device has finished the frame.
  virtual Status status() = 0;

  /// The method's memory by buffer.
  const MemoryLedger& memory() const { return *ledger_; }

 private:
  friend struct MethodInfo;

  // In the base class, so that it is destroyed after the method's buffers.
  std::unique_ptr<MemoryLedger> ledger_ = std::make_unique<MemoryLedger>();
};

/// The declaration of a method: its name and origin, its parameters, and the features it needs.
struct MethodInfo {
  std::string name;     ///< the name of its folder
  std::string summary;  ///< one line
  std::string source;   ///< paper or origin
  bool exact = false;   ///< claims the exact image
  std::vector<Parameter> parameters;
  std::vector<std::string> features;  ///< Vulkan features it needs beyond the baseline
  /// It takes fragments from a source (makeSource()), and gets the parameters of one.
  bool takesFragments = false;
  /// Its default is source=compute. Exclusive methods have it, since few devices have what they
  /// need of hardware.
  bool computeFirst = false;
  std::function<std::unique_ptr<Method>(const MethodContext&)> make;

  /// The features that `device` lacks for this method; empty when the method can run there.
  std::vector<std::string> missing(const DeviceInfo& device) const;

  /// Calls `make` with a ledger for the method's memory. `device`, `scene` and `target` must
  /// outlive the method. Throws DeviceError when the device lacks a feature, memory, or refuses a
  /// shader.
  std::unique_ptr<Method> makeFor(const Device& device, const GpuScene& scene, const Target& target,
                                  const Parameters& parameters) const;
};

/// All registered methods by name.
const std::map<std::string, MethodInfo>& methods();

/// Throws InputError, with a suggestion, when there is no such method.
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
