#pragma once

#include "image/image.h"
#include "quality/plane.h"

namespace oitlab {

// What the metrics of perception look at. In all of them a NaN or infinity counts as 0: what that
// means for the metric is up to the caller, but it must not spread through a filter.

/// What a display shows, sRGB-encoded: linear values are clamped to [0, 1] and encoded, encoded
/// ones are clamped.
Planes<double> displayEncoded(const Image& image);

/// What a display emits: the same clamped values, linear in [0, 1].
Planes<float> displayLinear(const Image& image);

/// Linear and as bright as it is; negative values count as 0.
Planes<float> sceneLinear(const Image& image);

}  // namespace oitlab
