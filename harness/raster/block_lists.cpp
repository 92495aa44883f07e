#include "raster/block_lists.h"

#include "raster/raster_defines.h"
#include "util/error.h"
#include "util/rounding.h"

namespace oitlab::raster {

using Stage = vk::PipelineStageFlagBits2;

BlockLists::BlockLists(const Device& device, const GpuScene& scene, const Target& target,
                       MemoryLedger& memory, const Options& options)
    : device_(device),
      memory_(memory),
      options_(options),
      frontEnd_(device, scene, target, memory, {.backFaceCulling = options.backFaceCulling}),
      blocks_(device, memory, "half-blocks", std::uint64_t(halfBlocks()) * sizeof(HalfBlock)),
      binBlocks_(device, memory, "half-blocks of high bins",
                 std::uint64_t(halfBlocks()) * sizeof(BinBlock)),
      counters_(device, memory, "list counters", options.counterBytes) {
  if (options.longestShort < MEDIUM_LIST)
    medium_ = Buffer(device, memory, "half-blocks of medium lists",
                     std::uint64_t(halfBlocks()) * sizeof(PixelJob));
  makePrograms(false);
  // First guesses; the first frame tells.
  makeRoomForLists(halfBlocks(), 1024);
  makeRoomForSegments();
}

void BlockLists::makePrograms(bool hasUnsnapped) {
  programsTakeUnsnapped_ = hasUnsnapped;
  // One workgroup per segment of a bin. On a CPU a large one is no faster.
  const char* group = device_.info().subgroupSize >= 32 ? "256u" : "64u";
  const Defines common = {{"GROUP", group},
                          {"HAS_UNSNAPPED", programsTakeUnsnapped_ ? "1" : "0"},
                          {"KEY", std::to_string(options_.key)},
                          {"FIRST_LIST", std::to_string(options_.longestShort) + "u"},
                          {"SHORT_TEAMS", std::to_string(options_.shortTeams) + "u"},
                          {"MEDIUM_TEAMS", std::to_string(options_.mediumTeams) + "u"},
                          {"COUNT_ALL", options_.countAll ? "1" : "0"}};
  auto pass = [&](const char* name) {
    return LazyPipeline([&device = device_, defines = with(common, {{"PASS", name}})] {
      return Pipeline::compute(device, "raster/blocks/blocks.comp", defines);
    });
  };
  countHigh_ = pass("COUNT_HIGH");
  countAndWriteLow_ = pass("COUNT_AND_WRITE_LOW");
  writeHigh_ = pass("WRITE_HIGH");
}

void BlockLists::makeAllPrograms(bool hasUnsnapped) {
  makePrograms(hasUnsnapped);
  for (const LazyPipeline* program : {&countHigh_, &countAndWriteLow_, &writeHigh_}) **program;
}

void BlockLists::makeRoomForSegments() {
  segmentLists_ = Buffer();
  segmentLists_ = Buffer(device_, memory_, "lists of segments",
                         std::uint64_t(frontEnd_.segmentCapacity()) * sizeof(SegmentLists));
}

void BlockLists::makeRoomForLists(std::uint64_t triHalfBlocks, std::uint64_t cached) {
  if (triHalfBlocks >= ~0u)
    fail<DeviceError>("{} tri-half-blocks are more than 32 bits can name", triHalfBlocks);
  triHalfBlocks += triHalfBlocks % 2;
  list_ = Buffer();  // give the old ones back first: both may not fit
  keys_ = Buffer();
  list_ = Buffer(device_, memory_, "tri-half-blocks",
                 triHalfBlocks * sizeof(TriHalfBlock) + cached * sizeof(glm::uvec4));
  if (options_.key != KEY_NONE)
    keys_ =
        Buffer(device_, memory_, "keys of tri-half-blocks", triHalfBlocks * sizeof(std::uint32_t));
  listCapacity_ = std::uint32_t(triHalfBlocks);
  cachedCapacity_ = std::uint32_t(cached);
}

void BlockLists::record(const Frame& frame) {
  frontEnd_.record(frame, {&counters_.buffer(), &binBlocks_});
  frame.stage("blocks", [&] {
    const RasterPush front = frontEnd_.addresses(frame);
    const BlocksPush push{.mesh = front.mesh,
                          .frame = front.frame,
                          .entries = front.entries,
                          .segments = front.segments,
                          .rasterCounters = front.counters,
                          .list = list_.address(),
                          .keys = keys_.address(),
                          .blocks = blocks_.address(),
                          .medium = medium_.address(),
                          .binBlocks = binBlocks_.address(),
                          .segmentLists = segmentLists_.address(),
                          .counters = counters_.address(),
                          .listCapacity = listCapacity_,
                          .cachedCapacity = cachedCapacity_};
    auto run = [&](const LazyPipeline& program, std::size_t offset) {
      frame.bind(*program, push);
      frame.commands.dispatchIndirect(frontEnd_.counters().vk(), offset);
    };
    const auto compute = Stage::eComputeShader;
    if (highBinsSeen_) run(countHigh_, offsetof(RasterCounters, high));
    run(countAndWriteLow_, offsetof(RasterCounters, low));
    frame.barrier(compute, compute | Stage::eDrawIndirect);
    if (!highBinsSeen_) return;
    run(writeHigh_, offsetof(RasterCounters, high));
    frame.barrier(compute, compute);
  });
}

void BlockLists::readBack(const Frame& frame) const {
  recordReadback(frame.commands, {&frontEnd_.counters(), &counters_});
}

bool BlockLists::grow() {
  const BlockCounters& c = counters_.read<BlockCounters>();
  bool lacked = false;
  if (frontEnd_.counted().highSegments > 0 && !highBinsSeen_) highBinsSeen_ = lacked = true;
  if (frontEnd_.grow()) {
    makeRoomForSegments();
    if (frontEnd_.hasUnsnapped() && !programsTakeUnsnapped_) makePrograms(true);
    return true;
  }
  if (c.triHalfBlocks > listCapacity_ || c.cached > cachedCapacity_) {
    const std::uint64_t list = listCapacity_, cached = cachedCapacity_;
    makeRoomForLists(c.triHalfBlocks > list ? withSlack(c.triHalfBlocks) : list,
                     c.cached > cached ? withSlack(c.cached) : cached);
    return true;
  }
  return lacked;
}

std::uint64_t BlockLists::scratchBytes() const {
  std::uint64_t bytes = 0;
  for (const Buffer* buffer : {&list_, &keys_, &blocks_, &medium_, &binBlocks_, &segmentLists_})
    bytes += buffer->bytes();
  return bytes;
}

void BlockLists::poison(const Commands& commands, std::uint32_t pattern) const {
  frontEnd_.poison(commands, pattern);
  for (const Buffer* buffer :
       {&list_, &keys_, &blocks_, &medium_, &binBlocks_, &segmentLists_, &counters_.buffer()})
    if (*buffer) fillBuffer(commands, *buffer, pattern);
}

}  // namespace oitlab::raster
