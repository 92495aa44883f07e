#include "quality/display.h"

#include <algorithm>
#include <cmath>

#include "util/parallel.h"

namespace oitlab {
namespace {

template <typename T, typename Convert>
Planes<T> convertChannels(const Image& image, Convert&& convert) {
  Planes<T> planes;
  for (Plane<T>& plane : planes) plane = Plane<T>(image.width, image.height);
  parallelFor(std::size_t(image.height), [&](std::size_t y) {
    const float* from = image.at(0, int(y));
    for (std::size_t c = 0; c < 3; ++c) {
      T* to = planes[c].row(int(y));
      for (int x = 0; x < image.width; ++x) {
        const float value = from[4 * x + int(c)];
        to[x] = std::isfinite(value) ? T(convert(value)) : T(0);
      }
    }
  });
  return planes;
}

}  // namespace

Planes<double> displayEncoded(const Image& image) {
  return convertChannels<double>(image, [&](float value) {
    const float clamped = std::clamp(value, 0.0F, 1.0F);
    return image.srgb ? clamped : srgbEncode(clamped);
  });
}

Planes<float> displayLinear(const Image& image) {
  return convertChannels<float>(image, [&](float value) {
    const float clamped = std::clamp(value, 0.0F, 1.0F);
    return image.srgb ? srgbDecode(clamped) : clamped;
  });
}

Planes<float> sceneLinear(const Image& image) {
  return convertChannels<float>(image, [&](float value) {
    const float positive = std::max(value, 0.0F);
    return image.srgb ? srgbDecode(positive) : positive;
  });
}

}  // namespace oitlab
