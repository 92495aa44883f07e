"""Bar charts of a section: frame times with their intervals, stage times and memory, stacked.

The vertical unit of every chart is the inch: bars keep their thickness and texts their room however
many there are, and charts only grow longer. Legends stand above the axes and the file is cut to
what is drawn, so that a legend covers no bar.
"""

from __future__ import annotations

import math
import textwrap

import numpy
import pandas
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from .. import formats
from ..compare.labels import records
from ..compare.sections import Section
from .style import COLOURS, HATCHES, source_line

LOG_ABOVE = 30
BARS_PER_CHART = 60
BAR, BETWEEN_SETTINGS, LINE = 0.19, 0.2, 0.155  # inches
LABEL_CHARACTERS = 26
FRAME_CAPTION = "Frame times: medians with their 95% intervals."
MEMORY_CAPTION = (
    "Memory: what Vulkan was asked for, by buffer; the method's own, the scene's and the harness's."
)
STAGE_CAPTION = (
    "Stage times: medians of a separate run with timers between the stages, which change what they "
    "time. The mark is the whole frame, measured without them. Stages that were timed at a lower clock "
    "than the frames are left out."
)


def stage_columns(table: pandas.DataFrame) -> list[str]:
    """The stages that some cell of the table has, in the order in which they run."""
    return [c for c in table.columns if c.startswith("stage.") and table[c].notna().any()]


def paginate(section: Section) -> list[list[tuple[str, pandas.DataFrame]]]:
    """The settings of a section in charts of about equal length, at most about 60 bars each."""
    pages: list[list] = [[]]
    bars = 0
    most = len(section.table) / math.ceil(len(section.table) / BARS_PER_CHART)
    for name, cells in section.settings():
        if pages[-1] and bars + len(cells) / 2 > most:
            pages.append([])
            bars = 0
        pages[-1].append((name, cells))
        bars += len(cells)
    return pages


def method_styles(table: pandas.DataFrame) -> dict[str, tuple[str, str]]:
    """Label -> colour and hatch, for what was measured.

    One colour a method, another hatch for each of its variants.
    """
    table = table[table["status"] == "ok"]
    methods = list(dict.fromkeys(table.sort_values("method", kind="stable")["method"]))
    methods.sort(key=lambda method: method != "blend")
    labels = list(dict.fromkeys(zip(table["method"], table["label"])))
    labels.sort(key=lambda pair: (methods.index(pair[0]), formats.natural_key(pair[1])))
    return {
        label: (COLOURS[methods.index(method) % len(COLOURS)], HATCHES[i % len(HATCHES)])
        for i, (method, label) in enumerate(labels)
    }


def draw_frame_times(section: Section, page: list[tuple[str, pandas.DataFrame]]) -> Figure:
    """Horizontal bars grouped by setting; every chart of a section has the same axis."""
    styles = method_styles(section.table)
    middles, names, rows, y = [], [], [], 0.0
    for name, cells in page:
        lines = textwrap.wrap(name, LABEL_CHARACTERS) or [""]
        height = max(len(cells) * BAR, len(lines) * LINE)
        top = y + (height - len(cells) * BAR) / 2
        rows += [(top + (i + 0.5) * BAR, row) for i, row in enumerate(records(cells))]
        middles.append(y + height / 2)
        names.append("\n".join(lines))
        y += height + BETWEEN_SETTINGS
    figure, axes = _axes(y)
    low, high = _set_time_axis(axes, section.table)
    for label, style in styles.items():
        measured = [(y, row) for y, row in rows if (row["status"], row["label"]) == ("ok", label)]
        if measured:
            _draw_bars(axes, measured, style, low)
    for y, row in rows:
        _write_beside(axes, y, row, low)
    axes.set_yticks(middles, names)
    shown = {row["label"] for _, row in rows}
    handles = [Patch(facecolor=c, hatch=h, edgecolor="black", linewidth=0.5, label=name)
               for name, (c, h) in styles.items() if name in shown]
    _legend(figure, axes, handles)
    _footer(axes, "frame time, ms (median, 95% interval)" + (
        "; log scale: compare ends, not lengths" if axes.get_xscale() == "log" else ""), section)
    return figure


def _axes(height: float) -> tuple[Figure, Axes]:
    """Axes of 6.5 inches by `height`, y downwards in inches."""
    figure = Figure(figsize=(9, height + 1))
    axes = figure.add_axes((0.2, 0.5 / (height + 1), 6.5 / 9, height / (height + 1)))
    axes.set_ylim(height - BETWEEN_SETTINGS / 2, -BETWEEN_SETTINGS / 2)
    axes.tick_params(axis="y", length=0)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(axis="x", color="#dddddd", linewidth=0.6)
    return figure, axes


def _set_time_axis(axes: Axes, table: pandas.DataFrame) -> tuple[float, float]:
    """Linear from 0, or logarithmic if the times span more than 30x; room right for the figures."""
    medians = table["frame_ms.median"].dropna()
    ends = table["frame_ms.ci_high"].dropna()
    least, most = medians.min(), max(medians.max(), ends.max())
    if medians.max() / least > LOG_ABOVE:
        axes.set_xscale("log")
        low, high = least / 2, most * (most / (least / 2)) ** 0.14
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    else:
        low, high = 0.0, most * 1.14
    axes.set_xlim(low, high)
    return low, high


def _draw_bars(
    axes: Axes, rows: list[tuple[float, dict]], style: tuple[str, str], low: float
) -> None:
    """All bars of one method with their intervals, in one go: an artist each would be slow."""
    heights = [y for y, _ in rows]
    medians, lower, upper = (
        [row[f"frame_ms.{key}"] for _, row in rows] for key in ("median", "ci_low", "ci_high")
    )
    axes.barh(heights, [median - low for median in medians], BAR * 0.92, low, color=style[0],
              hatch=style[1], edgecolor="black", linewidth=0.5)
    axes.hlines(heights, lower, upper, color="black", linewidth=1.2)
    for ends in (lower, upper):
        axes.plot(ends, heights, color="black", marker="|", markersize=5, linestyle="none")


def _write_beside(axes: Axes, y: float, row: dict, low: float) -> None:
    """The median right of its bar; where there is none, why."""
    text, x = f"{row['label']}: {row['status']}", low
    if row["status"] == "ok":
        median = row["frame_ms.median"]
        text, x = formats.number(median), max(median, row["frame_ms.ci_high"])
    axes.annotate(text, (x, y), (4, 0), textcoords="offset points", va="center", size=7)


def draw_stages(section: Section, page: list[tuple[str, pandas.DataFrame]]) -> Figure | None:
    """The stages of each cell, one panel a setting. None if no cell of the page has stage times."""
    columns = stage_columns(section.table)
    named = {c: c.removeprefix("stage.").removesuffix("_ms") for c in columns}
    mark = Line2D([], [], color="black", marker="|", markersize=9, linestyle="none",
                  markeredgewidth=2, label="whole frame, separate run")
    return _draw_stacks(section, page, named, "stage times, ms (medians)", 1.0,
                        ("frame_ms.median", mark))


def memory_columns(table: pandas.DataFrame) -> dict[str, str]:
    """Buffers of some cell, greatest first, with their names; the tail is left to `other`."""
    columns = [c for c in table.columns if c.startswith("memory.") and table[c].notna().any()]
    columns.sort(key=lambda column: -table[column].max())
    return {column: column.removeprefix("memory.") for column in columns}


def draw_memory(section: Section, page: list[tuple[str, pandas.DataFrame]]) -> Figure | None:
    """The buffers of each method, greatest first, one panel a setting; equal variants once."""
    columns = memory_columns(section.table)
    shown = dict(list(columns.items())[:len(COLOURS) - 1])
    rest = [column for column in columns if column not in shown]
    distinct = []
    for name, cells in page:
        cells = cells[cells["status"] == "ok"].drop_duplicates(["method", *columns])
        if rest:
            cells = cells.assign(**{"memory.other": cells[rest].sum(axis=1)})
        distinct.append((name, cells))
    if rest:
        shown["memory.other"] = f"{len(rest)} smaller buffers"
    return _draw_stacks(section, distinct, shown, "memory, MiB", 2.0**20)


def _draw_stacks(
    section: Section, page: list[tuple[str, pandas.DataFrame]], named: dict[str, str], unit: str,
    divisor: float, mark: tuple[str, Line2D] | None = None,
) -> Figure | None:
    """One panel per setting with an axis of its own, so that a fast scene is not lost."""
    columns = list(named)
    page = [(name, cells[cells[columns].notna().any(axis=1)]) for name, cells in page]
    page = [(name, cells) for name, cells in page if not cells.empty]
    if not page:
        return None
    styles = {c: (COLOURS[i % len(COLOURS)], HATCHES[i % len(HATCHES)])
              for i, c in enumerate(columns)}
    head, foot = 0.3, 0.3  # inches above and below the bars of a panel: title, tick labels
    panels = [(name, cells, len(cells) * BAR * 1.15 + 0.1) for name, cells in page]
    height = sum(head + bars + foot for _, _, bars in panels)
    figure = Figure(figsize=(9, height))
    top, all_axes = 0.0, []
    for name, cells, bars in panels:
        top += head
        axes = figure.add_axes((0.25, 1 - (top + bars) / height, 6 / 9, bars / height))
        _draw_stack_panel(axes, name, cells, styles, divisor)
        if mark:
            axes.plot(cells[mark[0]] / divisor, range(len(cells)), color="black", marker="|",
                      markersize=12, markeredgewidth=2, linestyle="none")
        all_axes.append(axes)
        top += bars + foot
    used = {c for _, cells, _ in panels for c in columns if cells[c].notna().any()}
    handles = [Patch(facecolor=c, hatch=h, edgecolor="black", linewidth=0.5, label=named[s])
               for s, (c, h) in styles.items() if s in used]
    _legend(figure, all_axes[0], handles + ([mark[1]] if mark else []), head)
    _footer(all_axes[-1], unit, section)
    return figure


def _draw_stack_panel(
    axes: Axes, name: str, cells: pandas.DataFrame, styles: dict[str, tuple[str, str]],
    divisor: float,
) -> None:
    rows = numpy.arange(len(cells))
    starts = numpy.zeros(len(cells))
    for column, (colour, hatch) in styles.items():
        widths = cells[column].to_numpy(dtype=float) / divisor
        has = widths > 0
        if not has.any():
            continue
        axes.barh(rows[has], widths[has], 0.7, starts[has], color=colour, hatch=hatch,
                  edgecolor="black", linewidth=0.5)
        starts[has] += widths[has]
    axes.set_ylim(len(cells) - 0.45, -0.55)
    axes.set_xlim(left=0)
    axes.set_yticks(rows, [textwrap.shorten(n, 40) for n in cells["label"]])
    axes.tick_params(axis="y", length=0)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(axis="x", color="#dddddd", linewidth=0.6)
    axes.set_title(name, loc="left", size=9, weight="bold")


def _legend(figure: Figure, axes: Axes, handles: list, above: float = 0.0) -> None:
    """A legend right above the axes, `above` inches up, in as many columns as fit."""
    longest = max((len(handle.get_label()) for handle in handles), default=0)
    height = axes.get_position().height * figure.get_figheight()
    axes.legend(handles=handles, loc="lower left", bbox_to_anchor=(0, 1 + above / height),
                borderaxespad=0.3, ncol=max(1, min(len(handles), 100 // (longest + 7))), frameon=False,
                handlelength=2.2, handleheight=1.1)


def _footer(axes: Axes, text: str, section: Section) -> None:
    axes.set_xlabel(f"{text}\n{textwrap.fill(source_line(section), 110)}", size=8)
