"""Laying out a chart in inches: panels with titles, a legend above them, labels at points, limits.

A layout engine would take a second for each chart, and would not keep room for a legend outside.
"""

from __future__ import annotations

import itertools
import math
import textwrap
from collections.abc import Sequence

import numpy
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, LogLocator, NullFormatter

from .style import GRID, PAGE, TALLEST

# Inches: a line of a title or of a legend, what tick labels and axis labels take.
TITLE_LINE, LEGEND_LINE, TICKS, LABEL = 0.15, 0.133, 0.26, 0.22
LEFT, GAP = 0.68, 0.32
TITLE_SIZE = 8
CHARACTER = 0.6  # of the font size: the mean width of a character of DejaVu Sans
LEGEND_CHARACTERS = 46  # two columns of the page
MOST_TITLE_LINES = 3
MOST_ENTRIES = 60  # of a legend: more would leave no room for panels
MOST_LABELS = 60  # points of one panel that a label is tried for
HALO = [withStroke(linewidth=1.6, foreground="white")]  # a text over a line stays legible


def characters(inches: float, size: float) -> int:
    """How many characters of a font size in points fit into a width."""
    return max(8, int(inches * 72 / (CHARACTER * size)))


def panel_titles(names: Sequence[str], width: int) -> list[str]:
    """The names in lines of at most `width` characters, at most three each.

    Names that are too long lose what they begin with in common, and then their middle: what tells
    them apart stays. Different names give different titles.
    """
    wrapped = [textwrap.wrap(name, width) or [""] for name in names]
    if max(map(len, wrapped), default=0) > MOST_TITLE_LINES and len(set(names)) > 1:
        start = _common_words(list(dict.fromkeys(names)))
        names = [f"… {name[start:]}" if start else name for name in names]
        wrapped = [textwrap.wrap(name, width) or [""] for name in names]
    titles = ["\n".join(lines if len(lines) <= MOST_TITLE_LINES
                        else [lines[0], "…", lines[-1]]) for lines in wrapped]
    taken: dict[str, str] = {}
    for i, (name, title) in enumerate(zip(names, titles)):
        if taken.setdefault(title, name) != name:
            titles[i] = f"{title} #{i + 1}"
    return titles


def wrap_label(label: str, width: int) -> str:
    """`lucid (a=1, b=2)` in lines of about `width` characters. No line ends in a comma: the break says it."""
    lines = [""]
    for part in label.split(", "):
        longer = f"{lines[-1]}, {part}" if lines[-1] else part
        lines = [*lines[:-1], longer] if len(longer) <= width or not lines[-1] else [*lines, part]
    return "\n".join(piece for line in lines for piece in textwrap.wrap(line, width, break_long_words=False,
                                                                        break_on_hyphens=False) or [""])


def _common_words(names: list[str]) -> int:
    """How many characters all names begin with in common, to the end of a word."""
    common = 0
    for i, letters in enumerate(zip(*names)):
        if len(set(letters)) > 1:
            break
        if letters[0] == " ":
            common = i + 1
    return common


def shortened(handles: list, most: int = MOST_ENTRIES) -> list:
    """The entries of a legend; of too many the first, and how many more there are."""
    if len(handles) <= most:
        return handles
    return [*handles[:most - 1], Line2D([], [], linestyle="none", label=f"and {len(handles) - most + 1} more")]


def legend_columns(labels: Sequence[str], width: float, size: float = 7) -> int:
    """In how many columns the entries of a legend fit into a width in inches."""
    longest = max((len(line) for label in labels for line in label.split("\n")), default=0)
    return max(1, min(len(labels), characters(width, size) // (longest + 6)))


def legend_labels(labels: Sequence[str]) -> list[str]:
    """The entries as a legend has them: long ones take two lines rather than the room of a column."""
    return [wrap_label(label, LEGEND_CHARACTERS) for label in labels]


def legend_height(labels: Sequence[str], width: float) -> float:
    """In inches; 0 without entries."""
    if not labels:
        return 0.0
    lines = [label.count("\n") + 1 for label in legend_labels(labels)]
    columns = legend_columns(legend_labels(labels), width)
    rows, longer = divmod(len(lines), columns)  # the first columns have one entry more
    starts = [column * rows + min(column, longer) for column in range(columns + 1)]
    return max(sum(lines[first:last]) for first, last in itertools.pairwise(starts)) * LEGEND_LINE + 0.08


def add_legend(figure: Figure, handles: Sequence, size: float = 7) -> None:
    """A legend at the top left of the figure."""
    if handles:
        labels = legend_labels([handle.get_label() for handle in handles])
        figure.legend(handles=handles, labels=labels, loc="upper left", bbox_to_anchor=(0, 1), frameon=False,
                      fontsize=size, ncol=legend_columns(labels, figure.get_figwidth(), size), borderaxespad=0.1,
                      handletextpad=0.5, columnspacing=1.2, labelspacing=0.35)


def panel_grid(names: Sequence[str], columns: int, height: float, handles: Sequence = (),
               gap: float = GAP) -> tuple[Figure, list[Axes]]:
    """Panels of `height` inches in rows of `columns`, `gap` apart, with their titles, under a legend."""
    width = PAGE
    columns = min(columns, len(names))
    rows = math.ceil(len(names) / columns)
    panel = (width - LEFT - 0.1 - (columns - 1) * gap) / columns
    titles = panel_titles(names, characters(panel, TITLE_SIZE))
    lines = max((title.count("\n") + 1 for title in titles if title), default=0)
    above = lines * TITLE_LINE + 0.06
    legend = legend_height([handle.get_label() for handle in handles], width)
    total = legend + rows * (above + height + TICKS) + LABEL
    if total > TALLEST:  # the panels give way, since nothing else can
        height -= (total - TALLEST) / rows
        total = TALLEST
    figure = Figure(figsize=(width, total))
    all_axes = []
    for index, title in enumerate(titles):
        row, column = divmod(index, columns)
        top = legend + row * (above + height + TICKS) + above
        axes = figure.add_axes(((LEFT + column * (panel + gap)) / width, 1 - (top + height) / total,
                                panel / width, height / total))
        axes.set_title(title, size=TITLE_SIZE, loc="left", pad=3)
        axes.tick_params(labelsize=7)
        axes.grid(**GRID)
        axes.spines[["top", "right"]].set_visible(False)
        all_axes.append(axes)
    add_legend(figure, handles)
    return figure, all_axes


def robust_limit(values: Sequence[float], log: bool = False, origin: float | None = None,
                 share: float = 0.1) -> float | None:
    """Where an axis ends so that a few values far off do not crush the others; None where none are.

    At most a `share` of the values (one, of a few) is left beyond the end, and only if the others then
    get 2.5 times the room between it and `origin` (their least by default). On a log axis they must be
    ten times off, too.
    """
    finite = numpy.sort(numpy.asarray([v for v in values if v is not None and math.isfinite(v)
                                       and (v > 0 or not log)], dtype=float))
    if len(finite) < 5:
        return None
    scaled = numpy.log10(finite) if log else finite
    start = scaled[0] if origin is None else origin
    for beyond in range(1, max(1, int(len(finite) * share)) + 1):
        inner, outer = scaled[-beyond - 1], scaled[-beyond]
        far = scaled[-1] - start > 2.5 * (inner - start) and inner > start
        if far and (not log or outer - inner >= 1):
            return float(finite[-beyond - 1])
    return None


def mark_beyond(axes: Axes, places: Sequence[tuple[float, float, str]], along: str, colour: str) -> None:
    """An arrow with the value at the end of an axis for each (x, y, value) beyond it."""
    for x, y, text in places:
        if along == "x":
            at, offset, align = (axes.get_xlim()[1], y), (-3, 0), {"ha": "right", "va": "center"}
        else:
            at, offset, align = (x, axes.get_ylim()[1]), (0, -2), {"ha": "center", "va": "top"}
        axes.annotate(f"{text} →" if along == "x" else f"↑ {text}", at, offset, textcoords="offset points",
                      size=6, color=colour, zorder=5, **align)


def place_labels(axes: Axes, points: Sequence[tuple[float, float, str, str]], size: float = 6.5,
                 lines: Sequence[tuple[float, float, float, float]] = ()) -> list[bool]:
    """Writes (x, y, text, colour) beside each point where it covers neither a point nor a label, nor one
    of the upright and level `lines` (x0, y0, x1, y1). A point without text is only kept free.

    Earlier points choose first; what finds no place stays without its label. Returns for each point whether
    its text was written. The limits of the axes must be set.
    """
    figure = axes.get_figure()
    scale = 72 / figure.dpi
    at = [tuple(axes.transData.transform((x, y)) * scale) for x, y, _, _ in points]  # in points
    frame = axes.get_window_extent()
    left, bottom, right, top = (value * scale for value in frame.extents)
    marks = [(x - 3, y - 3, x + 3, y + 3) for x, y in at]
    for x0, y0, x1, y1 in lines:
        (u0, v0), (u1, v1) = axes.transData.transform([(x0, y0), (x1, y1)]) * scale
        marks.append((min(u0, u1), min(v0, v1) - 0.5, max(u0, u1), max(v0, v1) + 0.5))
    taken = numpy.asarray(marks).reshape(-1, 4)
    written = [False] * len(points)
    labelled = [index for index, (_, _, text, _) in enumerate(points) if text]
    for index in labelled[:MOST_LABELS]:
        (x, y, text, colour), (px, py) = points[index], at[index]
        lines = text.split("\n")
        width = max(map(len, lines)) * size * CHARACTER
        height = len(lines) * size * 1.2
        for dx, dy, horizontal, vertical in _offsets():
            x0 = px + dx - {"left": 0, "center": width / 2, "right": width}[horizontal]
            y0 = py + dy - {"bottom": 0, "center": height / 2, "top": height}[vertical]
            box = (x0, y0, x0 + width, y0 + height)
            inside = box[0] >= left + 1 and box[2] <= right + 6 and box[1] >= bottom and box[3] <= top + 2
            if inside and not _overlaps(box, taken) and _nearest(box, index, at, points):
                taken = numpy.vstack([taken, box])
                axes.annotate(text, (x, y), (dx, dy), textcoords="offset points", ha=horizontal, va=vertical,
                              size=size, color=darker(colour), linespacing=1.0, zorder=4,
                              annotation_clip=False, path_effects=HALO)
                written[index] = True
                break
    return written


def _offsets() -> list[tuple[float, float, str, str]]:
    """Where a label may stand: right of its point first, then around it, then a little further off."""
    found = []
    for away in (4.5, 9):
        found += [(away, 0, "left", "center"), (-away, 0, "right", "center"), (0, away, "center", "bottom"),
                  (0, -away, "center", "top"), (away, away, "left", "bottom"), (away, -away, "left", "top"),
                  (-away, away, "right", "bottom"), (-away, -away, "right", "top")]
    return found


def _nearest(box: tuple[float, float, float, float], own: int, at: Sequence[tuple[float, float]],
             points: Sequence[tuple[float, float, str, str]]) -> bool:
    """Whether no other point is nearer to a label than its own, so that it would be taken for the other's.
    A label that names no variant (`wboit`) may stand by another point of its colour."""
    places = numpy.asarray(at)
    outside = [numpy.maximum(numpy.maximum(box[axis] - places[:, axis], places[:, axis] - box[axis + 2]), 0)
               for axis in (0, 1)]
    away = numpy.hypot(*outside)
    nearer = numpy.flatnonzero(away < away[own])
    text, colour = points[own][2:]
    return all(points[other][3] == colour and "=" not in text for other in nearer)


def _overlaps(box: tuple[float, float, float, float], others: numpy.ndarray) -> bool:
    """Whether a box (left, bottom, right, top) covers part of any of the others."""
    return bool(((box[0] < others[:, 2]) & (others[:, 0] < box[2]) & (box[1] < others[:, 3])
                 & (others[:, 1] < box[3])).any())


def darker(colour: str) -> str:
    """A colour for text on white: yellow and light blue are too light to read."""
    parts = [int(colour[i:i + 2], 16) for i in (1, 3, 5)]
    light = 0.299 * parts[0] + 0.587 * parts[1] + 0.114 * parts[2]
    factor = min(1.0, 105 / light) if light else 1.0
    return "#" + "".join(f"{int(part * factor):02x}" for part in parts)


def log_axis(axes: Axes, which: str, low: float, high: float, most: int = 4) -> None:
    """A logarithmic axis from low to high, with plain numbers at few places, whatever the span."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    (axes.set_xscale if which == "x" else axes.set_yscale)("log")
    (axes.set_xlim if which == "x" else axes.set_ylim)(low, high)
    axis.set_major_locator(FixedLocator(log_ticks(low, high, most)))
    axis.set_major_formatter(lambda value, _: plain(value))
    axis.set_minor_formatter(NullFormatter())


def log_ticks(low: float, high: float, most: int) -> list[float]:
    """At most `most` round places from low to high, two at least."""
    ticks: list[float] = []
    for steps in ((1,), (1, 3), (1, 2, 5), (1, 1.5, 2, 3, 4, 5, 6, 8)):
        ticks = [t for t in LogLocator(subs=steps).tick_values(low, high) if low <= t <= high]
        if len(ticks) >= 2:
            break
    if len(ticks) < 2:
        ticks = list(numpy.linspace(low, high, 4)[1:3])
    while len(ticks) > most:
        ticks = ticks[::2]
    return ticks


def linear_label(value: float) -> str:
    """A tick label of a linear axis, whose ticks may lie close together."""
    return plain(value) if abs(value) >= 1e4 else f"{value:.6g}"


def plain(value: float) -> str:
    """A tick label: three digits at most, 12 K for large numbers."""
    for factor, prefix in ((1e9, "G"), (1e6, "M"), (1e4, "K")):
        if abs(value) >= factor * 0.9995:
            value, unit = value / (1e3 if prefix == "K" else factor), prefix
            return f"{float(f'{value:.3g}'):g} {unit}"
    return f"{float(f'{value:.3g}'):g}"
