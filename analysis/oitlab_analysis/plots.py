"""Bar charts of a section: frame times with their intervals, and stage times stacked.

The vertical unit of every chart is the inch: bars keep their thickness and texts their room however
many there are, and charts only grow longer. Legends stand above the axes and the file is cut to
what is drawn, so that a legend covers no bar.
"""

from __future__ import annotations

import math
import textwrap
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy
import pandas
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from . import formats
from .sections import Section

# Okabe and Ito's colours, told apart by all common forms of colour blindness; black is for text.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999")
# For prints in grey.
HATCHES = ("", "///", "...", "xx", "\\\\\\", "--", "oo", "++", "||", "**")
STYLE = {
    "font.family": "DejaVu Sans",  # comes with matplotlib: the same on every machine
    "font.size": 9,
    "hatch.linewidth": 0.5,
    "svg.hashsalt": "oitlab",  # the same file for the same data
    "axes.axisbelow": True,
    "text.parse_math": False,  # a $ in a name is a $
}
LOG_ABOVE = 30
BARS_PER_CHART = 60
FEW_CHARTS = 4
BAR, BETWEEN_SETTINGS, LINE = 0.19, 0.2, 0.155  # inches
LABEL_CHARACTERS = 26
FRAME_CAPTION = "Frame times: medians with their 95% intervals."
STAGE_CAPTION = (
    "Stage times: medians of a separate run with timers between the stages, which change what they "
    "time. The mark is the whole frame, measured without them."
)


@dataclass(frozen=True)
class Chart:
    """A chart that was saved as `name`.png and `name`.svg in the folder plots."""

    name: str
    caption: str


def save_charts(sections: list[Section], folder: Path) -> list[list[Chart]]:
    """Draws the charts of each section; long ones are spread over several files."""
    folder.mkdir(exist_ok=True)
    tasks = [
        (section, number, kind, page)
        for number, section in enumerate(sections, 1)
        if (section.table["status"] == "ok").any()
        for kind in DRAWN
        for page in range(len(paginate(section)))
    ]
    if len(tasks) > FEW_CHARTS:
        # A chart takes about a second, and matplotlib does not run in threads.
        with ProcessPoolExecutor() as pool:
            charts = list(pool.map(_save_chart, tasks, [folder] * len(tasks)))
    else:
        charts = [_save_chart(task, folder) for task in tasks]
    return [
        [chart for task, chart in zip(tasks, charts) if chart and task[0] is section]
        for section in sections
    ]


def _save_chart(task: tuple[Section, int, str, int], folder: Path) -> Chart | None:
    section, number, kind, index = task
    caption, draw = DRAWN[kind]
    pages = paginate(section)
    with matplotlib.rc_context(STYLE):
        figure = draw(section, pages[index])
        if figure is None:
            return None
        name = f"{kind}-{number}" + (f"-{index + 1}" if len(pages) > 1 else "")
        _save(figure, folder / name)
    part = f" Chart {index + 1} of {len(pages)}." if len(pages) > 1 else ""
    return Chart(name, caption + part)


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
        rows += [(top + (i + 0.5) * BAR, row) for i, (_, row) in enumerate(cells.iterrows())]
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
    axes: Axes, rows: list[tuple[float, pandas.Series]], style: tuple[str, str], low: float
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


def _write_beside(axes: Axes, y: float, row: pandas.Series, low: float) -> None:
    """The median right of its bar; where there is none, why."""
    text, x = f"{row['label']}: {row['status']}", low
    if row["status"] == "ok":
        median = row["frame_ms.median"]
        text, x = formats.number(median), max(median, row["frame_ms.ci_high"])
    axes.annotate(text, (x, y), (4, 0), textcoords="offset points", va="center", size=7)


def draw_stages(section: Section, page: list[tuple[str, pandas.DataFrame]]) -> Figure | None:
    """One panel per setting with an axis of its own, so that a fast scene is not lost.

    None if no cell of the page has stage times.
    """
    columns = stage_columns(section.table)
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
        _draw_stage_panel(axes, name, cells, styles)
        all_axes.append(axes)
        top += bars + foot
    used = {c for _, cells, _ in panels for c in columns if cells[c].notna().any()}
    handles = [Patch(facecolor=c, hatch=h, edgecolor="black", linewidth=0.5, label=stage_name(s))
               for s, (c, h) in styles.items() if s in used]
    handles.append(Line2D([], [], color="black", marker="|", markersize=9, linestyle="none",
                                 markeredgewidth=2, label="whole frame, separate run"))
    _legend(figure, all_axes[0], handles, head)
    _footer(all_axes[-1], "stage times, ms (medians)", section)
    return figure


def stage_name(column: str) -> str:
    return column.removeprefix("stage.").removesuffix("_ms")


def _draw_stage_panel(
    axes: Axes, name: str, cells: pandas.DataFrame, styles: dict[str, tuple[str, str]]
) -> None:
    rows = numpy.arange(len(cells))
    starts = numpy.zeros(len(cells))
    for column, (colour, hatch) in styles.items():
        has = cells[column].notna().to_numpy()
        widths = cells[column].to_numpy(dtype=float)[has]
        axes.barh(rows[has], widths, 0.7, starts[has], color=colour, hatch=hatch,
                  edgecolor="black", linewidth=0.5)
        starts[has] += widths
    axes.plot(cells["frame_ms.median"], rows, color="black", marker="|", markersize=12,
              markeredgewidth=2, linestyle="none")
    axes.set_ylim(len(cells) - 0.45, -0.55)
    axes.set_xlim(left=0)
    axes.set_yticks(range(len(cells)), [textwrap.shorten(n, 40) for n in cells["label"]])
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
    """The axis title, and below it what the chart was measured on: charts get copied around."""
    commit = f"commit {section.context['Commit']}"
    source = section.title if commit in section.title else f"{section.title}, {commit}"
    axes.set_xlabel(f"{text}\n{textwrap.fill(source, 110)}", size=8)


DRAWN = {
    "frame-times": (FRAME_CAPTION, draw_frame_times),
    "stages": (STAGE_CAPTION, draw_stages),
}


def _save(figure: Figure, path: Path) -> None:
    """Writes PNG and SVG without a date, so that the same data gives the same files."""
    # What bbox_inches="tight" does, but laid out once for both files: layout is the slow part.
    box = figure.get_tightbbox().padded(0.12)
    png, svg = path.with_name(path.name + ".png"), path.with_name(path.name + ".svg")
    figure.savefig(png, dpi=150, bbox_inches=box, facecolor="white")
    figure.savefig(svg, bbox_inches=box, facecolor="white", metadata={"Date": None})
