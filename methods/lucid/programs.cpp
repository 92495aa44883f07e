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

Programs::Programs(const Device& device, const Scene& scene, bool hasOpaque, bool hasIrregular,
                   const std::string& targetFormat, const Parameters& parameters)
    : irregular(hasIrregular) {
  const bool isWide = device.info().subgroupSize >= 32;
  ordersFirst = parameters.flag("ordered_first");
  // Half-blocks that a workgroup works on side by side. They wait for each other, but each
  // workgroup takes 1 KB of shared memory beside what it asks for (docs/performance.md); a CPU has
  // fewer workgroups to start.
  const char* orderedTeams = isWide ? "2u" : "4u";
  const char* lowTeams = isWide ? "1u" : "4u";

  const std::uint32_t lanes = device.info().subgroupSize;
  const Defines common = {
      {"SUBGROUP_SIZE", std::to_string(lanes) + "u"},
      {"TARGET_FORMAT", targetFormat},
      {"HAS_OPAQUE", hasOpaque ? "1" : "0"},
      {"HAS_IRREGULAR", hasIrregular ? "1" : "0"},
      {"HAS_TEXTURES", hasTextures(scene) ? "1" : "0"},
      {"HAS_GRADIENTS", hasGradients(scene) ? "1" : "0"},
      {"HAS_ATTRIBUTES", hasAttributes(scene) ? "1" : "0"},
      {"HAS_SMOOTH", isSmooth(scene) ? "1" : "0"},
      {"HAS_THRESHOLD", parameters.real("alpha_threshold") > 0.0 ? "1" : "0"},
      {"UNIFORM_CONTROL_FLOW", device.hasSubgroupUniformControlFlow() ? "1" : "0"},
      {"VERIFY_LOOPS", verifiesLoops(device) ? "1" : "0"}};
  auto raster = [&](const std::string& kind, const char* teams, std::int64_t filter) {
    Defines defines = common;
    defines["ORDERED"] = kind == "ordered" ? "1" : "0";
    defines["HIGH"] = kind == "high" ? "1" : "0";
    defines["LIST"] = "ORDERED_LIST";  // of the one that sorts
    defines["TEAMS"] = teams;
    defines["LOW_TEAMS"] = lowTeams;
    defines["DEPTH_FILTER"] = std::to_string(filter);
    return Pipeline::compute(device, "lucid/blend.comp", defines, {}, lanes);
  };
  auto sort = [&](const std::string& kind, const char* teams) {
    return Pipeline::compute(device, "lucid/sort_lists.comp",
                             {{"SUBGROUP_SIZE", common.at("SUBGROUP_SIZE")},
                              {"UNIFORM_CONTROL_FLOW", common.at("UNIFORM_CONTROL_FLOW")},
                              {"HIGH", kind == "high" ? "1" : "0"},
                              {"LIST", kind == "high" ? "HIGH_LIST" : "LOW_LIST"},
                              {"TEAMS", teams}},
                             {}, lanes);
  };
  // A workgroup a part of a bin. On a CPU a large one is no faster.
  const char* group = lanes >= 32 ? "256u" : "64u";
  for (std::size_t pass = 0; pass < blocks.size(); ++pass)
    blocks[pass] = Pipeline::compute(device, "lucid/blocks.comp",
                                     {{"PASS", std::to_string(pass)},
                                      {"HAS_IRREGULAR", common.at("HAS_IRREGULAR")},
                                      {"LOW_TEAMS", lowTeams},
                                      {"ORDERED_TEAMS", orderedTeams},
                                      {"GROUP", group},
                                      {"FIRST_LIST", ordersFirst ? "ORDERED_LIST" : "0u"}});
  const std::int64_t filter = parameters.integer("depth_filter");
  if (ordersFirst) ordered = raster("ordered", orderedTeams, 1);
  lowRaster = raster("low", lowTeams, filter);
  highRaster = raster("high", "1u", filter);
  sortLow = sort("low", lowTeams);
  sortHigh = sort("high", "1u");
  repair = Pipeline::compute(device, "lucid/repair.comp", common, {}, lanes);
  deepCapture = Pipeline::compute(device, "lucid/deep_capture.comp",
                                  {{"TARGET_FORMAT", targetFormat},
                                   {"HAS_OPAQUE", common.at("HAS_OPAQUE")},
                                   {"HAS_IRREGULAR", common.at("HAS_IRREGULAR")},
                                   {"HAS_TEXTURES", common.at("HAS_TEXTURES")},
                                   {"HAS_GRADIENTS", common.at("HAS_GRADIENTS")},
                                   {"HAS_ATTRIBUTES", common.at("HAS_ATTRIBUTES")},
                                   {"HAS_SMOOTH", common.at("HAS_SMOOTH")}});
  deepResolve =
      Pipeline::compute(device, "lucid/deep_resolve.comp", {{"TARGET_FORMAT", targetFormat}});
}

}  // namespace oitlab::lucid
