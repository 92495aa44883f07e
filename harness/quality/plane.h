#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "util/parallel.h"

namespace oitlab {

/// One number per pixel, rows top to bottom.
template <typename T>
struct Plane {
  Plane() = default;
  Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * std::size_t(h)) {}

  T* row(int y) { return values.data() + std::size_t(y) * width; }
  const T* row(int y) const { return values.data() + std::size_t(y) * width; }

  int width = 0;
  int height = 0;
  std::vector<T> values;
};

/// Calls work(i) once for the index i of each value, with rows in parallel on all cores.
template <typename T, typename Work>
void forEachPixel(const Plane<T>& plane, Work&& work) {
  parallelFor(std::size_t(plane.height), [&](std::size_t y) {
    const std::size_t first = y * std::size_t(plane.width);
    for (std::size_t i = first; i < first + std::size_t(plane.width); ++i) work(i);
  });
}

/// R, G and B, or the channels of another colour space.
template <typename T>
using Planes = std::array<Plane<T>, 3>;

/// Correlates with the product of two centred kernels of odd length: `horizontal` along the rows,
/// then `vertical`. Values at the edge are repeated beyond it. Runs on all cores. For float and
/// double; sums are in T.
template <typename T>
Plane<T> filterSeparable(const Plane<T>& plane, std::span<const T> horizontal,
                         std::span<const T> vertical);

/// The two steps, for filters that share the first one.
template <typename T>
Plane<T> filterRows(const Plane<T>& plane, std::span<const T> kernel);
template <typename T>
Plane<T> filterColumns(const Plane<T>& plane, std::span<const T> kernel);

}  // namespace oitlab
