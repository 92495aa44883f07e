// Compares this device's images with those of other devices, which are in the folders of
// tests/data/devices (README.md there). The exact methods give the same image on every device,
// except for pixels in doubt.
#include <unistd.h>

#include "support/truth.h"
#include "util/json_file.h"
#include "util/paths.h"

namespace oitlab::testing {
namespace {

namespace fs = std::filesystem;

// The images are small, so that the files are small.
constexpr std::uint32_t width = 96, height = 54;

/// The detail of a generated scene. Depth peeling has a pass per layer, and this much takes it a
/// second or two.
float detailOf(const std::string& scene) {
  static const std::map<std::string, float> own = {
      {"boxes", 0.1f},      {"planes", 1.0f},       {"smoke", 0.1f},       {"teapot", 0.5f},
      {"hairball", 0.003f}, {"powerplant", 0.001f}, {"sanmiguel", 0.004f}, {"whiteoak", 0.005f}};
  const auto found = own.find(scene);
  return found == own.end() ? 0.02f : found->second;
}

/// The value in steps of an 8-bit sRGB image, which are the steps of the files.
constexpr double step = 1.0 / 255;
constexpr double allowed = 2 * step;

int eightBits(float linear) {
  return int(std::lround(srgbEncode(std::clamp(linear, 0.0f, 1.0f)) * 255));
}

/// A pixel as a file stores it. Images from files are sRGB-encoded already.
int eightBitsOf(const Image& image, int x, int y, int channel) {
  const float value = image.at(x, y)[channel];
  return image.srgb ? int(std::lround(value * 255)) : eightBits(value);
}

fs::path dataFolder() {
  return dataRoot() / "tests" / "data" / "devices";
}

std::vector<fs::path> recordedDevices() {
  std::vector<fs::path> folders;
  if (!fs::is_directory(dataFolder())) return folders;
  for (const auto& entry : fs::directory_iterator(dataFolder()))
    if (entry.is_directory()) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  return folders;
}

/// `nvidia-h200-580.159.04` for NVIDIA H200 with driver 580.159.04. Text in brackets is left out.
std::string folderName(const DeviceInfo& device) {
  const auto shorter = [](const std::string& text) { return text.substr(0, text.find(" (")); };
  std::string name;
  for (const char c : shorter(device.name) + " " + shorter(device.driverInfo)) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) || c == '.';
    if (kept) name += char(std::tolower(static_cast<unsigned char>(c)));
    if (!kept && !name.empty() && name.back() != '-') name += '-';
  }
  return name;
}

struct Agreement {
  std::uint64_t sure = 0;     ///< pixels without doubt that are not background
  std::uint64_t differs = 0;  ///< pixels without doubt that differ by more than is allowed
  int worst = 0;              ///< largest difference of a pixel without doubt, in steps
};

/// How much two devices may differ that snap vertices differently, in steps of 8-bit sRGB.
double snappingAt(const CpuImage& truth, std::size_t pixel) {
  const float by = truth.snapping[pixel];
  double most = 0.0;
  for (int c = 0; c < 3; ++c) {
    const auto color = float(truth.color[pixel][c]);
    most = std::max(most, double(srgbEncode(std::min(color + by, 1.0f)) -
                                 srgbEncode(std::max(color - by, 0.0f))));
  }
  return most;
}

Agreement compareWhereSure(const Image& image, const Image& other, const CpuImage& truth) {
  Agreement found;
  for (int y = 0; y < truth.height; ++y)
    for (int x = 0; x < truth.width; ++x) {
      const std::size_t pixel = truth.index(x, y);
      if (truth.doubts[pixel] != 0) continue;
      if (truth.fragments[pixel] > 0) ++found.sure;
      int difference = 0;
      for (int c = 0; c < 3; ++c)
        difference = std::max(difference,
                              std::abs(eightBitsOf(image, x, y, c) - eightBitsOf(other, x, y, c)));
      found.worst = std::max(found.worst, difference);
      if (difference * step > allowed + snappingAt(truth, pixel) + 1e-9) ++found.differs;
    }
  return found;
}

class DeviceImages : public GpuTest {};

/// A scene, its true image with doubts, and this device's images.
struct Subject {
  explicit Subject(const std::string& name)
      : scene(loadScene({name, {}, detailOf(name)})),
        truth(renderOnCpu(scene, findView(scene, "default"), int(width), int(height))),
        fixture(scene, width, height) {}
  Scene scene;
  CpuImage truth;
  RenderFixture fixture;
};

/// The exact methods that run on the device.
std::vector<std::string> exactMethods() {
  std::vector<std::string> names;
  for (const auto& [name, info] : methods())
    if (info.exact && name != "cpu_reference" && info.missing(sharedDevice().info()).empty())
      names.push_back(name);
  return names;
}

TEST_F(DeviceImages, AreThoseOfOtherDevicesWhereNothingIsInDoubt) {
  const auto folders = recordedDevices();
  ASSERT_FALSE(folders.empty()) << "no folders in " << dataFolder();
  const auto exact = exactMethods();
  ASSERT_GE(exact.size(), 4u);
  for (const SceneInfo& info : sceneCatalogue()) {
    Subject subject(info.name);
    std::vector<Image> made;
    for (const std::string& method : exact) made.push_back(subject.fixture.render(method).image);
    for (const fs::path& folder : folders) {
      SCOPED_TRACE(info.name + ", images of " + folder.filename().string());
      const Image recorded = readImage(folder / (info.name + ".png"));
      ASSERT_EQ(recorded.width, int(width));
      ASSERT_EQ(recorded.height, int(height));
      const Agreement own = compareWhereSure(recorded, subject.truth.toImage(), subject.truth);
      EXPECT_EQ(own.differs, 0u)
          << "the file differs from the CPU renderer by up to " << own.worst
          << "/255: was the scene another when it was made? Make it again (README.md there)";
      for (std::size_t i = 0; i < exact.size(); ++i) {
        const Agreement found = compareWhereSure(made[i], recorded, subject.truth);
        EXPECT_EQ(found.differs, 0u) << exact[i] << ": up to " << found.worst << "/255";
        // Otherwise nothing was compared.
        EXPECT_GT(double(found.sure), 0.3 * double(subject.truth.coveredPixels()));
        RecordProperty(fmt::format("{} {}", folder.filename().string(), info.name),
                       fmt::format("worst {}/255 from the CPU renderer", own.worst));
        RecordProperty(fmt::format("{} {} {}", folder.filename().string(), info.name, exact[i]),
                       fmt::format("worst {}/255 of {} sure pixels", found.worst, found.sure));
      }
    }
  }
}

// The comparison finds differences.
TEST_F(DeviceImages, ThatDifferAreFound) {
  Subject subject("boxes");
  const Image image = subject.fixture.render("reference").image;
  EXPECT_EQ(compareWhereSure(image, image, subject.truth).worst, 0);
  Image brighter = image;
  for (float& value : brighter.rgba) value = srgbDecode(srgbEncode(value) + 3.0f / 255);
  const Agreement found = compareWhereSure(brighter, image, subject.truth);
  EXPECT_GT(found.differs, subject.truth.coveredPixels() / 2);
  EXPECT_EQ(found.worst, 3);
  const Image other = subject.fixture.render("wboit").image;
  EXPECT_GT(compareWhereSure(other, image, subject.truth).differs, 0u);
}

TEST(DeviceImagesFolder, IsNamedByDeviceAndDriver) {
  DeviceInfo device;
  device.name = "NVIDIA H200";
  device.driverInfo = "580.159.04";
  EXPECT_EQ(folderName(device), "nvidia-h200-580.159.04");
  device.name = "llvmpipe (LLVM 15.0.6, 256 bits)";
  device.driverInfo = "Mesa 22.3.6 (LLVM 15.0.6)";
  EXPECT_EQ(folderName(device), "llvmpipe-mesa-22.3.6");
}

// With OITLAB_RECORD_IMAGES=DIR this stores the images of this device in a folder of DIR.
TEST_F(DeviceImages, CanBeRecorded) {
  const DeviceInfo& device = sharedDevice().info();
  const fs::path temporary =
      fs::temp_directory_path() / fmt::format("oitlab_device_images_{}", ::getpid());
  const char* wanted = std::getenv("OITLAB_RECORD_IMAGES");
  const bool kept = wanted != nullptr && *wanted != '\0';
  const fs::path folder = (kept ? fs::path(wanted) : temporary) / folderName(device);
  fs::create_directories(folder);
  nlohmann::json said = {{"device", device.name},
                         {"driver", device.driver},
                         {"driver_info", device.driverInfo},
                         {"method", "reference"},
                         {"scenes", nlohmann::json::object()}};
  for (const SceneInfo& info : sceneCatalogue()) {
    Subject subject(info.name);
    const auto result = subject.fixture.render("reference");
    const Agreement found = compareWhereSure(result.image, subject.truth.toImage(), subject.truth);
    EXPECT_EQ(found.differs, 0u) << info.name << ": up to " << found.worst
                                 << "/255 from the CPU renderer, which no device should be";
    const fs::path file = folder / (info.name + ".png");
    writeImage(file, result.image);
    EXPECT_EQ(compareWhereSure(readImage(file), result.image, subject.truth).worst, 0);
    said["scenes"][info.name] = {{"detail", detailOf(info.name)}, {"hash_rgba32f", result.hash}};
  }
  writeJsonFile(folder / "device.json", said);
  if (kept) fmt::print("{}: {} images\n", folder.string(), sceneCatalogue().size());
  fs::remove_all(temporary);
}

}  // namespace
}  // namespace oitlab::testing
