#include "abuffer/options.h"

#include <bit>

#include "abuffer/abuffer_types.h"
#include "abuffer/sort_table.h"

#include "util/rounding.h"

namespace oitlab::abuffer {
namespace {

/// The stencil stops at 255, where it may mean any number from there on.
constexpr std::uint32_t stencilLimit = 254;

std::uint32_t sortNumber(const std::string& name) {
  return std::uint32_t(std::find(sortNames.begin(), sortNames.end(), name) - sortNames.begin());
}

/// The sorts of a shader with room for `length` fragments of `entryBytes`; `branching`: it chooses
/// when it runs.
void defineSorts(IntervalPlan& plan, const Parameters& parameters, const DeviceInfo& device,
                 std::uint32_t length, bool branching, std::uint32_t entryBytes) {
  Defines& defines = plan.defines;
  const std::string& sort = parameters.choice("sort");
  std::uint32_t small = sortNumber(sort), large = small, upTo = length;
  if (sort == "auto") {
    const AutoSort& row = autoSortFor(device.name);
    upTo = branching ? row.insertionUpToMax : row.insertionUpTo;
    small = sortNumber("insertion");
    large = length <= upTo ? small : sortNumber("merge");
    if (!branching) small = large;
  }
  defines["MAX_FRAGMENTS"] = fmt::format("{}", length);
  defines["ROUND_LENGTH"] = fmt::format("{}", std::bit_ceil(length));
  defines["SMALL_SORT"] = fmt::format("{}", small);
  defines["LARGE_SORT"] = fmt::format("{}", large);
  defines["SMALL_UP_TO"] = fmt::format("{}", upTo);
  // The arrays of sort_local.glsl and sort_register.glsl.
  const auto uses = [&](const char* name) {
    return small == sortNumber(name) || large == sortNumber(name);
  };
  std::uint32_t entries = uses("bitonic") ? std::bit_ceil(length) : length;
  if (uses("merge")) entries += (std::bit_ceil(length) + 1) / 2;
  if (uses("register")) entries = divideUp(length, 32u);
  plan.localBytes = entries * entryBytes;
}

}  // namespace

Options::Options(const Parameters& parameters, const DeviceInfo& device,
                 const std::string& targetFormat) {
  const std::string& memory = parameters.choice("sort_memory");
  sortMemory = memory == "bma"   ? SortMemory::bma
               : memory == "max" ? SortMemory::max
                                 : SortMemory::maxByInterval;
  const std::string& maskName = parameters.choice("mask");
  mask = maskName == "stencil" ? Mask::stencil
         : maskName == "lists" ? Mask::lists
                               : Mask::stencilIncrement;
  maxFragments = std::uint32_t(parameters.integer("max_fragments"));
  truncate = parameters.choice("deep") == "truncate";
  drop = parameters.choice("on_overflow") == "drop";
  initialDepth = parameters.real("initial_depth");

  const std::string& color = parameters.choice("node_color");
  nodes["NODE_COLOR"] = color == "rgba32f" ? "0" : color == "rgba16f" ? "1" : "2";
  nodes["TARGET_FORMAT"] = targetFormat;
  const std::uint32_t colorBytes = color == "rgba32f" ? 16 : color == "rgba16f" ? 8 : 4;
  nodeBytes = std::uint32_t(sizeof(Node) - sizeof(vec4)) + colorBytes;
  // The shader for all pixels needs no counts: it sees a list's length when it loads it. The
  // register sort is the exception, since it takes the list apart as it loads.
  counts_ = byInterval() ? mask != Mask::stencilIncrement
                         : parameters.choice("sort") == "register" && !truncate;

  Defines defines = nodes;
  localColor_ = parameters.choice("local") == "fragments";
  if (localColor_) defines["LOCAL_COLOR"] = "1";
  const std::uint32_t entryBytes = 8 + (localColor_ ? colorBytes : 0);  // entry.glsl
  if (!byInterval()) {
    defines["DIRECT"] = nodes["DIRECT"] = "1";
    if (!truncate) defines["FIND_DEEP"] = "1";
    intervals.push_back({0, ~0u, maxFragments, defines});
    defineSorts(intervals.back(), parameters, device, maxFragments, true, entryBytes);
    return;
  }
  if (mask == Mask::lists) defines["LISTED"] = "1";
  for (std::uint32_t upper = SMALLEST_INTERVAL, low = 0; low < maxFragments; upper *= 2) {
    IntervalPlan plan{low, std::min(upper, maxFragments), std::min(upper, maxFragments), defines};
    if (stencilCounts()) plan.high = std::min(plan.high, stencilLimit);
    const bool own = sortMemory == SortMemory::bma;
    defineSorts(plan, parameters, device, own ? plan.name : maxFragments, !own, entryBytes);
    low = plan.high;
    intervals.push_back(std::move(plan));
    if (stencilCounts() && low == stencilLimit) break;
  }
  // The last one takes what is deeper too, and sorts what it has room for (section 3).
  if (truncate) intervals.back().high = ~0u;
}

std::string Options::ifRefused(const IntervalPlan& plan) const {
  return fmt::format(
      "an invocation sorts up to {} fragments in {} bytes of local memory, which may be more than "
      "the driver allows: lower 'max_fragments' (now {}){}, or choose sort=register",
      plan.defines.at("MAX_FRAGMENTS"), plan.localBytes, maxFragments,
      localColor_ ? ", or choose local=keys or a smaller 'node_color'" : "");
}

std::vector<Parameter> declareParameters() {
  return {
      choice(
          "sort_memory", {"bma", "max", "max_by_interval"},
          "local memory for sorting: bma: what each interval of 8, 16, ... fragments needs; max: "
          "max_fragments for all; max_by_interval: max's shader run as bma's (for Table 1)"),
      integer("max_fragments", 512, 8, 1024, "fragments a pixel that local memory is made for",
              "fragments"),
      choice(
          "mask", {"stencil", "lists", "stencil_increment"},
          "how an interval's shader comes to its pixels: stencil marked for each interval; lists "
          "of pixels run by compute shaders; stencil incremented by the capture, to 254 "
          "fragments and not beyond"),
      choice("sort", {"auto", "insertion", "merge", "shell", "bitonic", "register"},
             "auto: insertion sort for few fragments, merge sort for more; register: blocks sorted "
             "in registers, merged from the lists"),
      choice("deep", {"exact", "truncate"},
             "pixels of more than max_fragments: exact: sorted in their lists; truncate: the rest "
             "is left out and counted"),
      choice("on_overflow", {"grow", "drop"},
             "more fragments than memory: grow: make room and record again; drop: lose and count "
             "them"),
      real("initial_depth", 4.0, 0.0, 1024.0, "fragments a pixel that memory is first made for",
           "fragments"),
      choice("node_color", {"rgba32f", "rgba16f", "rgba8"},
             "how lists hold colours; rgba32f is exact"),
      choice("local", {"keys", "fragments"},
             "what is sorted in local memory: keys: depth and node, 8 bytes; fragments: the colour "
             "with them, 16 bytes for rgba16f, as in the paper"),
  };
}

}  // namespace oitlab::abuffer
