#pragma once

#include "gpu/lazy_pipeline.h"
#include "raster/blocks/block_types.h"
#include "raster/front_end.h"

namespace oitlab::raster {

/// For each half-block (8 x 4 pixels) the list of the triangles that cover some of its pixels, with
/// their coverage: LucidRaster (Jakubowski 2024), section 2, stages 1 to 3 up to the sort. Lists
/// are unordered. Their lengths say which of three kinds they are (block_types.h).
class BlockLists {
 public:
  struct Options {
    bool backFaceCulling = false;
    /// The longest list that counts as short: 0, SHORT_LIST or MEDIUM_LIST.
    std::uint32_t longestShort = SHORT_LIST;
    int key = KEY_DEPTH;  ///< KEY_*: what lies beside each tri-half-block in keys()
    /// Half-blocks per workgroup of the dispatches that BlockCounters counts.
    std::uint32_t shortTeams = 1, mediumTeams = 1;
    /// Of the counters, which begin with BlockCounters. What is behind is the method's own.
    std::uint64_t counterBytes = sizeof(BlockCounters);
    bool countAll = false;  ///< count the dispatches over lists of all kinds, too
  };

  /// As FrontEnd.
  BlockLists(const Device& device, const GpuScene& scene, const Target& target,
             MemoryLedger& memory, const Options& options);

  /// Records the stages "setup", "binning" and "blocks". After them the lists are visible to
  /// compute shaders and indirect dispatches, unless a buffer was too small: then
  /// BlockCounters::overflow is 1, or grow() says that the frame is to be recorded again.
  void record(const Frame& frame);

  /// Once the device is done: makes room where room was short, and makes the programs that a frame
  /// has lacked. True: record again.
  bool grow();

  /// Records the end of a frame: counters() can be read once the device is done.
  void readBack(const Frame& frame) const;

  const FrontEnd& frontEnd() const { return frontEnd_; }
  Mesh mesh(const Frame& frame) const { return frontEnd_.addresses(frame).mesh; }

  /// Zeroed at the beginning of record(): BlockCounters, then the method's own.
  const CountersBuffer& counters() const { return counters_; }
  const Buffer& list() const { return list_; }      ///< TriHalfBlock
  const Buffer& keys() const { return keys_; }      ///< uint each; null without a key
  const Buffer& blocks() const { return blocks_; }  ///< HalfBlock; as BlocksPush
  const Buffer& medium() const { return medium_; }  ///< PixelJob, one per half-block of the frame
  std::uint32_t halfBlocks() const { return frontEnd_.bins() * HALF_BLOCKS; }

  /// Bytes of the lists and of what is made on the way to them.
  std::uint64_t scratchBytes() const;

  /// For tests: makes the programs that frames would only make when they need them.
  void makeAllPrograms(bool hasUnsnapped);

  /// For tests: fills everything that a frame must write before it reads with `pattern`.
  void poison(const Commands& commands, std::uint32_t pattern) const;

 private:
  void makePrograms(bool hasUnsnapped);
  void makeRoomForSegments();
  void makeRoomForLists(std::uint64_t triHalfBlocks, std::uint64_t cached);

  const Device& device_;
  MemoryLedger& memory_;
  Options options_;
  FrontEnd frontEnd_;
  LazyPipeline countHigh_, countAndWriteLow_, writeHigh_;  // the passes of blocks.comp
  bool programsTakeUnsnapped_ = false;
  bool highBinsSeen_ = false;  // the passes for them are recorded from the first that is seen
  Buffer list_, keys_, blocks_, medium_, binBlocks_, segmentLists_;
  CountersBuffer counters_;
  std::uint32_t listCapacity_ = 0, cachedCapacity_ = 0;
};

}  // namespace oitlab::raster
