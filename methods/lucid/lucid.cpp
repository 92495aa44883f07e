// LucidRaster (Jakubowski 2024): a software rasterizer in compute shaders with exact OIT. The
// harness makes the lists of tri-half-blocks (raster/block_lists.h); here they are sorted, and
// become fragments and a blended image. Where the paper's two-stage sort goes wrong, the pixel is
// blended again in exact order.
//
//   programs  the shaders, for one device and scene
//   buffers   what lies between their steps
#include "lucid/lucid_types.h"

#include "lucid/buffers.h"
#include "lucid/programs.h"
#include "method/method.h"
#include "raster/block_lists.h"
#include "raster/raster_defines.h"
#include "util/error.h"
#include "util/rounding.h"

namespace oitlab::lucid {
namespace {

using Stage = vk::PipelineStageFlagBits2;

/// Dispatches a program of as many workgroups as `offset` in `counters` says.
template <typename Push>
void dispatchCounted(const Frame& frame, const Pipeline& pipeline, const Push& push,
                     vk::Buffer counters, std::size_t offset) {
  frame.bind(pipeline, push);
  frame.commands.dispatchIndirect(counters, offset);
}

}  // namespace

class Lucid : public Method {
 public:
  explicit Lucid(const MethodContext& context)
      : device_(context.device),
        scene_(context.scene),
        targetFormat_(formatName(context.target.format())),
        parameters_(context.parameters),
        lists_(device_, scene_, context.target, context.memory, listOptions()),
        buffers_(device_, context.memory),
        programs_(makePrograms(false)) {}

  bool usesComputeRasterizer() const override { return true; }

  void record(const Frame& frame) override {
    if (parameters_.flag("poison")) poison(frame);
    lists_.record(frame);
    const auto compute = Stage::eComputeShader;
    const BlendPush push = pushOf(frame);
    auto run = [&](const Pipeline& pipeline, std::size_t offset) {
      dispatchCounted(frame, pipeline, push, lists_.counters().vk(), offset);
    };
    // The programs of one step need no barrier between them: they work on different half-blocks.
    // Long lists come first, since the frame waits for the last job to end.
    const auto high = offsetof(LucidCounters, lists.longGroups);
    const auto low = offsetof(LucidCounters, lists.mediumGroups);
    frame.stage("sort", [&] {
      if (needed_.longLists) run(*programs_.sortHigh, high);
      if (needed_.filter) run(*programs_.sortLow, low);
    });
    frame.stage("low_raster", [&] {
      if (programs_.ordersFirst)
        run(*programs_.ordered, offsetof(LucidCounters, lists.shortGroups));
      if (needed_.filter || needed_.longLists)
        frame.barrier(compute, compute | Stage::eDrawIndirect);
      if (needed_.filter) run(*programs_.lowRaster, low);
    });
    frame.stage("high_raster", [&] {
      if (needed_.longLists) run(*programs_.highRaster, high);
    });
    frame.stage("repair", [&] {
      if (needed_.repair) recordRepair(frame, push);
    });
    lists_.readBack(frame);
  }

  Status status() override {
    const LucidCounters& c = lists_.counters().read<LucidCounters>();
    bool again = findNeeded(c);
    if (lists_.grow()) {
      if (lists_.frontEnd().hasUnsnapped() && !programs_.unsnapped) programs_ = makePrograms(true);
      return {.recordAgain = true};
    }
    if (c.repairJobs > buffers_.repairCapacity) {
      buffers_.makeRoomForRepairs(withSlack(c.repairJobs));
      again = true;
    }
    if (c.deepPixels > buffers_.deepCapacity || c.deepNodes > buffers_.nodeCapacity) {
      buffers_.makeRoomForDeep(withSlack(c.deepPixels), withSlack(c.deepNodes));
      again = true;
    } else if (c.unfinished > 0) {
      deepRounds_ *= 2;
      again = true;
    }
    if (again) return {.recordAgain = true};
    const std::uint32_t toBlend = c.lists.triHalfBlocks + c.passedOn;
    const bool blended = !raster::verifiesLoops(device_) || c.blended == toBlend;
    if (c.walked != c.expected || !blended)
      fail<DeviceError>(
          "lucid: {} of {} list entries and {} of {} tri-half-blocks were gone through: {} ends "
          "long loops early (too many triangles in a bin)",
          c.walked, c.expected, c.blended, toBlend, device_.info().name);
    if (c.repairedPixels != c.pixelsToRepair)
      fail<DeviceError>("lucid: of {} pixels {} were repaired: {} ends long loops early",
                        c.pixelsToRepair, c.repairedPixels, device_.info().name);
    if (c.deepCaptured != c.deepNodes || c.deepBlended != c.deepNodes)
      fail<DeviceError>("lucid: of {} fragments in deep pixels {} were captured and {} blended",
                        c.deepNodes, c.deepCaptured, c.deepBlended);
    Status status;
    lists_.frontEnd().addCounters(status.counters);
    status.counters["fragments"] = c.samples;
    status.counters["half_blocks"] = c.lists.triHalfBlocks;
    // filter_jobs, invalid_pixels and repaired_pixels vary between equal frames, with the order in
    // which invocations take places in lists (docs/lucid.md).
    status.counters["filter_jobs"] = c.lists.mediumLists + c.passedJobs;
    status.counters["long_lists"] = c.lists.longLists;
    status.counters["invalid_pixels"] = c.invalidPixels;
    status.counters["repaired_pixels"] = c.repairedPixels;
    status.counters["scratch_bytes"] = lists_.scratchBytes();
    return status;
  }

 private:
  Programs makePrograms(bool hasUnsnapped) const {
    return {device_, scene_, hasUnsnapped, targetFormat_, parameters_};
  }

  raster::BlockLists::Options listOptions() const {
    const Teams teams(device_);
    return {.backFaceCulling = parameters_.flag("backface_culling"),
            .longestShort = parameters_.flag("ordered_first") ? SHORT_LIST : 0u,
            .key = KEY_DEPTH,
            .shortTeams = teams.ordered,
            .mediumTeams = teams.low,
            .counterBytes = sizeof(LucidCounters)};
  }

  // Passes that a frame needs: those that none has needed so far are not recorded, since each costs
  // a GPU some microseconds that has nothing to do.
  struct Needed {
    bool longLists = false, filter = false, repair = false;
    bool operator==(const Needed&) const = default;
  };

  // Whether the last frame lacked a pass.
  bool findNeeded(const LucidCounters& c) {
    const Needed before = needed_;
    needed_.longLists = needed_.longLists || c.lists.longLists > 0;
    needed_.filter = needed_.filter || c.lists.mediumLists + c.passedJobs > 0;
    needed_.repair = needed_.repair || c.repairJobs > 0;
    return needed_ != before;
  }

  bool repairs() const {
    return parameters_.flag("repair") && !parameters_.flag("visualize_errors");
  }

  BlendPush pushOf(const Frame& frame) const {
    std::uint32_t flags = frame.instrumented ? COUNT_SAMPLES : 0u;
    // Without it invalid pixels stay; lists too long to be sorted elsewhere are the repair's even
    // so.
    if (repairs()) flags |= REPAIR;
    if (parameters_.flag("visualize_errors")) flags |= SHOW_ERRORS;
    return {.mesh = lists_.mesh(frame),
            .frame = frame.constants,
            .list = lists_.list().address(),
            .keys = lists_.keys().address(),
            .blocks = lists_.blocks().address(),
            .medium = lists_.medium().address(),
            .repairs = buffers_.repairs.address(),
            .counters = lists_.counters().address(),
            .halfBlocks = lists_.halfBlocks(),
            .size = {frame.target.width(), frame.target.height()},
            .repairCapacity = buffers_.repairCapacity,
            .alphaThreshold = float(parameters_.real("alpha_threshold")),
            .flags = flags};
  }

  void recordRepair(const Frame& frame, const BlendPush& lucid) const {
    const auto compute = Stage::eComputeShader;
    RepairPush push{.mesh = lucid.mesh,
                    .frame = lucid.frame,
                    .list = lucid.list,
                    .repairs = lucid.repairs,
                    .counters = lucid.counters,
                    .deepPixels = buffers_.deepCapacity > 0 ? buffers_.deepPixels.address() : 0,
                    .nodes = buffers_.deepCapacity > 0 ? buffers_.nodes.address() : 0,
                    .repairCapacity = buffers_.repairCapacity,
                    .deepCapacity = buffers_.deepCapacity,
                    .nodeCapacity = buffers_.nodeCapacity,
                    .alphaThreshold = lucid.alphaThreshold,
                    .flags = lucid.flags,
                    .round = 0,
                    .rounds = deepRounds_};
    auto run = [&](const Pipeline& pipeline, std::size_t offset) {
      dispatchCounted(frame, pipeline, push, lists_.counters().vk(), offset);
    };
    frame.barrier(compute, compute | Stage::eDrawIndirect);
    run(*programs_.repair, offsetof(LucidCounters, repair));
    if (buffers_.deepCapacity == 0) return;  // no frame has needed it yet
    frame.barrier(compute, compute | Stage::eDrawIndirect);
    run(*programs_.deepCapture, offsetof(LucidCounters, deep));
    for (push.round = 0; push.round < push.rounds; ++push.round) {
      frame.barrier(compute, compute);
      run(*programs_.deepResolve, offsetof(LucidCounters, deepResolve));
    }
  }

  void poison(const Frame& frame) const {
    constexpr std::uint32_t pattern = 0xcdcdcdcd;
    lists_.poison(frame.commands, pattern);
    buffers_.poison(frame.commands, pattern);
    frame.barrier(Stage::eTransfer, Stage::eTransfer | Stage::eComputeShader);
  }

  const Device& device_;
  const GpuScene& scene_;
  std::string targetFormat_;  // as shaders name it
  Parameters parameters_;
  raster::BlockLists lists_;
  Buffers buffers_;
  Programs programs_;
  Needed needed_;
  std::uint32_t deepRounds_ = 1;
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
         flag("ordered_first", true,
              "blend short lists with a depth filter of 1 first, and only pixels out of order with "
              "the whole; off: all with the whole, as the paper. Does not show in the image"),
         flag("visualize_errors", false, "paint pixels whose order went wrong red"),
         flag("backface_culling", false,
              "drop quads that face away, which no other method does: for the scene table"),
         flag("poison", false, "fill all buffers with rubbish before each frame: a test")},
    .features = {"subgroupSizeControl", "computeFullSubgroups", "subgroupOperations"},
    .make = makeMethod<Lucid>,
});

}  // namespace oitlab::lucid
