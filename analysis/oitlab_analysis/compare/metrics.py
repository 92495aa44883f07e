"""The measures of error that a plot can be asked for; each is turned so that less is better."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy
import pandas


@dataclass(frozen=True)
class Metric:
    """`errors` gives a number for each cell: 0 where the image has no such error, NaN where it is
    not known. `shown` turns an error into what the axis says."""

    label: str
    errors: Callable[[pandas.DataFrame], numpy.ndarray]
    shown: Callable[[float], float] = lambda error: error
    none: str = "0"  # what the axis says of no error


def column(table: pandas.DataFrame, name: str) -> numpy.ndarray:
    """A column of numbers; NaN where it is missing or no number."""
    if name not in table:
        return numpy.full(len(table), numpy.nan)
    return pandas.to_numeric(table[name], errors="coerce").to_numpy(dtype=float)


def _psnr_error(table: pandas.DataFrame) -> numpy.ndarray:
    """10^(-PSNR/20), the error relative to the peak: 0 where PSNR is infinite."""
    psnr, rmse = column(table, "quality.psnr"), column(table, "quality.rmse")
    return numpy.where(rmse == 0, 0.0, 10 ** (-psnr / 20))


def wrong_order(table: pandas.DataFrame) -> numpy.ndarray:
    """The share of pixels that were blended in the wrong order, by the method's own count."""
    invalid, repaired = column(table, "counter.invalid_pixels"), column(table, "counter.repaired_pixels")
    return (invalid - numpy.nan_to_num(repaired)) / (column(table, "width") * column(table, "height"))


def wrong_order_found(table: pandas.DataFrame) -> numpy.ndarray:
    """The share of pixels that were in the wrong order before any was repaired."""
    return column(table, "counter.invalid_pixels") / (column(table, "width") * column(table, "height"))


METRICS = {
    "rmse": Metric("RMSE", lambda t: column(t, "quality.rmse")),
    "psnr": Metric("PSNR, dB", _psnr_error, lambda error: float(-20 * numpy.log10(error)), "∞"),
    "ssim": Metric("1 − SSIM", lambda t: numpy.maximum(0, 1 - column(t, "quality.ssim"))),
    "flip": Metric("FLIP", lambda t: column(t, "quality.flip")),
    "pixels_off": Metric("pixels off by more than 1/255, %",
                         lambda t: 100 * column(t, "quality.pixels_off")),
    "wrong_order": Metric("pixels blended in the wrong order, %", lambda t: 100 * wrong_order(t)),
}
