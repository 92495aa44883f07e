#include "sweep/pace.h"

#include <nlohmann/json.hpp>

#include "util/error.h"
#include "util/json_file.h"

namespace oitlab {
namespace {

// Overhead before anything was learned, in seconds; measured on two cores with lavapipe and on an
// H200 with 24 cores, where scoring an image takes most of it.
constexpr double overheadOfGroup = 0.5;
constexpr double overheadOfCell = 0.1;
constexpr double overheadOfMegapixel = 0.3;

/// Of the older runs, so that a scene that loads slowly does not rule the estimates for ever.
constexpr double keptShare = 0.5;

/// Of the overhead comes after the blocks: stages, reading the image back, scoring and writing it.
constexpr double finishingShare = 0.5;

double modelOverhead(const GroupSize& group) {
  return overheadOfGroup +
         double(group.cells) * (overheadOfCell + overheadOfMegapixel * group.megapixels);
}

}  // namespace

Pace::Pace(const MeasureSettings& settings, bool isCpu) : settings_(settings), isCpu_(isCpu) {}

double Pace::blocksOf(double blockSeconds) const {
  const StopRule::Limits& stop = settings_.stop;
  // Without experience: on GPUs most cells end soon after the fewest blocks (of 1023 cells on an
  // H200 the median took 6 of at least 6). On a CPU, which others use too, the spread stays above
  // the limit.
  double blocks = isCpu_ ? stop.maxBlocks : 1.2 * stop.minBlocks;
  if (cells_ > 0) blocks = cellBlocks_ / cells_;
  blocks = std::clamp(blocks, double(stop.minBlocks), double(stop.maxBlocks));
  // A cell goes on to the end of the block in which its time is over.
  return std::min(blocks, stop.timeLimitSeconds / blockSeconds + 0.5);
}

double Pace::cellSeconds() const {
  if (cells_ > 0) return cellSeconds_ / cells_;
  // A tenth more to warm up. The clock of a GPU is probed before and after each block.
  const double block = 1.1 * settings_.blockSeconds + (isCpu_ ? 0.0 : 0.03);
  return block * blocksOf(block);
}

double Pace::secondsLeft(const MeasureProgress& cell) const {
  if (cell.finished) return 0;
  if (cell.blocks == 0) return cellSeconds();
  const double block = std::max(cell.seconds / cell.blocks, 1e-6);
  // Whatever was expected, at least one more is to come.
  return block * std::max(blocksOf(block) - cell.blocks, 1.0);
}

double Pace::overhead(const GroupSize& group) const {
  const double model = modelOverhead(group);
  return overheadModel_ > 0 ? model * overheadSeconds_ / overheadModel_ : model;
}

double Pace::secondsOf(const GroupSize& group) const {
  return overhead(group) + double(group.cells) * cellSeconds();
}

double Pace::secondsLeft(const GroupSize& group, const std::vector<MeasureProgress>& progress,
                         double elapsed) const {
  const double around = overhead(group);
  if (progress.empty())
    return double(group.cells) * cellSeconds() + std::max(around - elapsed, 0.0);
  double blocksLeft = 0, blocksDone = 0, unfinished = 0;
  for (const MeasureProgress& cell : progress) {
    blocksLeft += secondsLeft(cell);
    blocksDone += cell.seconds;
    unfinished += !cell.finished;
  }
  // Each cell that is not finished has its stages and its image still to come.
  const double toFinish = around * finishingShare * unfinished / double(progress.size());
  return blocksLeft + std::max(around - (elapsed - blocksDone), toFinish);
}

void Pace::learn(const GroupSize& group, const std::vector<MeasureProgress>& progress,
                 double seconds) {
  double inBlocks = 0;
  for (const MeasureProgress& cell : progress) {
    inBlocks += cell.seconds;
    if (cell.blocks == 0) continue;
    cells_ += 1;
    cellBlocks_ += cell.blocks;
    cellSeconds_ += cell.seconds;
  }
  overheadSeconds_ += std::max(seconds - inBlocks, 0.0);
  overheadModel_ += modelOverhead(group);
}

// Only the overhead is kept: what a cell takes in blocks depends on the experiment's settings.
void Pace::load(const std::filesystem::path& file) {
  try {
    const nlohmann::json kept = readJsonFile(file);
    const double seconds = kept.at("overhead_seconds"), model = kept.at("overhead_model");
    if (!(seconds >= 0 && model > 0)) return;
    overheadSeconds_ = keptShare * seconds;
    overheadModel_ = keptShare * model;
  } catch (const std::exception&) {
  }
}

void Pace::save(const std::filesystem::path& file) const {
  if (!(overheadModel_ > 0)) return;
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  try {
    writeJsonFile(file,
                  {{"overhead_seconds", overheadSeconds_}, {"overhead_model", overheadModel_}});
  } catch (const InputError&) {
  }
}

}  // namespace oitlab
