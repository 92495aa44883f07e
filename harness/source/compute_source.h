#pragma once

#include "gpu/lazy_pipeline.h"
#include "raster/block_lists.h"
#include "source/compute_types.h"
#include "source/fragment_source.h"

namespace oitlab {

/// Fragments from the compute rasterizer: triangles are set up, binned and listed by half-block
/// once a frame; each run of a pass goes through the lists. A pixel belongs to one lane, so that
/// sums and states are in registers.
class ComputeSource : public FragmentSource {
 public:
  struct Options {
    int deliver = DELIVER_ANY;  ///< DELIVER_*
    std::uint32_t seed = 0;     ///< of DELIVER_SHUFFLED
    bool poison = false;        ///< for tests: fill all buffers with rubbish before each frame
  };

  /// All must outlive this. `memory` lists the buffers. Throws DeviceError when the device lacks a
  /// feature or memory.
  ComputeSource(const Device& device, const GpuScene& scene, const Target& target,
                MemoryLedger& memory, const Options& options);

  FragmentPass make(const FragmentProgram& program) override;
  std::uint64_t begin(const Frame& frame, const Submission& submission) override;
  void end(const Frame& frame) override;
  bool grow() override;
  void addCounters(std::map<std::string, std::uint64_t>& counters) override;
  vk::PipelineStageFlags2 stages() const override {
    return vk::PipelineStageFlagBits2::eComputeShader;
  }
  bool usesComputeRasterizer() const override { return true; }

  /// For tests: makes the programs that frames would only make when they need them.
  void makeAllPrograms();

 private:
  struct Pass {
    FragmentProgram program;
    Pipeline pipeline;
  };

  void runBytes(const Frame& frame, const std::string& stage, FragmentPass pass,
                std::span<const std::byte> push, const FragmentRun& run) override;
  Pipeline makePipeline(const FragmentProgram& program) const;
  void makeOrderPrograms();
  void recordOrder(const Frame& frame, const OrderRule& rule);
  /// Lists of up to so many tri-half-blocks are put in order in this frame.
  std::uint32_t longestOrdered() const;
  void mergeLongLists(const Frame& frame, OrderPush push);
  bool makeRoomForLongLists(std::uint32_t longest);
  bool isOrdered() const { return options_.deliver != DELIVER_ANY; }

  const Device& device_;
  const Target& target_;
  MemoryLedger& memory_;
  Options options_;
  Defines sceneDefines_;  // found once: they take a walk over the whole scene
  raster::BlockLists lists_;
  std::vector<Pass> passes_;
  LazyPipeline orderShort_, orderMedium_, orderLong_, merge_;
  bool longSeen_ = false, mediumSeen_ = false;  // their lists are ordered from the first on
  std::uint32_t merges_ = 0;                    // that the longest list seen needs
  Buffer constants_, sequence_, runs_[2];
  std::uint32_t runsDone_ = 0;  // runs of passes in this frame
};

}  // namespace oitlab
