"""The lines of a curve: the cells that differ in nothing but the quantity on the x axis."""

from __future__ import annotations

from dataclasses import dataclass, replace

import pandas

from .. import formats
from ..compare.labels import is_given, records
from ..compare.quantities import find_quantity, in_order, varying
from ..compare.sections import SETTING, Section
from ..compare.special_values import Special, meaning
from ..read.sources import BadResults
from .style import DASHES

MOST_DASHES = len(DASHES)
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
    if x.columns[:1] and x.columns[0].startswith("param."):
        name = x.columns[0].removeprefix("param.")
        said = [meaning(method, name, value) for method, value in zip(table["method"], table["x"])]
        table = table.assign(x=pandas.Series(said, index=table.index, dtype=object))
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
    methods = {method for table in tables for method in table["method"]}
    if curve.method and curve.method not in methods:
        raise BadResults(f"no cell is of the method {curve.method!r}; there are: {', '.join(sorted(methods))}")
    names = [curve.x, curve.y] + ([curve.per] if curve.per and curve.per not in PER_COLUMN else [])
    for name in names:
        find_quantity(name, pandas.concat(tables))
    lines = [line for section in sections for line in lines_of(section, curve)]
    if lines:
        if curve.base is not None and all(place_of(line.x, curve.base) is None for line in lines):
            there = in_order([value for line in lines for value in line.x])
            raise BadResults(f"no line has {curve.x} = {curve.base}; there are: "
                             f"{', '.join(formats.parameter(value) for value in there)}")
        return
    varied = list(dict.fromkeys(name for table in tables for name in varying(table)))
    raise BadResults(f"no two cells differ in {curve.x} alone and have {curve.y}; "
                     f"these vary: {', '.join(varied) or 'none'}")


def place_of(values: list, base: float | str) -> int | None:
    """Where the base is among the values of x: numbers, texts, or special ones, by number or word."""
    for index, value in enumerate(values):
        number = value.value if isinstance(value, Special) else value
        if number == base or str(base) in (formats.parameter(number), str(value)):
            return index
    return None


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
            lines = [replace(line, panel=line.setting, setting="") for line in lines]
        for name in dict.fromkeys(line.panel for line in lines):
            panels.append((curve, name, [line for line in lines if line.panel == name]))
    return panels
