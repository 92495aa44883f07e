#include "cli/commands.h"
#include "cli/scene_options.h"
#include "results/describe.h"
#include "scene/coverage.h"
#include "scene/quads.h"
#include "util/error.h"
#include "util/json_file.h"
#include "util/size.h"

namespace oitlab {
namespace {

struct SceneOptions {
  std::string scene;
  std::string view = "default";
  std::string size = "2560x1330";
  std::optional<float> opacity;
  float detail = 1.0f;
  bool allowOutside = false;
  bool json = false;
};

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole ? 100.0 * double(part) / double(whole) : 0.0;
}

int describeScene(const SceneOptions& options) {
  const auto size = parseSize(options.size);
  if (!size) fail<InputError>("--size {}: wanted WxH, such as 1280x720", options.size);
  const Scene scene =
      loadScene({options.scene, options.opacity, options.detail, options.allowOutside});
  const Camera camera = findView(scene, options.view);
  const auto [width, height] = *size;
  const Coverage coverage = measureCoverage(scene, camera, int(width), int(height));
  const QuadMesh quads = cachedQuads(scene);
  const std::uint64_t triangles = scene.triangles.size();
  const double mean = double(coverage.samples) / (double(width) * double(height));

  std::vector<std::string> views, paths;
  for (const auto& [name, ignored] : scene.views) views.push_back(name);
  for (const auto& [name, ignored] : scene.paths) paths.push_back(name);
  nlohmann::json repairs = nlohmann::json::array();
  for (const Repair& repair : scene.repairs)
    repairs.push_back({{"what", repair.what}, {"count", repair.count}});
  const nlohmann::json result = {
      {"scene", scene.name},
      {"triangles", triangles},
      {"vertices", scene.vertices.size()},
      {"materials", scene.materials.size()},
      {"textures", scene.textures.size()},
      {"views", views},
      {"paths", paths},
      {"repairs", repairs},
      {"quads", quads.quads.size()},
      {"degenerate_percent", quads.degeneratePercent()},
      {"view", options.view},
      {"camera", describeCamera(camera)},
      {"size", {width, height}},
      {"samples", coverage.samples},
      {"mean_depth", mean},
      {"peak_depth", coverage.peakDepth},
      {"covered_pixels", coverage.coveredPixels},
      {"visible_percent", percent(coverage.visible, triangles)},
      {"visible_front_percent", percent(coverage.visibleFront, triangles)}};
  if (options.json) {
    fmt::print("{}\n", jsonText(result));
    return exitDone;
  }
  for (const Repair& repair : scene.repairs)
    fmt::print("repaired: {} {}\n", repair.count, repair.what);
  fmt::print("{}: {} triangles, {} vertices, {} materials, {} textures\n", scene.name, triangles,
             scene.vertices.size(), scene.materials.size(), scene.textures.size());
  fmt::print("  {} quads, {:.1f}% of them a single triangle\n", quads.quads.size(),
             quads.degeneratePercent());
  fmt::print("  view {} at {}x{}: {:.3f} M samples, depth {:.2f} mean, {} peak\n", options.view,
             width, height, double(coverage.samples) * 1e-6, mean, coverage.peakDepth);
  fmt::print("  {:.1f}% of the triangles visible, {:.1f}% with back-face culling\n",
             percent(coverage.visible, triangles), percent(coverage.visibleFront, triangles));
  return exitDone;
}

}  // namespace

void addScene(CLI::App& program, Action& action) {
  auto options = std::make_shared<SceneOptions>();
  CLI::App* verb = program.add_subcommand(
      "scene", "A scene's size, repairs, and what a view of it asks of a rasterizer (no device)");
  verb->add_option("scene", options->scene, "Generated scene or file")->required();
  verb->add_option("--view", options->view, "View of the scene, 'orbit:...' or 'look:...'");
  verb->add_option("--size", options->size, "WxH in pixels")->capture_default_str();
  verb->add_option("--opacity", options->opacity, "Opacity for all materials, in (0, 1]");
  verb->add_option("--detail", options->detail, "Share of a generated scene's triangles, (0, 1]");
  addAllowOutside(*verb, options->allowOutside);
  verb->add_flag("--json", options->json, "One JSON object on stdout");
  verb->callback([=, &action] { action = [=] { return describeScene(*options); }; });
}

}  // namespace oitlab
