"""FLIP in float64 numpy, written from the papers apart from the C++: full two-dimensional kernels,
no separation, no shortcut. Slow; what the program is held against.

Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images" (sections named below);
Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images".
Images are (height, width, 3) arrays of linear sRGB.
"""

from __future__ import annotations

import numpy
from scipy.ndimage import correlate

PIXELS_PER_DEGREE = 0.7 * 3840 / 0.7 * numpy.pi / 180  # distance * pixels / width
# Section 4.1.1, table 1: a1, b1, a2, b2 of the achromatic, red-green and blue-yellow filters.
CSF = ((1, 0.0047, 0, 1e-5), (1, 0.0053, 0, 1e-5), (34.1, 0.04, 13.5, 0.025))


def srgb_to_linear(encoded: numpy.ndarray) -> numpy.ndarray:
    return numpy.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def linear_to_srgb(linear: numpy.ndarray) -> numpy.ndarray:
    return numpy.where(linear <= 0.0031308, linear * 12.92,
                       1.055 * numpy.maximum(linear, 1e-12) ** (1 / 2.4) - 0.055)


def _xyz_matrix() -> numpy.ndarray:
    """From the chromaticities of sRGB's primaries and of D65."""
    xy = numpy.array([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]])
    xyz = numpy.column_stack([xy[:, 0] / xy[:, 1], numpy.ones(4), (1 - xy.sum(axis=1)) / xy[:, 1]])
    amounts = numpy.linalg.solve(xyz[:3].T, xyz[3])
    return xyz[:3].T * amounts


TO_XYZ = _xyz_matrix()
WHITE = TO_XYZ @ numpy.ones(3)


def to_opponent(rgb: numpy.ndarray) -> numpy.ndarray:
    x, y, z = numpy.moveaxis(rgb @ TO_XYZ.T / WHITE, -1, 0)
    return numpy.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def from_opponent(opponent: numpy.ndarray) -> numpy.ndarray:
    y = (opponent[..., 0] + 16) / 116
    xyz = numpy.stack([opponent[..., 1] / 500 + y, y, y - opponent[..., 2] / 200], axis=-1)
    return xyz * WHITE @ numpy.linalg.inv(TO_XYZ).T


def to_hunt_lab(rgb: numpy.ndarray) -> numpy.ndarray:
    xyz = rgb @ TO_XYZ.T / WHITE
    f = numpy.where(xyz > (6 / 29) ** 3, numpy.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    lightness = 116 * f[..., 1] - 16
    a, b = 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])
    return numpy.stack([lightness, 0.01 * lightness * a, 0.01 * lightness * b], axis=-1)


def hyab(p: numpy.ndarray, q: numpy.ndarray) -> numpy.ndarray:
    d = p - q
    return numpy.abs(d[..., 0]) + numpy.hypot(d[..., 1], d[..., 2])


def _squared_distances(radius: int) -> numpy.ndarray:
    y, x = numpy.mgrid[-radius:radius + 1, -radius:radius + 1]
    return (x**2 + y**2).astype(float)


def spatially_filtered(opponent: numpy.ndarray, ppd: float) -> numpy.ndarray:
    widest = max(max(b1, b2) for _, b1, _, b2 in CSF)
    radius = int(numpy.ceil(3 * numpy.sqrt(widest / (2 * numpy.pi**2)) * ppd))
    squares = _squared_distances(radius) / ppd**2
    filtered = numpy.empty_like(opponent)
    for channel, (a1, b1, a2, b2) in enumerate(CSF):
        kernel = sum(a * numpy.sqrt(numpy.pi / b) * numpy.exp(-(numpy.pi**2) * squares / b)
                     for a, b in ((a1, b1), (a2, b2)))
        filtered[..., channel] = correlate(opponent[..., channel], kernel / kernel.sum(),
                                           mode="nearest")
    return filtered


def colour_difference(a: numpy.ndarray, b: numpy.ndarray, ppd: float) -> numpy.ndarray:
    """Section 4.1."""
    qc, pc, pt = 0.7, 0.4, 0.95
    labs = [to_hunt_lab(from_opponent(spatially_filtered(to_opponent(i), ppd)).clip(0, 1))
            for i in (a, b)]
    difference = hyab(*labs) ** qc
    green, blue = to_hunt_lab(numpy.array([0.0, 1, 0])), to_hunt_lab(numpy.array([0.0, 0, 1]))
    largest = hyab(green, blue) ** qc
    return numpy.where(difference < pc * largest, pt / (pc * largest) * difference,
                       pt + (difference - pc * largest) / (largest - pc * largest) * (1 - pt))


def feature_length(luminance: numpy.ndarray, ppd: float, kind: str) -> numpy.ndarray:
    """Section 4.2.1."""
    sigma = 0.5 * 0.082 * ppd
    radius = int(numpy.ceil(3 * sigma))
    x = numpy.mgrid[-radius:radius + 1, -radius:radius + 1][1]
    gauss = numpy.exp(-_squared_distances(radius) / (2 * sigma**2))
    kernel = -x * gauss if kind == "edge" else (x**2 / sigma**2 - 1) * gauss
    kernel = numpy.where(kernel > 0, kernel / kernel[kernel > 0].sum(),
                         kernel / -kernel[kernel < 0].sum())
    return numpy.hypot(correlate(luminance, kernel, mode="nearest"),
                       correlate(luminance, kernel.T, mode="nearest"))


def feature_difference(a: numpy.ndarray, b: numpy.ndarray, ppd: float) -> numpy.ndarray:
    """Section 4.2.2, on the achromatic channel scaled to [0, 1]."""
    luminances = [(to_opponent(i)[..., 0] + 16) / 116 for i in (a, b)]
    differences = [numpy.abs(feature_length(luminances[0], ppd, kind)
                             - feature_length(luminances[1], ppd, kind))
                   for kind in ("edge", "point")]
    return (numpy.maximum(*differences) / numpy.sqrt(2)) ** 0.5


def flip(a: numpy.ndarray, b: numpy.ndarray, ppd: float = PIXELS_PER_DEGREE) -> numpy.ndarray:
    """The map; a and b in [0, 1]."""
    return colour_difference(a, b, ppd) ** (1 - feature_difference(a, b, ppd))


ACES = (0.6**2 * 2.51, 0.6 * 0.03, 0.0, 0.6**2 * 2.43, 0.6 * 0.59, 0.14)


def aces(x: numpy.ndarray) -> numpy.ndarray:
    k = ACES
    return ((k[0] * x**2 + k[1] * x + k[2]) / (k[3] * x**2 + k[4] * x + k[5])).clip(0, 1)


def exposures(reference: numpy.ndarray) -> numpy.ndarray:
    t, k = 0.85, ACES
    bright = numpy.roots([k[0] - t * k[3], k[1] - t * k[4], k[2] - t * k[5]]).max()
    luminance = reference @ TO_XYZ[1]
    start = numpy.log2(bright / luminance.max())
    stop = numpy.log2(bright / numpy.median(luminance))
    return numpy.linspace(start, stop, max(2, int(numpy.ceil(stop - start))))


def hdr_flip(image: numpy.ndarray, reference: numpy.ndarray,
             ppd: float = PIXELS_PER_DEGREE) -> numpy.ndarray:
    """The map; linear values of any brightness."""
    return numpy.max([flip(aces(image * 2**e), aces(reference * 2**e), ppd)
                      for e in exposures(reference)], axis=0)
