"""How numbers and words are written, the same in every table, chart and caption."""

from __future__ import annotations

import math
import re

NOTHING = "–"


def is_number(value: object) -> bool:
    """True for a finite number; False for None, NaN, infinities, booleans and text."""
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return False
    try:
        return math.isfinite(value)  # type: ignore[arg-type]
    except (TypeError, OverflowError):
        return False


def decimals_for(value: float, digits: int = 3) -> int:
    """Decimals that show `digits` significant digits; whole numbers are never rounded to tens."""
    if value == 0:
        return 0
    rounded = float(f"{abs(value):.{digits - 1}e}")  # 9.996 is shown as 10.0, not as 10.00
    return max(0, digits - 1 - math.floor(math.log10(rounded)))


def number(value: float | None, digits: int = 3) -> str:
    """Three significant digits, an exponent only below 0.001."""
    if not is_number(value):
        return NOTHING
    if value != 0 and abs(value) < 1e-3:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{decimals_for(value, digits)}f}"


def with_interval(value: float | None, low: float | None, high: float | None,
                  count: float | None = None) -> str:
    """`12.3 [12.2, 12.4]`; a fourth digit where three would print both ends alike.

    `12.3 (n = 2)` where there is no interval, because it is of `count` blocks.
    """
    if not is_number(value):
        return NOTHING
    if not (is_number(low) and is_number(high)):
        return number(value) + (f" (n = {count:g})" if is_number(count) else "")
    for digits in (3, 4):
        decimals = decimals_for(value, digits)
        ends = f"{low:.{decimals}f}", f"{high:.{decimals}f}"
        if ends[0] != ends[1]:
            break
    return f"{value:.{decimals}f} [{ends[0]}, {ends[1]}]"


def count(value: float | None) -> str:
    """A count with a metric prefix: 950, 12.7 K, 2.90 M, 1.30 G."""
    if not is_number(value):
        return NOTHING
    for factor, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "K")):
        # 999 950 rounds to 1.00 M, not to 1000 K.
        if abs(value) >= factor * 0.9995:
            return f"{number(value / factor)} {prefix}"
    return f"{value:.0f}"


def mebibytes(value: float | None) -> str:
    """Bytes as MiB (2^20 bytes)."""
    return number(value / 2**20) if is_number(value) else NOTHING


def similarity(value: float | None) -> str:
    """Four decimals, rounded down: only what is equal reads as 1.0000."""
    return f"{math.floor(value * 1e4) / 1e4:.4f}" if is_number(value) else NOTHING


def share(value: float | None) -> str:
    """A share of 1 as a percentage; anything above zero is shown as above zero."""
    if not is_number(value):
        return NOTHING
    if 0 < value < 1e-5:
        return "<0.001 %"
    return f"{number(value * 100)} %"


def decibels(psnr: float | None, rmse: float | None) -> str:
    """PSNR in dB. It is infinite, written as null, where the image equals its reference."""
    return "∞ (equal)" if not is_number(psnr) and rmse == 0 else number(psnr)


def counted(number: int, noun: str) -> str:
    """`1 cell`, `2 cells`."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def parameter(value: object) -> str:
    """A parameter's value as one would type it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:g}" if isinstance(value, float) else str(value)


def one_line(text: str) -> str:
    """Text without line breaks and control characters: it can't upset a terminal or a table."""
    return "".join(c if c.isprintable() else " " for c in text)


def natural_key(text: str) -> list[tuple[bool, object]]:
    """Sorts `tile=8` before `tile=16`."""
    return [
        (part.isdigit(), int(part) if part.isdigit() else part)
        for part in re.split(r"([0-9]+)", text)
    ]
