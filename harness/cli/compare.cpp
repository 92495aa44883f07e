#include "quality/compare.h"

#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "results/describe.h"
#include "util/json_file.h"

namespace oitlab {
namespace {

struct CompareOptions {
  std::string image, reference, map;
  std::string metric = "abs";
  float mapScale = 0.0f;
  bool json = false;
};

int compare(const CompareOptions& options) {
  if (!options.map.empty()) checkImagePath(options.map);
  const MapMetric metric = parseMapMetric(options.metric);
  const Image image = readImage(options.image);
  const Image reference = readImage(options.reference);
  const Comparison c = compareImages(image, reference);
  if (!options.map.empty()) {
    const Plane<float> errors = errorPlane(image, reference, metric);
    // By default the largest error has the brightest colour. Equal images need a scale too.
    const float scale = options.mapScale > 0 ? options.mapScale : largestFinite(errors, 1.0f / 255);
    writeMap(options.map, errors, scale);
  }
  if (options.json) {
    nlohmann::json result = describeComparison(c);
    result["pixels_off_count"] = c.pixelsOffCount;
    result["size"] = {image.width, image.height};
    fmt::print("{}\n", jsonText(result));
    return exitDone;
  }
  fmt::print(stderr, "RMSE        {:.6g}\n", c.rmse);
  fmt::print(stderr, "PSNR        {}\n",
             std::isfinite(c.psnr) ? fmt::format("{:.2f} dB", c.psnr) : "infinite (equal)");
  fmt::print(stderr, "max error   {:.6g}\n", c.maxError);
  fmt::print(stderr, "pixels off  {} ({:.4f} %) by more than 1/255\n", c.pixelsOffCount,
             100.0 * c.pixelsOff);
  const auto printed = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.6f}", *value) : "not measurable";
  };
  fmt::print(stderr, "SSIM        {}\n", printed(c.ssim));
  fmt::print(stderr, "FLIP        {}\n", printed(c.flip));
  if (c.flipHdr) fmt::print(stderr, "HDR-FLIP    {}\n", printed(c.flipHdr));
  return exitDone;
}

}  // namespace

void addCompare(CLI::App& program, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* verb = program.add_subcommand("compare", "How far image A is from image B");
  verb->add_option("A", options->image, "Image, .png or .exr")->required();
  verb->add_option("B", options->reference, "Reference image of the same size")->required();
  verb->add_option("--map", options->map,
                   "Write the error here: a picture of it (.png) or its values (.exr)")
      ->type_name("FILE");
  verb->add_option("--map-scale", options->mapScale,
                   "Error of the brightest colour (default: the largest)")
      ->check(CLI::PositiveNumber);
  verb->add_option("--metric", options->metric,
                   "Of the map: abs (largest channel difference), flip, flip_hdr (two .exr) or "
                   "ssim (1 - SSIM)")
      ->capture_default_str();
  verb->add_flag("--json", options->json, "One JSON object on stdout");
  verb->callback([=, &action] { action = [=] { return compare(*options); }; });
}

}  // namespace oitlab
