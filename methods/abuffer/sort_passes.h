#pragma once

#include "abuffer/list_memory.h"
#include "gpu/pipeline.h"

namespace oitlab::abuffer {

/// From captured lists to blended pixels: the intervals and how each comes to its pixels.
class SortPasses {
 public:
  /// `stencil` is the method's own image where the mask is one, else null; it and `options` must
  /// outlive this.
  SortPasses(const Device& device, const Options& options, const GpuImage* stencil);

  /// Records all of it. The capture's writes must be visible to fragment and compute shaders, and a
  /// counting stencil to its tests.
  void record(const Frame& frame, const ListMemory& memory, Push push) const;

 private:
  void findIntervals(const Frame& frame, const Push& push) const;
  void runAll(const Frame& frame, const Push& push) const;
  void runLists(const Frame& frame, const ListMemory& memory, Push push) const;
  void runStencil(const Frame& frame, const ListMemory& memory, const Push& push) const;
  void runCountingStencil(const Frame& frame, const Push& push) const;
  void drawThroughStencil(const Frame& frame, const Pipeline& pipeline, const Push& push,
                          std::uint32_t reference) const;
  Push forInterval(Push push, std::size_t interval) const;
  std::string stageName(std::size_t interval) const;

  const Options& options_;
  const GpuImage* stencil_;
  std::vector<Pipeline> sorts_;  ///< one for each interval
  Pipeline histogram_, arguments_, fillLists_, mask_, findDeep_;
};

}  // namespace oitlab::abuffer
