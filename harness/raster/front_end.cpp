#include "raster/front_end.h"

#include <algorithm>
#include <numeric>

#include "scene/quads.h"
#include "util/check.h"
#include "util/error.h"
#include "util/rounding.h"

namespace oitlab::raster {
namespace {

using Stage = vk::PipelineStageFlagBits2;

/// The room to make for `counted` items that did not fit.
std::uint32_t roomFor(std::uint64_t counted) {
  constexpr std::uint64_t most = 0xfffffff0u;
  if (counted > most)
    fail<DeviceError>("{} primitives in bins are more than 32-bit lists can name", counted);
  return std::uint32_t(std::min(withSlack(counted), most));
}

/// One invocation per item.
void dispatchEach(const Commands& commands, std::uint32_t items) {
  const std::uint32_t groups = divideUp(std::max(items, 1u), std::uint32_t(SETUP_GROUP));
  const auto most = std::uint32_t(MAX_GROUPS);
  commands.dispatch(std::min(groups, most), divideUp(groups, most), 1);
}

}  // namespace

FrontEnd::FrontEnd(const Device& device, const GpuScene& scene, const Target& target,
                   MemoryLedger& memory, const Options& options)
    : device_(device),
      memory_(memory),
      options_(options),
      binColumns_(divideUp(target.width(), std::uint32_t(BIN_SIZE))),
      binRows_(divideUp(target.height(), std::uint32_t(BIN_SIZE))),
      zeroFill_(device),
      project_(Pipeline::compute(device, "raster/binning/project.comp")),
      setup_(Pipeline::compute(device, "raster/binning/setup.comp", {{"HAS_UNSNAPPED", "0"}})),
      countLarge_(Pipeline::compute(device, "raster/binning/bin_large.comp", {{"COUNT", "1"}})),
      offsets_(Pipeline::compute(device, "raster/binning/bin_offsets.comp")),
      writeSmall_(Pipeline::compute(device, "raster/binning/bin_small.comp")),
      writeLarge_(Pipeline::compute(device, "raster/binning/bin_large.comp", {{"COUNT", "0"}})) {
  makeQuads(scene);
  bins_ = Buffer(device, memory, "bins", std::uint64_t(bins()) * sizeof(Bin));
  counters_ = CountersBuffer(device, memory, "raster counters", sizeof(RasterCounters));
  // First guesses; the first frame tells.
  makeRoomForSmall(std::min<std::uint64_t>(quadCount_, 4096));
  makeRoomForLarge(1024);
  makeRoomForUnsnapped(64);
  makeRoomForEntries(std::uint64_t(bins()) * 4);
}

void FrontEnd::makeQuads(const GpuScene& scene) {
  const QuadMesh mesh = cachedQuads(scene.scene());
  std::vector<std::uint32_t> order;
  for (std::uint32_t q = 0; q < mesh.quads.size(); ++q)
    if (scene.scene().alphaModeOf(scene.scene().triangles[mesh.triangles[q].x]) == AlphaMode::blend)
      order.push_back(q);
  const auto& submission = scene.submission();
  if (!std::is_sorted(submission.begin(), submission.end())) {
    std::vector<std::uint32_t> place(scene.scene().triangles.size());
    for (std::uint32_t i = 0; i < submission.size(); ++i) place[submission[i]] = i;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return place[mesh.triangles[a].x] < place[mesh.triangles[b].x];
    });
  }
  const Scene& s = scene.scene();
  std::uint32_t first = ~0u, last = 0;
  for (const std::uint32_t q : order)
    for (int i = 0; i < 4; ++i) {
      first = std::min(first, mesh.quads[q][i]);
      last = std::max(last, mesh.quads[q][i]);
    }
  if (order.empty()) first = 0;
  std::vector<RasterQuad> quads;
  quads.reserve(order.size());
  for (const std::uint32_t q : order) {
    const glm::uvec4 corners = mesh.quads[q];
    const glm::uvec2 ids = mesh.triangles[q];
    bool white = true;
    for (int i = 0; i < 4; ++i) white = white && s.vertices[corners[i]].color == 0xffffffffu;
    quads.push_back({.corners = corners - first,
                     .ids = {ids.x, ids.y},
                     .material = s.vertices[corners.x].material,
                     .flags = white ? 0u : TRIANGLE_COLORED});
    if (ids.y == QuadMesh::noTriangle) ++degenerateQuads_;
  }
  quadCount_ = std::uint32_t(quads.size());
  quads_ = uploadBuffer(device_, memory_, "quads", quads);
  vertexCount_ = order.empty() ? 0 : last - first + 1;
  vertices_ = scene.vertices().address() + std::uint64_t(first) * sizeof(Vertex);
  onScreen_ = Buffer(device_, memory_, "vertices on the screen",
                     std::max<std::uint64_t>(vertexCount_, 1) * sizeof(ScreenVertex));
}

void FrontEnd::makeRoomForSmall(std::uint64_t quads) {
  smallCapacity_ = std::uint32_t(std::max<std::uint64_t>(quads, 1));
  smallQuads_ = Buffer();
  smallQuads_ = Buffer(device_, memory_, "small quads", smallCapacity_ * sizeof(SmallQuad));
}

void FrontEnd::makeRoomForLarge(std::uint64_t triangles) {
  largeCapacity_ = std::uint32_t(triangles);
  large_ = Buffer();
  large_ = Buffer(device_, memory_, "large triangles", triangles * sizeof(std::uint32_t));
}

void FrontEnd::makeRoomForUnsnapped(std::uint64_t triangles) {
  unsnappedCapacity_ = std::uint32_t(triangles);
  unsnapped_ = Buffer();
  unsnapped_ =
      Buffer(device_, memory_, "unsnapped triangles", triangles * sizeof(UnsnappedTriangle));
}

void FrontEnd::makeRoomForEntries(std::uint64_t entries) {
  entries_ = Buffer();
  segments_ = Buffer();
  entries_ = Buffer(device_, memory_, "bin entries", entries * 4);
  entryCapacity_ = std::uint32_t(entries);
  segments_ = Buffer(device_, memory_, "segments of bins",
                     (std::uint64_t(bins()) + segmentCapacity()) * sizeof(Segment));
}

RasterPush FrontEnd::addresses(const Frame& frame) const {
  return {.mesh = {.quads = quads_.address(),
                   .vertices = vertices_,
                   .onScreen = onScreen_.address(),
                   .unsnapped = unsnapped_.address()},
          .frame = frame.constants,
          .smallQuads = smallQuads_.address(),
          .large = large_.address(),
          .bins = bins_.address(),
          .entries = entries_.address(),
          .segments = segments_.address(),
          .counters = counters_.address(),
          .quadCount = quadCount_,
          .vertexCount = vertexCount_,
          .smallCapacity = smallCapacity_,
          .largeCapacity = largeCapacity_,
          .unsnappedCapacity = unsnappedCapacity_,
          .entryCapacity = entryCapacity_,
          // Enough to fill a large GPU, and quick to start for nothing; a CPU takes 3 us for each.
          .largeGroups = device_.info().isCpu() ? 64u : 1024u,
          .backFaceCulling = options_.backFaceCulling,
          .countAll = frame.instrumented};
}

void FrontEnd::record(const Frame& frame, std::initializer_list<const Buffer*> alsoZeroed) {
  // Else the opaque depth would be the hardware's, which these fragments cannot be compared with.
  OITLAB_CHECK(frame.computeRasterizer);
  const RasterPush push = addresses(frame);
  auto run = [&](const Pipeline& pipeline, auto&& dispatch) {
    frame.bind(pipeline, push);
    dispatch();
  };
  const auto compute = Stage::eComputeShader;
  frame.stage("setup", [&] {
    std::vector<const Buffer*> zeroed = {&bins_, &counters_.buffer()};
    zeroed.insert(zeroed.end(), alsoZeroed);
    zeroFill_.record(frame.commands, zeroed);
    run(project_, [&] { dispatchEach(frame.commands, vertexCount_); });
    frame.barrier(compute, compute);
    frame.finishTarget(0);  // beside steps that leave room on a GPU
    run(setup_, [&] { dispatchEach(frame.commands, quadCount_); });
    frame.barrier(compute, compute);
  });
  frame.stage("binning", [&] {
    if (largeSeen_) {
      run(countLarge_, [&] { frame.commands.dispatch(push.largeGroups, 1, 1); });
      frame.barrier(compute, compute);
    }
    frame.finishTarget(1);
    run(offsets_,
        [&] { frame.commands.dispatch(divideUp(bins(), std::uint32_t(OFFSET_GROUP)), 1, 1); });
    frame.barrier(compute, compute | Stage::eDrawIndirect);
    run(writeSmall_,
        [&] { frame.commands.dispatchIndirect(counters_.vk(), offsetof(RasterCounters, small)); });
    if (largeSeen_) run(writeLarge_, [&] { frame.commands.dispatch(push.largeGroups, 1, 1); });
    frame.barrier(compute, compute);
  });
}

std::uint32_t FrontEnd::segmentCapacity() const {
  // A small quad is one entry and two triangles; each high bin rounds up.
  return 2 * (entryCapacity_ / SEGMENT_TRIANGLES + 1) + bins();
}

bool FrontEnd::grow() {
  const RasterCounters& c = counted();
  bool lacked = false;
  if (c.unsnappedSeen != 0) {
    unsnappedSeen_ = lacked = true;
    setup_ = Pipeline::compute(device_, "raster/binning/setup.comp", {{"HAS_UNSNAPPED", "1"}});
  }
  if (c.largeTriangles > 0 && !largeSeen_) largeSeen_ = lacked = true;
  if (c.ready != 0) return lacked;
  if (c.smallQuads > smallCapacity_)
    makeRoomForSmall(std::min<std::uint64_t>(roomFor(c.smallQuads), quadCount_));
  if (c.largeTriangles > largeCapacity_) makeRoomForLarge(roomFor(c.largeTriangles));
  if (c.unsnappedTriangles > unsnappedCapacity_)
    makeRoomForUnsnapped(roomFor(c.unsnappedTriangles));
  if (c.entries > entryCapacity_) makeRoomForEntries(roomFor(c.entries));
  return true;
}

void FrontEnd::addCounters(std::map<std::string, std::uint64_t>& counters) const {
  const RasterCounters& c = counted();
  counters["input_quads"] = quadCount_;
  counters["degenerate_quads"] = degenerateQuads_;
  counters["visible_quads"] = c.smallQuads + c.largeQuads;
  counters["visible_triangles"] = c.visibleTriangles;
  counters["visible_degenerate_quads"] = c.visibleDegenerate;
  counters["small_quads"] = c.smallQuads;
  counters["large_quads"] = c.largeQuads;
  counters["unsnapped_triangles"] = c.unsnappedTriangles;
  if (options_.backFaceCulling) counters["culled_backface_quads"] = c.culledBackFacing;
  counters["bins_empty"] = c.emptyBins;
  counters["bins_low"] = c.lowBins;
  counters["bins_high"] = c.highBins;
  counters["bin_entries"] = c.entries;
}

void FrontEnd::poison(const Commands& commands, std::uint32_t pattern) const {
  for (const Buffer* buffer : {&onScreen_, &unsnapped_, &smallQuads_, &large_, &bins_, &entries_,
                               &segments_, &counters_.buffer()})
    fillBuffer(commands, *buffer, pattern);
}

}  // namespace oitlab::raster
