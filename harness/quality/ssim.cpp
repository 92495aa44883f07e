#include "quality/ssim.h"

#include <cmath>

#include "quality/display.h"
#include "util/check.h"

namespace oitlab {
namespace {

// Wang et al. 2004, section III.B and C. The window there is 11 x 11.
constexpr int radius = (minSsimSide - 1) / 2;
constexpr double sigma = 1.5;
constexpr double c1 = 0.01 * 0.01;  // (K1 L)^2, eq. 7, with L = 1
constexpr double c2 = 0.03 * 0.03;  // (K2 L)^2, eq. 9

std::array<double, 2 * radius + 1> makeWindow() {
  std::array<double, 2 * radius + 1> window{};
  double sum = 0;
  for (int i = -radius; i <= radius; ++i)
    sum += window[std::size_t(i + radius)] = std::exp(-0.5 * i * i / (sigma * sigma));
  for (double& weight : window) weight /= sum;
  return window;
}

/// Adds one third of the similarity of one channel to the map.
void addChannel(Plane<double>& map, const Plane<double>& a, const Plane<double>& b) {
  const auto window = makeWindow();
  const auto blur = [&](const Plane<double>& plane) {
    return filterSeparable<double>(plane, window, window);
  };
  const auto blurProduct = [&](const Plane<double>& p, const Plane<double>& q) {
    Plane<double> product(p.width, p.height);
    forEachPixel(product, [&](std::size_t i) { product.values[i] = p.values[i] * q.values[i]; });
    return blur(product);
  };
  const Plane<double> meanA = blur(a), meanB = blur(b);
  const Plane<double> squareA = blurProduct(a, a), squareB = blurProduct(b, b);
  const Plane<double> mixed = blurProduct(a, b);
  forEachPixel(map, [&](std::size_t i) {
    const double ma = meanA.values[i], mb = meanB.values[i];
    const double varianceA = squareA.values[i] - ma * ma;
    const double varianceB = squareB.values[i] - mb * mb;
    const double covariance = mixed.values[i] - ma * mb;
    // Eq. 13.
    const double similarity = ((2 * ma * mb + c1) * (2 * covariance + c2)) /
                              ((ma * ma + mb * mb + c1) * (varianceA + varianceB + c2));
    map.values[i] += similarity / 3;
  });
}

}  // namespace

Ssim computeSsim(const Image& image, const Image& reference) {
  OITLAB_CHECK(image.width == reference.width && image.height == reference.height);
  const Planes<double> a = displayEncoded(image);
  const Planes<double> b = displayEncoded(reference);
  Ssim result;
  result.map = Plane<double>(image.width, image.height);
  for (std::size_t c = 0; c < 3; ++c) addChannel(result.map, a[c], b[c]);

  const int insideWidth = image.width - 2 * radius, insideHeight = image.height - 2 * radius;
  if (insideWidth < 1 || insideHeight < 1) return result;
  double sum = 0;
  for (int y = radius; y < image.height - radius; ++y)
    for (int x = radius; x < image.width - radius; ++x) sum += result.map.row(y)[x];
  result.mean = sum / (double(insideWidth) * double(insideHeight));
  return result;
}

}  // namespace oitlab
