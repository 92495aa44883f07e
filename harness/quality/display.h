#pragma once

#include "image/image.h"
#include "quality/plane.h"

namespace oitlab {

// The input of the perceptual metrics. NaN and infinity become 0, so that they do not spread
// through a filter. What they mean for the metric is up to the caller.

/// What a display shows, sRGB-encoded: linear values are clamped to [0, 1] and encoded; encoded
/// values are clamped.
Planes<double> displayEncoded(const Image& image);

/// What a display emits: the same clamped values, linear in [0, 1].
Planes<float> displayLinear(const Image& image);

/// Linear, without an upper limit. Negative values become 0.
Planes<float> sceneLinear(const Image& image);

}  // namespace oitlab
