// Experiments: what a TOML file spans, how it is dealt out, and what its mistakes are answered
// with.
#include "experiment/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "experiment/plan.h"
#include "support/glb.h"
#include "support/temporary_folder.h"
#include "util/error.h"
#include "util/paths.h"
#include "util/text_file.h"

namespace oitlab::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Experiments : public TemporaryFolder {
 protected:
  Experiment read(const std::string& text) {
    const auto path = folder_ / "x.toml";
    writeFileAtomically(path, text);
    return readExperiment(path);
  }
  std::string errorOf(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
};

constexpr const char* small = R"(
scenes = ["boxes", "planes"]
sizes = ["64x32", "32x16"]
[[methods]]
method = "blend"
order = ["submission", "sorted"]
[[methods]]
method = "reference"
)";

TEST_F(Experiments, SpansTheProductOfItsLists) {
  const Experiment experiment = read(small);
  EXPECT_EQ(experiment.name, "x");
  ASSERT_EQ(experiment.cells.size(), 2u * 2 * 3);
  EXPECT_EQ(experiment.cells[0].label(), "boxes blend 64x32");
  EXPECT_EQ(experiment.cells[1].label(), "boxes blend order=sorted 64x32");
  EXPECT_EQ(experiment.cells[2].label(), "boxes reference 64x32");
  EXPECT_EQ(experiment.cells[3].label(), "boxes blend 32x16");
  EXPECT_EQ(experiment.cells.back().label(), "planes reference 32x16");
}

TEST_F(Experiments, SweepsInheritWhatTheyLeaveOutAndRepetitionsAreDropped) {
  const Experiment experiment = read(R"(
sizes = ["64x32"]
methods = ["blend"]
[[sweep]]
scenes = [{ source = "boxes", opacity = [0.5, 0.8], views = ["default", "orbit:0,0,9"] }]
[[sweep]]
scenes = ["planes"]
methods = ["blend", "blend", { method = "reference", initial_depth = 2 }]
)");
  std::vector<std::string> labels;
  for (const CellSpec& cell : experiment.cells) labels.push_back(cell.label());
  EXPECT_THAT(labels,
              ::testing::ElementsAre(
                  "boxes opacity 0.5 blend 64x32", "boxes opacity 0.5 orbit:0,0,9 blend 64x32",
                  "boxes opacity 0.8 blend 64x32", "boxes opacity 0.8 orbit:0,0,9 blend 64x32",
                  "planes blend 64x32", "planes reference initial_depth=2 64x32"));
}

TEST_F(Experiments, MistakesNameFileLineAndRemedy) {
  EXPECT_THAT(errorOf("scenes = [\n"), HasSubstr("x.toml:"));
  EXPECT_THAT(errorOf("scnes = [\"boxes\"]\n"), AllOf(HasSubstr("x.toml:1: unknown key 'scnes'"),
                                                      HasSubstr("did you mean 'scenes'")));
  EXPECT_THAT(errorOf("scenes = [\"boxs\"]\nmethods = [\"blend\"]\n"),
              AllOf(HasSubstr("x.toml:1"), HasSubstr("boxs"), HasSubstr("did you mean 'boxes'")));
  EXPECT_THAT(errorOf("scenes = [\"nowhere.glb\"]\nmethods = [\"blend\"]\n"),
              AllOf(HasSubstr("x.toml:1"), HasSubstr("nowhere.glb")));
  EXPECT_THAT(errorOf("scenes = [\"boxes\"]\nmethods = [\"blnd\"]\n"),
              AllOf(HasSubstr("x.toml:2"), HasSubstr("did you mean 'blend'")));
  EXPECT_THAT(errorOf("scenes = [\"boxes\"]\n[[methods]]\nmethod = \"blend\"\nordr = \"sorted\"\n"),
              AllOf(HasSubstr("x.toml:2"), HasSubstr("did you mean 'order'")));
  EXPECT_THAT(
      errorOf("scenes = [\"boxes\"]\nmethods = [{method = \"blend\", order = \"sortd\"}]\n"),
      AllOf(HasSubstr("submission | sorted"), HasSubstr("did you mean 'sorted'")));
  EXPECT_THAT(
      errorOf("scenes = [\"boxes\"]\nmethods = [{method = \"reference\", initial_depth = -1}]\n"),
      AllOf(HasSubstr("out of range"), HasSubstr("0 to 1024")));
  EXPECT_THAT(errorOf("sizes = [\"64\"]\nscenes = [\"boxes\"]\nmethods = [\"blend\"]\n"),
              AllOf(HasSubstr("x.toml:1"), HasSubstr("WxH")));
  EXPECT_THAT(errorOf("scenes = [{source = \"boxes\", opacity = 1.5}]\nmethods = [\"blend\"]\n"),
              HasSubstr("above 0, up to 1"));
  EXPECT_THAT(errorOf("format = \"rgb\"\nscenes = [\"boxes\"]\nmethods = [\"blend\"]\n"),
              HasSubstr("rgba16f"));
  EXPECT_THAT(errorOf("[measure]\ntime_limit = \"long\"\n"), HasSubstr("x.toml:2"));
  EXPECT_THAT(errorOf("[measure]\ntime_limit = 0\n"), HasSubstr("out of range"));
  EXPECT_THAT(errorOf("name = \"empty\"\n"), HasSubstr("no cells"));
}

TEST_F(Experiments, ViewsAreCheckedWhenTheFileIsRead) {
  const auto withView = [&](const std::string& view) {
    return errorOf(
        "scenes = [\"boxes\", \"planes\"]\nmethods = [\"blend\"]\nviews = [\"default\", \"" + view +
        "\"]\n");
  };
  EXPECT_EQ(withView("orbit:0.5,0.8,3"), "no error");
  EXPECT_EQ(withView("look:1,2,3,0,0,0,60"), "no error");
  EXPECT_THAT(withView("foo"), AllOf(HasSubstr("x.toml:3"), HasSubstr("view 'foo'"),
                                     HasSubstr("scene 'boxes'"), HasSubstr("it has default")));
  EXPECT_THAT(withView("defalt"), HasSubstr("did you mean 'default'"));
  EXPECT_THAT(withView("orbit:foo"), AllOf(HasSubstr("x.toml:3"), HasSubstr("orbit:YAW,PITCH")));
  EXPECT_THAT(withView("orbit:1,2,-3"), AllOf(HasSubstr("x.toml:3"), HasSubstr("-3")));
  EXPECT_THAT(withView("look:1,2,3,1,2,3"), HasSubstr("same point"));
  EXPECT_THAT(withView("path:nowhere@0.5"), AllOf(HasSubstr("x.toml:3"), HasSubstr("nowhere")));
  EXPECT_THAT(withView("path:nowhere"), HasSubstr("path:NAME@T"));
  // Those of a scene, of a sweep, and of a profile that is not the one in use.
  EXPECT_THAT(errorOf("methods = [\"blend\"]\nscenes = [{source = \"boxes\", views = \"foo\"}]\n"),
              AllOf(HasSubstr("x.toml:2"), HasSubstr("view 'foo'")));
  EXPECT_THAT(
      errorOf("methods = [\"blend\"]\nscenes = [\"boxes\"]\n[[sweep]]\nviews = [\"foo\"]\n"),
      HasSubstr("x.toml:4"));
  EXPECT_THAT(
      errorOf("methods = [\"blend\"]\nscenes = [\"boxes\"]\n[profile.cpu]\nviews = [\"foo\"]\n"),
      HasSubstr("x.toml:4"));
}

TEST_F(Experiments, AViewMayBeACameraOfTheScenesFile) {
  GlbBuilder glb;
  const int mesh = glb.mesh({{"POSITION", glb.positions({0, 0, 0, 1, 0, 0, 0, 1, 0})}});
  glb.node({{"mesh", mesh}});
  glb.json["cameras"] = {{{"name", "front"},
                          {"type", "perspective"},
                          {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  glb.node({{"camera", 0}, {"translation", {0, 0, 5}}});
  glb.write(folder_ / "own.glb");
  const auto withView = [&](const std::string& view) {
    return errorOf("scenes = [\"own.glb\"]\nmethods = [\"blend\"]\nviews = [\"" + view + "\"]\n");
  };
  EXPECT_EQ(withView("front"), "no error");
  EXPECT_THAT(withView("frnt"), AllOf(HasSubstr("x.toml:3"), HasSubstr("did you mean 'front'")));
}

TEST_F(Experiments, ANameThatCannotBeAFoldersIsAMistake) {
  const std::string rest = "\nscenes = [\"boxes\"]\nmethods = [\"blend\"]\n";
  for (const std::string name : {"../../evil", "a/b", "..", ".hidden", "", "a\\\\b", "a\\nb"})
    EXPECT_THAT(errorOf(fmt::format("name = \"{}\"{}", name, rest)),
                AllOf(HasSubstr("x.toml:1: the name"), HasSubstr("wanted")))
        << name;
  EXPECT_THAT(errorOf("name = \"" + std::string(200, 'a') + "\"" + rest), HasSubstr("x.toml:1"));
  EXPECT_EQ(errorOf("name = \"sorting in 2.5 dimensions, \u00fc\"" + rest), "no error");
}

TEST_F(Experiments, EveryKeyHasItsTypeAndRange) {
  const std::string rest = "\nscenes = [\"boxes\"]\nmethods = [\"blend\"]\n";
  const auto wrong = [&](const std::string& line) { return errorOf(line + rest); };
  EXPECT_THAT(wrong("title = 3"), HasSubstr("x.toml:1: 'title' must be a string, found 3"));
  EXPECT_THAT(wrong("seed = 1.5"), HasSubstr("x.toml:1: 'seed' must be a whole number, found 1.5"));
  EXPECT_THAT(wrong("seed = true"), HasSubstr("must be a whole number"));
  EXPECT_THAT(wrong("seed = -1"), HasSubstr("out of range"));
  EXPECT_THAT(wrong("detail = true"), HasSubstr("x.toml:1: 'detail' must be a number"));
  EXPECT_THAT(wrong("reference = \"refrence\""), HasSubstr("did you mean 'reference'"));
  EXPECT_THAT(wrong("measure = 1"), HasSubstr("x.toml:1: 'measure' must be a table"));
  EXPECT_THAT(wrong("sizes = [\"0x5\"]"), AllOf(HasSubstr("x.toml:1"), HasSubstr("WxH")));
  EXPECT_THAT(wrong("sizes = [5]"), HasSubstr("a size must be a string"));
  EXPECT_THAT(wrong("views = []"), HasSubstr("x.toml:1: 'views' is an empty list"));
  EXPECT_THAT(wrong("sweep = 1"), HasSubstr("'sweep' must be tables"));
  EXPECT_THAT(wrong("profile = 1"), HasSubstr("'profile' must be tables"));
  EXPECT_THAT(wrong("profile.full.detail = 1"), HasSubstr("[profile.full]"));
  const auto measure = [&](const std::string& line) {
    return errorOf(rest + "[measure]\n" + line);
  };
  EXPECT_THAT(measure("min_blocks = 2.5"), HasSubstr("x.toml:5: 'min_blocks' must be a whole"));
  EXPECT_THAT(measure("min_blocks = true"), HasSubstr("must be a whole number, found true"));
  EXPECT_THAT(measure("time_limit = nan"), HasSubstr("out of range"));
  EXPECT_THAT(measure("min_blocks = 9\nmax_blocks = 8"), HasSubstr("min_blocks, 9, is above"));
  EXPECT_THAT(errorOf("scenes = [{source = \"boxes\", optional = 1}]\nmethods = [\"blend\"]\n"),
              HasSubstr("x.toml:1: 'optional' must be true or false, found 1"));
  EXPECT_THAT(errorOf("scenes = [\".\"]\nmethods = [\"blend\"]\n"), HasSubstr("is not a file"));
  writeFileAtomically(folder_ / "own.obj", "v 0 0 0\n");
  EXPECT_THAT(errorOf("scenes = [{source = \"own.obj\", detail = 0.5}]\nmethods = [\"blend\"]\n"),
              AllOf(HasSubstr("x.toml:1"), HasSubstr("only generated scenes")));
}

TEST_F(Experiments, DetailMayBeOfSomeScenesOnly) {
  const auto path = folder_ / "d.toml";
  const std::string text = R"(
scenes = ["boxes", "planes", { source = "smoke", detail = 0.5 }, { source = "teapot", detail = 0.2 }]
methods = ["blend"]
[profile.cpu]
detail = { boxes = 0.125, smoke = 0.25, teapot = 0.75 }
)";
  writeFileAtomically(path, text);
  const auto details = [&](const ExperimentOptions& options) {
    std::vector<float> found;
    for (const CellSpec& cell : readExperiment(path, options).cells)
      found.push_back(cell.scene.detail);
    return found;
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(details({}), ElementsAre(1.0f, 1.0f, 0.5f, 0.2f));
  EXPECT_THAT(details({.profile = "cpu"}), ElementsAre(0.125f, 1.0f, 0.25f, 0.2f));
  EXPECT_THAT(details({.profile = "cpu", .detail = 0.5f}), ElementsAre(0.5f, 0.5f, 0.5f, 0.5f));
  EXPECT_THAT(errorOf("detail = { boxs = 0.1 }\nscenes = ['boxes']\nmethods = ['blend']\n"),
              AllOf(HasSubstr("x.toml:1"), HasSubstr("did you mean 'boxes'")));
  EXPECT_THAT(errorOf("detail = { boxes = 2 }\nscenes = ['boxes']\nmethods = ['blend']\n"),
              HasSubstr("out of range"));
}

TEST_F(Experiments, EveryExperimentOfTheProjectCanBeRead) {
  const std::filesystem::path folder = dataRoot() / "experiments";
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml" || entry.path().stem() == "views") continue;
    for (const char* profile : {"full", "brief", "cpu"}) {
      const bool required = std::string_view(profile) == "brief";  // not all need a cpu profile
      const Experiment experiment =
          readExperiment(entry.path(), {.profile = profile, .profileRequired = required});
      EXPECT_FALSE(experiment.cells.empty()) << entry.path();
      EXPECT_EQ(experiment.name, entry.path().stem()) << "results go to a folder of this name";
    }
    ++read;
  }
  EXPECT_GE(read, 7);
}

TEST_F(Experiments, AnOptionalSceneThatIsNotThereIsLeftOutWithANote) {
  const Experiment experiment = read(R"(
scenes = ["boxes", { source = "nowhere.glb", optional = true }]
methods = ["blend"]
)");
  EXPECT_EQ(experiment.cells.size(), 1u);
  ASSERT_EQ(experiment.notes.size(), 1u);
  EXPECT_THAT(experiment.notes[0], HasSubstr("nowhere.glb"));
}

TEST_F(Experiments, ShardsAreDisjointWholeGroupsAndTheirUnionIsTheWhole) {
  const auto cells = read(small).cells;  // four groups of three
  std::multiset<std::string> all;
  for (const CellSpec& cell : cells) all.insert(cell.label());
  for (const std::uint32_t count : {1u, 2u, 3u, 4u, 5u, 12u, 20u}) {
    std::multiset<std::string> seen;
    std::size_t empty = 0;
    for (std::uint32_t index = 1; index <= count; ++index) {
      const auto mine = shardCells(cells, {index, count});
      empty += mine.empty();
      for (const CellSpec& cell : mine) seen.insert(cell.label());
      for (const auto& group : groupCells(mine)) EXPECT_EQ(group.size(), 3u) << count << " shards";
    }
    EXPECT_EQ(seen, all) << count << " shards";
    EXPECT_EQ(empty, count > 4 ? count - 4 : 0) << count << " shards";
  }
}

TEST_F(Experiments, AnEditedSceneFileMakesAnotherCell) {
  const auto idOf = [&](const std::string& color) {
    writeFileAtomically(folder_ / "own.mtl", "newmtl m\nKd " + color + "\n");
    writeFileAtomically(folder_ / "own.obj",
                        "mtllib own.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    return cellId(read("scenes = [\"own.obj\"]\nmethods = [\"blend\"]\n").cells.at(0), {});
  };
  // Of the same name and size: it used to be the same cell.
  const std::string red = idOf("1 0 0"), green = idOf("0 1 0");
  EXPECT_NE(red, green);
  EXPECT_EQ(idOf("1 0 0"), red);
}

TEST_F(Experiments, ShardTextIsChecked) {
  EXPECT_EQ(parseShard("2/4").index, 2u);
  EXPECT_EQ(parseShard("2/4").count, 4u);
  for (const std::string text : {"", "2", "0/4", "5/4", "a/b", "1/", "/1", "1/2x", "-1/2"})
    EXPECT_THROW(parseShard(text), InputError) << text;
}

TEST_F(Experiments, CellIdsTellCellsAndDevicesApart) {
  const auto cells = read(small).cells;
  DeviceInfo a, b;
  a.name = "A";
  b.name = "B";
  std::set<std::string> ids;
  for (const CellSpec& cell : cells) {
    ids.insert(cellId(cell, a));
    ids.insert(cellId(cell, b));
    EXPECT_EQ(cellId(cell, a), cellId(cell, a));
  }
  EXPECT_EQ(ids.size(), 2 * cells.size());
  EXPECT_THAT(cellId(cells[1], a), HasSubstr("boxes-blend-order-sorted-64x32-"));
}

TEST_F(Experiments, ADeviceWhoseNameIsNotUtf8HasIdsToo) {
  DeviceInfo device;
  device.name = "GPU \xff";
  const CellSpec cell = read("scenes = [\"boxes\"]\nmethods = [\"blend\"]\n").cells.at(0);
  EXPECT_THAT(cellId(cell, device), HasSubstr("boxes-blend-"));
  EXPECT_EQ(groupKey(cell, device).size(), 16u);
}

}  // namespace
}  // namespace oitlab::testing
