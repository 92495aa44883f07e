"""What a parameter does: lines over its values, one for each scene and for what else differs.

Times are compared within a group of cells that were measured in turn, block by block.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from dataclasses import dataclass

import numpy
import pandas
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .. import formats
from ..compare.labels import records
from ..compare.metrics import METRICS, wrong_order
from .quality_speed import error_floor, set_error_axis
from ..compare.sections import Section
from ..compare.statistics import Comparison, compare_cells
from .style import PAGE, line_style, source_line

LEGEND_CHARACTERS = 105  # of a row, at the width of a page
SETTINGS_PER_CHART = 12
DEPTH_FILTER_BASE = 3  # the paper's default, to which its table relates the times
DEPTH_FILTER_CAPTION = (
    "Depth filter of `lucid`: pixels that come out in the wrong order without repair, and frame time "
    "against that with a filter of 3 (intervals: 95%, of paired blocks)."
)
ALPHA_CAPTION = (
    "Alpha threshold of `lucid`: speed-up against shading every sample (intervals: 95%, of paired blocks)."
)


@dataclass(frozen=True)
class Line:
    """The cells of one line, by rising value of the parameter.

    `variant` says what tells it from the other lines of its setting; empty where nothing does.
    """

    setting: str
    variant: str
    values: list[float]
    cells: pandas.DataFrame


def lines_of(section: Section, method: str, parameter: str) -> list[Line]:
    """Cells of a method that differ in nothing but this parameter, where it has two values or more."""
    column = f"param.{parameter}"
    if column not in section.table:
        return []
    table = section.table
    table = table[(table["status"] == "ok") & (table["method"] == method) & table[column].notna()]
    others = [c for c in table.columns if c.startswith("param.") and c != column]
    groups = [cells.sort_values(column).drop_duplicates(column) for _, cells
              in table.groupby(["setting", *others], sort=False, dropna=False)
              if cells[column].nunique() > 1]
    # Only what differs between lines names them.
    firsts = [records(cells.head(1))[0] for cells in groups]
    varying = [c for c in others if len({str(first[c]) for first in firsts}) > 1]
    return [
        Line(first["setting"],
             ", ".join(f"{c.removeprefix('param.')}={formats.parameter(first[c])}" for c in varying),
             cells[column].tolist(), cells)
        for first, cells in zip(firsts, groups)
    ]


def pages(method: str, parameter: str) -> Callable[[Section], int]:
    """How many charts the lines of a section take; at least one."""
    def count(section: Section) -> int:
        settings = {line.setting for line in lines_of(section, method, parameter)}
        return max(1, -(-len(settings) // SETTINGS_PER_CHART))
    return count


def _page_of(section: Section, method: str, parameter: str, page: int) -> list[Line]:
    lines = lines_of(section, method, parameter)
    settings = list(dict.fromkeys(line.setting for line in lines))
    shown = settings[page * SETTINGS_PER_CHART:(page + 1) * SETTINGS_PER_CHART]
    return [line for line in lines if line.setting in shown]


def against(section: Section, line: Line, value: float) -> list[Comparison] | None:
    """Each cell of a line against the one where the parameter has this value; None without one."""
    if value not in line.values:
        return None
    base = section.cells[line.cells["key"].iloc[line.values.index(value)]]
    return [compare_cells(section.cells[key], base) for key in line.cells["key"]]


def draw_depth_filter(section: Section, page: int = 0, metric: str = "") -> Figure | None:
    """Wrong pixels and time over the size of the filter; None where it was not varied."""
    lines = _page_of(section, "lucid", "depth_filter", page)
    if not lines:
        return None
    looks = _looks(lines)
    figure = Figure(figsize=(PAGE, 3.1), layout="constrained")
    left, right = figure.subplots(1, 2)
    shares = [100 * _invalid_share(line.cells) for line in lines]
    every = pandas.Series(numpy.concatenate(shares))
    floor = error_floor(every)
    drawn = set()
    for line, look, share in zip(lines, looks, shares):
        if line.setting not in drawn:  # repaired or not, as many were found
            left.plot(line.values, numpy.maximum(share, floor), markersize=3.5, linewidth=1,
                      **look | {"linestyle": "-"})
        drawn.add(line.setting)
        _draw_ratios(right, line.values, against(section, line, DEPTH_FILTER_BASE), look, 100)
    set_error_axis(left, METRICS["wrong_order"], every, floor)
    left.set_ylabel("invalid pixels before repair, %", size=8)
    right.set_ylabel(f"frame time against a filter of {DEPTH_FILTER_BASE}, %", size=8)
    _finish(figure, [left, right], "size of the depth filter", section, lines, looks)
    return figure


def _invalid_share(cells: pandas.DataFrame) -> numpy.ndarray:
    """Invalid pixels as found, whether they were repaired or not."""
    return wrong_order(cells.assign(**{"counter.repaired_pixels": 0}))


def draw_alpha_threshold(section: Section, page: int = 0, metric: str = "") -> Figure | None:
    """The speed-up over the threshold; None where it was not varied."""
    lines = [line for line in _page_of(section, "lucid", "alpha_threshold", page) if 0 in line.values]
    if not lines:
        return None
    looks = _looks(lines)
    figure = Figure(figsize=(PAGE, 2.6), layout="constrained")
    axes = figure.subplots()
    values = sorted({value for line in lines for value in line.values})
    for line, look in zip(lines, looks):
        speedups = [_inverse(ratio) for ratio in against(section, line, 0)]
        _draw_ratios(axes, [values.index(value) for value in line.values], speedups, look, 1)
    axes.set_xticks(range(len(values)), ["off" if v == 0 else f"{v:.4g}" for v in values])
    axes.axhline(1, color="black", linewidth=0.6)
    axes.set_ylabel("speed-up", size=8)
    _finish(figure, [axes], "alpha threshold", section, lines, looks)
    return figure


def _inverse(c: Comparison) -> Comparison:
    """The speed-up in place of the ratio."""
    if c.ratio is None:
        return c
    low, high = (1 / c.high, 1 / c.low) if c.low is not None else (None, None)
    return Comparison(1 / c.ratio, low, high, c.blocks, c.verdict)


def _draw_ratios(axes: Axes, values: list, ratios: list[Comparison] | None, look: dict,
                 scale: float) -> None:
    points = [(x, c) for x, c in zip(values, ratios or []) if c.ratio is not None]
    if not points:
        return
    axes.plot([x for x, _ in points], [scale * c.ratio for _, c in points], markersize=3.5,
              linewidth=1, **look)
    sure = [(x, c) for x, c in points if c.low is not None]
    axes.vlines([x for x, _ in sure], [scale * c.low for _, c in sure],
                [scale * c.high for _, c in sure], color=look["color"], linewidth=0.9)


def _looks(lines: list[Line]) -> list[dict]:
    """Colour and marker by setting, dashes by variant."""
    settings = list(dict.fromkeys(line.setting for line in lines))
    variants = list(dict.fromkeys(line.variant for line in lines))
    return [line_style(settings.index(line.setting), variants.index(line.variant)) for line in lines]


def _finish(figure: Figure, all_axes: list[Axes], xlabel: str, section: Section, lines: list[Line],
            looks: list[dict]) -> None:
    """Axes, and a legend above them of the settings and, where there are several, the variants."""
    for axes in all_axes:
        axes.set_xlabel(xlabel, size=8)
        axes.tick_params(labelsize=7.5)
        axes.grid(color="#e4e4e4", linewidth=0.5)
        axes.spines[["top", "right"]].set_visible(False)
    settings = {line.setting: look for line, look in reversed(list(zip(lines, looks)))}
    variants = {line.variant: look["linestyle"] for line, look in zip(lines, looks)}
    handles = [Line2D([], [], markersize=3.5, linewidth=1, label=name, **look | {"linestyle": "-"})
               for name, look in reversed(settings.items())]
    if len(variants) > 1:
        handles += [Line2D([], [], color="black", linestyle=dashes, linewidth=1, label=name)
                    for name, dashes in variants.items()]
    longest = max(len(handle.get_label()) for handle in handles)
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.01, 1), frameon=False,
                  fontsize=7, ncol=max(1, min(len(handles), LEGEND_CHARACTERS // (longest + 7))))
    figure.supxlabel(textwrap.fill(source_line(section), 110), size=7.5)
