#include "cli/commands.h"
#include "cli/device_options.h"
#include "cli/scene_options.h"
#include "image/hash.h"
#include "measure/statistics.h"
#include "results/describe.h"
#include "util/error.h"
#include "util/json_file.h"
#include "util/size.h"

namespace oitlab {
namespace {

struct RenderOptions {
  std::string scene, method;
  std::vector<std::string> settings;
  std::string size = "1280x720";
  std::string view = "default";
  std::optional<float> opacity;
  float detail = 1.0f;
  bool allowOutside = false;
  std::string format = "rgba16f";
  std::optional<std::uint64_t> shuffle;
  std::string out;
  bool json = false;
  Device::Options device;
};

/// Parses "name=value" pairs. A name that is given twice is an error.
std::map<std::string, std::string> parseSettings(const std::vector<std::string>& settings) {
  std::map<std::string, std::string> given;
  for (const std::string& setting : settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      fail<InputError>("--set {}: wanted name=value", setting);
    if (!given.emplace(setting.substr(0, equals), setting.substr(equals + 1)).second)
      fail<InputError>("--set {}: given twice", setting.substr(0, equals));
  }
  return given;
}

/// The median time of a few frames, for a first look. `oitlab run` measures properly.
double quickFrameTime(Renderer& renderer, Method& method, const Camera& camera) {
  std::vector<double> ms;
  const auto start = std::chrono::steady_clock::now();
  renderer.render(method, camera);  // the first frame may enlarge buffers
  do {
    if (const auto frame = renderer.render(method, camera).frameMs) ms.push_back(*frame);
  } while (ms.size() < 5 && std::chrono::steady_clock::now() - start < std::chrono::seconds(2));
  if (ms.empty()) throw DeviceError("the device gives no usable timestamps");
  std::sort(ms.begin(), ms.end());
  return quantileOfSorted(ms, 0.5);
}

int render(const RenderOptions& options) {
  // Names and values are checked before slow work starts.
  const MethodInfo& info = findMethod(options.method);
  const Parameters parameters(info.parameters, parseSettings(options.settings), info.name);
  const TargetFormat format = parseFormat(options.format);
  const auto size = parseSize(options.size);
  if (!size) fail<InputError>("--size {}: wanted WxH, such as 1280x720", options.size);
  std::string out = options.out;
  if (out.empty() && !options.json)
    out = fmt::format("{}-{}.png", std::filesystem::path(options.scene).stem().string(), info.name);
  if (!out.empty()) checkImagePath(out);

  const Scene scene =
      loadScene({options.scene, options.opacity, options.detail, options.allowOutside});
  const Camera camera = findView(scene, options.view);
  for (const Repair& repair : scene.repairs)
    fmt::print(stderr, "{}: {} {}\n", options.scene, repair.count, repair.what);
  const Device device(options.device);
  const Target target(device, size->first, size->second, format);
  const GpuScene gpuScene(device, scene, options.shuffle);
  Renderer renderer(device, gpuScene, target);
  const auto method = renderer.make(info, parameters);

  const double frameMs = quickFrameTime(renderer, *method, camera);
  const auto bytes = target.readBytes(device);
  const FrameResult labelled = renderer.render(*method, camera, true);
  if (!out.empty()) writeImage(out, target.toImage(bytes));

  nlohmann::json stages = nlohmann::json::object();
  for (const auto& [name, ms] : labelled.stageMs) stages[name] = ms;
  const nlohmann::json result = {
      {"device", describeDevice(device.info())},
      {"scene",
       {{"name", scene.name},
        {"source", options.scene},
        {"triangles", scene.triangles.size()},
        {"transparent_triangles", gpuScene.transparentCount()}}},
      {"view", options.view},
      {"camera", describeCamera(camera)},
      {"size", {size->first, size->second}},
      {"format", options.format},
      {"method", info.name},
      {"parameters", parameters.toJson()},
      {"gpu_ms", {{"frame", frameMs}, {"stages", stages}}},
      {"counters", labelled.counters},
      {"memory_bytes", describeMemory(renderer, *method)},
      {"image_hash", imageHash(bytes)},
      {"image", out.empty() ? nlohmann::json() : nlohmann::json(out)},
      {"provenance", describeProvenance(device.validation(), device.shaders().hashes())},
  };
  if (options.json) {
    fmt::print("{}\n", jsonText(result));
    return exitDone;
  }
  fmt::print(stderr, "{} with {} at {}x{} on {}\n", scene.name, info.name, size->first,
             size->second, device.info().name);
  fmt::print(stderr, "  frame      {:10.3f} ms{}\n", frameMs,
             device.info().isCpu() ? "  (CPU device: says nothing about GPUs)" : "");
  for (const auto& [name, ms] : labelled.stageMs)
    fmt::print(stderr, "    {:<10} {:8.3f} ms\n", name, ms);
  for (const auto& [name, count] : labelled.counters)
    fmt::print(stderr, "  {:<24} {}\n", name, count);
  fmt::print(stderr, "  memory of the method     {:.1f} MiB\n",
             double(method->memory().total()) / (1 << 20));
  fmt::print(stderr, "  image                    {}\n", out);
  return exitDone;
}

}  // namespace

void addRender(CLI::App& program, Action& action) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* verb = program.add_subcommand("render", "Render one image and say what it took");
  verb->add_option("--scene", options->scene,
                   "A name of `oitlab list scenes`, or a .glb/.gltf file")
      ->required();
  verb->add_option("--method", options->method, "A name of `oitlab list methods`")->required();
  verb->add_option("--set", options->settings, "A parameter of the method: name=value (repeatable)")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb->add_option("--size", options->size, "Width x height in pixels")
      ->capture_default_str()
      ->type_name("WxH");
  verb->add_option("--view", options->view,
                   "A named view of the scene, orbit:YAW,PITCH,DISTANCE[,FOV] (radians; FOV in "
                   "degrees) or look:EX,EY,EZ,TX,TY,TZ[,FOV]")
      ->capture_default_str();
  verb->add_option("--opacity", options->opacity, "Give every material this opacity, in (0, 1]");
  verb->add_option("--detail", options->detail,
                   "Generated scenes: share of the triangles, in (0, 1]")
      ->capture_default_str();
  verb->add_option("--format", options->format, "Of the target: rgba16f, rgba8 or rgba32f, linear")
      ->capture_default_str();
  verb->add_option("--shuffle", options->shuffle,
                   "Submit the triangles in a random order with this seed");
  verb->add_option(
      "--out", options->out,
      "Image file, .exr (linear) or .png (default: SCENE-METHOD.png, or none with --json)");
  addAllowOutside(*verb, options->allowOutside);
  verb->add_flag("--json", options->json, "One JSON object on stdout");
  addDeviceOptions(*verb, options->device);
  verb->callback([=, &action] { action = [=] { return render(*options); }; });
}

}  // namespace oitlab
