"""Stacked bars of a section: the stages of a frame, and the buffers of a method.

The vertical unit is the inch: bars keep their thickness and texts their room however many there are.
"""

from __future__ import annotations

import numpy
import pandas
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from .. import formats
from ..compare.labels import short_labels
from ..compare.memory import PREFIX
from ..compare.sections import Section
from .layout import (
    CHARACTER,
    LABEL,
    TITLE_LINE,
    TITLE_SIZE,
    add_legend,
    characters,
    legend_height,
    panel_titles,
    plain,
    robust_limit,
    shortened,
    wrap_label,
)
from .style import COLOURS, GRID, HATCHES, PAGE, TALLEST

ROW = 0.17  # inches
NAMES = 1.9  # inches left of the axes
BARS = PAGE - NAMES - 0.1  # inches of the axes
NOTE_SIZE = 6.2
FOOT = 0.27  # inches below a panel: tick labels
TALLEST_PAGE = TALLEST - 1.0  # inches of panels: what a legend and the axis label leave
GREY = "#bfc5cb"
STAGE_CAPTION = (
    "Where the time goes: the share of each stage, and their sum beside the bar; medians of a separate run "
    "with timers between the stages, which change what they time. The mark is the whole frame, measured "
    "without them. Stages that were timed at a lower clock than the frames are left out."
)
MEMORY_CAPTION = (
    "Memory by buffer, as Vulkan was asked for: the method's own in colours, the scene's and the harness's "
    "in grey. Beside each bar: the sum, and the largest buffer of the method with its share of the method's."
)
SHARED = {"memory.the scene": ("#8d949b", ""), "memory.the harness": (GREY, "")}


def stage_columns(table: pandas.DataFrame) -> list[str]:
    """The stages that some cell of the table has, in the order in which they run."""
    return [c for c in table.columns if c.startswith("stage.") and table[c].notna().any()]


def buffer_columns(table: pandas.DataFrame) -> list[str]:
    """The buffers that some cell has, the one that is largest anywhere first."""
    columns = [c for c in table.columns if c.startswith("memory.") and table[c].notna().any()]
    return sorted(columns, key=lambda column: -table[column].max())


def with_shared(table: pandas.DataFrame) -> tuple[pandas.DataFrame, list[str]]:
    """The table with what is not the method's own summed up, and the method's own columns, largest
    first. Cells that do not say whose a buffer is have it as the method's."""
    own, sums = [], {}
    for column in buffer_columns(table):
        group = next((name for name in ("scene", "harness") if column.startswith(f"memory.{name}: ")), None)
        if group:
            sums.setdefault(f"memory.the {group}", []).append(column)
        else:
            own.append(column)
    return table.assign(**{name: table[columns].sum(axis=1) for name, columns in sums.items()}), own


def _stage_cells(section: Section) -> list[tuple[str, pandas.DataFrame]]:
    columns = stage_columns(section.table)
    return _named(section.table[section.table[columns].notna().any(axis=1)]) if columns else []


def _memory_cells(section: Section) -> list[tuple[str, pandas.DataFrame]]:
    """Variants that take the same memory once."""
    columns = buffer_columns(section.table)
    measured = section.table[section.table["status"] == "ok"]
    return _named(measured.drop_duplicates(["setting", "method", *columns])) if columns else []


def _named(table: pandas.DataFrame) -> list[tuple[str, pandas.DataFrame]]:
    """The cells of each setting, with the `name` of each cell in the chart."""
    names, _ = short_labels(table)
    return list(table.assign(name=table["label"].map(names)).groupby("setting", sort=False))


def _note(settings: list[tuple[str, pandas.DataFrame]]) -> str:
    return short_labels(pandas.concat([cells for _, cells in settings]))[1] if settings else ""


def stage_note(section: Section) -> str:
    """What the caption of the stages must say of the names, or ""."""
    return _note(_stage_cells(section))


def memory_note(section: Section) -> str:
    return _note(_memory_cells(section))


def _paginate(settings: list[tuple[str, pandas.DataFrame]]) -> list[list[tuple[str, pandas.DataFrame]]]:
    """Settings in charts that fit on a page; a setting that is too long for one is taken apart."""
    most = int((TALLEST_PAGE - 0.7) / ROW)
    pages: list[list] = []
    height = TALLEST
    for name, cells in settings:
        for start in range(0, len(cells), most):
            part = cells.iloc[start:start + most]
            own = len(part) * ROW + 0.7
            if height + own > TALLEST_PAGE:
                pages.append([])
                height = 0.0
            pages[-1].append((name, part))
            height += own
    return pages


def stage_pages(section: Section) -> int:
    return len(_paginate(_stage_cells(section)))


def memory_pages(section: Section) -> int:
    return len(_paginate(_memory_cells(section)))


def draw_stages(section: Section, page: int, metric: str = "") -> Figure | None:
    """The stages of each cell, one panel for each setting. None without stage times."""
    pages = _paginate(_stage_cells(section))
    if not pages:
        return None
    columns = stage_columns(section.table)
    styles = {c: (COLOURS[i % len(COLOURS)], HATCHES[i // len(COLOURS) % len(HATCHES)])
              for i, c in enumerate(columns)}
    names = {c: c.removeprefix("stage.").removesuffix("_ms") for c in columns}
    mark = Line2D([], [], color="black", marker="|", markersize=9, linestyle="none", markeredgewidth=2,
                  label="whole frame")
    shown = [(name, _shares(cells, columns)) for name, cells in pages[page]]
    return _draw(shown, styles, names, "share of the sum of the stages, %", 1.0, mark)


def _shares(cells: pandas.DataFrame, columns: list[str]) -> pandas.DataFrame:
    """The cells with their stages in % of the sum of these, `frame` likewise, and the sum as a note.

    Shares, because a method that is fifty times as fast as another would have no stages to be seen.
    """
    sums = cells[columns].sum(axis=1)
    return cells.assign(**{c: 100 * cells[c] / sums for c in columns}, frame=100 * cells["frame_ms.median"] / sums,
                        note=[f"{formats.number(value)} ms" for value in sums])


def draw_memory(section: Section, page: int, metric: str = "") -> Figure | None:
    """The buffers of each method, one panel for each setting. None without memory."""
    pages = _paginate(_memory_cells(section))
    if not pages:
        return None
    _, own = with_shared(section.table)
    own = _leading(section.table, own)
    named, rest = own[:len(COLOURS) - 1], own[len(COLOURS) - 1:]
    styles = {c: (COLOURS[i], "") for i, c in enumerate(named)}
    names = {c: c.removeprefix(PREFIX).removeprefix("memory.") for c in named}
    shown = []
    for name, cells in pages[page]:
        cells, _ = with_shared(cells)
        if rest:
            cells = cells.assign(**{"memory.other": cells[rest].sum(axis=1)})
        shown.append((name, cells.assign(note=_largest(cells, own))))
    if rest:
        styles["memory.other"] = (COLOURS[-1], "///")
        names["memory.other"] = f"{len(rest)} smaller buffers" if len(rest) > 1 else \
            rest[0].removeprefix(PREFIX).removeprefix("memory.")
    for column, style in SHARED.items():
        if any(column in cells for _, cells in shown):
            styles[column], names[column] = style, column.removeprefix("memory.")
    return _draw(shown, styles, names, "memory, MiB", 2.0**20)


def _leading(table: pandas.DataFrame, own: list[str]) -> list[str]:
    """The buffers, those first that are the largest of some method."""
    largest = {method: cells[own].max().fillna(0).idxmax() for method, cells in table.groupby("method")} if own else {}
    first = [column for column in own if column in largest.values() and table[column].max() > 0]
    return first + [column for column in own if column not in first]


def _largest(cells: pandas.DataFrame, own: list[str]) -> list[str]:
    """`77 MiB: nodes 61 %` for each cell: its whole memory and the largest of the method's buffers."""
    notes = []
    for _, row in cells.iterrows():
        sizes = row[own].astype(float).fillna(0) if own else pandas.Series(dtype=float)
        text = f"{formats.mebibytes(row['memory_total_bytes'])} MiB"
        if sizes.sum() > 0:
            largest = sizes.idxmax()
            name = largest.removeprefix(PREFIX).removeprefix("memory.")
            text += f": {name} {100 * sizes[largest] / sizes.sum():.0f} %"
        notes.append(text)
    return notes


def _draw(settings: list[tuple[str, pandas.DataFrame]], styles: dict[str, tuple[str, str]],
          names: dict[str, str], unit: str, divisor: float, mark: Line2D | None = None) -> Figure:
    """One panel for each setting with an axis of its own, so that a fast scene is not lost."""
    styles = {c: style for c, style in styles.items() if any(c in cells and (cells[c] > 0).any()
                                                             for _, cells in settings)}
    handles = shortened([Patch(facecolor=colour, hatch=hatch, edgecolor="black", linewidth=0.4, label=names[c])
                         for c, (colour, hatch) in styles.items()]) + ([mark] if mark else [])
    legend = legend_height([handle.get_label() for handle in handles], PAGE)
    titles = panel_titles([name for name, _ in settings], characters(PAGE - NAMES, TITLE_SIZE))
    heads = [(title.count("\n") + 1) * TITLE_LINE + 0.08 if title else 0.06 for title in titles]
    bars = [len(cells) * ROW + 0.08 for _, cells in settings]
    total = legend + sum(heads) + sum(bars) + FOOT * len(bars) + LABEL
    figure = Figure(figsize=(PAGE, total))
    top, axes = legend, None
    for title, head, height, (_, cells) in zip(titles, heads, bars, settings):
        top += head
        axes = figure.add_axes((NAMES / PAGE, 1 - (top + height) / total, BARS / PAGE,
                                height / total))
        _draw_panel(axes, cells, styles, divisor, mark is not None)
        axes.set_title(title, loc="left", size=TITLE_SIZE, pad=3)
        top += height + FOOT
    axes.set_xlabel(unit, size=8)
    add_legend(figure, handles)
    return figure


def _draw_panel(axes: Axes, cells: pandas.DataFrame, styles: dict[str, tuple[str, str]], divisor: float,
                marked: bool) -> None:
    rows = numpy.arange(len(cells))
    parts = {c: numpy.nan_to_num(cells[c].to_numpy(dtype=float)) / divisor for c in styles if c in cells}
    sums = sum(parts.values())
    limit = robust_limit(sums, origin=0, share=0.25) or sums.max()
    starts = numpy.zeros(len(cells))
    for column, widths in parts.items():
        has = widths > 0
        colour, hatch = styles[column]
        axes.barh(rows[has], widths[has], 0.72, starts[has], color=colour, hatch=hatch, edgecolor="black",
                  linewidth=0.4)
        starts += widths
    frames = cells["frame"].to_numpy(dtype=float) if marked else sums
    longest = min(120.0, frames.max()) if marked else limit
    # A note stands right of its bar, or of the mark of the frame.
    ends = numpy.maximum(sums, numpy.where(frames <= longest, frames, 0))
    room = [1 - (len(note) * NOTE_SIZE * CHARACTER / 72 + 0.1) / BARS for note in cells["note"]]
    last = max(limit, longest)
    axes.set_xlim(0, max([last, *(end / part for end, part in zip(ends, room) if end <= last)]))
    if marked:
        inside = frames <= longest
        axes.plot(frames[inside], rows[inside], color="black", marker="|", markersize=9, markeredgewidth=1.6,
                  linestyle="none")
    for row, value in enumerate(sums):
        beyond = value > limit * (1 + 1e-9)
        text = cells["note"].iloc[row] + (" →" if beyond else "")
        at = axes.get_xlim()[1] if beyond else max(value, frames[row] if marked and frames[row] <= longest else 0)
        axes.annotate(text, (at, row), (-3 if beyond else 4, 0), textcoords="offset points", va="center",
                      ha="right" if beyond else "left", size=NOTE_SIZE,
                      bbox={"facecolor": "white", "edgecolor": "none", "pad": 1} if beyond else None)
    axes.set_ylim(len(cells) - 0.45, -0.55)
    labels, size = _fitting(cells["name"].tolist())
    axes.set_yticks(rows, labels, size=size)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(axis="x", labelsize=7)
    axes.xaxis.set_major_formatter(lambda value, _: plain(value))
    axes.grid(axis="x", **GRID)
    axes.spines[["top", "right"]].set_visible(False)


def _fitting(names: list[str]) -> tuple[list[str], float]:
    """The names and a font size at which they fit left of the axes, in two lines if need be; then the
    middle of what is too long goes."""
    longest = max(map(len, names))
    for size in (7, 6.5, 6):
        if longest <= characters(NAMES, size):
            return names, size
    size = 5
    room = 2 * characters(NAMES, size) - 14  # lines break at words
    cut = [name if len(name) <= room else f"{name[:room // 2 - 1]} … {name[-(room // 2 - 2):]}" for name in names]
    return [wrap_label(name, characters(NAMES, size)) for name in cut], size
