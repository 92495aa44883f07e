#include "quality/plane.h"

#include <algorithm>

#include "util/check.h"
#include "util/parallel.h"

namespace oitlab {
namespace {

/// The number of pixels whose sums are in registers. It is constant, so that -O2 vectorizes the
/// loop.
constexpr std::size_t block = 16;

/// to[x] = the sum over k of kernel[k] * source(k)[x] for x in [0, width).
template <typename T, typename Source>
void weightedSum(T* to, std::size_t width, std::span<const T> kernel, Source&& source) {
  std::size_t x = 0;
  for (; x + block <= width; x += block) {
    T sums[block] = {};
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const T weight = kernel[k];
      const T* from = source(k) + x;
      for (std::size_t i = 0; i < block; ++i) sums[i] += weight * from[i];
    }
    std::copy_n(sums, block, to + x);
  }
  for (; x < width; ++x) {
    T sum = 0;
    for (std::size_t k = 0; k < kernel.size(); ++k) sum += kernel[k] * source(k)[x];
    to[x] = sum;
  }
}

}  // namespace

template <typename T>
Plane<T> filterRows(const Plane<T>& plane, std::span<const T> kernel) {
  OITLAB_CHECK_OP(kernel.size() % 2, ==, std::size_t(1));
  const auto radius = int(kernel.size() / 2);
  Plane<T> result(plane.width, plane.height);
  parallelFor(std::size_t(plane.height), [&](std::size_t y) {
    const T* from = plane.row(int(y));
    // A copy with repeated edges, so that the inner loop has no branch.
    std::vector<T> padded(std::size_t(plane.width) + 2 * std::size_t(radius));
    for (int x = -radius; x < plane.width + radius; ++x)
      padded[std::size_t(x + radius)] = from[std::clamp(x, 0, plane.width - 1)];
    weightedSum(result.row(int(y)), std::size_t(plane.width), kernel,
                [&](std::size_t k) { return padded.data() + k; });
  });
  return result;
}

template <typename T>
Plane<T> filterColumns(const Plane<T>& plane, std::span<const T> kernel) {
  OITLAB_CHECK_OP(kernel.size() % 2, ==, std::size_t(1));
  const auto radius = int(kernel.size() / 2);
  Plane<T> result(plane.width, plane.height);
  parallelFor(std::size_t(plane.height), [&](std::size_t y) {
    weightedSum(result.row(int(y)), std::size_t(plane.width), kernel, [&](std::size_t k) {
      return plane.row(std::clamp(int(y) + int(k) - radius, 0, plane.height - 1));
    });
  });
  return result;
}

template <typename T>
Plane<T> filterSeparable(const Plane<T>& plane, std::span<const T> horizontal,
                         std::span<const T> vertical) {
  return filterColumns(filterRows(plane, horizontal), vertical);
}

template Plane<float> filterRows(const Plane<float>&, std::span<const float>);
template Plane<double> filterRows(const Plane<double>&, std::span<const double>);
template Plane<float> filterColumns(const Plane<float>&, std::span<const float>);
template Plane<double> filterColumns(const Plane<double>&, std::span<const double>);
template Plane<float> filterSeparable(const Plane<float>&, std::span<const float>,
                                      std::span<const float>);
template Plane<double> filterSeparable(const Plane<double>&, std::span<const double>,
                                       std::span<const double>);

}  // namespace oitlab
