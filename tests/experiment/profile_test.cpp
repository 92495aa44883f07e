// Profiles of experiments: what they replace, `brief`, and what the command line replaces.
#include "experiment/profile.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiment/experiment.h"
#include "experiment/measure_settings.h"
#include "support/temporary_folder.h"
#include "util/error.h"
#include "util/text_file.h"

namespace oitlab::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Profiles : public TemporaryFolder {
 protected:
  std::string errorOf(const std::string& text) {
    writeFileAtomically(path_, text);
    try {
      readExperiment(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  const std::filesystem::path path_ = folder_ / "p.toml";
};

TEST_F(Profiles, MistakesInAProfileThatIsNotUsedAreMistakes) {
  const std::string rest = "scenes = [\"boxes\"]\nmethods = [\"blend\"]\n[profile.brief]\n";
  EXPECT_THAT(errorOf(rest + "siezs = [\"1x1\"]\n"),
              AllOf(HasSubstr("p.toml:4"), HasSubstr("did you mean 'sizes'")));
  EXPECT_THAT(errorOf(rest + "[profile.brief.measure]\ntime_limit = 0\n"), HasSubstr("p.toml:5"));
}

constexpr const char* profiled = R"(
scenes = ["boxes", { source = "teapot", detail = 0.125 }, { source = "planes", opacity = 0.5 }]
sizes = ["64x32", "32x16"]
methods = ["blend", "reference"]
[measure]
time_limit = 7
max_blocks = 50
[[sweep]]
scenes = ["hairball"]
[profile.cpu]
sizes = ["16x8"]
detail = 0.25
methods = ["blend"]
[profile.cpu.measure]
time_limit = 2
[profile.tiny]
scenes = ["boxes"]
[[profile.tiny.sweep]]
methods = [{ method = "blend", order = "sorted" }]
)";

std::vector<std::string> labelsOf(const Experiment& experiment) {
  std::vector<std::string> labels;
  for (const CellSpec& cell : experiment.cells)
    labels.push_back(fmt::format("{} {:g}", cell.label(), cell.scene.detail));
  return labels;
}

TEST_F(Profiles, AProfileReplacesWhatItNames) {
  writeFileAtomically(path_, profiled);
  const Experiment full = readExperiment(path_);
  EXPECT_EQ(full.profile, "full");
  EXPECT_EQ(full.cells.size(), 3u * 2 * 2 + 2 * 2);
  EXPECT_EQ(full.measure.stop.timeLimitSeconds, 7);

  const Experiment cpu = readExperiment(path_, {.profile = "cpu"});
  EXPECT_EQ(cpu.profile, "cpu");
  EXPECT_THAT(labelsOf(cpu), ::testing::ElementsAre(
                                 "boxes blend 16x8 0.25", "teapot blend 16x8 0.125",
                                 "planes opacity 0.5 blend 16x8 0.25", "hairball blend 16x8 0.25"));
  EXPECT_EQ(cpu.measure.stop.timeLimitSeconds, 2);
  EXPECT_EQ(cpu.measure.stop.maxBlocks, 50);  // tables are replaced key by key

  EXPECT_THAT(labelsOf(readExperiment(path_, {.profile = "tiny"})),
              ::testing::ElementsAre("boxes blend 64x32 1", "boxes reference 64x32 1",
                                     "boxes blend 32x16 1", "boxes reference 32x16 1",
                                     "boxes blend order=sorted 64x32 1",
                                     "boxes blend order=sorted 32x16 1"));
}

TEST_F(Profiles, EveryExperimentHasABriefProfile) {
  const auto brief = [&](const std::string& text) {
    writeFileAtomically(path_, "scenes = ['boxes']\nmethods = ['blend']\n" + text);
    const Experiment read = readExperiment(path_, {.profile = "brief", .profileRequired = true});
    EXPECT_EQ(read.profile, "brief");
    EXPECT_EQ(read.cells.size(), 1u);
    return describeMeasureSettings(read.measure).dump();
  };
  const std::string limits =
      R"({"block_seconds":0.02,"max_blocks":20,"max_frames":20,"min_blocks":6,"min_frames":1,)"
      R"("relative_spread":0.005,"seed":1,"stage_frames":5,"time_limit":2.0})";
  EXPECT_EQ(brief(""), limits);
  EXPECT_EQ(brief("[measure]\nmin_blocks = 1000\nmax_blocks = 1000\n"), limits);
  EXPECT_THAT(brief("[measure]\nmin_blocks = 1\nmax_blocks = 1\ntime_limit = 0.5\n"),
              AllOf(HasSubstr(R"("max_blocks":1,)"), HasSubstr(R"("min_blocks":1,)"),
                    HasSubstr(R"("time_limit":0.5)")))
      << "less stays less";
  EXPECT_THAT(brief("[profile.brief.measure]\nstage_frames = 20\n"),
              AllOf(HasSubstr(R"("stage_frames":20)"), HasSubstr(R"("max_blocks":20,)")));
}

TEST_F(Profiles, DetailAndSizeOfTheCommandLineReplaceAllOfTheFile) {
  writeFileAtomically(path_, profiled);
  const Experiment experiment =
      readExperiment(path_, {.profile = "cpu", .detail = 0.125f, .size = {{8, 4}}});
  EXPECT_THAT(
      labelsOf(experiment),
      ::testing::ElementsAre("boxes blend 8x4 0.125", "teapot blend 8x4 0.125",
                             "planes opacity 0.5 blend 8x4 0.125", "hairball blend 8x4 0.125"));
  EXPECT_EQ(experiment.overrides.dump(), R"({"detail":0.125,"size":[8,4]})");
}

TEST_F(Profiles, AProfileThatIsNotThere) {
  writeFileAtomically(path_, "scenes = ['boxes']\nmethods = ['blend']\n");
  EXPECT_EQ(readExperiment(path_, {.profile = "cpu"}).profile, "full");  // chosen by itself
  writeFileAtomically(path_, profiled);
  try {
    readExperiment(path_, {.profile = "cpv", .profileRequired = true});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("p.toml"), HasSubstr("[profile.cpv]"),
                      HasSubstr("did you mean 'cpu'"), HasSubstr("full, cpu, tiny, brief")));
  }
  writeFileAtomically(path_,
                      "scenes = [\"boxes\"]\nmethods = [\"blend\"]\n[profile.cpu]\nseeds = 3\n");
  try {
    readExperiment(path_, {.profile = "cpu"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("p.toml:4"), HasSubstr("'seeds' in [profile.cpu]")));
  }
}

}  // namespace
}  // namespace oitlab::testing
