#pragma once

#include "frame/frame_bindings.h"
#include "frame/sample_counter.h"
#include "source/fragment_source.h"

namespace oitlab {

/// Fragments from the hardware rasterizer: fragment shaders, in the order of submission where a
/// pixel's fragments are blended, else in any order. A run is a geometry pass.
class HardwareSource : public FragmentSource {
 public:
  /// All must outlive this. `memory` lists the images of sums.
  HardwareSource(const Device& device, const GpuScene& scene, const Target& target,
                 MemoryLedger& memory);

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
  };

  void runBytes(const Frame& frame, const std::string& stage, FragmentPass pass,
                std::span<const std::byte> push, const FragmentRun& run) override;
  void draw(const Frame& frame, const FragmentRun& run) const;
  void accumulate(const Frame& frame, const Pass& pass, std::span<const std::byte> push,
                  const FragmentRun& run);
  void composite(const Frame& frame, const Pass& pass, std::span<const std::byte> push) const;
  void checkFeature(const char* feature, const char* why) const;

  const Device& device_;
  const GpuScene& scene_;
  const Target& target_;
  MemoryLedger& memory_;
  std::vector<Pass> passes_;
  Submission submission_;
  SampleCounter samples_;
  bool counts_ = false;  // the next pass of this frame counts its fragments
};

}  // namespace oitlab
