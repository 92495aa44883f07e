#include "quality/compare.h"

#include <nlohmann/json.hpp>

#include "cli/commands.h"

namespace oitlab {
namespace {

struct Options {
  std::string image, reference, map;
  float mapScale = 0.0f;
  bool json = false;
};

int compare(const Options& options) {
  if (!options.map.empty()) checkImagePath(options.map);
  const Image image = readImage(options.image);
  const Image reference = readImage(options.reference);
  const Comparison c = compareImages(image, reference);
  if (!options.map.empty()) {
    // By default the largest error is the brightest colour; equal images have a scale all the same.
    constexpr float least = 1.0f / 255.0f;
    float scale = options.mapScale;
    if (scale == 0.0f)
      scale = std::isfinite(c.maxError) ? std::max(float(c.maxError), least) : 1.0f;
    writeImage(options.map, errorMap(image, reference, scale));
  }
  if (options.json) {
    const nlohmann::json finitePsnr = std::isfinite(c.psnr) ? nlohmann::json(c.psnr) : nullptr;
    fmt::print("{}\n", nlohmann::json{{"rmse", c.rmse},
                                      {"psnr", finitePsnr},
                                      {"max_error", c.maxError},
                                      {"pixels_off", c.pixelsOff},
                                      {"pixels_off_count", c.pixelsOffCount},
                                      {"size", {image.width, image.height}}}
                           .dump(2));
    return exitDone;
  }
  fmt::print(stderr, "RMSE        {:.6g}\n", c.rmse);
  fmt::print(stderr, "PSNR        {}\n",
             std::isfinite(c.psnr) ? fmt::format("{:.2f} dB", c.psnr) : "infinite (equal)");
  fmt::print(stderr, "max error   {:.6g}\n", c.maxError);
  fmt::print(stderr, "pixels off  {} ({:.4f} %) by more than 1/255\n", c.pixelsOffCount,
             100.0 * c.pixelsOff);
  return exitDone;
}

}  // namespace

void addCompare(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = program.add_subcommand("compare", "How far image A is from image B");
  verb->add_option("A", options->image, "Image, .png or .exr")->required();
  verb->add_option("B", options->reference, "Reference image of the same size")->required();
  verb->add_option("--map", options->map, "Write a picture of the error here (.png)")
      ->type_name("FILE");
  verb->add_option("--map-scale", options->mapScale,
                   "Error of the brightest colour (default: the largest)")
      ->check(CLI::PositiveNumber);
  verb->add_flag("--json", options->json, "One JSON object on stdout");
  verb->callback([=, &action] { action = [=] { return compare(*options); }; });
}

}  // namespace oitlab
