// Whether every barrier of every method is needed, and noticed when it is missing. The layer
// `reorder` (layer/reorder.cpp) runs a frame's commands in another order that the barriers allow:
// with all of them the image stays the same, without some of them it changes. Synchronization
// validation sees less: it does not know what shaders reach through addresses.
#include <dlfcn.h>
#include <unistd.h>

#include <gmock/gmock.h>

#include "faults/layer/reorder.h"
#include "support/gpu.h"
#include "support/planted.h"
#include "util/error.h"
#include "util/paths.h"

namespace oitlab::testing {
namespace {

namespace fs = std::filesystem;

/// Beside the program, where the build puts them.
fs::path layers() {
  return fs::read_symlink("/proc/self/exe").parent_path() / "layers";
}

/// A device with the layer `reorder` in front of all others.
class ReorderedDevice {
 public:
  explicit ReorderedDevice(bool validation) {
    ::setenv("VK_ADD_LAYER_PATH", layers().c_str(), 1);
    ::setenv("VK_INSTANCE_LAYERS", "VK_LAYER_OITLAB_reorder", 1);
    device_ = std::make_unique<Device>(Device::Options{.validation = validation});
    ::unsetenv("VK_INSTANCE_LAYERS");
    ::unsetenv("VK_ADD_LAYER_PATH");
    void* library = ::dlopen((layers() / "liboitlab_layer_reorder.so").c_str(), RTLD_NOW);
    if (library == nullptr) throw std::runtime_error(::dlerror());
    using Find = layer::Reorder* (*)();
    control_ = reinterpret_cast<Find>(::dlsym(library, "oitlabReorder"))();
    *control_ = {};
  }
  ~ReorderedDevice() { *control_ = {}; }

  const Device& device() const { return *device_; }
  layer::Reorder& control() const { return *control_; }

 private:
  std::unique_ptr<Device> device_;
  layer::Reorder* control_ = nullptr;
};

using Set = std::map<std::string, std::string>;

/// A method with parameters that lead it along other barriers than its defaults, and how many
/// triangles it gets: a pass for each layer takes few of them, sorts of long lists take many.
struct Variant {
  std::string method;
  Set parameters = {};

  int triangles() const { return method == "depth_peeling" ? 24 : 160; }
  /// Of the image, in pixels: several bins of the compute rasterizer.
  std::uint32_t width() const {
    return method == "lucid" || findMethod(method).computeFirst ? 96 : 32;
  }
  std::string text() const {
    std::string text = method;
    for (const auto& [name, value] : parameters) text += fmt::format(" {}={}", name, value);
    return text;
  }
};

std::vector<Variant> allVariants() {
  std::vector<Variant> all;
  for (const auto& [name, info] : methods()) all.push_back({name});
  all.insert(all.end(), {{"abuffer", {{"mask", "lists"}}},
                         {"abuffer", {{"mask", "stencil_increment"}}},
                         {"abuffer", {{"sort_memory", "max"}}},
                         {"abuffer", {{"max_fragments", "8"}}},
                         {"blend", {{"order", "sorted"}}},
                         {"depth_peeling", {{"mode", "dual"}}},
                         {"depth_peeling", {{"mode", "dual"}, {"back", "blend"}}},
                         {"depth_peeling", {{"atomics", "int32"}}},
                         {"lucid", {{"depth_filter", "1"}}}});
  return all;
}

/// Barriers without which the order is another and the image is not, with the reason. Every one
/// that is not in this list has to be noticed.
struct Harmless {
  std::string variant;   ///< what its text() begins with
  std::string from, to;  ///< parts of the stages' names
  /// Only some barriers of these stages; one at least is noticed in each variant.
  bool onlySome;
  std::string reason;
};
const std::vector<Harmless> harmless = {
    {"abuffer", "LateFragmentTests", "LateFragmentTests", true,
     "the passes of the intervals draw on pixels of their own: any order of them is right"},
    {"abuffer mask=lists", "ComputeShader", "ComputeShader", true,
     "so do the dispatches of the intervals"},
    {"abuffer mask=stencil_increment", "ColorAttachmentOutput", "AllCommands", false,
     "only what clears buffers moves: a later barrier waits for the opaque pass too"},
    {"blend", "ComputeShader", "ComputeShader", true,
     "the last digit of the sort's keys is the same in nearly all, in the frame before too"},
    {"depth_peeling", "FragmentShader", "FragmentShader", true,
     "passes beyond the last layer draw nothing"},
    {"depth_peeling", "ComputeShader", "AllTransfer", false,
     "what is copied counts broken lists, of which there are none"},
    {"depth_peeling", "ColorAttachmentOutput", "AllCommands", false,
     "only what clears buffers moves: the first pass's barrier waits for the opaque pass too"},
    {"local_memory", "ColorAttachmentOutput", "AllCommands", false,
     "what it draws, however often, adds nothing to the image"},
};

std::string describe(const std::vector<layer::Node>& nodes, int group) {
  std::vector<std::string> parts;
  for (const layer::Node& node : nodes)
    if (node.barrier && node.group == group)
      parts.push_back(fmt::format("{} -> {}", vk::to_string(vk::PipelineStageFlags2(node.from)),
                                  vk::to_string(vk::PipelineStageFlags2(node.to))));
  return fmt::format("{}", fmt::join(parts, ", "));
}

int groupsOf(const std::vector<layer::Node>& nodes) {
  int most = 0;
  for (const layer::Node& node : nodes) most = std::max(most, node.group);
  return most;
}

/// The actions in the order that they run in: what is left out of barriers does not show in it.
std::vector<std::size_t> actionsInOrder(std::vector<layer::Node> nodes, int without = 0) {
  dropGroup(nodes, without);
  auto order = layer::adversarialOrder(nodes);
  std::erase_if(order, [&](std::size_t place) { return nodes[place].barrier; });
  return order;
}

class Barriers : public ::testing::Test {
 protected:
  void SetUp() override {
    if (fs::exists(layers() / "reorder.json")) return;
    // A bundle has none; beside the sources the build makes them.
    if (fs::exists(dataRoot() / "tests")) FAIL() << "no layers in " << layers();
    GTEST_SKIP() << "no layers in " << layers();
  }
};

/// One variant on a device whose commands are reordered.
class Subject {
 public:
  Subject(const ReorderedDevice& on, const Variant& variant)
      : on_(on),
        variant_(variant),
        fixture_(sceneOf(variant), variant.width(), variant.width() * 3 / 4, {},
                 TargetFormat::rgba32f, on.device()) {}

  /// What a frame with these barriers leaves: the image's hash and its fragments, or why there is
  /// none. The frame before it, from another camera, leaves contents in the method's buffers that
  /// are wrong for this one; the first of all, from the same one, makes them large enough.
  std::string frame(bool shuffle, int drop) {
    auto& control = on_.control();
    std::string text;
    try {
      if (!method_) {
        method_ = fixture_.make(variant_.method, variant_.parameters);
        fixture_.renderer().render(*method_, frontCamera(), true);
      }
      fixture_.renderer().render(*method_, otherCamera(), true);
      control.shuffle = shuffle;
      control.drop = drop;
      const FrameResult result = fixture_.renderer().render(*method_, frontCamera(), true);
      nodes_ = control.nodes;
      control = {};
      text = imageHash(fixture_.target().readBytes(on_.device()));
      // A second recording may be right after the first has cleared what it should have begun with.
      text += fmt::format(" {} recordings", result.recordings);
      // Other counters may differ from frame to frame: lucid's say how many pixels were in the
      // wrong order before they were mended, which is as parallel shaders came to write them.
      if (const auto found = result.counters.find("fragments"); found != result.counters.end())
        text += fmt::format(" {} fragments", found->second);
    } catch (const DeviceError& error) {
      text = error.what();
    }
    control = {};
    // What a missing barrier spoils may stay, such as counts that memory grows by.
    if (drop != 0) method_.reset();
    return text;
  }

  /// Of the last frame(), as it was recorded.
  const std::vector<layer::Node>& nodes() const { return nodes_; }

 private:
  /// Triangles in each other's way, some in front of opaque ones.
  static Scene sceneOf(const Variant& variant) {
    Scene scene = randomSoup(21, variant.triangles());
    makeOpaque(scene, scene.triangles.size() - 8);
    // The last of them hides the left of the image from much of the rest.
    const std::array<glm::vec3, 3> corners = {{{-3, -3, 0}, {0, -3, 0}, {0, 3, 0}}};
    for (int i = 0; i < 3; ++i) scene.vertices[scene.triangles.back()[i]].position = corners[i];
    return scene;
  }
  static Camera otherCamera() {
    Camera camera = frontCamera();
    camera.eye += glm::vec3(0.3f, -0.2f, 0.1f);
    camera.target = {-0.1f, 0.1f, -1.0f};
    return camera;
  }

  const ReorderedDevice& on_;
  Variant variant_;
  RenderFixture fixture_;
  std::unique_ptr<Method> method_;
  std::vector<layer::Node> nodes_;
};

/// What became of a frame without a group of barriers.
struct Trial {
  int group = 0;
  std::string outcome;   ///< "noticed", "same image", or "died": then it was noticed as well
  std::string barriers;  ///< "{ FragmentShader } -> { ComputeShader }", ...
};

constexpr int secondsForATrial = 60;  // lists without an end may be what a missing barrier makes

/// Runs the variant's trials from group `first` on, and writes a line before and after each. In a
/// process of its own: what a missing barrier leaves, such as places in lists, may crash a driver.
void runTrials(const Variant& variant, int first) {
  const ReorderedDevice on(false);
  Subject subject(on, variant);
  const std::string recorded = subject.frame(false, 0);
  const std::string shuffled = subject.frame(true, 0);
  const auto nodes = subject.nodes();
  if (shuffled != recorded) {
    fmt::print("a barrier is missing: recorded {}, reordered {}\n", recorded, shuffled);
    return;
  }
  const auto whole = actionsInOrder(nodes);
  for (int group = first; group <= groupsOf(nodes); ++group) {
    // The first barriers of a frame wait for the frame before and the last for the CPU, both of
    // which fences do too; and some order what others order as well.
    if (actionsInOrder(nodes, group) == whole) continue;
    ::alarm(secondsForATrial);
    fmt::print("begin\t{}\t{}\n", group, describe(nodes, group));
    std::fflush(stdout);
    if (std::getenv("DBG")) {
      fmt::print("{}\n{}\n", recorded, subject.frame(true, group));
      for (const auto& n : nodes)
        fmt::print("  node {} {} {} {}\n", n.barrier, n.group,
                   vk::to_string(vk::PipelineStageFlags2(n.from)),
                   vk::to_string(vk::PipelineStageFlags2(n.to)));
      for (auto i : actionsInOrder(nodes, group)) fmt::print(" {}", i);
    }
    const bool noticed = subject.frame(true, group) != recorded;
    fmt::print("end\t{}\n", noticed ? "noticed" : "same image");
    std::fflush(stdout);
  }
  fmt::print("done\n");
}

/// One run of runTrials() in a child process: its trials, and whether it came to an end by itself.
/// Throws std::runtime_error where the barriers do not suffice or the child cannot run.
bool trialsOfChild(std::size_t variant, int first, std::vector<Trial>& trials) {
  // Without this process's share of the tests, in which the trials need not be.
  const std::string command = fmt::format(
      "env -u GTEST_TOTAL_SHARDS -u GTEST_SHARD_INDEX OITLAB_TRIALS='{} {}' '{}' "
      "--gtest_also_run_disabled_tests "
      "--gtest_filter=Barriers.DISABLED_Trials 2>&1",
      variant, first, fs::read_symlink("/proc/self/exe").string());
  FILE* child = ::popen(command.c_str(), "r");
  if (child == nullptr) throw std::runtime_error("no child process");
  std::string said;
  std::array<char, 4096> line;
  bool done = false, begun = false;
  while (std::fgets(line.data(), int(line.size()), child) != nullptr) {
    std::string text = line.data();
    said += text;
    text.erase(text.find_last_not_of('\n') + 1);
    if (text.starts_with("begin\t")) {
      const auto tab = text.find('\t', 6);
      trials.push_back({std::stoi(text.substr(6, tab - 6)), "died", text.substr(tab + 1)});
      begun = true;
    }
    if (text.starts_with("end\t")) trials.back().outcome = text.substr(4);
    done = done || text == "done";
  }
  ::pclose(child);
  if (!done && !begun) throw std::runtime_error(said);
  return done;
}

/// Expects each trial to be noticed or to be one of the harmless ones. How many were noticed.
std::size_t checkTrials(const Variant& variant, const std::vector<Trial>& trials) {
  const auto isOf = [&](const Trial& trial, const Harmless& entry) {
    const auto arrow = trial.barriers.find("->");
    return variant.text().starts_with(entry.variant) &&
           trial.barriers.substr(0, arrow).find(entry.from) != std::string::npos &&
           trial.barriers.substr(arrow).find(entry.to) != std::string::npos;
  };
  const auto isNoticed = [](const Trial& trial) { return trial.outcome != "same image"; };
  for (const Trial& trial : trials) {
    if (isNoticed(trial)) continue;
    const bool known = std::any_of(harmless.begin(), harmless.end(), [&](const Harmless& entry) {
      if (!isOf(trial, entry)) return false;
      return !entry.onlySome || std::any_of(trials.begin(), trials.end(), [&](const Trial& other) {
        return isNoticed(other) && isOf(other, entry);
      });
    });
    EXPECT_TRUE(known) << "the image is right without group " << trial.group << ": "
                       << trial.barriers;
  }
  return std::size_t(std::count_if(trials.begin(), trials.end(), isNoticed));
}

/// Not for itself: the child processes of the test below run it.
TEST_F(Barriers, DISABLED_Trials) {
  const char* which = std::getenv("OITLAB_TRIALS");
  if (which == nullptr) GTEST_SKIP() << "OITLAB_TRIALS names no variant";
  std::size_t variant = 0;
  int first = 0;
  ASSERT_EQ(std::sscanf(which, "%zu %d", &variant, &first), 2);
  runTrials(allVariants().at(variant), first);
}

TEST_F(Barriers, SufficeInAnotherOrderAndAreNoticedWhenMissing) {
  const auto variants = allVariants();
  std::size_t noticed = 0;
  for (std::size_t v = 0; v < variants.size(); ++v) {
    SCOPED_TRACE(variants[v].text());
    std::vector<Trial> trials;
    int first = 1;
    while (!trialsOfChild(v, first, trials)) first = trials.back().group + 1;
    noticed += checkTrials(variants[v], trials);
    RecordProperty(variants[v].text(), int(trials.size()));
    if (std::getenv("OITLAB_PRINT_TRIALS"))
      for (const Trial& trial : trials)
        fmt::print("{}\t{}\t{}\t{}\n", variants[v].text(), trial.group, trial.outcome,
                   trial.barriers);
  }
  EXPECT_GT(noticed, 80u);  // or little was tried
}

}  // namespace
}  // namespace oitlab::testing
