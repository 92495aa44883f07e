#include "lucid/programs.h"

#include "raster/raster_defines.h"

namespace oitlab::lucid {

using raster::only, raster::with;

Teams::Teams(const Device& device) {
  const bool isWide = device.info().subgroupSize >= 32;
  ordered = isWide ? 2 : 4;
  low = isWide ? 1 : 4;
}

Programs::Programs(const Device& device, const GpuScene& scene, bool hasUnsnapped,
                   const std::string& targetFormat, const Parameters& parameters)
    : unsnapped(hasUnsnapped), ordersFirst(parameters.flag("ordered_first")) {
  const Teams teams(device);
  const std::string lowTeams = std::to_string(teams.low) + "u";
  const std::uint32_t lanes = device.info().subgroupSize;
  // `lanes` of a subgroup where the program counts on it; 0: any.
  auto program = [&device](const char* file, const Defines& defines, std::uint32_t lanes = 0) {
    return LazyPipeline(
        [=, &device] { return Pipeline::compute(device, file, defines, {}, lanes); });
  };
  const Defines team = raster::teamDefines(device);
  const Defines common =
      with(with(team, raster::sceneDefines(scene, hasUnsnapped)),
           {{"TARGET_FORMAT", targetFormat},
            {"HAS_THRESHOLD", parameters.real("alpha_threshold") > 0.0 ? "1" : "0"},
            {"VERIFY_LOOPS", raster::verifiesLoops(device) ? "1" : "0"}});
  auto blend = [&](const std::string& kind, const std::string& teams, std::int64_t filter) {
    return program("lucid/blend.comp",
                   with(common, {{"ORDERED", kind == "ordered" ? "1" : "0"},
                                 {"HIGH", kind == "high" ? "1" : "0"},
                                 {"LIST", "SHORT_LIST"},  // of the one that sorts
                                 {"TEAMS", teams},
                                 {"MEDIUM_TEAMS", lowTeams},
                                 {"DEPTH_FILTER", std::to_string(filter)}}),
                   lanes);
  };
  auto sort = [&](const std::string& kind, const std::string& teams) {
    return program("lucid/sort_lists.comp",
                   with(team, {{"HIGH", kind == "high" ? "1" : "0"},
                               {"LIST", kind == "high" ? "HIGH_LIST" : "MEDIUM_LIST"},
                               {"TEAMS", teams}}),
                   lanes);
  };
  const std::int64_t filter = parameters.integer("depth_filter");
  ordered = blend("ordered", std::to_string(teams.ordered) + "u", 1);
  lowRaster = blend("low", lowTeams, filter);
  highRaster = blend("high", "1u", filter);
  sortLow = sort("low", lowTeams);
  sortHigh = sort("high", "1u");
  repair = program("lucid/repair.comp", common, lanes);
  deepCapture = program("lucid/deep_capture.comp", common);
  deepResolve = program("lucid/deep_resolve.comp", only(common, {"TARGET_FORMAT"}));
}

}  // namespace oitlab::lucid
