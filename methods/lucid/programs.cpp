#include "lucid/programs.h"

#include <algorithm>

namespace oitlab::lucid {
namespace {

bool hasTextures(const Scene& scene) {
  return !scene.textures.empty();
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

bool hasAttributes(const Scene& scene) {
  return hasTextures(scene) || hasColors(scene);
}

}  // namespace

bool verifiesLoops(const Device& device) {
  return device.info().isCpu();
}

Defines teamDefines(const Device& device) {
  const std::uint32_t lanes = device.info().subgroupSize;
  return {{"SUBGROUP_SIZE", std::to_string(lanes) + "u"},
          {"SMALL_SUBGROUP", lanes < 32 ? "1" : "0"},
          {"SUBGROUP_BARRIER", device.info().driver == "llvmpipe" ? "0" : "1"},
          {"UNIFORM_CONTROL_FLOW", device.hasSubgroupUniformControlFlow() ? "1" : "0"}};
}

Programs::Programs(const Device& device, const Scene& scene, bool hasOpaque, bool hasUnsnapped,
                   const std::string& targetFormat, const Parameters& parameters)
    : unsnapped(hasUnsnapped) {
  const bool isWide = device.info().subgroupSize >= 32;
  ordersFirst = parameters.flag("ordered_first");
  // Half-blocks that a workgroup works on side by side. They wait for each other, but each
  // workgroup takes 1 KB of shared memory beside what it asks for (docs/performance.md); a CPU has
  // fewer workgroups to start.
  const char* orderedTeams = isWide ? "2u" : "4u";
  const char* lowTeams = isWide ? "1u" : "4u";

  const std::uint32_t lanes = device.info().subgroupSize;
  // `lanes` of a subgroup where the program counts on it; 0: any.
  auto program = [&device](const char* file, const Defines& defines, std::uint32_t lanes = 0) {
    return Program([=, &device] { return Pipeline::compute(device, file, defines, {}, lanes); });
  };
  auto with = [](Defines defines, const Defines& more) {
    for (const auto& [name, value] : more) defines[name] = value;
    return defines;
  };
  const Defines team = teamDefines(device);
  const Defines common =
      with(team, {{"TARGET_FORMAT", targetFormat},
                  {"HAS_OPAQUE", hasOpaque ? "1" : "0"},
                  {"HAS_UNSNAPPED", hasUnsnapped ? "1" : "0"},
                  {"HAS_TEXTURES", hasTextures(scene) ? "1" : "0"},
                  {"HAS_GRADIENTS", hasGradients(scene) ? "1" : "0"},
                  {"HAS_ATTRIBUTES", hasAttributes(scene) ? "1" : "0"},
                  {"HAS_SMOOTH", isSmooth(scene) ? "1" : "0"},
                  {"HAS_THRESHOLD", parameters.real("alpha_threshold") > 0.0 ? "1" : "0"},
                  {"VERIFY_LOOPS", verifiesLoops(device) ? "1" : "0"}});
  // Programs that differ in nothing are made once for all scenes.
  auto only = [&common](std::initializer_list<const char*> names) {
    Defines defines;
    for (const char* name : names) defines[name] = common.at(name);
    return defines;
  };
  auto raster = [&](const std::string& kind, const char* teams, std::int64_t filter) {
    return program("lucid/blend.comp",
                   with(common, {{"ORDERED", kind == "ordered" ? "1" : "0"},
                                 {"HIGH", kind == "high" ? "1" : "0"},
                                 {"LIST", "ORDERED_LIST"},  // of the one that sorts
                                 {"TEAMS", teams},
                                 {"LOW_TEAMS", lowTeams},
                                 {"DEPTH_FILTER", std::to_string(filter)}}),
                   lanes);
  };
  auto sort = [&](const std::string& kind, const char* teams) {
    return program("lucid/sort_lists.comp",
                   with(team, {{"HIGH", kind == "high" ? "1" : "0"},
                               {"LIST", kind == "high" ? "HIGH_LIST" : "LOW_LIST"},
                               {"TEAMS", teams}}),
                   lanes);
  };
  // One workgroup per segment of a bin. On a CPU a large one is no faster.
  const char* group = isWide ? "256u" : "64u";
  auto blocks = [&](const char* pass) {
    return program(
        "lucid/blocks.comp",
        with(only({"HAS_UNSNAPPED"}), {{"PASS", pass},
                                       {"LOW_TEAMS", lowTeams},
                                       {"ORDERED_TEAMS", orderedTeams},
                                       {"GROUP", group},
                                       {"FIRST_LIST", ordersFirst ? "ORDERED_LIST" : "0u"}}));
  };
  countHigh = blocks("COUNT_HIGH");
  countAndWriteLow = blocks("COUNT_AND_WRITE_LOW");
  writeHigh = blocks("WRITE_HIGH");
  const std::int64_t filter = parameters.integer("depth_filter");
  ordered = raster("ordered", orderedTeams, 1);
  lowRaster = raster("low", lowTeams, filter);
  highRaster = raster("high", "1u", filter);
  sortLow = sort("low", lowTeams);
  sortHigh = sort("high", "1u");
  repair = program("lucid/repair.comp", common, lanes);
  deepCapture = program("lucid/deep_capture.comp", common);
  deepResolve = program("lucid/deep_resolve.comp", only({"TARGET_FORMAT"}));
}

}  // namespace oitlab::lucid
