"""What a parameter does: lines of one quantity over another, for what else differs.

A line joins cells that differ in nothing but the quantity on the x axis. Times relative to one value
of it are compared within a group of cells that were measured in turn, block by block.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy
import pandas
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .. import formats
from ..compare.labels import is_given, records
from ..compare.quantities import Quantity, find_quantity, in_order, varying
from ..compare.sections import SETTING, Section
from ..compare.statistics import Comparison, compare_cells
from ..read.sources import BadResults
from .layout import LEFT, characters, linear_label, log_axis, mark_beyond, panel_grid, robust_limit
from .quality_speed import error_floor, set_error_axis
from .style import DASHES, PAGE, series_look

PANELS_PER_CHART = 12
MOST_DASHES = len(DASHES)
LOG_ABOVE = 30  # span of values from which on an axis is logarithmic
LOG_X_ABOVE = 20
# Where a group of panels comes from.
PER_COLUMN = {"scene": "scene_label", "method": "method", "view": "view", "size": "size_label",
              "setting": "setting"}


@dataclass(frozen=True)
class Curve:
    """What to draw. `x`, `y` and `per` are names as find_quantity() knows them; `per` gives each value
    a panel. `base` is the value of x to which y is related; `speedup` turns that ratio over."""

    x: str
    y: str
    per: str = ""
    method: str = ""  # only this one
    base: float | str | None = None
    speedup: bool = False

    @property
    def name(self) -> str:
        parts = [self.y, "over", self.x, *(["per", self.per] if self.per else [])]
        return "-".join("".join(c if c.isalnum() or c in "._" else "-" for c in part) for part in parts)

    def caption(self) -> str:
        text = f"{self.y} over {self.x}" + (f", per {self.per}" if self.per else "")
        if self.base is not None:
            text = f"{'speed-up' if self.speedup else self.y} over {self.x}, against {self.x} = {self.base}"
        return f"{text}. A line joins cells that differ in nothing but {self.x}; intervals: 95%."


# The depth filter and the alpha threshold of the paper, to whose values its tables relate the times.
DEPTH_FILTER = (Curve("depth_filter", "wrong_order_found", method="lucid"),
                Curve("depth_filter", "time", method="lucid", base=3))
ALPHA_THRESHOLD = (Curve("alpha_threshold", "time", per="scene", method="lucid", base=0, speedup=True),)


@dataclass(frozen=True)
class Line:
    """The cells of one line, by rising x. Setting and variant say what tells it from the others."""

    panel: str
    setting: str
    variant: str
    x: list
    cells: pandas.DataFrame


def lines_of(section: Section, curve: Curve) -> list[Line]:
    """Every line of two values of x or more, where y is known; [] where there are none."""
    table = section.table[section.table["status"] == "ok"]
    if curve.method:
        table = table[table["method"] == curve.method]
    if table.empty:
        return []
    try:
        x, y = find_quantity(curve.x, table), find_quantity(curve.y, table)
    except BadResults:
        return []
    table = table.assign(x=x.values(table), y=y.values(table))
    table = table[table["x"].notna() & table["y"].notna()]
    if table.empty:
        return []
    if "view" in x.columns:  # each path is a line; its places are the x
        table = table.assign(view=table["view"].str.partition("@")[0])
    # What a scene holds changes with its knobs, and a scene of other triangles has another hash.
    same = {*x.columns, "content_hash"} | ({"detail"} if curve.x == "triangles" else set())
    setting = [name for name in SETTING if name not in same]
    parameters = [name for name in table.columns if name.startswith("param.") and name not in same]
    keys = [*setting, "method", *parameters]
    several = table.groupby(keys, dropna=False)["x"].transform("nunique") > 1
    groups = [cells for _, cells in table[several].groupby(keys, sort=False, dropna=False)]
    firsts = [records(cells.head(1))[0] for cells in groups]
    panels = [_panel(first, curve) for first in firsts]
    said = _names(firsts, panels, setting)
    variants = _variants(firsts, panels, parameters)
    return [Line(panel, one, variant, cells["x"].tolist(), cells)
            for panel, one, variant, cells in zip(panels, said, variants, map(_sorted, groups))]


def check(sections: list[Section], curve: Curve) -> None:
    """Raises BadResults that says what is wrong with what the user asked for, where no section has it."""
    tables = [section.table for section in sections]
    names = [curve.x, curve.y] + ([curve.per] if curve.per and curve.per not in PER_COLUMN else [])
    for name in names:
        find_quantity(name, pandas.concat(tables))
    if any(lines_of(section, curve) for section in sections):
        return
    varied = list(dict.fromkeys(name for table in tables for name in varying(table)))
    raise BadResults(f"no two cells differ in {curve.x} alone and have {curve.y}; "
                     f"these vary: {', '.join(varied) or 'none'}")


def _sorted(cells: pandas.DataFrame) -> pandas.DataFrame:
    """By rising x; of cells with the same x the newest."""
    cells = cells.sort_values("date", kind="stable").drop_duplicates("x", keep="last")
    order = in_order(cells["x"].tolist())
    return cells.assign(place=cells["x"].map(order.index)).sort_values("place")


def _panel(row: dict, curve: Curve) -> str:
    if not curve.per:
        return ""
    if curve.per == "scene":  # without knobs that are on the x axis
        return row["scene"]
    if curve.per in PER_COLUMN:
        return str(row[PER_COLUMN[curve.per]])
    return f"{curve.per}={formats.parameter(row.get(f'param.{curve.per}', row.get(curve.per)))}"


def _names(rows: list[dict], panels: list[str], columns: list[str]) -> list[str]:
    """For each row the values of the columns that differ among the rows of some panel."""
    varying = [c for c in columns if len({(panel, str(row.get(c))) for panel, row in zip(panels, rows)})
               > len(set(panels))]
    return [", ".join(_word(c, row[c]) for c in varying if is_given(row.get(c))) for row in rows]


def _variants(rows: list[dict], panels: list[str], parameters: list[str]) -> list[str]:
    """`lucid (repair=true)`: the method where there are several, and what differs among its own lines."""
    methods = [row["method"] for row in rows]
    words = [""] * len(rows)
    several = len(set(zip(panels, methods))) > len(set(panels))
    for method in set(methods):
        own = [index for index, name in enumerate(methods) if name == method]
        texts = _names([rows[index] for index in own], [panels[index] for index in own], parameters)
        for index, text in zip(own, texts):
            words[index] = (f"{method} ({text})" if text else method) if several else text
    return words


def _word(column: str, value: object) -> str:
    text = formats.parameter(value)
    if column in ("scene", "method", "view", "format"):
        return text
    if column in ("width", "height"):
        return f"{column} {text}"
    return f"{column.removeprefix('param.')}={text}"


def panels_of(section: Section, curves: tuple[Curve, ...]) -> list[tuple[Curve, str, list[Line]]]:
    """The panels of a chart: for each curve, one for each value of what it is drawn per.

    Where many variants meet many settings, each setting has a panel of its own.
    """
    panels = []
    for curve in curves:
        lines = lines_of(section, curve)
        per_setting = not curve.per and len(curves) == 1 and len({line.setting for line in lines}) > 1 and \
            len({line.variant for line in lines}) > MOST_DASHES
        if per_setting:
            lines = [Line(line.setting, "", line.variant, line.x, line.cells) for line in lines]
        for name in dict.fromkeys(line.panel for line in lines):
            panels.append((curve, name, [line for line in lines if line.panel == name]))
    return panels


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
    places = {curve.x: in_order([value for other, _, lines in panels if other.x == curve.x
                                 for line in lines for value in line.x]) for curve, _, _ in panels}
    for axes, (curve, _, lines) in zip(all_axes, panels):
        _draw_panel(axes, section, curve, lines, looks, places[curve.x])
    for index, (axes, (curve, _, _)) in enumerate(zip(all_axes, panels)):
        if index % columns == 0 or len(curves) > 1:
            axes.set_ylabel(_y_label(section, curve), size=8)
        if index + columns >= len(panels):
            axes.set_xlabel(find_quantity(curve.x, section.table).label, size=8)
    return figure


def _has_base(panel: tuple[Curve, str, list[Line]]) -> bool:
    curve, _, lines = panel
    return curve.base is None or any(_place_of(line.x, curve.base) is not None for line in lines)


def _place_of(values: list, base: float | str) -> int | None:
    """Where the base is among the values of x, which may be numbers or texts."""
    for index, value in enumerate(values):
        if value == base or formats.parameter(value) == str(base):
            return index
    return None


def _y_label(section: Section, curve: Curve) -> str:
    if curve.speedup:
        return f"speed-up against {curve.base:g}"
    label = find_quantity(curve.y, section.table).label
    return label if curve.base is None else f"{label.split(',')[0]}, % of that at {curve.base}"


def _draw_panel(axes: Axes, section: Section, curve: Curve, lines: list[Line], looks: dict,
                places: list) -> None:
    """`places` are the values of x in all panels, which have the same axis."""
    x, y = (find_quantity(name, section.table) for name in (curve.x, curve.y))
    even = not x.is_number or _uneven(places)  # a place for each value rather than a scale
    drawn = []
    for line in lines:
        at = [places.index(value) for value in line.x] if even else line.x
        drawn += [(line, *point) for point in _points(section, curve, y, line, at)]
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
        axes.plot(*zip(*inside) if inside else ([], []), markersize=3.5, linewidth=1, **look)
        sure = [(at, low, high) for at, value, low, high in own if low is not None and value <= top]
        if sure:
            axes.vlines([s[0] for s in sure], [s[1] for s in sure], [s[2] for s in sure],
                        color=look["color"], linewidth=0.9)
        mark_beyond(axes, [(at, value, formats.number(value)) for at, value, _, _ in own if value > top],
                    "y", "black")
    _set_x_axis(axes, places, even)
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
    place = _place_of(line.x, curve.base)
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


def _uneven(places: list) -> bool:
    """Few values, most of them crowded: 0, 0.9, 0.99, 0.999. Each gets the same room."""
    if len(places) < 3 or len(places) > 8:
        return False
    steps = numpy.diff(places)
    return steps.max() > 8 * numpy.median(steps)


def _set_x_axis(axes: Axes, places: list, even: bool) -> None:
    if even:
        _name_places(axes, places)
    elif places[0] > 0 and places[-1] / places[0] > LOG_X_ABOVE:
        log_axis(axes, "x", places[0] / 1.1, places[-1] * 1.1, 6)
    else:
        axes.xaxis.set_major_formatter(lambda value, _: linear_label(value))
        if all(float(place).is_integer() for place in places):
            axes.xaxis.get_major_locator().set_params(integer=True)


def _name_places(axes: Axes, places: list) -> None:
    """Ticks at even places: every name that finds room, numbers with as few digits as tell them apart."""
    names = [formats.parameter(place) for place in places]
    for digits in range(2, 7):
        short = [place if isinstance(place, str) else f"{place:.{digits}g}" for place in places]
        if len(set(short)) == len(places):
            names = short
            break
    size = 6
    room = characters(axes.get_position().width * PAGE, size)
    step = -(-sum(len(name) + 1 for name in names) // room)
    axes.set_xticks(range(0, len(places), step), names[::step], size=size)
    axes.set_xlim(-0.4, len(places) - 0.6)


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
    return [Line2D([], [], markersize=3.5, linewidth=1, label=name or "–", **looks[pair])
            for pair, name in names.items()]
