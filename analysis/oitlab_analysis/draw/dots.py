"""Frame times of a section: a band for each setting with a row for each method, a dot with its interval
for each cell.

A dot may stand on a log axis, where the length of a bar would mean nothing.
"""

from __future__ import annotations

import math
import textwrap

import numpy
import pandas
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .. import formats
from ..compare.labels import records, short_labels
from ..compare.sections import Section
from .layout import (
    HALO,
    LABEL,
    TICKS,
    add_legend,
    characters,
    legend_height,
    log_axis,
    mark_beyond,
    plain,
    robust_limit,
    shortened,
)
from .quality_speed import MOST_VARIANTS_NAMED, looks_of
from .style import GRID, PAGE, TALLEST

LOG_ABOVE = 4  # span of times from which on the axis is logarithmic
ROW, BETWEEN, LINE = 0.095, 0.07, 0.13  # inches: a row, the room between bands, a line of a band's name
NAMES = 1.6  # inches left of the axes
MOST_LEGEND = 3.0  # inches: variants are named while the legend is no taller
CAPTION = ("Frame times: medians with their 95% intervals, a band for each scene and setting with a row for "
           "each method.")


def paginate(section: Section) -> list[list[tuple[str, pandas.DataFrame]]]:
    """The settings of a section in charts of about equal height; a setting that is too long for one
    is taken apart."""
    room = _room(section)
    parts = [(name, part) for name, cells in section.settings() for part in _parts(cells, room)]
    total = sum(_height(name, cells) for name, cells in parts)
    target = total / math.ceil(total / room)
    pages: list[list] = [[]]
    height = 0.0
    for name, cells in parts:
        own = _height(name, cells)
        if pages[-1] and (height + own / 2 > target or height + own > room):
            pages.append([])
            height = 0.0
        pages[-1].append((name, cells))
        height += own
    return pages


def pages(section: Section) -> int:
    return len(paginate(section))


def note(section: Section) -> str:
    """What the caption must say of the names, or ""."""
    return short_labels(section.table[section.table["status"] == "ok"])[1]


def _name_lines(name: str) -> list[str]:
    return textwrap.wrap(name, characters(NAMES - 0.1, 8)) or [""]


def _room(section: Section) -> float:
    """Inches of bands on a page: what the legend of all that was measured and the axis leave."""
    table = section.table[section.table["status"] == "ok"]
    handles = _handles(set(table["label"]), looks_of(table), short_labels(table)[0])
    return TALLEST - TICKS - LABEL - legend_height([handle.get_label() for handle in handles], PAGE)


def _parts(cells: pandas.DataFrame, room: float) -> list[pandas.DataFrame]:
    """The cells in parts of at most as many methods as have a row on one page."""
    most = int((room - BETWEEN) / ROW)
    methods = cells["method"].unique()
    return [cells[cells["method"].isin(methods[start:start + most])] for start in range(0, len(methods), most)]


def _height(name: str, cells: pandas.DataFrame) -> float:
    return max(cells["method"].nunique() * ROW, len(_name_lines(name)) * LINE) + BETWEEN


def draw_frame_times(section: Section, page: int, metric: str = "") -> Figure | None:
    """The bands of one page; every chart of a section has the same axis. None if nothing was measured."""
    table = section.table[section.table["status"] == "ok"]
    if table.empty:
        return None
    looks = looks_of(table)
    bands = paginate(section)[page]
    names, _ = short_labels(table)
    handles = _handles({label for _, cells in bands for label in cells["label"]}, looks, names)
    legend = legend_height([handle.get_label() for handle in handles], PAGE)
    height = sum(_height(name, cells) for name, cells in bands)
    total = legend + height + TICKS + LABEL
    figure = Figure(figsize=(PAGE, total))
    axes = figure.add_axes((NAMES / PAGE, (TICKS + LABEL) / total, (PAGE - NAMES - 0.1) / PAGE, height / total))
    axes.set_ylim(height, 0)
    limit = _set_time_axis(axes, table)
    middles, titles, rows, y = [], [], [], 0.0
    for index, (name, cells) in enumerate(bands):
        own, methods = _height(name, cells), list(cells["method"].unique())
        if index % 2:
            axes.axhspan(y, y + own, color="#f3f5f7", linewidth=0)
        top = y + (own - len(methods) * ROW) / 2
        rows += [(top + (methods.index(row["method"]) + 0.5) * ROW, row) for row in records(cells)]
        middles.append(y + own / 2)
        titles.append("\n".join(_name_lines(name)))
        y += own
    _draw_rows(axes, rows, looks, names, limit)
    axes.set_yticks(middles, titles, size=8)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(axis="x", labelsize=7.5)
    axes.grid(axis="x", **GRID)
    axes.spines[["top", "right"]].set_visible(False)
    log = " (log scale)" if axes.get_xscale() == "log" else ""
    axes.set_xlabel(f"frame time, ms: median, 95% interval{log}", size=8)
    add_legend(figure, handles)
    return figure


def _set_time_axis(axes: Axes, table: pandas.DataFrame) -> float:
    """Logarithmic if the times span more than 4x; returns the largest time drawn in its place."""
    medians = table["frame_ms.median"]
    log = medians.max() / medians.min() > LOG_ABOVE
    limit = robust_limit(medians, log) or float(medians.max())
    shown = table[medians <= limit]
    least = numpy.nanmin([medians.min(), shown["frame_ms.ci_low"].min()])
    most = numpy.nanmax([shown["frame_ms.median"].max(), shown["frame_ms.ci_high"].max()])
    if log and least > 0:
        log_axis(axes, "x", least / 1.15, most * 1.15, 7)
    else:
        axes.set_xlim(0, most * 1.06)
        axes.xaxis.set_major_formatter(lambda value, _: plain(value))
    return limit


def _draw_rows(axes: Axes, rows: list[tuple[float, dict]], looks: dict, names: dict[str, str],
               limit: float) -> None:
    """All dots of one look at once: an artist for each would be slow."""
    measured = [(y, row) for y, row in rows if row["status"] == "ok"]
    by_look: dict[tuple, list[tuple[float, dict]]] = {}
    for y, row in measured:
        by_look.setdefault((looks[row["label"]]["color"], looks[row["label"]]["marker"]), []).append((y, row))
    for own in by_look.values():
        look = looks[own[0][1]["label"]]
        inside = [(y, row) for y, row in own if row["frame_ms.median"] <= limit]
        heights = [y for y, _ in inside]
        sure = [(y, row) for y, row in inside if formats.is_number(row["frame_ms.ci_low"])]
        if sure:
            axes.hlines([y for y, _ in sure], [row["frame_ms.ci_low"] for _, row in sure],
                        [row["frame_ms.ci_high"] for _, row in sure], color=look["color"], linewidth=1.1)
        axes.plot([row["frame_ms.median"] for _, row in inside], heights, linestyle="none",
                  marker=look["marker"], color=look["color"], markersize=4.2, markeredgecolor="black",
                  markeredgewidth=0.35)
        mark_beyond(axes, [(0, y, f"{names[row['label']]}: {formats.number(row['frame_ms.median'])}")
                           for y, row in own if row["frame_ms.median"] > limit], "x", "black")
    unmeasured: dict[float, list[dict]] = {}
    for y, row in rows:
        if row["status"] != "ok":
            unmeasured.setdefault(y, []).append(row)
    for y, own in unmeasured.items():
        text = f"{own[0]['label']}: {own[0]['status']}" if len(own) == 1 else \
            f"{own[0]['method']}: {len(own)} not measured"
        axes.annotate(text, (axes.get_xlim()[0], y), (4, 0), textcoords="offset points", va="center", size=5.5,
                      color="#a40e26", path_effects=HALO)


def _handles(shown: set[str], looks: dict, names: dict[str, str]) -> list[Line2D]:
    """Every variant by name; only the method where it has many, or where the legend would be too tall."""
    for most in (2 * MOST_VARIANTS_NAMED, MOST_VARIANTS_NAMED, 1):
        entries: dict[str, dict] = {}
        for method in dict.fromkeys(look["method"] for label, look in looks.items() if label in shown):
            own = {names[label]: look for label, look in looks.items()
                   if look["method"] == method and label in shown}
            entries |= own if len(own) <= most else {f"{method} ({len(own)} variants)": next(iter(own.values()))}
        if legend_height(list(entries), PAGE) <= MOST_LEGEND:
            break
    return shortened([Line2D([], [], linestyle="none", marker=look["marker"], color=look["color"], markersize=4.5,
                             markeredgecolor="black", markeredgewidth=0.35, label=label)
                      for label, look in entries.items()])
