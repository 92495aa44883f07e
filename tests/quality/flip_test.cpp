#include "quality/flip.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "quality/flip_color.h"
#include "quality/flip_feature.h"
#include "util/random.h"

namespace oitlab {
namespace {

Image makeFlat(int width, int height, const Color3& color, bool srgb = true) {
  Image image{width, height, srgb, std::vector<float>(std::size_t(width) * height * 4, 1.0F)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) std::copy(color.begin(), color.end(), image.at(x, y));
  return image;
}

Image makeNoise(int width, int height, std::uint64_t seed, float scale = 1, bool srgb = true) {
  Image image = makeFlat(width, height, {0, 0, 0}, srgb);
  Pcg32 random(seed);
  for (float& value : image.rgba) value = scale * random.uniform();
  return image;
}

TEST(FlipColor, KnownColors) {
  // White is the white of both spaces. The CIELAB values of the primaries are in published tables.
  const Color3 white = toHuntLab({1, 1, 1});
  EXPECT_NEAR(white[0], 100, 1e-3);
  EXPECT_NEAR(white[1], 0, 1e-3);
  EXPECT_NEAR(white[2], 0, 1e-3);
  const Color3 green = toHuntLab({0, 1, 0}), blue = toHuntLab({0, 0, 1});
  EXPECT_NEAR(green[0], 87.735, 0.01);
  EXPECT_NEAR(green[1], -86.183 * 0.87735, 0.02);
  EXPECT_NEAR(green[2], 83.180 * 0.87735, 0.02);
  EXPECT_NEAR(blue[0], 32.297, 0.01);
  EXPECT_NEAR(blue[1], 79.188 * 0.32297, 0.02);
  EXPECT_NEAR(blue[2], -107.860 * 0.32297, 0.02);
  EXPECT_NEAR(luminance({1, 0, 0}), 0.2126, 1e-4);
  const Color3 grey = toYCxCz({0.5F, 0.5F, 0.5F});
  EXPECT_NEAR(grey[0], 116 * 0.5 - 16, 1e-4);
  EXPECT_NEAR(grey[1], 0, 1e-4);
  const Color3 back = fromYCxCz(toYCxCz({0.2F, 0.7F, 0.4F}));
  EXPECT_NEAR(back[0], 0.2, 1e-6);
  EXPECT_NEAR(back[1], 0.7, 1e-6);
  EXPECT_NEAR(back[2], 0.4, 1e-6);
}

TEST(FlipColor, DistancesAreRedistributedInTwoPieces) {
  EXPECT_FLOAT_EQ(hyAb({50, 3, 0}, {40, 0, 4}), 15);  // 10 + a 3-4-5 triangle
  const Color3 green = toHuntLab({0, 1, 0}), blue = toHuntLab({0, 0, 1});
  EXPECT_FLOAT_EQ(flipColorDifference(green, blue), 1);
  EXPECT_FLOAT_EQ(flipColorDifference(green, green), 0);
  // At the knee, 0.4 of the largest difference, it is 0.95, and at half of the knee half of that.
  const double largest = std::pow(hyAb(green, blue), 0.7);
  const auto at = [](double powered) {
    return flipColorDifference({float(std::pow(powered, 1 / 0.7)), 0, 0}, {0, 0, 0});
  };
  EXPECT_NEAR(at(0.4 * largest), 0.95, 1e-5);
  EXPECT_NEAR(at(0.2 * largest), 0.475, 1e-5);
  EXPECT_NEAR(at(0.7 * largest), 0.975, 1e-5);
}

TEST(FlipFeature, AnEdgeAndAPointAreFoundAndFlatIsNothing) {
  Plane<float> step(41, 41), flat(41, 41);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x) step.row(y)[x] = x >= 20 ? 1.0F : 0.0F;
  std::fill(flat.values.begin(), flat.values.end(), 0.7F);
  const Features none = detectFeatures(flat, flipPixelsPerDegree);
  const Features found = detectFeatures(step, flipPixelsPerDegree);
  EXPECT_NEAR(none.edges.row(20)[20], 0, 1e-6);
  EXPECT_NEAR(none.points.row(20)[20], 0, 1e-6);
  // The half of the kernel over white adds up to 1, and the other half is over black.
  EXPECT_NEAR(found.edges.row(20)[20], 1, 1e-5);
  EXPECT_NEAR(found.edges.row(20)[3], 0, 1e-6);
  // The same, rotated by 90 degrees.
  Plane<float> turned(41, 41);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x) turned.row(x)[y] = step.row(y)[x];
  EXPECT_NEAR(detectFeatures(turned, flipPixelsPerDegree).points.row(24)[20],
              found.points.row(20)[24], 1e-6);
  EXPECT_GT(found.points.row(20)[24], 0.1);
  EXPECT_NEAR(flipFeatureDifference(1, 0.5F, 0.2F, 0.3F), std::sqrt(0.5 / std::sqrt(2)), 1e-6);
}

TEST(Flip, FlatImagesAreTheirColorDifference) {
  EXPECT_EQ(computeFlip(makeFlat(30, 20, {0.3F, 0.9F, 0}), makeFlat(30, 20, {0.3F, 0.9F, 0})).mean,
            0);
  // Black and white differ by a lightness of 100, and 100^0.7 = 25.119. For green and blue the
  // power is 41.274, so the knee is 16.510 and the result 0.95 + 0.05 * (25.119 - 16.510) / (41.274
  // - 16.510).
  EXPECT_NEAR(computeFlip(makeFlat(30, 20, {0, 0, 0}), makeFlat(30, 20, {1, 1, 1})).mean, 0.96738,
              2e-5);
  EXPECT_NEAR(computeFlip(makeFlat(9, 3, {0, 1, 0}), makeFlat(9, 3, {0, 0, 1})).mean, 1, 1e-5);
}

TEST(Flip, IsSymmetricAndWithinItsRange) {
  const Image a = makeNoise(40, 31, 1), b = makeNoise(40, 31, 2);
  const Flip forth = computeFlip(a, b), back = computeFlip(b, a);
  EXPECT_EQ(forth.map.values, back.map.values);
  const auto [least, most] = std::minmax_element(forth.map.values.begin(), forth.map.values.end());
  EXPECT_GE(*least, 0);
  EXPECT_LE(*most, 1);
  EXPECT_GT(forth.mean, 0.1);
}

TEST(Flip, FineDetailIsForgivenFromAfar) {
  // A checkerboard of single pixels and its mean grey: less visible from farther away.
  Image board = makeFlat(64, 64, {0, 0, 0}, false);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c) board.at(x, y)[c] = float((x + y) % 2);
  const Image grey = makeFlat(64, 64, {0.5F, 0.5F, 0.5F}, false);
  const double near = computeFlip(board, grey, 10).mean;
  const double far = computeFlip(board, grey, 67).mean;
  EXPECT_LT(far, 0.2 * near);
  EXPECT_GT(near, 0.3);
}

TEST(Flip, LinearImagesAreWhatADisplayShows) {
  const Flip shown = computeFlip(makeFlat(20, 20, {1, 0.5F, 0}), makeFlat(20, 20, {0, 0, 0}));
  const Flip linear = computeFlip(makeFlat(20, 20, {3, srgbDecode(0.5F), -1}, false),
                                  makeFlat(20, 20, {0, 0, 0}, false));
  EXPECT_NEAR(linear.mean, shown.mean, 1e-6);
}

TEST(HdrFlip, ExposuresAreThoseOfBrightestAndMedian) {
  // 3 x 3 pixels: one of 16, five of 1, three of 0.5. ACES of x with the factor 0.6 is 0.85 where
  // (0.9036 - 0.85 * 0.8748) x^2 + (0.018 - 0.85 * 0.354) x - 0.85 * 0.14 = 0: x = 2.1745.
  Image reference = makeFlat(3, 3, {1, 1, 1}, false);
  for (int c = 0; c < 3; ++c) {
    reference.at(1, 1)[c] = 16;
    for (int x = 0; x < 3; ++x) reference.at(x, 2)[c] = 0.5F;
  }
  const ExposureRange range = flipExposures(reference);
  const double a = 0.9036 - 0.85 * 0.8748, b = 0.018 - 0.85 * 0.354, c = -0.85 * 0.14;
  const double bright = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
  EXPECT_NEAR(range.first, std::log2(bright / 16), 1e-5);
  EXPECT_NEAR(range.last, std::log2(bright), 1e-5);
  EXPECT_EQ(range.count, 4);
}

TEST(HdrFlip, BlackReferencesHaveExposuresToo) {
  const ExposureRange black = flipExposures(makeFlat(3, 3, {0, 0, 0}, false));
  EXPECT_EQ(black.first, 0);
  EXPECT_EQ(black.last, 0);
  EXPECT_EQ(black.count, 2);
  Image night = makeFlat(5, 1, {0, 0, 0}, false);
  for (int c = 0; c < 3; ++c) night.at(2, 0)[c] = 4;
  const ExposureRange range = flipExposures(night);
  EXPECT_DOUBLE_EQ(range.first, range.last);
  EXPECT_TRUE(std::isfinite(computeHdrFlip(night, night).mean));
}

TEST(HdrFlip, SeesWhatTheDisplayClampsAway) {
  const Image dim = makeFlat(20, 20, {2, 2, 2}, false), bright = makeFlat(20, 20, {8, 8, 8}, false);
  EXPECT_EQ(computeFlip(bright, dim).mean, 0);
  EXPECT_GT(computeHdrFlip(bright, dim).mean, 0.1);
  EXPECT_EQ(computeHdrFlip(dim, dim).mean, 0);
}

TEST(HdrFlip, TheUnitOfLightIsOfNoMatter) {
  const Image a = makeNoise(30, 20, 5, 1, false), b = makeNoise(30, 20, 6, 1, false);
  Image brightA = a, brightB = b;
  for (float& value : brightA.rgba) value *= 1024;
  for (float& value : brightB.rgba) value *= 1024;
  EXPECT_NEAR(computeHdrFlip(brightA, brightB).mean, computeHdrFlip(a, b).mean, 1e-5);
}

}  // namespace
}  // namespace oitlab
