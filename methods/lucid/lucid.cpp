// LucidRaster (Jakubowski 2024): a software rasterizer in compute shaders with exact OIT. The front
// end (raster/front_end.h) bins the triangles; here they become tri-half-blocks, sorted lists of
// these, fragments, and a blended image. Where the paper's two-stage sort goes wrong, the pixel is
// blended again in exact order.
#include "lucid/lucid_types.h"

#include "method/method.h"
#include "raster/front_end.h"
#include "util/error.h"

namespace oitlab::lucid {
namespace {

using Stage = vk::PipelineStageFlagBits2;

/// Counted items, and a sixteenth more for a camera that moves on.
std::uint64_t withSlack(std::uint64_t counted) {
  return counted + counted / 16 + 64;
}

/// Whether a vertex has another colour than white.
bool hasColors(const Scene& scene) {
  return std::any_of(scene.vertices.begin(), scene.vertices.end(),
                     [](const Vertex& v) { return v.color != 0xffffffffu; });
}

/// Whether the corners of a triangle differ in colour.
bool hasGradients(const Scene& scene) {
  const auto& v = scene.vertices;
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](const auto& t) {
    return v[t.x].color != v[t.y].color || v[t.x].color != v[t.z].color;
  });
}

/// Whether the corners of a triangle differ in normal.
bool isSmooth(const Scene& scene) {
  const auto& v = scene.vertices;
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](const auto& t) {
    return v[t.x].normal != v[t.y].normal || v[t.x].normal != v[t.z].normal;
  });
}

}  // namespace

class Lucid : public Method {
 public:
  void prepare(const Device& device, const GpuScene& scene, const Target& target,
               const Parameters& parameters) override {
    device_ = &device;
    opaque_ = scene.opaqueCount() > 0;
    textures_ = !scene.scene().textures.empty();
    colors_ = hasColors(scene.scene());
    gradients_ = colors_ && hasGradients(scene.scene());
    smooth_ = isSmooth(scene.scene());
    parameters_ = parameters;
    frontEnd_ = std::make_unique<raster::FrontEnd>(
        device, scene, target, memory_,
        raster::FrontEnd::Options{.backFaceCulling = parameters.flag("backface_culling"),
                                  .attributes = textures_ || colors_});
    makePipelines(formatName(target.format()));
    const std::uint64_t halfBlocks = std::uint64_t(frontEnd_->bins()) * HALF_BLOCKS;
    blocks_ = Buffer(device, memory_, "half-blocks", halfBlocks * sizeof(HalfBlock));
    filterJobs_ = Buffer(device, memory_, "depth filter jobs", halfBlocks * sizeof(PixelJob));
    binBlocks_ = Buffer(device, memory_, "half-blocks of high bins", halfBlocks * sizeof(BinBlock));
    counters_ = Buffer(device, memory_, "lucid counters", sizeof(LucidCounters));
    readback_ = Buffer(device, memory_, "lucid counters readback", sizeof(LucidCounters),
                       BufferKind::readback);
    makeRoomForParts();
    makeRoomForLists(halfBlocks);
    makeRoomForRepairs(1024);
  }

  bool finishesTarget() const override { return true; }

  void record(const Frame& frame) override {
    if (parameters_.flag("poison")) poison(frame);
    frontEnd_->record(frame, {&counters_, &binBlocks_});
    const raster::RasterPush front = frontEnd_->addresses(frame);
    const auto compute = Stage::eComputeShader;
    frame.stage("blocks", [&] { recordBlocks(frame, front); });
    const BlendPush push = pushOf(frame, front);
    auto indirect = [&](const Pipeline& pipeline, std::size_t offset) {
      pipeline.bind(frame.commands, frame.bindings);
      pipeline.push(frame.commands, push);
      frame.commands.dispatchIndirect(counters_.vk(), offset);
    };
    // Within a step no barrier parts the programs: their half-blocks are different ones. Long lists
    // come first, since the last to end holds up the frame.
    const auto high = offsetof(LucidCounters, high), low = offsetof(LucidCounters, low);
    frame.stage("sort", [&] {
      if (needed_.longLists) indirect(sortHigh_, high);
      if (needed_.filter) indirect(sortLow_, low);
    });
    frame.stage("low_raster", [&] {
      if (ordersFirst()) indirect(ordered_, offsetof(LucidCounters, ordered));
      if (needed_.filter || needed_.longLists)
        frame.barrier(compute, compute | Stage::eDrawIndirect);
      if (needed_.filter) indirect(lowRaster_, low);
    });
    frame.stage("high_raster", [&] {
      if (needed_.longLists) indirect(highRaster_, high);
    });
    frame.stage("repair", [&] {
      if (needed_.repair) recordRepair(frame, front, push);
    });
    frame.barrier(compute, Stage::eTransfer);
    frontEnd_->recordReadback(frame);
    frame.commands.copyBuffer(counters_.vk(), readback_.vk(),
                              vk::BufferCopy(0, 0, sizeof(LucidCounters)));
    frame.barrier(Stage::eTransfer, Stage::eHost);
  }

  Status status() override {
    const LucidCounters& c = readback_.mapped<LucidCounters>()[0];
    bool again = findNeeded(c);
    if (frontEnd_->grow()) {
      makeRoomForParts();
      return {.recordAgain = true};
    }
    if (c.triHalfBlocks > listCapacity_) {
      makeRoomForLists(withSlack(c.triHalfBlocks));
      return {.recordAgain = true};
    }
    if (c.repairJobs > repairCapacity_) {
      makeRoomForRepairs(withSlack(c.repairJobs));
      again = true;
    }
    if (c.deepPixels > deepCapacity_ || c.deepNodes > nodeCapacity_) {
      makeRoomForDeep(withSlack(c.deepPixels), withSlack(c.deepNodes));
      again = true;
    } else if (c.unfinished > 0) {
      deepRounds_ *= 2;
      again = true;
    }
    if (again) return {.recordAgain = true};
    // A short subgroup goes through each list several times.
    const std::uint32_t sweeps = std::max(32 / device_->info().subgroupSize, 1u);
    const std::uint32_t toBlend = c.triHalfBlocks * sweeps + c.passedOn;
    const bool blended = !verifiesLoops() || c.blended == toBlend;
    if (c.walked != c.expected || !blended)
      fail<DeviceError>(
          "lucid: {} of {} list entries and {} of {} tri-half-blocks were gone through: {} ends "
          "long loops early (too many triangles in a bin)",
          c.walked, c.expected, c.blended, toBlend, device_->info().name);
    if (c.repairedPixels != c.pixelsToRepair)
      fail<DeviceError>("lucid: of {} pixels {} were repaired: {} ends long loops early",
                        c.pixelsToRepair, c.repairedPixels, device_->info().name);
    if (c.deepCaptured != c.deepNodes || c.deepBlended != c.deepNodes)
      fail<DeviceError>("lucid: of {} fragments in deep pixels {} were captured and {} blended",
                        c.deepNodes, c.deepCaptured, c.deepBlended);
    Status status;
    frontEnd_->addCounters(status.counters);
    status.counters["fragments"] = c.samples;
    status.counters["half_blocks"] = c.triHalfBlocks;
    status.counters["filter_jobs"] = c.lowLists + c.passedJobs;
    status.counters["long_lists"] = c.highLists;
    status.counters["invalid_pixels"] = c.invalidPixels;
    status.counters["repaired_pixels"] = c.repairedPixels;
    status.counters["scratch_bytes"] = 0;
    for (const Buffer* buffer : {&list_, &keys_, &blocks_, &filterJobs_, &binBlocks_, &partLists_})
      status.counters["scratch_bytes"] += buffer->bytes();
    return status;
  }

 private:
  // Passes that a frame needs: those that none has needed so far are not recorded, since each costs
  // a GPU some microseconds that has nothing to do.
  struct Needed {
    bool highBins = false, longLists = false, filter = false, repair = false;
    bool operator==(const Needed&) const = default;
  };

  // Whether the last frame lacked a pass.
  bool findNeeded(const LucidCounters& c) {
    const Needed before = needed_;
    needed_.highBins = needed_.highBins || frontEnd_->counted().highParts > 0;
    needed_.longLists = needed_.longLists || c.highLists > 0;
    needed_.filter = needed_.filter || c.lowLists + c.passedJobs > 0;
    needed_.repair = needed_.repair || c.repairJobs > 0;
    return needed_ != before;
  }

  // llvmpipe ends long loops early and in silence: there the turns are counted.
  bool verifiesLoops() const { return device_->info().isCpu(); }

  // Half-blocks that a workgroup of ordered and low raster works on side by side. They wait for
  // each other, so that a GPU is fastest with 1 (docs/performance.md); a CPU has fewer groups to
  // start.
  const char* lowTeams() const { return device_->info().subgroupSize < 32 ? "4u" : "1u"; }
  const char* orderedTeams() const { return device_->info().subgroupSize < 32 ? "4u" : "2u"; }

  // Whether short lists are first blended without the depth filter: quicker on a GPU, whose
  // subgroups then take less room; on a CPU the pixels that are passed on cost more than is won.
  bool ordersFirst() const {
    const std::string& choice = parameters_.choice("ordered_first");
    return choice == "auto" ? device_->info().subgroupSize >= 32 : choice == "on";
  }

  bool repairs() const {
    return parameters_.flag("repair") && !parameters_.flag("visualize_errors");
  }

  void makePipelines(const std::string& format) {
    const std::uint32_t lanes = device_->info().subgroupSize;
    const Defines common = {
        {"SUBGROUP_SIZE", std::to_string(lanes) + "u"},
        {"TARGET_FORMAT", format},
        {"HAS_OPAQUE", opaque_ ? "1" : "0"},
        {"HAS_TEXTURES", textures_ ? "1" : "0"},
        {"HAS_GRADIENTS", gradients_ ? "1" : "0"},
        {"HAS_ATTRIBUTES", textures_ || colors_ ? "1" : "0"},
        {"HAS_SMOOTH", smooth_ ? "1" : "0"},
        {"HAS_THRESHOLD", parameters_.real("alpha_threshold") > 0.0 ? "1" : "0"},
        {"UNIFORM_CONTROL_FLOW", device_->hasSubgroupUniformControlFlow() ? "1" : "0"},
        {"VERIFY_LOOPS", verifiesLoops() ? "1" : "0"}};
    auto raster = [&](const char* list, const char* teams, std::int64_t filter) {
      Defines defines = common;
      defines["LOW_TEAMS"] = lowTeams();
      defines["ORDERED"] = list == std::string("ORDERED_LIST") ? "1" : "0";
      defines["HIGH"] = list == std::string("HIGH_LIST") ? "1" : "0";
      defines["TEAMS"] = teams;
      defines["LIST"] = list;
      defines["DEPTH_FILTER"] = std::to_string(filter);
      return Pipeline::compute(*device_, "lucid/blend.comp", defines, {}, lanes);
    };
    auto sort = [&](const char* list, const char* teams) {
      return Pipeline::compute(*device_, "lucid/sort_lists.comp",
                               {{"SUBGROUP_SIZE", common.at("SUBGROUP_SIZE")},
                                {"UNIFORM_CONTROL_FLOW", common.at("UNIFORM_CONTROL_FLOW")},
                                {"HIGH", list == std::string("HIGH_LIST") ? "1" : "0"},
                                {"TEAMS", teams},
                                {"LIST", list}},
                               {}, lanes);
    };
    // A workgroup a part of a bin. On a CPU a large one is no faster.
    const char* group = lanes >= 32 ? "256u" : "64u";
    for (std::size_t pass = 0; pass < blocksPasses_.size(); ++pass)
      blocksPasses_[pass] =
          Pipeline::compute(*device_, "lucid/blocks.comp",
                            {{"PASS", std::to_string(pass)},
                             {"LOW_TEAMS", lowTeams()},
                             {"ORDERED_TEAMS", orderedTeams()},
                             {"GROUP", group},
                             {"FIRST_LIST", ordersFirst() ? "ORDERED_LIST" : "0u"}});
    const std::int64_t filter = parameters_.integer("depth_filter");
    if (ordersFirst()) ordered_ = raster("ORDERED_LIST", orderedTeams(), 1);
    lowRaster_ = raster("LOW_LIST", lowTeams(), filter);
    highRaster_ = raster("HIGH_LIST", "1u", filter);
    sortLow_ = sort("LOW_LIST", lowTeams());
    sortHigh_ = sort("HIGH_LIST", "1u");
    repair_ = Pipeline::compute(*device_, "lucid/repair.comp", common, {}, lanes);
    deepCapture_ = Pipeline::compute(*device_, "lucid/deep_capture.comp",
                                     {{"TARGET_FORMAT", format},
                                      {"HAS_OPAQUE", common.at("HAS_OPAQUE")},
                                      {"HAS_TEXTURES", common.at("HAS_TEXTURES")},
                                      {"HAS_GRADIENTS", common.at("HAS_GRADIENTS")},
                                      {"HAS_ATTRIBUTES", common.at("HAS_ATTRIBUTES")},
                                      {"HAS_SMOOTH", common.at("HAS_SMOOTH")}});
    deepResolve_ =
        Pipeline::compute(*device_, "lucid/deep_resolve.comp", {{"TARGET_FORMAT", format}});
  }

  void recordBlocks(const Frame& frame, const raster::RasterPush& front) const {
    const auto compute = Stage::eComputeShader;
    const BlocksPush push{.triangles = front.triangles,
                          .irregular = front.irregular,
                          .shading = front.shading,
                          .bins = front.bins,
                          .entries = front.entries,
                          .parts = front.parts,
                          .rasterCounters = front.counters,
                          .list = list_.address(),
                          .keys = keys_.address(),
                          .blocks = blocks_.address(),
                          .filterJobs = filterJobs_.address(),
                          .binBlocks = binBlocks_.address(),
                          .partLists = partLists_.address(),
                          .counters = counters_.address(),
                          .listCapacity = listCapacity_,
                          .near = frame.camera.near,
                          .size = {frame.target.width(), frame.target.height()}};
    auto run = [&](int pass, std::size_t offset) {
      blocksPasses_[std::size_t(pass)].bind(frame.commands, frame.bindings);
      blocksPasses_[std::size_t(pass)].push(frame.commands, push);
      frame.commands.dispatchIndirect(frontEnd_->counters(), offset);
    };
    if (needed_.highBins) run(1, offsetof(RasterCounters, high));
    run(0, offsetof(RasterCounters, low));
    frame.barrier(compute, compute | Stage::eDrawIndirect);
    if (!needed_.highBins) return;
    run(2, offsetof(RasterCounters, high));
    frame.barrier(compute, compute);
  }

  BlendPush pushOf(const Frame& frame, const raster::RasterPush& front) const {
    std::uint32_t flags = frame.instrumented ? COUNT_SAMPLES : 0u;
    // Without it invalid pixels stay; lists too long to be sorted elsewhere are the repair's even
    // so.
    if (repairs()) flags |= REPAIR;
    if (parameters_.flag("visualize_errors")) flags |= SHOW_ERRORS;
    return {.frame = front.frame,
            .irregular = front.irregular,
            .shading = front.shading,
            .attributes = front.attributes,
            .list = list_.address(),
            .keys = keys_.address(),
            .blocks = blocks_.address(),
            .filterJobs = filterJobs_.address(),
            .repairs = repairs_.address(),
            .counters = counters_.address(),
            .halfBlocks = frontEnd_->bins() * HALF_BLOCKS,
            .size = {frame.target.width(), frame.target.height()},
            .repairCapacity = repairCapacity_,
            .alphaThreshold = float(parameters_.real("alpha_threshold")),
            .flags = flags};
  }

  void recordRepair(const Frame& frame, const raster::RasterPush& front,
                    const BlendPush& lucid) const {
    const auto compute = Stage::eComputeShader;
    RepairPush push{.frame = lucid.frame,
                    .triangles = front.triangles,
                    .irregular = lucid.irregular,
                    .shading = lucid.shading,
                    .attributes = lucid.attributes,
                    .list = lucid.list,
                    .repairs = lucid.repairs,
                    .counters = lucid.counters,
                    .deepPixels = deepCapacity_ > 0 ? deepPixels_.address() : 0,
                    .nodes = deepCapacity_ > 0 ? nodes_.address() : 0,
                    .repairCapacity = repairCapacity_,
                    .deepCapacity = deepCapacity_,
                    .nodeCapacity = nodeCapacity_,
                    .alphaThreshold = lucid.alphaThreshold,
                    .flags = lucid.flags,
                    .round = 0,
                    .rounds = deepRounds_};
    auto run = [&](const Pipeline& pipeline, std::size_t offset) {
      pipeline.bind(frame.commands, frame.bindings);
      pipeline.push(frame.commands, push);
      frame.commands.dispatchIndirect(counters_.vk(), offset);
    };
    frame.barrier(compute, compute | Stage::eDrawIndirect);
    run(repair_, offsetof(LucidCounters, repair));
    if (deepCapacity_ == 0) return;  // no frame has needed it yet
    frame.barrier(compute, compute | Stage::eDrawIndirect);
    run(deepCapture_, offsetof(LucidCounters, deep));
    for (push.round = 0; push.round < push.rounds; ++push.round) {
      frame.barrier(compute, compute);
      run(deepResolve_, offsetof(LucidCounters, deepResolve));
    }
  }

  void makeRoomForParts() {
    partLists_ = Buffer();
    partLists_ = Buffer(*device_, memory_, "lists of parts",
                        std::uint64_t(frontEnd_->partCapacity()) * sizeof(PartLists));
  }

  void makeRoomForLists(std::uint64_t entries) {
    if (entries > ~0u / 2)
      fail<DeviceError>("lucid: {} tri-half-blocks are more than 32 bits can name", entries);
    list_ = Buffer();  // give the old ones back first: both may not fit
    keys_ = Buffer();
    list_ = Buffer(*device_, memory_, "tri-half-blocks", 2 * entries * sizeof(TriHalfBlock));
    keys_ = Buffer(*device_, memory_, "depth keys", entries * sizeof(std::uint32_t));
    listCapacity_ = std::uint32_t(entries);
  }

  void makeRoomForRepairs(std::uint64_t jobs) {
    repairs_ = Buffer();
    repairs_ = Buffer(*device_, memory_, "repair jobs", jobs * sizeof(PixelJob));
    repairCapacity_ = std::uint32_t(jobs);
  }

  void makeRoomForDeep(std::uint64_t pixels, std::uint64_t nodes) {
    if (nodes >= LIST_END)
      fail<DeviceError>("lucid: {} fragments in deep pixels are more than 32 bits can name", nodes);
    deepPixels_ = Buffer();
    nodes_ = Buffer();
    deepPixels_ = Buffer(*device_, memory_, "deep pixels", pixels * sizeof(DeepPixel));
    nodes_ = Buffer(*device_, memory_, "deep fragments", nodes * sizeof(Node));
    deepCapacity_ = std::uint32_t(pixels);
    nodeCapacity_ = std::uint32_t(nodes);
  }

  // Fills what a frame must write before it reads, for a test that it does.
  void poison(const Frame& frame) const {
    constexpr std::uint32_t pattern = 0xcdcdcdcd;
    frontEnd_->poison(frame.commands, pattern);
    for (const Buffer* buffer : {&list_, &keys_, &blocks_, &filterJobs_, &binBlocks_, &partLists_,
                                 &repairs_, &counters_, &deepPixels_, &nodes_})
      if (*buffer) fillBuffer(frame.commands, *buffer, pattern);
    frame.barrier(Stage::eTransfer, Stage::eTransfer | Stage::eComputeShader);
  }

  const Device* device_ = nullptr;
  bool opaque_ = false, textures_ = false, colors_ = false, gradients_ = false, smooth_ = false;
  Parameters parameters_;
  std::unique_ptr<raster::FrontEnd> frontEnd_;
  std::uint32_t listCapacity_ = 0, repairCapacity_ = 0, deepCapacity_ = 0, nodeCapacity_ = 0;
  std::uint32_t deepRounds_ = 1;
  Needed needed_;
  std::array<Pipeline, 3> blocksPasses_;
  Pipeline ordered_, sortLow_, sortHigh_, lowRaster_, highRaster_, repair_, deepCapture_,
      deepResolve_;
  Buffer list_, keys_, blocks_, filterJobs_, binBlocks_, partLists_, repairs_, counters_, readback_,
      deepPixels_, nodes_;
};

const RegisterMethod registered({
    .name = "lucid",
    .summary =
        "exact: software rasterizer in compute shaders, two-stage sort, wrong pixels repaired",
    .source = "Jakubowski 2024, LucidRaster: GPU Software Rasterizer for Exact "
              "Order-Independent Transparency",
    .exact = true,
    .parameters =
        {integer("depth_filter", 3, 1, 16,
                 "fragments that each pixel keeps back to mend their order"),
         flag("repair", true,
              "blend pixels whose order went wrong again in exact order; off: the paper's image"),
         real("alpha_threshold", 0.0, 0.0, 1.0,
              "stop blending a pixel at this coverage; 0: never; the paper: 0.9921875"),
         choice("ordered_first", {"auto", "on", "off"},
                "blend short lists without the depth filter first, and only pixels out of order "
                "with it; auto: on GPUs. Does not show in the image"),
         flag("visualize_errors", false, "paint pixels whose order went wrong red"),
         flag("backface_culling", false,
              "drop quads that face away, which no other method does: for the scene table"),
         flag("poison", false, "fill all buffers with rubbish before each frame: a test")},
    .features = {"subgroupSizeControl", "computeFullSubgroups", "subgroupOperations"},
    .make = [] { return std::make_unique<Lucid>(); },
});

}  // namespace oitlab::lucid
