#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>

#include "frame/frame.h"
#include "source/fragment_program.h"

namespace oitlab {

/// A fragment program that a source has made. It names it to that source only.
struct FragmentPass {
  std::size_t number = ~std::size_t(0);
};

/// The order in which triangles count as submitted, if it is not that of the scene.
struct Submission {
  const Buffer* indices = nullptr;   ///< vertex indices of all transparent triangles, three each
  const Buffer* sequence = nullptr;  ///< by primitive id: its place in that order, a uint each
};

/// What one run of a pass can have beside its push constants.
struct FragmentRun {
  /// Hardware draws with the VkDrawIndexedIndirectCommand that lies here, which an earlier pass may
  /// have changed; other sources ask the program (FragmentProgram::isConditional).
  vk::Buffer draw = {};
  vk::DeviceSize drawOffset = 0;
  /// With hardware, render on this image (Frame::renderOnDepthStencil), without clearing it, with
  /// the reference value 0.
  const GpuImage* depthStencil = nullptr;
};

/// Delivers the transparent fragments of a frame to fragment programs: each fragment that is not
/// behind the opaque depth, once per run. docs/sources.md compares the sources.
class FragmentSource {
 public:
  virtual ~FragmentSource() = default;

  /// Makes a program for this source. Throws DeviceError when the device lacks what the program's
  /// access needs with this source, or refuses it; InputError when the GLSL does not compile.
  virtual FragmentPass make(const FragmentProgram& program) = 0;

  /// Begins a frame. Records what all passes of the frame share. Returns the address that every
  /// pass must have as `frame` in its push constants, of FrameConstants.
  virtual std::uint64_t begin(const Frame& frame, const Submission& submission) = 0;
  std::uint64_t begin(const Frame& frame) { return begin(frame, {}); }

  /// Records a pass over all fragments as stage `stage` (none, if it is empty). What the method did
  /// before must be visible to stages(). Blended and exclusive programs leave their image in the
  /// target. `Push` begins with the address from begin().
  template <typename Push>
  void run(const Frame& frame, const std::string& stage, FragmentPass pass, const Push& push,
           const FragmentRun& run = {}) {
    static_assert(sizeof(Push) <= Device::pushConstantBytes);
    runBytes(frame, stage, pass, std::as_bytes(std::span(&push, 1)), run);
  }

  /// Records what the source needs at the end of a frame.
  virtual void end(const Frame& frame) = 0;

  /// Once the device is done: true if something did not fit and the frame is to be recorded again.
  /// The method's own counters mean nothing then.
  virtual bool grow() = 0;

  /// Adds the source's counters of the last frame. "fragments", those that a program took, only
  /// for blended and exclusive programs, and complete after an instrumented frame.
  virtual void addCounters(std::map<std::string, std::uint64_t>& counters) = 0;

  /// In which programs run: for the method's barriers.
  virtual vk::PipelineStageFlags2 stages() const = 0;

  /// As Method::usesComputeRasterizer(), for the method.
  virtual bool usesComputeRasterizer() const { return false; }

 private:
  virtual void runBytes(const Frame& frame, const std::string& stage, FragmentPass pass,
                        std::span<const std::byte> push, const FragmentRun& run) = 0;
};

}  // namespace oitlab
