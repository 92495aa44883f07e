#include "source/compute_source.h"

#include "raster/raster_defines.h"
#include "source/program_contract.h"
#include "source/program_defines.h"
#include "source/state_size.h"
#include "util/error.h"

namespace oitlab {
namespace {

using Stage = vk::PipelineStageFlagBits2;

std::string text(std::uint32_t number) {
  return std::to_string(number) + "u";
}

/// Half-blocks that a workgroup works on side by side. They wait for each other; a CPU has fewer
/// workgroups to start.
std::uint32_t teamsOf(const Device& device) {
  return device.info().subgroupSize >= 32 ? 2 : 4;
}

raster::BlockLists::Options listOptions(const Device& device, int deliver) {
  const bool byDepth = deliver == DELIVER_NEAR_TO_FAR || deliver == DELIVER_FAR_TO_NEAR;
  return {.longestShort = SHORT_LIST,
          .key = deliver == DELIVER_ANY ? KEY_NONE
                 : byDepth              ? KEY_DEPTH
                                        : KEY_ID,
          .shortTeams = teamsOf(device),
          .mediumTeams = 1,
          .counterBytes = sizeof(SourceCounters),
          .countAll = true};
}

void checkFeatures(const Device& device) {
  for (const char* feature : {"subgroupSizeControl", "computeFullSubgroups", "subgroupOperations"})
    if (!device.info().has(feature))
      fail<DeviceError>(
          "source=compute needs {}, which {} lacks: half-blocks are shared out to subgroups of "
          "a known size; take source=hardware",
          feature, device.info().name);
}

}  // namespace

ComputeSource::ComputeSource(const Device& device, const GpuScene& scene, const Target& target,
                             MemoryLedger& memory, const Options& options)
    : device_((checkFeatures(device), device)),
      target_(target),
      memory_(memory),
      options_(options),
      sceneDefines_(raster::sceneDefines(scene, false)),
      lists_(device, scene, target, memory, listOptions(device, options.deliver)),
      constants_(device, memory, "source constants", sizeof(SourceConstants), BufferKind::upload) {
  const auto& submitted = scene.submission();
  if (options.deliver == DELIVER_SUBMISSION &&
      !std::is_sorted(submitted.begin(), submitted.end())) {
    std::vector<std::uint32_t> sequence(scene.scene().triangles.size());
    for (std::uint32_t i = 0; i < submitted.size(); ++i) sequence[submitted[i]] = i;
    sequence_ = uploadBuffer(device, memory, "order of submission", sequence);
  }
  if (isOrdered()) makeOrderPrograms();
}

void ComputeSource::makeOrderPrograms() {
  const std::uint32_t lanes = device_.info().subgroupSize;
  const Defines common =
      raster::with(raster::teamDefines(device_),
                   {{"DELIVER", std::to_string(options_.deliver)},
                    {"HAS_UNSNAPPED", lists_.frontEnd().hasUnsnapped() ? "1" : "0"}});
  auto order = [&](const char* kind, const char* list, std::uint32_t teams) {
    const Defines defines =
        raster::with(common, {{"KIND", kind}, {"LIST", list}, {"ORDER_TEAMS", text(teams)}});
    return LazyPipeline([&device = device_, defines, lanes] {
      return Pipeline::compute(device, "source/order.comp", defines, {}, lanes);
    });
  };
  if (ORDERED_IN_PASSING(lanes) < SHORT_LIST)
    orderShort_ = order("0", "SHORT_LIST", teamsOf(device_));
  orderMedium_ = order("1", "MEDIUM_LIST", 1);
  orderLong_ = order("2", "SORTED_RUN", 1);
  merge_ = LazyPipeline([&device = device_, common] {
    return Pipeline::compute(device, "source/order_merge.comp",
                             raster::only(common, {"DELIVER", "HAS_UNSNAPPED"}));
  });
}

Pipeline ComputeSource::makePipeline(const FragmentProgram& program) const {
  Defines defines = raster::with(programDefines(program), raster::teamDefines(device_));
  defines = raster::with(defines, sceneDefines_);
  const TargetFormat format = target_.format();
  const char* bits = format == TargetFormat::rgba8     ? "8"
                     : format == TargetFormat::rgba16f ? "16"
                                                       : "32";
  defines = raster::with(defines, {{"TARGET_FORMAT", formatName(format)},
                                   {"TARGET_BITS", bits},
                                   {"DELIVER", std::to_string(options_.deliver)},
                                   {"TEAMS", text(teamsOf(device_))},
                                   {"VERIFY_LOOPS", raster::verifiesLoops(device_) ? "1" : "0"}});
  if (program.access == Access::exclusive)
    stateBytes(device_, program, "source/compute.comp", defines);  // throws where it is too large
  return makeProgram(program, [&] {
    return Pipeline::compute(device_, "source/compute.comp", defines, {},
                             device_.info().subgroupSize, program.file + " with source=compute");
  });
}

void ComputeSource::makeAllPrograms() {
  for (const LazyPipeline* program : {&orderShort_, &orderMedium_, &orderLong_, &merge_})
    if (*program) **program;
}

FragmentPass ComputeSource::make(const FragmentProgram& program) {
  passes_.push_back({program, makePipeline(program)});
  return {passes_.size() - 1};
}

std::uint64_t ComputeSource::begin(const Frame& frame, const Submission& submission) {
  if (options_.poison) {
    constexpr std::uint32_t pattern = 0xcdcdcdcd;
    lists_.poison(frame.commands, pattern);
    for (const Buffer& runs : runs_)
      if (runs) fillBuffer(frame.commands, runs, pattern);
    frame.barrier(Stage::eTransfer, Stage::eTransfer | Stage::eComputeShader);
  }
  runsDone_ = 0;
  lists_.record(frame);
  const Buffer* sequence = submission.sequence != nullptr ? submission.sequence : &sequence_;
  const OrderRule rule{
      .sequence = sequence->address(), .seed = options_.seed, .longest = longestOrdered()};
  if (isOrdered() && (orderShort_ || mediumSeen_ || longSeen_))
    frame.stage("order", [&] { recordOrder(frame, rule); });
  constants_.mapped<SourceConstants>()[0] = {.frame = frame.values,
                                             .mesh = lists_.mesh(frame),
                                             .list = lists_.list().address(),
                                             .order = lists_.keys().address(),
                                             .blocks = lists_.blocks().address(),
                                             .medium = lists_.medium().address(),
                                             .counters = lists_.counters().address(),
                                             .rule = rule,
                                             .halfBlocks = lists_.halfBlocks(),
                                             .counting = frame.instrumented};
  return constants_.address();
}

std::uint32_t ComputeSource::longestOrdered() const {
  if (longSeen_) return ~0u;
  const std::uint32_t before = mediumSeen_ ? MEDIUM_LIST : SHORT_LIST;
  return std::max(before, ORDERED_IN_PASSING(device_.info().subgroupSize));
}

void ComputeSource::recordOrder(const Frame& frame, const OrderRule& rule) {
  OrderPush push{.mesh = lists_.mesh(frame),
                 .list = lists_.list().address(),
                 .keys = lists_.keys().address(),
                 .blocks = lists_.blocks().address(),
                 .medium = lists_.medium().address(),
                 .counters = lists_.counters().address(),
                 .rule = rule,
                 .from = runs_[0].address(),
                 .to = runs_[1].address(),
                 .halfBlocks = lists_.halfBlocks(),
                 .run = merges_ > 0 ? SORTED_RUN : 0u,
                 .last = 0};
  const vk::Buffer counters = lists_.counters().vk();
  auto run = [&](const LazyPipeline& program, std::size_t offset) {
    frame.bind(*program, push);
    frame.commands.dispatchIndirect(counters, offset);
  };
  // They need no barrier between them: they work on different lists.
  if (longSeen_) run(orderLong_, offsetof(SourceCounters, lists.runGroups));
  if (mediumSeen_) run(orderMedium_, offsetof(SourceCounters, lists.mediumGroups));
  if (orderShort_) run(orderShort_, offsetof(SourceCounters, lists.shortGroups));
  if (longSeen_ && merges_ > 0) mergeLongLists(frame, push);
  frame.barrier(Stage::eComputeShader, Stage::eComputeShader);
}

void ComputeSource::mergeLongLists(const Frame& frame, OrderPush push) {
  for (std::uint32_t i = 0; i < merges_; ++i) {
    frame.barrier(Stage::eComputeShader, Stage::eComputeShader);
    push.last = i + 1 == merges_;
    frame.bind(*merge_, push);
    frame.commands.dispatchIndirect(lists_.counters().vk(),
                                    offsetof(SourceCounters, lists.mergeGroups));
    std::swap(push.from, push.to);
    push.run *= 2;
  }
}

void ComputeSource::runBytes(const Frame& frame, const std::string& stage, FragmentPass number,
                             std::span<const std::byte> push, const FragmentRun&) {
  const auto record = [&] {
    passes_.at(number.number).pipeline.bind(frame.commands, frame.bindings, push);
    frame.commands.dispatchIndirect(lists_.counters().vk(),
                                    offsetof(SourceCounters, lists.allGroups));
  };
  if (stage.empty())
    record();
  else
    frame.stage(stage, record);
  ++runsDone_;
}

void ComputeSource::end(const Frame& frame) {
  lists_.readBack(frame);
}

bool ComputeSource::grow() {
  const SourceCounters& c = lists_.counters().read<SourceCounters>();
  const bool hadUnsnapped = lists_.frontEnd().hasUnsnapped();
  bool lacked = lists_.grow();
  if (!hadUnsnapped && lists_.frontEnd().hasUnsnapped()) {
    sceneDefines_ = raster::with(sceneDefines_, {{"HAS_UNSNAPPED", "1"}});
    for (Pass& pass : passes_) pass.pipeline = makePipeline(pass.program);
    if (isOrdered()) makeOrderPrograms();
  }
  if (isOrdered()) {
    if (c.lists.mediumLists > 0 && !mediumSeen_) mediumSeen_ = lacked = true;
    if (c.lists.longLists > 0 && !longSeen_) longSeen_ = lacked = true;
    if (makeRoomForLongLists(c.lists.longest)) lacked = true;
  }
  return lacked;
}

bool ComputeSource::makeRoomForLongLists(std::uint32_t longest) {
  std::uint32_t merges = 0;
  while ((std::uint64_t(SORTED_RUN) << merges) < longest) ++merges;
  merges = std::max(merges, merges_);
  const std::uint64_t bytes = merges > 0 ? lists_.list().bytes() : 0;
  if (merges == merges_ && bytes <= runs_[0].bytes()) return false;
  merges_ = merges;
  for (Buffer& runs : runs_) {
    runs = Buffer();
    runs = Buffer(device_, memory_, "runs of long lists", bytes);
  }
  return true;
}

void ComputeSource::addCounters(std::map<std::string, std::uint64_t>& counters) {
  const SourceCounters& c = lists_.counters().read<SourceCounters>();
  const std::uint64_t expected = std::uint64_t(c.lists.triHalfBlocks) * runsDone_;
  if (raster::verifiesLoops(device_) && c.delivered != std::uint32_t(expected) &&
      std::none_of(passes_.begin(), passes_.end(),
                   [](const Pass& pass) { return pass.program.isConditional; }))
    fail<DeviceError>(
        "source=compute: {} of {} tri-half-blocks were gone through: {} ends long loops early (too "
        "many triangles in a half-block)",
        c.delivered, expected, device_.info().name);
  lists_.frontEnd().addCounters(counters);
  counters["half_blocks"] = c.lists.triHalfBlocks;
  counters["longest_list"] = c.lists.longest;
  counters["fragments"] = c.fragments;
}

}  // namespace oitlab
