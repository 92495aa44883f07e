#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/shader.h"
#include "method/parameters.h"

namespace oitlab::abuffer {

/// How much local memory the sort is given (Knowles et al. 2013, section 3).
enum class SortMemory {
  max,            ///< one shader with max_fragments for all pixels
  bma,            ///< a shader for each interval, with as much as the interval needs
  maxByInterval,  ///< the intervals of bma, each run by the shader of max
};

/// How an interval's shader comes to its pixels. It says, for SortMemory::max too, whether the sort
/// is a fragment shader (stencils) or a compute shader (lists).
enum class Mask { stencil, lists, stencilIncrement };

/// One interval of fragments a pixel, and the variant of the sort that runs it.
struct IntervalPlan {
  std::uint32_t low, high;       ///< low < fragments <= high; the stencil's values too
  std::uint32_t name;            ///< its upper bound, as the stages call it
  Defines defines;               ///< of its shader
  std::uint32_t localBytes = 0;  ///< of the arrays that each of its invocations sorts in
};

/// The parameters of the method, and what follows from them.
struct Options {
  SortMemory sortMemory;
  Mask mask;
  std::uint32_t maxFragments;
  bool truncate;  ///< deep pixels lose what is too much, as in the paper
  bool drop;      ///< fragments beyond the first capacity are lost, as in the paper
  double initialDepth;
  std::uint32_t nodeBytes;
  std::vector<IntervalPlan> intervals;  ///< ascending; a single one of all for SortMemory::max
  Defines nodes;                        ///< of every shader that reads or writes nodes

  /// `targetFormat` as shaders name it.
  Options(const Parameters& parameters, const DeviceInfo& device, const std::string& targetFormat);

  /// What to say where a device refuses the shader of an interval: how much local memory it takes,
  /// and which parameters take less.
  std::string ifRefused(const IntervalPlan& plan) const;

  bool byInterval() const { return sortMemory != SortMemory::max; }
  bool fragmentShader() const { return mask != Mask::lists; }
  /// Whether the capture counts the fragments of each pixel in a buffer.
  bool counts() const { return counts_; }
  /// Whether the stencil counts them.
  bool stencilCounts() const { return byInterval() && mask == Mask::stencilIncrement; }

 private:
  bool counts_;
  bool localColor_;
};

/// What the method takes, for its registration.
std::vector<Parameter> declareParameters();

}  // namespace oitlab::abuffer
