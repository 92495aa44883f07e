"""What a parameter does: lines of one quantity over another, for what else differs.

A line joins cells that differ in nothing but the quantity on the x axis. Times relative to one value
of it are compared within a group of cells that were measured in turn, block by block.
"""

from __future__ import annotations

import pandas
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .. import formats
from ..compare.quantities import Quantity, find_quantity
from ..compare.sections import Section, baselines_of
from ..compare.special_values import Special
from ..compare.statistics import Comparison, compare_cells
from .curve_lines import MOST_DASHES, Curve, Line, panels_of, place_of
from .layout import LEFT, linear_label, log_axis, mark_beyond, panel_grid, robust_limit, shortened
from .quality_speed import error_floor, set_error_axis
from .style import DASHES, series_look
from .x_axis import XAxis

PANELS_PER_CHART = 12
MOST_HANDLES = 24  # entries of a legend: looks come again after as many
LOG_ABOVE = 30  # span of values from which on the y axis is logarithmic


def pages(curves: tuple[Curve, ...]):
    """A function that says how many charts the curves of a section take."""
    def count(section: Section) -> int:
        return -(-len(panels_of(section, curves)) // PANELS_PER_CHART)
    return count


def draw_curves(section: Section, curves: tuple[Curve, ...], page: int = 0) -> Figure | None:
    """The panels of this page; None where x was not varied."""
    panels = panels_of(section, curves)[page * PANELS_PER_CHART:(page + 1) * PANELS_PER_CHART]
    panels = [panel for panel in panels if _has_base(panel)]
    if not panels:
        return None
    looks = _looks([line for _, _, lines in panels for line in lines])
    columns = 1 if len(panels) == 1 else 2 if len(panels) in (2, 4) else 3
    figure, all_axes = panel_grid([name for _, name, _ in panels], columns, 2.6 if len(panels) < 3 else 1.6,
                                  _handles(looks), LEFT if len(curves) > 1 else 0.45)
    x_axes = {curve.x: XAxis([value for other, _, lines in panels if other.x == curve.x
                              for line in lines for value in line.x],
                             find_quantity(curve.x, section.table).is_number) for curve, _, _ in panels}
    for axes, (curve, _, lines) in zip(all_axes, panels):
        _draw_panel(axes, section, curve, lines, looks, x_axes[curve.x])
    for index, (axes, (curve, _, lines)) in enumerate(zip(all_axes, panels)):
        if index % columns == 0 or len(curves) > 1:
            axes.set_ylabel(_y_label(section, curve, lines), size=8)
        if index + columns >= len(panels):
            label = find_quantity(curve.x, section.table).label
            axes.set_xlabel(label.replace("the baseline", baselines_of(section.table)), size=8)
    return figure


def _has_base(panel: tuple[Curve, str, list[Line]]) -> bool:
    curve, _, lines = panel
    return curve.base is None or any(place_of(line.x, curve.base) is not None for line in lines)


def _y_label(section: Section, curve: Curve, lines: list[Line]) -> str:
    label = find_quantity(curve.y, section.table).label.replace("the baseline", baselines_of(section.table))
    if curve.base is None:
        return label
    places = ((line, place_of(line.x, curve.base)) for line in lines)
    base = next((line.x[place] for line, place in places if place is not None), curve.base)
    base = f"“{base}”" if isinstance(base, Special) else formats.parameter(base)
    return f"speed-up against {base}" if curve.speedup else f"{label.split(',')[0]}, % of that at {base}"


def _draw_panel(axes: Axes, section: Section, curve: Curve, lines: list[Line], looks: dict,
                x_axis: XAxis) -> None:
    y = find_quantity(curve.y, section.table)
    drawn = [(line, *point) for line in lines
             for point in _points(section, curve, y, line, list(map(x_axis.at, line.x)))]
    values = [value for _, _, value, _, _ in drawn]
    related = curve.base is not None
    ends = [end for *_, low, high in drawn for end in (low, high) if end is not None]
    top = _set_y_axis(axes, y, values, ends, related)
    for line in lines:
        look = looks[line.setting, line.variant]
        own = [(at, value, low, high) for other, at, value, low, high in drawn if other is line]
        if not own:
            continue
        inside = [(at, _floored(axes, value, y, related)) for at, value, _, _ in own if value <= top]
        axes.plot(*zip(*inside) if inside else ([], []), markersize=3.5, linewidth=1, clip_on=False, **look)
        sure = [(at, low, high) for at, value, low, high in own if low is not None and value <= top]
        if sure:
            axes.vlines([s[0] for s in sure], [s[1] for s in sure], [s[2] for s in sure],
                        color=look["color"], linewidth=0.9)
        mark_beyond(axes, [(at, value, formats.number(value)) for at, value, _, _ in own if value > top],
                    "y", "black")
    x_axis.apply(axes)
    if related:
        axes.axhline(1 if curve.speedup else 100, color="black", linewidth=0.6)


def _points(section: Section, curve: Curve, y: Quantity, line: Line, at: list):
    """(x, y, low, high) of each cell of a line; low and high are None where there is no interval."""
    values = line.cells["y"].tolist()
    if curve.base is None:
        ends = [line.cells[name].tolist() for name in y.interval] if y.interval else [[None] * len(at)] * 2
        return [(x, value, *((low, high) if formats.is_number(low) and formats.is_number(high)
                             else (None, None)))
                for x, value, low, high in zip(at, values, *ends)]
    place = place_of(line.x, curve.base)
    if place is None:
        return []
    if curve.y == "time":
        base = section.cells[line.cells["key"].iloc[place]]
        ratios = [compare_cells(section.cells[key], base) for key in line.cells["key"]]
    else:
        ratios = [Comparison(value / values[place] if values[place] else None, None, None, 0, "")
                  for value in values]
    return [_related(x, ratio, curve.speedup) for x, ratio in zip(at, ratios) if ratio.ratio]


def _related(x, c: Comparison, speedup: bool) -> tuple:
    """A ratio in percent, or turned over as a speed-up."""
    if speedup:
        low, high = (1 / c.high, 1 / c.low) if c.low is not None else (None, None)
        return x, 1 / c.ratio, low, high
    low, high = (100 * c.low, 100 * c.high) if c.low is not None else (None, None)
    return x, 100 * c.ratio, low, high


def _set_y_axis(axes: Axes, y: Quantity, values: list[float], ends: list[float], related: bool) -> float:
    """Sets the limits; returns the largest value that is drawn in its place."""
    if y.metric and not related:
        errors = pandas.Series(values, dtype=float)
        set_error_axis(axes, y.metric, errors, error_floor(errors))
        return max(values)
    low, high = min(values), max(values)
    log = low > 0 and high / low > LOG_ABOVE
    top = robust_limit(values, log, origin=None if related or log else min(0.0, low)) or high
    if log:
        log_axis(axes, "y", low / 1.3, top * 1.3)
        return top
    if related:  # the differences count, not the distance from 0; but a per cent is not a mountain
        low, top = min([low, *ends]), max([top, *(end for end in ends if end <= 1.2 * top)])
        room = max((top - low) * 0.08, (0.06 * top - (top - low)) / 2)
        axes.set_ylim(low - room, top + room)
    else:
        axes.set_ylim(min(0.0, low * 1.1), (top or 1) * 1.12)
    axes.yaxis.set_major_formatter(lambda value, _: linear_label(value))
    return top


def _floored(axes: Axes, value: float, y: Quantity, related: bool) -> float:
    return max(value, axes.get_ylim()[0]) if y.metric and not related else value


def _looks(lines: list[Line]) -> dict[tuple[str, str], dict]:
    """Colour and marker by setting and dashes by variant; by variant alone where there is one setting,
    or where there are more variants than kinds of dashes."""
    settings = list(dict.fromkeys(line.setting for line in lines))
    variants = list(dict.fromkeys(line.variant for line in lines))
    both = len(settings) > 1 and len(variants) > 1
    looks = {}
    for line in lines:
        if both and len(variants) <= MOST_DASHES:
            index, dash = settings.index(line.setting), variants.index(line.variant)
        else:
            names = list(dict.fromkeys((other.setting, other.variant) for other in lines))
            index = names.index((line.setting, line.variant))
            dash = index // 24  # after every colour with every marker that goes with it
        looks[line.setting, line.variant] = series_look(index) | {"linestyle": DASHES[dash % MOST_DASHES]}
    return looks


def _handles(looks: dict[tuple[str, str], dict]) -> list[Line2D]:
    """Legend entries: settings by colour, variants by dashes, or both by colour."""
    settings, variants = (list(dict.fromkeys(pair[i] for pair in looks)) for i in (0, 1))
    if len(settings) > 1 and len(variants) > 1 and len(variants) <= MOST_DASHES:
        colours = {pair[0]: look for pair, look in reversed(looks.items())}
        dashes = {pair[1]: look["linestyle"] for pair, look in looks.items()}
        return [Line2D([], [], markersize=3.5, linewidth=1, label=name or "–", **colours[name] | {"linestyle": "-"})
                for name in settings] + [
                    Line2D([], [], color="black", linestyle=dash, linewidth=1, label=name or "–")
                    for name, dash in dashes.items()]
    names = {pair: ", ".join(part for part in pair if part) for pair in looks}
    if len(names) == 1:
        return []
    return shortened([Line2D([], [], markersize=3.5, linewidth=1, label=name or "–", **looks[pair])
                      for pair, name in names.items()], MOST_HANDLES)
