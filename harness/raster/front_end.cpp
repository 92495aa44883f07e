#include "raster/front_end.h"

#include <algorithm>
#include <numeric>

#include "scene/quads.h"
#include "util/error.h"

namespace oitlab::raster {
namespace {

using Stage = vk::PipelineStageFlagBits2;

/// A sixteenth more than was counted, so that a slowly turning camera does not grow every frame.
std::uint32_t withSlack(std::uint64_t counted) {
  constexpr std::uint64_t most = 0xfffffff0u;
  if (counted > most)
    fail<DeviceError>("{} primitives in bins are more than 32-bit lists can name", counted);
  return std::uint32_t(std::min(counted + counted / 16 + 64, most));
}

std::uint32_t divideUp(std::uint32_t a, std::uint32_t b) {
  return (a + b - 1) / b;
}

}  // namespace

FrontEnd::FrontEnd(const Device& device, const GpuScene& scene, const Target& target,
                   MemoryLedger& memory, const Options& options)
    : device_(device),
      memory_(memory),
      options_(options),
      binColumns_(divideUp(target.width(), BIN_SIZE)),
      binRows_(divideUp(target.height(), BIN_SIZE)),
      zeroFill_(device),
      setup_(Pipeline::compute(device, "raster/setup.comp")),
      countLarge_(Pipeline::compute(device, "raster/bin_large.comp", {{"COUNT", "1"}})),
      offsets_(Pipeline::compute(device, "raster/bin_offsets.comp")),
      writeSmall_(Pipeline::compute(device, "raster/bin_small.comp")),
      writeLarge_(Pipeline::compute(device, "raster/bin_large.comp", {{"COUNT", "0"}})) {
  makeQuads(scene);
  bins_ = Buffer(device, memory, "bins", std::uint64_t(bins()) * sizeof(Bin));
  counters_ = Buffer(device, memory, "raster counters", sizeof(RasterCounters));
  readback_ = Buffer(device, memory, "raster counters readback", sizeof(RasterCounters),
                     BufferKind::readback);
  // First guesses; the first frame tells.
  makeRoomForQuads(std::min<std::uint64_t>(quadCount_, 4096));
  makeRoomForIrregular(64);
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
  std::vector<glm::uvec4> quads;
  std::vector<glm::uvec2> ids;
  quads.reserve(order.size());
  ids.reserve(order.size());
  for (const std::uint32_t q : order) {
    quads.push_back(mesh.quads[q]);
    ids.push_back(mesh.triangles[q]);
    if (mesh.triangles[q].y == QuadMesh::noTriangle) ++degenerateQuads_;
  }
  quadCount_ = std::uint32_t(quads.size());
  quads_ = uploadBuffer(device_, memory_, "quads", quads);
  quadIds_ = uploadBuffer(device_, memory_, "quad ids", ids);
}

void FrontEnd::makeRoomForQuads(std::uint64_t quads) {
  const std::uint64_t room = std::max<std::uint64_t>(quads, 1);
  for (Buffer* buffer : {&triangles_, &shading_, &attributes_, &quadBins_}) *buffer = Buffer();
  triangles_ = Buffer(device_, memory_, "triangle coverage", room * 2 * sizeof(RasterTriangle));
  shading_ = Buffer(device_, memory_, "triangle planes", room * 2 * sizeof(ShadeTriangle));
  attributes_ = Buffer(device_, memory_, "quad attributes",
                       (options_.attributes ? room : 1) * sizeof(QuadAttributes));
  quadBins_ = Buffer(device_, memory_, "quad bins", room * sizeof(BinBox));
  quadCapacity_ = std::uint32_t(room);
}

void FrontEnd::makeRoomForIrregular(std::uint64_t triangles) {
  if (triangles > MAX_IRREGULAR)
    fail<DeviceError>(
        "{} triangles cross the near plane or reach far beyond the screen: more than {}", triangles,
        MAX_IRREGULAR);
  irregular_ = Buffer();
  irregular_ =
      Buffer(device_, memory_, "irregular triangles", triangles * sizeof(IrregularTriangle));
  irregularCapacity_ = std::uint32_t(triangles);
}

void FrontEnd::makeRoomForEntries(std::uint64_t entries) {
  entries_ = Buffer();
  parts_ = Buffer();
  entries_ = Buffer(device_, memory_, "bin entries", entries * 4);
  entryCapacity_ = std::uint32_t(entries);
  parts_ = Buffer(device_, memory_, "parts of bins",
                  (std::uint64_t(bins()) + partCapacity()) * sizeof(Part));
}

RasterPush FrontEnd::addresses(const Frame& frame) const {
  return {.frame = frame.constants,
          .quads = quads_.address(),
          .quadIds = quadIds_.address(),
          .triangles = triangles_.address(),
          .irregular = irregular_.address(),
          .shading = shading_.address(),
          .attributes = attributes_.address(),
          .quadBins = quadBins_.address(),
          .bins = bins_.address(),
          .entries = entries_.address(),
          .parts = parts_.address(),
          .counters = counters_.address(),
          .quadCount = quadCount_,
          .quadCapacity = quadCapacity_,
          .irregularCapacity = irregularCapacity_,
          .entryCapacity = entryCapacity_,
          .backFaceCulling = options_.backFaceCulling,
          .countAll = frame.instrumented};
}

void FrontEnd::record(const Frame& frame, std::initializer_list<const Buffer*> alsoZeroed) {
  const RasterPush push = addresses(frame);
  auto run = [&](const Pipeline& pipeline, auto&& dispatch) {
    pipeline.bind(frame.commands, frame.bindings);
    pipeline.push(frame.commands, push);
    dispatch();
  };
  const auto compute = Stage::eComputeShader;
  frame.stage("setup", [&] {
    std::vector<const Buffer*> zeroed = {&bins_, &counters_};
    zeroed.insert(zeroed.end(), alsoZeroed);
    zeroFill_.record(frame.commands, zeroed);
    frame.barrier(compute, compute);
    frame.finishTarget(0);  // beside steps that leave room on a GPU
    run(setup_, [&] {
      const std::uint32_t groups = divideUp(std::max(quadCount_, 1u), SETUP_GROUP);
      frame.commands.dispatch(std::min(groups, MAX_GROUPS), divideUp(groups, MAX_GROUPS), 1);
    });
    frame.barrier(compute, compute);
  });
  frame.stage("binning", [&] {
    if (largeSeen_) {
      run(countLarge_, [&] { frame.commands.dispatch(LARGE_GROUPS, 1, 1); });
      frame.barrier(compute, compute);
    }
    frame.finishTarget(1);
    run(offsets_, [&] { frame.commands.dispatch(divideUp(bins(), OFFSET_GROUP), 1, 1); });
    frame.barrier(compute, compute | Stage::eDrawIndirect);
    run(writeSmall_,
        [&] { frame.commands.dispatchIndirect(counters_.vk(), offsetof(RasterCounters, small)); });
    if (largeSeen_) run(writeLarge_, [&] { frame.commands.dispatch(LARGE_GROUPS, 1, 1); });
    frame.barrier(compute, compute);
  });
}

void FrontEnd::recordReadback(const Frame& frame) const {
  frame.commands.copyBuffer(counters_.vk(), readback_.vk(),
                            vk::BufferCopy(0, 0, sizeof(RasterCounters)));
}

std::uint32_t FrontEnd::partCapacity() const {
  // A small quad is one entry and two triangles; each high bin rounds up.
  return 2 * (entryCapacity_ / PART_TRIANGLES + 1) + bins();
}

bool FrontEnd::grow() {
  const RasterCounters& c = counted();
  const bool lacked = c.largeQuads > 0 && !largeSeen_;
  largeSeen_ = largeSeen_ || lacked;
  if (c.ready != 0) return lacked;
  const std::uint64_t quads = std::uint64_t(c.smallQuads) + c.largeQuads;
  if (quads > quadCapacity_) makeRoomForQuads(std::min(withSlack(quads), quadCount_));
  if (c.irregularTriangles > irregularCapacity_)
    makeRoomForIrregular(std::uint64_t(c.irregularTriangles) * 2);
  if (c.entries > entryCapacity_) makeRoomForEntries(withSlack(c.entries));
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
  counters["irregular_triangles"] = c.irregularTriangles;
  if (options_.backFaceCulling) counters["culled_backface_quads"] = c.culledBackFacing;
  counters["bins_empty"] = c.emptyBins;
  counters["bins_low"] = c.lowBins;
  counters["bins_high"] = c.highBins;
  counters["bin_entries"] = c.entries;
}

void FrontEnd::poison(const Commands& commands, std::uint32_t pattern) const {
  for (const Buffer* buffer : {&triangles_, &irregular_, &shading_, &attributes_, &quadBins_,
                               &bins_, &entries_, &parts_, &counters_})
    fillBuffer(commands, *buffer, pattern);
}

}  // namespace oitlab::raster
