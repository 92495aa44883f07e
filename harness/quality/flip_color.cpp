#include "quality/flip_color.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace oitlab {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

constexpr double determinant(const Matrix& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

constexpr Matrix inverse(const Matrix& m) {
  Matrix result{};
  const double d = determinant(m);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t r = (j + 1) % 3, s = (j + 2) % 3, t = (i + 1) % 3, u = (i + 2) % 3;
      result[i][j] = (m[r][t] * m[s][u] - m[r][u] * m[s][t]) / d;
    }
  return result;
}

/// The matrix from linear sRGB to XYZ, computed from the chromaticities of IEC 61966-2-1, because
/// printed matrices are rounded.
constexpr Matrix makeRgbToXyz() {
  constexpr double xs[3] = {0.64, 0.30, 0.15}, ys[3] = {0.33, 0.60, 0.06};
  constexpr double whiteX = 0.3127, whiteY = 0.3290;  // D65
  Matrix primaries{};
  for (std::size_t c = 0; c < 3; ++c) {
    primaries[0][c] = xs[c];
    primaries[1][c] = ys[c];
    primaries[2][c] = 1 - xs[c] - ys[c];
  }
  const double white[3] = {whiteX / whiteY, 1, (1 - whiteX - whiteY) / whiteY};
  const Matrix fromPrimaries = inverse(primaries);
  for (std::size_t c = 0; c < 3; ++c) {
    double amount = 0;
    for (std::size_t k = 0; k < 3; ++k) amount += fromPrimaries[c][k] * white[k];
    for (std::size_t row = 0; row < 3; ++row) primaries[row][c] *= amount;
  }
  return primaries;
}

/// From linear sRGB to XYZ divided by the XYZ of white, the only form that is used here.
constexpr Matrix makeRgbToWhiteXyz() {
  Matrix m = makeRgbToXyz();
  for (auto& row : m) {
    const double white = row[0] + row[1] + row[2];
    for (double& value : row) value /= white;
  }
  return m;
}

constexpr Matrix rgbToXyz = makeRgbToWhiteXyz();
constexpr Matrix xyzToRgb = inverse(rgbToXyz);

Color3 transform(const Matrix& m, const Color3& v) {
  Color3 result{};
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = float(m[i][0]) * v[0] + float(m[i][1]) * v[1] + float(m[i][2]) * v[2];
  return result;
}

/// The f of CIELAB.
float labCurve(float t) {
  constexpr float delta = 6.0F / 29.0F;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0F / 29.0F;
}

/// A sum of two Gaussians, a1 sqrt(pi / b1) exp(-pi^2 x^2 / b1) + ..., x in degrees: the inverse
/// Fourier transform of a contrast sensitivity function (Andersson et al. 2020, eq. 3, table 1).
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity achromatic{1.0, 0.0047, 0.0, 1.0};
constexpr Sensitivity redGreen{1.0, 0.0053, 0.0, 1.0};
constexpr Sensitivity blueYellow{34.1, 0.04, 13.5, 0.025};

/// The radius in pixels: three standard deviations of the widest Gaussian, for all channels
/// (section 4.1.1).
int filterRadius(double pixelsPerDegree) {
  return int(std::ceil(3 * std::sqrt(blueYellow.b1 / (2 * std::numbers::pi * std::numbers::pi)) *
                       pixelsPerDegree));
}

std::vector<double> gaussian(double b, int radius, double pixelsPerDegree) {
  std::vector<double> taps;
  for (int i = -radius; i <= radius; ++i) {
    const double x = i / pixelsPerDegree;
    taps.push_back(std::exp(-std::numbers::pi * std::numbers::pi * x * x / b));
  }
  return taps;
}

double sumOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

/// Both Gaussians are products of one in x and one in y, so the filter is a sum of two separable
/// filters. Its two-dimensional weights add up to 1.
Plane<float> filterBy(const Sensitivity& s, const Plane<float>& plane, double pixelsPerDegree) {
  const int radius = filterRadius(pixelsPerDegree);
  const auto first = gaussian(s.b1, radius, pixelsPerDegree);
  const auto second = gaussian(s.b2, radius, pixelsPerDegree);
  const double scale1 = s.a1 * std::sqrt(std::numbers::pi / s.b1);
  const double scale2 = s.a2 * std::sqrt(std::numbers::pi / s.b2);
  const double total =
      scale1 * sumOf(first) * sumOf(first) + scale2 * sumOf(second) * sumOf(second);
  const auto filter = [&](const std::vector<double>& taps, double scale) {
    std::vector<float> kernel;
    for (const double tap : taps) kernel.push_back(float(tap * std::sqrt(scale / total)));
    // Taps that are too small to change a float are left out, because they cost as much as others.
    while (kernel.size() > 1 && kernel.front() < 1e-9F) {
      kernel.erase(kernel.begin());
      kernel.pop_back();
    }
    return filterSeparable<float>(plane, kernel, kernel);
  };
  Plane<float> result = filter(first, scale1);
  if (s.a2 == 0) return result;
  const Plane<float> rest = filter(second, scale2);
  forEachPixel(result, [&](std::size_t i) { result.values[i] += rest.values[i]; });
  return result;
}

/// Calls change(colour) for every pixel, on all cores.
template <typename Change>
void changeColors(Planes<float>& planes, Change&& change) {
  forEachPixel(planes[0], [&](std::size_t i) {
    const Color3 color =
        change(Color3{planes[0].values[i], planes[1].values[i], planes[2].values[i]});
    for (std::size_t c = 0; c < 3; ++c) planes[c].values[i] = color[c];
  });
}

}  // namespace

float luminance(const Color3& rgb) {
  return transform(rgbToXyz, rgb)[1];
}

Color3 toYCxCz(const Color3& rgb) {
  const auto [x, y, z] = transform(rgbToXyz, rgb);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Color3 fromYCxCz(const Color3& yCxCz) {
  const float y = (yCxCz[0] + 16) / 116;
  return transform(xyzToRgb, {y + yCxCz[1] / 500, y, y - yCxCz[2] / 200});
}

Color3 toHuntLab(const Color3& rgb) {
  const Color3 xyz = transform(rgbToXyz, rgb);
  const float x = labCurve(xyz[0]), y = labCurve(xyz[1]), z = labCurve(xyz[2]);
  const float lightness = 116 * y - 16;
  return {lightness, 0.01F * lightness * 500 * (x - y), 0.01F * lightness * 200 * (y - z)};
}

float hyAb(const Color3& a, const Color3& b) {
  const float da = a[1] - b[1], db = a[2] - b[2];
  return std::abs(a[0] - b[0]) + std::sqrt(da * da + db * db);
}

Planes<float> perceivedColors(const Planes<float>& rgb, double pixelsPerDegree) {
  Planes<float> planes = rgb;
  changeColors(planes, toYCxCz);
  constexpr const Sensitivity* sensitivities[] = {&achromatic, &redGreen, &blueYellow};
  for (std::size_t c = 0; c < 3; ++c)
    planes[c] = filterBy(*sensitivities[c], planes[c], pixelsPerDegree);
  changeColors(planes, [](const Color3& filtered) {
    Color3 shown = fromYCxCz(filtered);
    for (float& value : shown) value = std::clamp(value, 0.0F, 1.0F);
    return toHuntLab(shown);
  });
  return planes;
}

float flipColorDifference(const Color3& a, const Color3& b) {
  // Section 4.1.2: large differences are compressed into the last 5% of the range.
  constexpr float qc = 0.7F, pc = 0.4F, pt = 0.95F;
  static const float largest =
      std::pow(hyAb(toHuntLab({0, 1, 0}), toHuntLab({0, 0, 1})), qc);  // green against blue
  const float difference = std::pow(hyAb(a, b), qc);
  const float knee = pc * largest;
  if (difference < knee) return pt / knee * difference;
  return pt + (difference - knee) / (largest - knee) * (1 - pt);
}

}  // namespace oitlab
