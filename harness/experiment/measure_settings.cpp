#include "experiment/measure_settings.h"

namespace oitlab {

void readMeasureSettings(TomlTable& root, const toml::node& node, MeasureSettings& settings) {
  if (!node.is_table()) root.failAt(node, "'measure' must be a table: [measure]");
  TomlTable table(root.file(), "[measure]", *node.as_table());
  StopRule::Limits& stop = settings.stop;
  stop.timeLimitSeconds = table.number("time_limit", stop.timeLimitSeconds, 0.01, 3600);
  stop.relativeSpread = table.number("relative_spread", stop.relativeSpread, 1e-5, 1.0);
  stop.minBlocks = int(table.whole("min_blocks", stop.minBlocks, 1, 1000));
  stop.maxBlocks = int(table.whole("max_blocks", stop.maxBlocks, 1, 100000));
  settings.stageFrames = int(table.whole("stage_frames", settings.stageFrames, 1, 1000));
  settings.blockSeconds = table.number("block_seconds", settings.blockSeconds, 1e-4, 60);
  settings.minFrames = int(table.whole("min_frames", settings.minFrames, 1, 1000));
  settings.maxFrames = int(table.whole("max_frames", settings.maxFrames, 1, 10000));
  table.finish();
  if (stop.minBlocks > stop.maxBlocks)
    root.failAt(node, fmt::format("in [measure] min_blocks, {}, is above max_blocks, {}",
                                  stop.minBlocks, stop.maxBlocks));
  if (settings.minFrames > settings.maxFrames)
    root.failAt(node, fmt::format("in [measure] min_frames, {}, is above max_frames, {}",
                                  settings.minFrames, settings.maxFrames));
}

nlohmann::json describeMeasureSettings(const MeasureSettings& settings) {
  const StopRule::Limits& stop = settings.stop;
  return {{"time_limit", stop.timeLimitSeconds},
          {"relative_spread", stop.relativeSpread},
          {"min_blocks", stop.minBlocks},
          {"max_blocks", stop.maxBlocks},
          {"stage_frames", settings.stageFrames},
          {"block_seconds", settings.blockSeconds},
          {"min_frames", settings.minFrames},
          {"max_frames", settings.maxFrames},
          {"seed", settings.seed}};
}

}  // namespace oitlab
