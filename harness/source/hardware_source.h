#pragma once

#include "frame/frame_bindings.h"
#include "frame/sample_counter.h"
#include "source/fragment_source.h"
#include "source/pixel_states.h"

namespace oitlab {

/// Fragments from the hardware rasterizer: fragment shaders, in the order of submission where a
/// pixel's fragments are blended or change its state, else in any order. A run is a geometry pass.
class HardwareSource : public FragmentSource {
 public:
  struct Options {
    /// For tests: exclusive programs run without fragment shader interlock. This is right on
    /// llvmpipe, where one thread runs all fragment shaders of a pixel in the order of submission.
    bool withoutInterlock = false;
  };

  /// All must outlive this. `memory` lists the images of sums and the states.
  HardwareSource(const Device& device, const GpuScene& scene, const Target& target,
                 MemoryLedger& memory, const Options& options);

  FragmentPass make(const FragmentProgram& program) override;
  std::uint64_t begin(const Frame& frame, const Submission& submission) override;
  void end(const Frame&) override {}
  bool grow() override { return false; }
  void addCounters(std::map<std::string, std::uint64_t>& counters) override;
  vk::PipelineStageFlags2 stages() const override {
    return vk::PipelineStageFlagBits2::eFragmentShader;
  }

 private:
  struct Pass {
    FragmentProgram program;
    Pipeline fragments, composite;
    std::vector<GpuImage> sums;
    std::optional<FrameBindings> bindings;  // with `sums`
    bool hasComposite() const { return !sums.empty() || program.access == Access::exclusive; }
  };

  void runBytes(const Frame& frame, const std::string& stage, FragmentPass pass,
                std::span<const std::byte> push, const FragmentRun& run) override;
  void addTargets(const FragmentProgram& program, Pass& pass, Pipeline::Graphics& description);
  void addStates(const FragmentProgram& program, Pipeline::Graphics& description);
  Pipeline makeComposite(const FragmentProgram& program) const;
  void draw(const Frame& frame, const FragmentRun& run) const;
  void accumulate(const Frame& frame, const Pass& pass, std::span<const std::byte> push,
                  const FragmentRun& run);
  void composite(const Frame& frame, const Pass& pass, std::span<const std::byte> push) const;
  void checkFeature(const char* feature, const char* why) const;

  const Device& device_;
  const GpuScene& scene_;
  const Target& target_;
  MemoryLedger& memory_;
  Options options_;
  std::vector<Pass> passes_;
  PixelStates states_;
  Submission submission_;
  SampleCounter samples_;
  bool counts_ = false;  // the next pass of this frame counts its fragments
};

}  // namespace oitlab
