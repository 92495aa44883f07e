// Depth peeling: one geometry pass per layer, from the front (Everitt 2001) or from both ends
// (Bavoil and Myers 2008). shaders/depth_peeling/peel.frag says what a pass does.
//
// The number of passes: a frame has as many as the frame before it needed. Each is an indirect draw
// that the pass before it enables. A frame that needs more is recorded again, which a measurement
// does not count. Thus the CPU never waits for a query between passes, and with a fixed camera a
// frame has exactly the passes that it needs. When a moving camera needs fewer, the remaining
// passes are empty draws.
#include "depth_peeling/peel_types.h"

#include "gpu/counters_buffer.h"
#include "method/make_source.h"
#include "util/error.h"
#include "util/rounding.h"

namespace oitlab::depth_peeling {

using Stage = vk::PipelineStageFlagBits2;

class DepthPeeling : public Method {
 public:
  explicit DepthPeeling(const MethodContext& context)
      : device_(context.device),
        memory_(context.memory),
        triangles_(context.scene.transparentCount()),
        layers_(std::uint32_t(context.parameters.integer("layers"))),
        dual_(context.parameters.choice("mode") == "dual"),
        list_(dual_ && context.parameters.choice("back") == "list"),
        wide_(wantsWideAtomics(context.parameters.choice("atomics"))),
        source_(makeSource(context)),
        counters_(device_, memory_, "counters", sizeof(PeelCounters)) {
    makePipelines(formatName(context.target.format()));
    const std::uint64_t pixels = context.target.pixels();
    for (Buffer& keys : keys_)
      keys = Buffer(device_, memory_, "keys", pixels * sizeof(Key) * (dual_ ? 2 : 1));
    front_ = Buffer(device_, memory_, "front colour", pixels * sizeof(glm::vec4));
    if (dual_ && !list_)
      back_ = Buffer(device_, memory_, "back colour", pixels * sizeof(glm::vec4));
    if (list_) {
      heads_ = Buffer(device_, memory_, "back list heads", pixels * sizeof(std::uint32_t));
      allocateList(2 * pixels);
    }
    recorded_ = std::min(firstPasses, neededAtMost());
    allocateDraws();
  }

  bool usesComputeRasterizer() const override { return source_->usesComputeRasterizer(); }

  void record(const Frame& frame) override {
    const vk::DeviceSize drawBytes = (recorded_ + 1) * sizeof(PassDraw);
    PeelPush push{.frame = source_->begin(frame),
                  .front = front_.address(),
                  .back = back_.address(),
                  .heads = heads_.address(),
                  .listed = listed_.address(),
                  .draws = draws_.address(),
                  .counters = counters_.address(),
                  .capacity = capacity_};
    frame.stage("clear", [&] {
      fillBuffer(frame.commands, keys_[0], ~0u);  // in front of all fragments
      fillBuffer(frame.commands, keys_[1], 0);
      fillBuffer(frame.commands, front_, 0);
      if (back_) fillBuffer(frame.commands, back_, 0);
      if (heads_) fillBuffer(frame.commands, heads_, LIST_END);
      fillBuffer(frame.commands, counters_.buffer(), 0);
      frame.commands.copyBuffer(drawTemplate_.vk(), draws_.vk(), vk::BufferCopy(0, 0, drawBytes));
    });
    frame.stage("peel", [&] {
      for (push.pass = 0; push.pass < recorded_; ++push.pass) recordPass(frame, push);
      frame.barrier(source_->stages(), Stage::eComputeShader);
    });
    frame.stage("resolve", [&] {
      frame.bind(resolve_, push);
      frame.dispatchPixels();
      recordReadback(frame.commands, {&counters_, &draws_},
                     Stage::eFragmentShader | Stage::eComputeShader);
    });
    source_->end(frame);
    instrumented_ = frame.instrumented;
  }

  Status status() override {
    if (source_->grow()) return {.recordAgain = true};
    const PeelCounters counters = counters_.read<PeelCounters>();
    const auto draws = draws_.readAll<PassDraw>();
    std::uint32_t asked = 0;  // passes that were enabled, each by the one before it
    while (asked <= recorded_ && draws[asked].instanceCount > 0) ++asked;
    if (asked > recorded_) {
      if (recorded_ == maxPasses)
        fail<DeviceError>(
            "depth_peeling: some pixel needs more than {} passes; take fewer layers, or a method "
            "that sorts",
            maxPasses);
      recorded_ = std::min({4 * recorded_, neededAtMost(), maxPasses});
      allocateDraws();
      return {.recordAgain = true};
    }
    if (list_ && counters.back > capacity_) {
      allocateList(withSlack(counters.back));
      return {.recordAgain = true};
    }
    if (counters.broken > 0)
      fail<DeviceError>("depth_peeling: the lists of {} pixels do not end as lists do",
                        counters.broken);
    recorded_ = asked;  // for the next frame, which may need more

    const std::uint32_t blending = asked - 1;
    counted_["layers"] = blending + counters.lastBackPass;
    counted_["passes"] = wide_ ? asked : asked + blending;
    if (instrumented_) {
      // A lost fragment is an error, even if the reason is a device whose depths differ between
      // passes.
      if (counters.blended + counters.missed != counters.fragments)
        fail<DeviceError>(
            "depth_peeling: of {} fragments {} were blended and {} left over: {} does not give a "
            "fragment the same depth in every pass",
            counters.fragments, counters.blended, counters.missed, device_.info().name);
      counted_["fragments"] = counters.fragments;
      counted_["missed_fragments"] = counters.missed;
    }
    Status status;
    source_->addCounters(status.counters);
    for (const auto& [name, value] : counted_) status.counters[name] = value;
    return status;
  }

 private:
  /// resolve.comp has one loop iteration per pass, and llvmpipe ends loops at 65,535 iterations.
  static constexpr std::uint32_t maxPasses = 1u << 15;
  /// The passes of the first frame. Each new recording has four times as many, so that maxPasses is
  /// reached, with one recording to spare for the list, within 8 recordings.
  static constexpr std::uint32_t firstPasses = 16;

  void makePipelines(const std::string& targetFormat) {
    Defines defines;
    if (dual_) defines["DUAL"] = "1";
    if (list_) defines["BACK_LIST"] = "1";
    if (dual_ && !list_) defines["BACK_BLEND"] = "1";
    if (wide_) defines["WIDE_ATOMICS"] = "1";
    const auto geometry = [&](const Defines& with) {
      return source_->make({.file = "depth_peeling/peel.glsl",
                            .access = Access::none,
                            .defines = with,
                            .isConditional = true});
    };
    peel_ = geometry(defines);
    Defines resolve = defines;
    resolve["TARGET_FORMAT"] = targetFormat;
    resolve_ = Pipeline::compute(device_, "depth_peeling/resolve.comp", resolve);
    if (wide_) return;
    defines["STEP_TIES"] = "1";
    ties_ = geometry(defines);
  }

  bool wantsWideAtomics(const std::string& choice) const {
    const bool has = device_.info().has("shaderBufferInt64Atomics");
    if (choice == "int64" && !has)
      fail<DeviceError>("depth_peeling: {} lacks shaderBufferInt64Atomics; use atomics=int32",
                        device_.info().name);
    return has && choice != "int32";
  }

  /// The passes for a limited number of layers. The first pass only finds a layer.
  std::uint32_t neededAtMost() const {
    if (layers_ == 0) return std::numeric_limits<std::uint32_t>::max();
    return 1 + (dual_ ? (layers_ + 1) / 2 : layers_);
  }

  void recordPass(const Frame& frame, PeelPush& push) const {
    const bool last =
        push.pass + 1 == neededAtMost();  // the last that is needed, not the last that is recorded
    push.does = last ? 0 : PASS_FINDS;
    if (dual_ && !(last && layers_ % 2 == 1)) push.does |= PASS_HAS_BACK;
    if (frame.instrumented) push.does |= PASS_COUNTS | (push.pass == 0 ? PASS_COUNTS_ALL : 0);
    push.peeled = keys_[push.pass % 3].address();
    push.next = keys_[(push.pass + 1) % 3].address();
    const auto stages = source_->stages();
    frame.barrier(stages | Stage::eTransfer, stages | Stage::eTransfer | Stage::eDrawIndirect);
    // Clears the buffer of the pass after this one while this one draws: a third buffer saves a
    // wait.
    fillBuffer(frame.commands, keys_[(push.pass + 2) % 3], 0);
    draw(frame, peel_, push, push.pass);
    if (wide_ || last) return;
    frame.barrier(stages, stages | Stage::eDrawIndirect);
    draw(frame, ties_, push, push.pass + 1);
  }

  /// Goes through all transparent fragments, if pass `asked` is enabled.
  void draw(const Frame& frame, FragmentPass pass, PeelPush push, std::uint32_t asked) const {
    push.asked = asked;
    source_->run(frame, "", pass, push,
                 {.draw = draws_.vk(), .drawOffset = asked * sizeof(PassDraw)});
  }

  /// One command per recorded pass, and one for the pass that the last one may enable.
  void allocateDraws() {
    const std::uint64_t bytes = (recorded_ + 1) * sizeof(PassDraw);
    draws_ = CountersBuffer(device_, memory_, "pass draws", bytes);
    std::vector<PassDraw> commands(recorded_ + 1, {.indexCount = 3 * triangles_});
    commands.front().instanceCount = 1;
    drawTemplate_ = uploadBuffer(device_, memory_, "pass draws template", commands);
  }

  void allocateList(std::uint64_t nodes) {
    if (nodes >= LIST_END)
      fail<DeviceError>(
          "depth_peeling: {} fragments are more than the 2^32 - 1 that its lists can name", nodes);
    listed_ = Buffer();  // free the old one first: there may not be room for both
    listed_ = Buffer(device_, memory_, "back list", nodes * sizeof(BackFragment));
    capacity_ = std::uint32_t(nodes);
  }

  const Device& device_;
  MemoryLedger& memory_;
  std::uint32_t triangles_;
  std::uint32_t layers_;  // 0: all
  bool dual_, list_, wide_;
  bool instrumented_ = false;
  std::uint32_t recorded_ = 0;  // passes
  std::uint32_t capacity_ = 0;  // nodes of the back list
  std::unique_ptr<FragmentSource> source_;
  FragmentPass peel_, ties_;
  Pipeline resolve_;
  std::array<Buffer, 3> keys_;  // in rotation: blended, found, cleared
  Buffer front_, back_, heads_, listed_, drawTemplate_;
  CountersBuffer counters_, draws_;
  std::map<std::string, std::uint64_t> counted_;
};

const RegisterMethod registered({
    .name = "depth_peeling",
    .summary = "one geometry pass a layer, from the front or from both ends; exact with all layers",
    .source = "Everitt 2001, Interactive Order-Independent Transparency; Bavoil and Myers 2008, "
              "Order Independent Transparency with Dual Depth Peeling",
    .exact = true,
    .parameters =
        {integer("layers", 0, 0, 1024, "blended of each pixel, at most; 0: all", "layers"),
         choice("mode", {"front_to_back", "dual"},
                "front_to_back: a layer a pass; dual: one from each end"),
         choice("back", {"list", "blend"},
                "dual: fragments from the back are listed, and blended last, in the exact order; "
                "or blended at once as published, which rounds otherwise"),
         choice("atomics", {"auto", "int64", "int32"},
                "on keys of depth and primitive id; int32 takes a second pass a layer for the id")},
    .takesFragments = true,
    .make = makeMethod<DepthPeeling>,
});

}  // namespace oitlab::depth_peeling
