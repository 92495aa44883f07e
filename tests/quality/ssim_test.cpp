#include "quality/ssim.h"

#include <cmath>

#include <gtest/gtest.h>

namespace oitlab {
namespace {

Image makeGrey(int width, int height, float value, bool srgb = true) {
  return {width, height, srgb, std::vector<float>(std::size_t(width) * height * 4, value)};
}

TEST(Ssim, EqualImagesAreOne) {
  Image image = makeGrey(20, 15, 0.2F);
  image.at(7, 7)[1] = 0.9F;
  EXPECT_DOUBLE_EQ(computeSsim(image, image).mean.value(), 1);
}

TEST(Ssim, FlatImagesDifferInLuminanceAlone) {
  // Wang et al. 2004, eq. 13 without variances: (2 a b + C1) / (a^2 + b^2 + C1), C1 = 0.0001.
  const double wanted = (2 * 0.5 * 0.25 + 1e-4) / (0.25 + 0.0625 + 1e-4);
  EXPECT_NEAR(computeSsim(makeGrey(11, 11, 0.5F), makeGrey(11, 11, 0.25F)).mean.value(), wanted,
              1e-9);
}

TEST(Ssim, AFlippedPixelAgainstFlatGreyIsAsWorkedOutByHand) {
  // One window, in which only the centre pixel with weight w differs: means m and m + w d,
  // variances 0 and w d^2 (1 - w), covariance 0.
  Image image = makeGrey(11, 11, 0.5F);
  for (int c = 0; c < 3; ++c) image.at(5, 5)[c] = 1.0F;
  double sum = 0;
  for (int i = -5; i <= 5; ++i) sum += std::exp(-0.5 * i * i / 2.25);
  const double w = 1 / (sum * sum), mean = 0.5 + 0.5 * w, variance = 0.25 * w * (1 - w);
  const double wanted =
      (2 * 0.5 * mean + 1e-4) / (0.25 + mean * mean + 1e-4) * 9e-4 / (variance + 9e-4);
  EXPECT_NEAR(computeSsim(image, makeGrey(11, 11, 0.5F)).mean.value(), wanted, 1e-9);
  EXPECT_NEAR(computeSsim(makeGrey(11, 11, 0.5F), image).mean.value(), wanted, 1e-9);
}

TEST(Ssim, ChannelsAreAveragedAndTheBorderIsLeftOut) {
  const Image reference = makeGrey(12, 11, 0.5F);
  Image image = reference;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) image.rgba[i] = 0.25F;
  const double red = (2 * 0.5 * 0.25 + 1e-4) / (0.25 + 0.0625 + 1e-4);
  EXPECT_NEAR(computeSsim(image, reference).mean.value(), (red + 2) / 3, 1e-9);
  // Column 11 is in the window of column 6 and not in that of column 5.
  Image edge = reference;
  for (int y = 0; y < 11; ++y) edge.at(11, y)[0] = 1;
  const Ssim ssim = computeSsim(edge, reference);
  EXPECT_DOUBLE_EQ(ssim.map.row(5)[5], 1);
  EXPECT_LT(ssim.map.row(5)[6], 1);
  EXPECT_DOUBLE_EQ(*ssim.mean, (ssim.map.row(5)[5] + ssim.map.row(5)[6]) / 2);
}

TEST(Ssim, LinearImagesAreClampedAndEncodedFirst) {
  const double wanted =
      *computeSsim(makeGrey(11, 11, srgbEncode(0.25F)), makeGrey(11, 11, 1.0F)).mean;
  const double found =
      *computeSsim(makeGrey(11, 11, 0.25F, false), makeGrey(11, 11, 7.0F, false)).mean;
  EXPECT_NEAR(found, wanted, 1e-6);  // srgbEncode(1) is slightly below 1
}

TEST(Ssim, WithoutAWholeWindowThereIsNoMean) {
  EXPECT_FALSE(computeSsim(makeGrey(10, 40, 0.5F), makeGrey(10, 40, 0.5F)).mean.has_value());
  EXPECT_TRUE(computeSsim(makeGrey(11, 11, 0.5F), makeGrey(11, 11, 0.5F)).mean.has_value());
}

}  // namespace
}  // namespace oitlab
