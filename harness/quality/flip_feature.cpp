#include "quality/flip_feature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace oitlab {
namespace {

/// Width in degrees of the detectors of the human eye (Andersson et al. 2020, section 4.2.1).
constexpr double detectorWidth = 0.082;

struct Kernels {
  std::vector<float> smooth, edge, point;
};

/// Scales the positive weights to a sum of 1 and the negative weights to a sum of -1.
std::vector<float> balance(const std::vector<double>& taps) {
  double positive = 0, negative = 0;
  for (const double tap : taps) (tap > 0 ? positive : negative) += tap;
  std::vector<float> result;
  for (const double tap : taps) result.push_back(float(tap > 0 ? tap / positive : -tap / negative));
  return result;
}

Kernels makeKernels(double pixelsPerDegree) {
  const double sigma = 0.5 * detectorWidth * pixelsPerDegree;
  const int radius = int(std::ceil(3 * sigma));
  std::vector<double> smooth, edge, point;
  double sum = 0;
  for (int x = -radius; x <= radius; ++x) {
    const double weight = std::exp(-0.5 * x * x / (sigma * sigma));
    sum += weight;
    smooth.push_back(weight);
    edge.push_back(-x * weight);
    point.push_back((x * x / (sigma * sigma) - 1) * weight);
  }
  Kernels kernels{{}, balance(edge), balance(point)};
  for (const double weight : smooth) kernels.smooth.push_back(float(weight / sum));
  return kernels;
}

Plane<float> lengths(const Plane<float>& x, const Plane<float>& y) {
  Plane<float> result(x.width, x.height);
  forEachPixel(result, [&](std::size_t i) {
    result.values[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
  });
  return result;
}

}  // namespace

Features detectFeatures(const Plane<float>& luminance, double pixelsPerDegree) {
  const Kernels kernels = makeKernels(pixelsPerDegree);
  const auto columns = [&](const Plane<float>& plane, const std::vector<float>& kernel) {
    return filterColumns<float>(plane, kernel);
  };
  const Plane<float> smooth = filterRows<float>(luminance, kernels.smooth);
  const Plane<float> edge = filterRows<float>(luminance, kernels.edge);
  const Plane<float> point = filterRows<float>(luminance, kernels.point);
  return {lengths(columns(edge, kernels.smooth), columns(smooth, kernels.edge)),
          lengths(columns(point, kernels.smooth), columns(smooth, kernels.point))};
}

float flipFeatureDifference(float edgeA, float edgeB, float pointA, float pointB) {
  constexpr float invSqrt2 = float(1 / std::numbers::sqrt2);  // the largest length is sqrt(2)
  // q_f = 0.5
  return std::sqrt(invSqrt2 * std::max(std::abs(edgeA - edgeB), std::abs(pointA - pointB)));
}

}  // namespace oitlab
