#include "cli/commands.h"
#include "cli/device_options.h"
#include "cli/scene_options.h"
#include "quality/compare.h"
#include "render/depth_complexity.h"
#include "results/describe.h"
#include "util/error.h"
#include "util/json_file.h"
#include "util/python.h"
#include "util/size.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

struct DepthOptions {
  std::string scene;
  std::string size = "1280x720";
  std::string view = "default";
  std::string source = "hardware";
  std::optional<float> opacity;
  float detail = 1.0f;
  bool allowOutside = false;
  std::string out, histogram;
  float heatScale = 0.0f;
  bool json = false;
  Device::Options device;
};

nlohmann::json describeDepth(const DepthComplexity& depth) {
  return {{"size", {depth.width, depth.height}},
          {"fragments", depth.total},
          {"covered_pixels", depth.covered},
          {"max_fragments_per_pixel", depth.peak},
          {"mean_fragments_per_pixel", depth.meanOfAll()},
          {"mean_fragments_per_covered_pixel", depth.meanOfCovered()},
          {"histogram", depth.histogram}};
}

Plane<float> depthPlane(const DepthComplexity& depth) {
  Plane<float> plane(int(depth.width), int(depth.height));
  std::copy(depth.counts.begin(), depth.counts.end(), plane.values.begin());
  return plane;
}

/// The histogram as text, one line per count, for machines without the Python packages.
std::string depthHistogramText(const DepthComplexity& depth) {
  std::string text = "fragments pixels\n";
  for (std::size_t n = 0; n < depth.histogram.size(); ++n)
    if (depth.histogram[n] > 0) text += fmt::format("{:9} {}\n", n, depth.histogram[n]);
  return text;
}

/// Draws the histogram with the Python package. Returns the file that was written.
std::filesystem::path writeDepthHistogram(const std::filesystem::path& path,
                                          const DepthComplexity& depth,
                                          const nlohmann::json& result) {
  const auto python = findPython({"matplotlib"});
  if (!python) {
    auto table = path;
    table.replace_extension(".txt");
    fmt::print(stderr, "no Python with matplotlib (tried {}): the histogram is a table, {}\n",
               fmt::join(pythonCandidates(), ", "), table.string());
    writeFileAtomically(table, depthHistogramText(depth));
    return table;
  }
  auto numbers = path;
  numbers += ".json.tmp";
  writeJsonFile(numbers, result);
  const int code = runAnalysis(*python, {"histogram", numbers.string(), path.string()});
  std::error_code ignored;
  std::filesystem::remove(numbers, ignored);
  if (code != 0) fail<InputError>("{}: the histogram could not be drawn", path.string());
  return path;
}

int depth(const DepthOptions& options) {
  const auto size = parseSize(options.size);
  if (!size) fail<InputError>("--size {}: wanted WxH, such as 1280x720", options.size);
  if (!options.out.empty()) checkImagePath(options.out);
  if (!options.histogram.empty() && std::filesystem::path(options.histogram).extension() != ".png")
    fail<InputError>("--histogram {}: wanted a .png file", options.histogram);
  if (!options.histogram.empty()) checkImagePath(options.histogram);

  const Scene scene =
      loadScene({options.scene, options.opacity, options.detail, options.allowOutside});
  const Camera camera = findView(scene, options.view);
  const Device device(options.device);
  const Target target(device, size->first, size->second, TargetFormat::rgba16f);
  const GpuScene gpuScene(device, scene);
  Renderer renderer(device, gpuScene, target);
  const DepthComplexity counted = countFragments(renderer, camera, options.source == "hardware");

  nlohmann::json result = describeDepth(counted);
  result["device"] = describeDevice(device.info());
  result["scene"] = {{"name", scene.name},
                     {"source", options.scene},
                     {"triangles", scene.triangles.size()},
                     {"transparent_triangles", gpuScene.transparentCount()}};
  result["view"] = options.view;
  result["camera"] = describeCamera(camera);
  result["provenance"] = describeProvenance(device.validation(), device.shaders().hashes());

  if (!options.out.empty()) {
    const Plane<float> plane = depthPlane(counted);
    writeMap(options.out, plane,
             options.heatScale > 0 ? options.heatScale : largestFinite(plane, 1.0f));
  }
  std::string histogram;
  if (!options.histogram.empty())
    histogram = writeDepthHistogram(options.histogram, counted, result).string();
  if (options.json) {
    fmt::print("{}\n", jsonText(result));
    return exitDone;
  }
  fmt::print(stderr, "{} at {}x{}\n", scene.name, size->first, size->second);
  fmt::print(stderr, "  fragments                  {}\n", counted.total);
  fmt::print(stderr, "  covered pixels             {} ({:.2f} %)\n", counted.covered,
             100.0 * double(counted.covered) / double(counted.counts.size()));
  fmt::print(stderr, "  mean over covered pixels   {:.3f}\n", counted.meanOfCovered());
  fmt::print(stderr, "  mean over all pixels       {:.3f}\n", counted.meanOfAll());
  fmt::print(stderr, "  most in one pixel          {}\n", counted.peak);
  if (!options.out.empty()) fmt::print(stderr, "  heat map                   {}\n", options.out);
  if (!histogram.empty()) fmt::print(stderr, "  histogram                  {}\n", histogram);
  return exitDone;
}

}  // namespace

void addDepth(CLI::App& program, Action& action) {
  auto options = std::make_shared<DepthOptions>();
  CLI::App* verb = program.add_subcommand(
      "depth", "Depth complexity: how many transparent fragments each pixel has");
  verb->add_option("scene,--scene", options->scene,
                   "A name of `oitlab list scenes`, or a .glb/.gltf file")
      ->required();
  verb->add_option("--size", options->size, "Width x height in pixels")
      ->capture_default_str()
      ->type_name("WxH");
  verb->add_option("--view", options->view, "As for `oitlab render`")->capture_default_str();
  verb->add_option("--opacity", options->opacity, "Give every material this opacity, in (0, 1]");
  verb->add_option("--detail", options->detail,
                   "Generated scenes: share of the triangles, in (0, 1]")
      ->capture_default_str();
  verb->add_option("--source", options->source, "Where fragments come from: hardware or compute")
      ->check(CLI::IsMember({"hardware", "compute"}))
      ->capture_default_str();
  verb->add_option("--out", options->out,
                   "Heat map: a picture with a legend (.png) or the counts (.exr)")
      ->type_name("FILE");
  verb->add_option("--heat-scale", options->heatScale,
                   "Fragments of the brightest colour (default: the most in one pixel)")
      ->check(CLI::PositiveNumber);
  verb->add_option("--histogram", options->histogram,
                   "Pixels by number of fragments, log scale (.png; a .txt without Python)")
      ->type_name("FILE");
  addAllowOutside(*verb, options->allowOutside);
  verb->add_flag("--json", options->json, "One JSON object on stdout, with the histogram");
  addDeviceOptions(*verb, options->device);
  verb->callback([=, &action] { action = [=] { return depth(*options); }; });
}

}  // namespace oitlab
