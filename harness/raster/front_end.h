#pragma once

#include <map>
#include <string>

#include "frame/frame.h"
#include "gpu/counters_buffer.h"
#include "gpu/pipeline.h"
#include "gpu/zero_fill.h"
#include "raster/raster_types.h"

namespace oitlab::raster {

/// The first two stages of a compute rasterizer after LucidRaster (Jakubowski 2024, section 2):
/// quad setup and binning. From the scene's transparent triangles it leaves, for one camera, the
/// vertices on the screen, and for each 32 x 32 bin the list of its primitives. What rasterization
/// and shading need of a triangle shaders work out from these (shaders/raster/triangles.glsl). It
/// knows nothing of blending: what becomes of the fragments is the method's.
///
/// Memory follows the scene: buffers grow by what was counted, and the frame is recorded again.
class FrontEnd {
 public:
  struct Options {
    bool backFaceCulling = false;
  };

  /// `memory` must outlive this and lists the buffers; `scene` and `target` too. Takes the scene's
  /// quads, which may take seconds the first time (scene/quads.h). Throws DeviceError when memory
  /// is short.
  FrontEnd(const Device& device, const GpuScene& scene, const Target& target, MemoryLedger& memory,
           const Options& options);

  /// Records the stages "setup" and "binning". After them the lists are visible to compute shaders
  /// and indirect dispatches, if `RasterCounters::ready`; else the frame is to be recorded again.
  /// Zeroes `alsoZeroed` (at most two) on the way, and finishes a target that is not ready.
  void record(const Frame& frame, std::initializer_list<const Buffer*> alsoZeroed = {});

  /// Once the device is done: makes room where room was short. True: record again.
  bool grow();

  /// The counts of the last frame, if that ended with recordReadback() of counters().
  const RasterCounters& counted() const { return counters_.read<RasterCounters>(); }

  /// Adds the counters of the stages, by the names of the results.
  void addCounters(std::map<std::string, std::uint64_t>& counters) const;

  /// Where everything is: valid until grow().
  RasterPush addresses(const Frame& frame) const;

  /// Of the counters' `low` and `high` dispatches.
  const CountersBuffer& counters() const { return counters_; }
  std::uint32_t bins() const { return binColumns_ * binRows_; }
  std::uint32_t inputQuads() const { return quadCount_; }

  /// Some frame has had triangles that cannot be snapped.
  bool hasUnsnapped() const { return unsnappedSeen_; }

  /// Parts of high bins that there is room for: valid until grow().
  std::uint32_t segmentCapacity() const;

  /// For tests: fills everything that a frame must write before it reads with `pattern`.
  void poison(const Commands& commands, std::uint32_t pattern) const;

 private:
  void makeQuads(const GpuScene& scene);
  void makeRoomForSmall(std::uint64_t quads);
  void makeRoomForLarge(std::uint64_t triangles);
  void makeRoomForUnsnapped(std::uint64_t triangles);
  void makeRoomForEntries(std::uint64_t entries);

  const Device& device_;
  MemoryLedger& memory_;
  Options options_;
  std::uint32_t quadCount_ = 0, degenerateQuads_ = 0, vertexCount_ = 0;
  std::uint64_t vertices_ = 0;  // address of the first that a quad has
  std::uint32_t binColumns_, binRows_;
  std::uint32_t smallCapacity_ = 0, largeCapacity_ = 0, unsnappedCapacity_ = 0, entryCapacity_ = 0;
  // What these need is recorded from the first that is seen.
  bool largeSeen_ = false, unsnappedSeen_ = false;
  ZeroFill zeroFill_;
  Pipeline project_, setup_, countLarge_, offsets_, writeSmall_, writeLarge_;
  Buffer quads_, onScreen_, unsnapped_, smallQuads_, large_;
  Buffer bins_, entries_, segments_;
  CountersBuffer counters_;
};

}  // namespace oitlab::raster
