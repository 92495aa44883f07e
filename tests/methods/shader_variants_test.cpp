// Every variant of every shader compiles, and the driver makes a pipeline of it. Nothing is drawn
// with them, which is where a CPU device spends its time; .ci/run does this before the long tests.
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "lucid/programs.h"
#include "measure/clock_probe.h"
#include "raster/block_lists.h"
#include "render/depth_complexity.h"
#include "source/compute_source.h"
#include "source/hardware_source.h"
#include "support/gpu.h"
#include "support/planted.h"
#include "util/error.h"
#include "util/paths.h"

namespace oitlab::testing {
namespace {

using Given = std::map<std::string, std::string>;

/// Values that may choose a shader: all of an enumeration or a flag, the ends of a range.
std::vector<std::string> valuesOf(const Parameter& parameter) {
  const std::string type = parameter.typeName();
  if (type == "enum") return parameter.choices;
  if (type == "bool") return {"false", "true"};
  if (type == "int")
    return {std::to_string(std::int64_t(parameter.min)),
            std::to_string(std::int64_t(parameter.max))};
  return {std::to_string(parameter.min), std::to_string(parameter.max)};
}

bool isChoice(const Parameter& parameter) {
  return parameter.typeName() == "enum" || parameter.typeName() == "bool";
}

/// The defaults, each parameter at each of its values, and all pairs of choices.
std::vector<Given> variantsOf(const MethodInfo& method) {
  std::vector<Given> variants = {{}};
  const auto& parameters = method.parameters;
  for (std::size_t a = 0; a < parameters.size(); ++a)
    for (const std::string& value : valuesOf(parameters[a])) {
      variants.push_back({{parameters[a].name, value}});
      for (std::size_t b = a + 1; b < parameters.size() && isChoice(parameters[a]); ++b)
        if (isChoice(parameters[b]))
          for (const std::string& other : valuesOf(parameters[b]))
            variants.push_back({{parameters[a].name, value}, {parameters[b].name, other}});
    }
  for (Given& given : variants)  // most orders of delivery are for one source only
    if (given.contains("deliver")) given.emplace("source", "compute");
  return variants;
}

/// Programs of lucid that a frame would only make when it needs them.
void makeAll(const lucid::Programs& programs) {
  for (const auto* program :
       {&programs.ordered, &programs.sortLow, &programs.sortHigh, &programs.lowRaster,
        &programs.highRaster, &programs.repair, &programs.deepCapture, &programs.deepResolve})
    **program;
}

class ShaderVariants : public GpuTest {
 protected:
  /// Combinations that a method refuses (InputError) or the driver (DeviceError) have a message for
  /// the user; text that does not compile is a failure.
  template <typename Make>
  void make(const std::string& what, const Make& makeIt) {
    try {
      makeIt();
      ++made_;
    } catch (const std::exception& error) {
      EXPECT_EQ(std::string(error.what()).find("does not compile"), std::string::npos)
          << what << ": " << error.what();
    }
  }
  int made_ = 0;
};

/// A variant's path and definitions, from its label.
std::pair<std::string, Defines> variantOf(const std::string& label) {
  std::istringstream words(label);
  std::string path, word;
  words >> path;
  Defines defines;
  while (words >> word) {
    const std::size_t equals = word.find('=');
    defines[word.substr(0, equals)] = word.substr(equals + 1);
  }
  return {path, defines};
}

/// Code for other subgroup sizes than this device's also compiles.
void compileForWideSubgroups(ShaderLibrary& shaders) {
  for (const auto& [label, hash] : ShaderLibrary::Hashes(shaders.hashes())) {
    auto [path, defines] = variantOf(label);
    if (!defines.contains("SUBGROUP_SIZE")) continue;
    for (const char* lanes : {"32u", "64u"}) {
      defines["SUBGROUP_SIZE"] = lanes;
      defines["SMALL_SUBGROUP"] = "0";
      EXPECT_NO_THROW(shaders.compile(path, defines)) << label << ", subgroups of " << lanes;
    }
  }
}

TEST_F(ShaderVariants, AllCompileAndNoShaderIsLeftOut) {
  allowRefusals();  // of large local arrays
  // Colours of triangles, textures, and opaque surfaces: what lucid has separate code for.
  std::vector<std::unique_ptr<RenderFixture>> fixtures;
  for (const char* scene : {"planes", "scrubpine", "sanmiguel"})
    fixtures.push_back(std::make_unique<RenderFixture>(loadScene({scene, {}, 0.01f}), 32, 18,
                                                       std::nullopt, TargetFormat::rgba16f));
  const Device& device = sharedDevice();
  int variants = 0;
  for (const auto& entry : methods()) {
    const std::string& name = entry.first;
    const MethodInfo& method = entry.second;
    if (!method.missing(device.info()).empty()) continue;
    for (const Given& given : variantsOf(method)) {
      std::string what = name;
      for (const auto& [key, value] : given) what += fmt::format(" {}={}", key, value);
      make(what, [&] { fixtures.front()->make(name, given); });
      ++variants;
      if (name == "lucid")
        for (const auto& fixture : fixtures)
          for (const bool irregular : {false, true})
            make(what, [&] {
              const Parameters parameters(method.parameters, given, name);
              makeAll({device, fixture->renderer().scene(), irregular, "rgba16f", parameters});
            });
    }
  }
  MemoryLedger memory;
  raster::BlockLists lists(device, fixtures.front()->renderer().scene(), fixtures.front()->target(),
                           memory, {});
  for (const bool hasUnsnapped : {false, true}) lists.makeAllPrograms(hasUnsnapped);
  for (int deliver = DELIVER_ANY; deliver <= DELIVER_SHUFFLED; ++deliver)
    ComputeSource(device, fixtures.front()->renderer().scene(), fixtures.front()->target(), memory,
                  {.deliver = deliver})
        .makeAllPrograms();
  // No method of these is exclusive.
  HardwareSource(device, fixtures.front()->renderer().scene(), fixtures.front()->target(), memory,
                 {.withoutInterlock = !device.info().has("fragmentShaderPixelInterlock")})
      .make({.file = "../tests/data/programs/over.glsl", .access = Access::exclusive});
  ClockProbe probe(device, 1, 1);
  fixtures.back()->render("blend");
  Scene partlyOpaque = loadScene({"planes", {}, 1.0f});
  makeOpaque(partlyOpaque, partlyOpaque.triangles.size() / 2);
  RenderFixture(std::move(partlyOpaque), 32, 18).render("lucid");  // has an opaque pass of its own
  countFragments(fixtures.front()->renderer(), fixtures.front()->defaultView());
  EXPECT_GT(made_, variants * 3 / 4) << "most combinations are allowed";
  compileForWideSubgroups(device.shaders());

  std::set<std::string> compiled;
  for (const auto& [label, hash] : device.shaders().hashes())
    compiled.insert(label.substr(0, label.find(' ')));
  const std::filesystem::path root = dataRoot() / "shaders";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".comp" && extension != ".vert" && extension != ".frag") continue;
    const std::string name = entry.path().lexically_relative(root).generic_string();
    EXPECT_TRUE(compiled.contains(name)) << "no variant of shaders/" << name << " was compiled";
  }
}

}  // namespace
}  // namespace oitlab::testing
