#include "quality/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "quality/color_map.h"
#include "quality/tiny_font.h"
#include "support/temporary_folder.h"
#include "util/error.h"

namespace oitlab {
namespace {

using ::testing::HasSubstr;

constexpr double infinite = std::numeric_limits<double>::infinity();

Image makeFlat(int width, int height, float value, bool srgb = false) {
  return {width, height, srgb, std::vector<float>(std::size_t(width) * height * 4, value)};
}

TEST(CompareImages, EqualImages) {
  const Comparison result = compareImages(makeFlat(3, 2, 0.3F), makeFlat(3, 2, 0.3F));
  EXPECT_EQ(result.rmse, 0);
  EXPECT_EQ(result.psnr, infinite);
  EXPECT_EQ(result.maxError, 0);
  EXPECT_EQ(result.pixelsOff, 0);
}

TEST(CompareImages, ValuesWorkedOutByHand) {
  // 4 pixels with 12 channels. They differ by 0.5 and 0.25 in one pixel and by 0.25 in another.
  Image image = makeFlat(2, 2, 0.5F);
  image.at(0, 0)[0] = 1.0F;
  image.at(0, 0)[2] = 0.25F;
  image.at(1, 1)[1] = 0.75F;
  const Comparison result = compareImages(image, makeFlat(2, 2, 0.5F));
  const double mse = (0.25 + 0.0625 + 0.0625) / 12;  // 1 / 32
  EXPECT_DOUBLE_EQ(result.rmse, std::sqrt(mse));
  EXPECT_NEAR(result.psnr, 15.0514997832, 1e-9);  // 10 log10 32
  EXPECT_EQ(result.maxError, 0.5);
  EXPECT_EQ(result.pixelsOffCount, 2U);
  EXPECT_EQ(result.pixelsOff, 0.5);
}

TEST(CompareImages, AlphaDoesNotCount) {
  Image image = makeFlat(1, 1, 0.5F);
  image.rgba[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(compareImages(image, makeFlat(1, 1, 0.5F)).maxError, 0);
}

TEST(CompareImages, BlackPixelsMayBeWrongToo) {
  // A share that only counts pixels that are not black would miss these.
  const Comparison result = compareImages(makeFlat(2, 1, 0), makeFlat(2, 1, 0.5F));
  EXPECT_EQ(result.pixelsOff, 1);
}

TEST(CompareImages, OneStepOfEightBitsIsNotOffWhateverTheRounding) {
  for (int i = 0; i < 255; ++i) {
    const Image image = makeFlat(1, 1, float(i) / 255.0F, true);
    const Image next = makeFlat(1, 1, float(i + 1) / 255.0F, true);
    EXPECT_EQ(compareImages(image, next).pixelsOffCount, 0U) << i;
    EXPECT_EQ(compareImages(next, image).pixelsOffCount, 0U) << i;
    if (i == 254) continue;
    const Image second = makeFlat(1, 1, float(i + 2) / 255.0F, true);
    EXPECT_EQ(compareImages(image, second).pixelsOffCount, 1U) << i;
  }
}

TEST(CompareImages, NotANumberIsOffByInfinity) {
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), float(infinite)};
  for (const float value : bad) {
    Image broken = makeFlat(2, 1, 0.5F);
    broken.rgba[1] = value;
    const Image whole = makeFlat(2, 1, 0.5F);
    // In the image, in the reference, and in both at once.
    for (const auto& [a, b] :
         {std::pair(broken, whole), std::pair(whole, broken), std::pair(broken, broken)}) {
      const Comparison result = compareImages(a, b);
      EXPECT_EQ(result.maxError, infinite);
      EXPECT_EQ(result.rmse, infinite);
      EXPECT_EQ(result.psnr, -infinite);
      EXPECT_EQ(result.pixelsOffCount, 1U);
    }
  }
}

TEST(CompareImages, SsimAndFlipOfEqualImages) {
  const Comparison linear = compareImages(makeFlat(12, 11, 0.3F), makeFlat(12, 11, 0.3F));
  EXPECT_EQ(linear.ssim, 1);
  EXPECT_EQ(linear.flip, 0);
  EXPECT_EQ(linear.flipHdr, 0);
  // Equal images are not filtered, but the result must be the one of the filters.
  const Comparison small = compareImages(makeFlat(12, 10, 0.3F), makeFlat(12, 10, 0.3F));
  EXPECT_EQ(small.ssim, std::nullopt);
  EXPECT_EQ(small.flip, 0);
  const Comparison encoded =
      compareImages(makeFlat(12, 11, 0.3F, true), makeFlat(12, 11, 0.3F, true));
  EXPECT_EQ(encoded.ssim, 1);
  EXPECT_EQ(encoded.flipHdr, std::nullopt);
}

TEST(CompareImages, SsimAndFlipOfDifferentImages) {
  const Comparison linear = compareImages(makeFlat(12, 11, 0), makeFlat(12, 11, 1));
  EXPECT_NEAR(linear.ssim.value(), 1e-4 / (1 + 1e-4), 1e-9);
  EXPECT_NEAR(linear.flip.value(), 0.96738, 2e-5);
  EXPECT_TRUE(linear.flipHdr.has_value());
  // With one encoded and one linear image, what a display shows is compared, which has no exposure.
  const Comparison mixed = compareImages(makeFlat(12, 11, 0.5F, true), makeFlat(12, 11, 1));
  EXPECT_GT(mixed.flip.value(), 0.1);
  EXPECT_EQ(mixed.flipHdr, std::nullopt);
}

TEST(CompareImages, MeansOfSsimAndFlipDoNotHideNotANumber) {
  Image broken = makeFlat(20, 20, 0.5F);
  broken.at(0, 0)[2] = std::numeric_limits<float>::quiet_NaN();
  const Comparison result = compareImages(broken, makeFlat(20, 20, 0.5F));
  EXPECT_EQ(result.ssim, std::nullopt);
  EXPECT_EQ(result.flip, std::nullopt);
  EXPECT_EQ(result.flipHdr, std::nullopt);
}

TEST(CompareImages, EncodedMeetsLinear) {
  const Image encoded = makeFlat(1, 1, 0.5F, true);
  const Image linear = makeFlat(1, 1, 0.21404114F, false);
  EXPECT_NEAR(compareImages(encoded, linear).maxError, 0, 1e-6);
  EXPECT_NEAR(compareImages(linear, encoded).maxError, 0, 1e-6);
  // Two encoded images are compared as they are.
  EXPECT_NEAR(compareImages(encoded, makeFlat(1, 1, 0.25F, true)).maxError, 0.25, 1e-7);
}

TEST(CompareImages, SizesMustBeEqual) {
  const std::string message =
      messageOf<InputError>([] { compareImages(makeFlat(2, 3, 0), makeFlat(3, 2, 0)); });
  EXPECT_THAT(message, HasSubstr("2 x 3"));
  EXPECT_THAT(message, HasSubstr("3 x 2"));
  EXPECT_NE(messageOf<InputError>([] { errorMap(makeFlat(2, 3, 0), makeFlat(3, 2, 0), 1); }), "");
}

std::array<float, 3> colorAt(const Image& map, int x, int y) {
  const float* pixel = map.at(x, y);
  return {pixel[0], pixel[1], pixel[2]};
}

TEST(ErrorMap, ShowsTheLargestChannelOnTheScale) {
  Image image = makeFlat(100, 4, 0.5F);
  image.at(1, 0)[2] = 0.55F;  // half of the scale
  image.at(2, 0)[0] = 0.9F;   // beyond the scale
  image.at(3, 0)[1] = std::numeric_limits<float>::quiet_NaN();
  const Image map = errorMap(image, makeFlat(100, 4, 0.5F), 0.1F);
  EXPECT_TRUE(map.srgb);
  EXPECT_EQ(map.width, 100);
  EXPECT_GT(map.height, 4);
  EXPECT_EQ(colorAt(map, 0, 0), infernoColor(0));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(map.at(1, 0)[c], infernoColor(0.5)[c], 1e-5);
  EXPECT_EQ(colorAt(map, 2, 0), infernoColor(1));
  EXPECT_EQ(colorAt(map, 3, 0), (std::array<float, 3>{0, 1, 0}));
  EXPECT_EQ(colorAt(map, 0, 3), infernoColor(0));
}

TEST(ErrorMap, EachMetricIsZeroWhereEqualAndInfinityWhereNotANumber) {
  Image image = makeFlat(60, 40, 0.5F), reference = image;
  image.at(10, 20)[1] = std::numeric_limits<float>::quiet_NaN();
  for (int c = 0; c < 3; ++c) image.at(40, 20)[c] = 0.9F;
  for (const std::string& name : mapMetricNames()) {
    const Plane<float> errors = errorPlane(image, reference, parseMapMetric(name));
    EXPECT_EQ(errors.row(20)[10], infinite) << name;
    EXPECT_EQ(std::count_if(errors.values.begin(), errors.values.end(),
                            [](float error) { return std::isfinite(error); }),
              60 * 40 - 1)
        << name << ": it must not spread through a filter";
    EXPECT_GT(errors.row(20)[40], 0.01F) << name;
    EXPECT_LT(errors.row(20)[40], 1.0F) << name;
    EXPECT_NEAR(errors.row(2)[55], 0.0F, 1e-6F) << name;
    EXPECT_GE(*std::min_element(errors.values.begin(), errors.values.end()), 0.0F) << name;
  }
  // Filters spread an error to neighbours; a difference of pixels does not.
  EXPECT_EQ(errorPlane(image, reference, MapMetric::absolute).row(20)[41], 0.0F);
  EXPECT_GT(errorPlane(image, reference, MapMetric::ssim).row(20)[41], 0.0F);
}

TEST(ErrorMap, NamesAndKindsOfImagesAreChecked) {
  EXPECT_THAT(messageOf<InputError>([] { parseMapMetric("flop"); }), HasSubstr("flip_hdr"));
  const std::string message = messageOf<InputError>(
      [] { errorPlane(makeFlat(3, 3, 0, true), makeFlat(3, 3, 0), MapMetric::flipHdr); });
  EXPECT_THAT(message, HasSubstr("linear"));
}

TEST(ErrorMap, ValuesAsAnImageAreGrey) {
  Plane<float> plane(2, 1);
  plane.values = {0.25F, 7.0F};
  const Image image = planeImage(plane);
  EXPECT_FALSE(image.srgb);
  EXPECT_EQ(image.rgba, (std::vector<float>{0.25F, 0.25F, 0.25F, 1, 7, 7, 7, 1}));
}

TEST(ErrorMap, LegendRunsFromDarkToBright) {
  const Image map = errorMap(makeFlat(100, 4, 0), makeFlat(100, 4, 0), 0.1F);
  // With unit 1 the bar starts after a margin of 2, a digit of 3 and a gap of 2. It ends at the
  // same distance from the three characters of 0.1 on the right.
  const int y = 4 + 2;
  const int right = 100 - 2 - tinyTextWidth("0.1", 1) - 2 - 1;
  EXPECT_EQ(colorAt(map, 7, y), infernoColor(0));
  EXPECT_EQ(colorAt(map, right, y), infernoColor(1));
  EXPECT_EQ(colorAt(map, 2, y), (std::array<float, 3>{1, 1, 1}));  // a corner of the digit 0
}

TEST(ErrorMap, SmallImagesGetRoomForTheLegend) {
  const Image map = errorMap(makeFlat(1, 1, 0), makeFlat(1, 1, 0), 0.00123F);
  EXPECT_GE(map.width, 64);
  EXPECT_EQ(map.rgba.size(), std::size_t(map.width) * map.height * 4);
}

TEST(InfernoColor, GetsLighterAllTheWay) {
  double last = -1;
  for (int i = 0; i <= 100; ++i) {
    const auto [r, g, b] = infernoColor(i / 100.0);
    const double luminance =
        0.2126 * srgbDecode(r) + 0.7152 * srgbDecode(g) + 0.0722 * srgbDecode(b);
    EXPECT_GT(luminance, last) << i;
    last = luminance;
  }
  EXPECT_EQ(infernoColor(-1), infernoColor(0));
  EXPECT_EQ(infernoColor(2), infernoColor(1));
}

TEST(TinyText, DrawsADigitAndClips) {
  Image image = makeFlat(3, 5, 0);
  drawTinyText(image, 0, 0, 1, "7", {1, 1, 1});
  std::string picture;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) picture += image.rgba[i] > 0 ? '#' : '.';
  EXPECT_EQ(picture, "###..#.#.#..#..");
  EXPECT_EQ(tinyTextWidth("0.1", 2), 22);
  drawTinyText(image, -2, -2, 3, "88", {1, 1, 1});  // beyond every edge
}

}  // namespace
}  // namespace oitlab
