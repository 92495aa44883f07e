"""Draws how many pixels have how many fragments, from what `oitlab depth --json` prints: the
counterpart of figure 5 of Knowles et al. 2013 on backwards memory allocation."""

from __future__ import annotations

import json
import textwrap
from pathlib import Path

import matplotlib
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from .. import formats

BAR = "#0072B2"
MOST_BARS = 400  # more would be thinner than a printer's dot: counts are joined then


class BadDepth(Exception):
    """The file is not what `oitlab depth --json` prints; the message is one line for the user."""


def read_depth(path: Path) -> dict:
    """Raises BadDepth naming the file, what was found and what was wanted; OSError."""
    try:
        depth = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise BadDepth(f"{path}: not JSON: {formats.one_line(str(error))}") from error
    pixels = depth.get("histogram") if isinstance(depth, dict) else None
    if not isinstance(pixels, list) or not pixels or any(
            type(n) is not int or n < 0 for n in pixels):
        raise BadDepth(f"{path}: /histogram: wanted a list of numbers of pixels")
    return depth


def join_counts(pixels: list[int], most: int = MOST_BARS) -> tuple[int, list[int]]:
    """Pixels with 1, 2, 3, ... fragments as at most `most` bars, and how many counts one bar
    joins. Pixels of no fragment, pixels[0], are left out."""
    counts = pixels[1:]
    step = max(1, -(-len(counts) // most))
    return step, [sum(counts[i:i + step]) for i in range(0, len(counts), step)]


def describe_depth(pixels: list[int]) -> str:
    """The figures under the chart."""
    total = sum(n * count for n, count in enumerate(pixels))
    covered = sum(pixels[1:])
    if not covered:
        return "no fragments"
    return (f"{formats.count(total)} fragments, at most {len(pixels) - 1} a pixel; mean "
            f"{formats.number(total / covered)} over covered pixels "
            f"({formats.share(covered / sum(pixels))}), "
            f"{formats.number(total / sum(pixels))} over all")


def draw_histogram(source: Path, target: Path) -> None:
    """Writes the chart to `target` (the extension says its format). Raises BadDepth, OSError."""
    depth = read_depth(source)
    pixels = depth["histogram"]
    step, bars = join_counts(pixels)
    scene = depth.get("scene")
    name = scene.get("name", "") if isinstance(scene, dict) else ""
    style = {"font.family": "DejaVu Sans", "font.size": 9, "text.parse_math": False,
             "axes.axisbelow": True}
    with matplotlib.rc_context(style):
        figure = Figure(figsize=(6.4, 3.4), layout="constrained")
        axes = figure.add_subplot()
        # A bar is centred on the counts that it joins.
        axes.bar([1 + i * step + (step - 1) / 2 for i in range(len(bars))], bars, width=step,
                 color=BAR, linewidth=0)
        if any(bars):
            axes.set_yscale("log")
            axes.set_ylim(bottom=0.7)  # a single pixel is a bar too
            axes.yaxis.set_major_formatter(lambda pixels, _: formats.count(pixels))
            axes.yaxis.set_minor_formatter(NullFormatter())
        axes.xaxis.get_major_locator().set_params(integer=True)
        joined = f" (in steps of {step})" if step > 1 else ""
        axes.set_xlabel(f"fragments of a pixel{joined}")
        axes.set_ylabel("pixels, log scale")
        title = formats.one_line(f"Depth complexity: {name}" if name else "Depth complexity")
        lines = textwrap.wrap(title, 80) + textwrap.wrap(describe_depth(pixels), 110)
        axes.set_title("\n".join(lines), fontsize=8, loc="left")
        axes.grid(axis="y", color="#dddddd")
        figure.savefig(target, dpi=150)
