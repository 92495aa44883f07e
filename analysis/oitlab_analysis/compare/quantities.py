"""What a chart can have on its axes: parameters, scene knobs, sizes, times, errors, counts.

A quantity is found by the name that a user would type: one of NAMED, a parameter, a stage, a counter,
or any column of cells.csv.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable
from dataclasses import dataclass

import numpy
import pandas

from ..formats import natural_key, parameter
from ..read.sources import BadResults
from .metrics import METRICS, Metric, column, wrong_order_found
from .special_values import Special


@dataclass(frozen=True)
class Quantity:
    """A column of values of cells: numbers, or texts where `is_number` is false.

    `columns` are those of the tidy table from which it is made: cells that differ in these only
    differ in nothing else. `interval` names the two columns of a 95% interval. An error (`metric`) is
    drawn on a log axis whose lower end stands for none.
    """

    name: str
    label: str
    values: Callable[[pandas.DataFrame], numpy.ndarray]
    columns: tuple[str, ...] = ()
    is_number: bool = True
    interval: tuple[str, str] | None = None
    metric: Metric | None = None
    is_time: bool = False


def _of_column(name: str, label: str, source: str, **more) -> Quantity:
    return Quantity(name, label, lambda table: column(table, source), (source,), **more)


def _path_time(table: pandas.DataFrame) -> numpy.ndarray:
    """The place on a camera path, 0 to 1, of views such as path:fly@0.25; NaN for other views."""
    at = table["view"].where(table["view"].str.startswith("path:"), "").str.partition("@")[2]
    return pandas.to_numeric(at, errors="coerce").to_numpy(dtype=float)


def _of_metric(name: str, metric: Metric) -> Quantity:
    return Quantity(name, metric.label, metric.errors, metric=metric)


NAMED: dict[str, Quantity] = {
    "time": _of_column("time", "frame time, ms", "frame_ms.median", is_time=True,
                       interval=("frame_ms.ci_low", "frame_ms.ci_high")),
    "ratio": _of_column("ratio", "frame time over that of the baseline", "ratio",
                        interval=("ratio.low", "ratio.high")),
    "memory": Quantity("memory", "memory of the method, MiB",
                       lambda table: column(table, "memory_method_bytes") / 2**20),
    "pixels": Quantity("pixels", "pixels of the image",
                       lambda table: column(table, "width") * column(table, "height"), ("width", "height")),
    "path": Quantity("path", "place on the path, 0 to 1", _path_time, ("view",)),
    "opacity": _of_column("opacity", "opacity", "opacity"),
    "detail": _of_column("detail", "detail", "detail"),
    "triangles": _of_column("triangles", "triangles", "triangles"),
    "wrong_order_found": Quantity("wrong_order_found", "pixels in the wrong order before repair, %",
                                  lambda table: 100 * wrong_order_found(table),
                                  metric=Metric("pixels in the wrong order before repair, %",
                                                lambda table: 100 * wrong_order_found(table))),
} | {name: _of_metric(name, metric) for name, metric in METRICS.items()}
EXAMPLES = ("time", "ratio", "memory", "rmse")
# Prefixes of columns that a user may leave out, and the word after a stage.
SHORT = (("param.", ""), ("stage.", "_ms"), ("counter.", ""), ("memory.", ""), ("", ""))


def find_quantity(name: str, table: pandas.DataFrame) -> Quantity:
    """The quantity of this name in the table. Raises BadResults that says what is close or varies."""
    for prefix, suffix in SHORT:
        source = f"{prefix}{name}{suffix}"
        if source in table and not (prefix == "" and name in NAMED):
            return _of_any(name, source, table)
        if prefix == "param." and name in NAMED:
            return NAMED[name]
    known = list(dict.fromkeys(names_in(table)))
    close = difflib.get_close_matches(name, known, 3)
    varied = ", ".join(varying(table)[:12]) or "nothing"
    hint = f"did you mean {' or '.join(close)}?" if close else \
        f"there are {', '.join(EXAMPLES)}, and columns of cells.csv; of the parameters vary: {varied}"
    raise BadResults(f"no cell has a quantity {name!r}; {hint}")


def _of_any(name: str, source: str, table: pandas.DataFrame) -> Quantity:
    unit = ", ms" if source.startswith("stage.") else ""
    values = table[source].dropna()
    if values.map(lambda v: isinstance(v, (int, float)) and not isinstance(v, bool)).all():
        return _of_column(name, f"{name}{unit}", source, is_time=bool(unit))
    return Quantity(name, name, lambda cells: _texts(cells[source]), (source,), is_number=False)


def _texts(values: pandas.Series) -> numpy.ndarray:
    """As one would type them; None where there is no value."""
    return numpy.array([None if pandas.isna(v) else parameter(v) for v in values], dtype=object)


def names_in(table: pandas.DataFrame) -> list[str]:
    """Every name that find_quantity() knows for this table."""
    short = [name.removeprefix(prefix).removesuffix(suffix)
             for prefix, suffix in SHORT[:-1] for name in table.columns if name.startswith(prefix)]
    return [*NAMED, *short, *table.columns]


def varying(table: pandas.DataFrame) -> list[str]:
    """The parameters and knobs that have several values: what an x axis can be."""
    found = [name.removeprefix("param.") for name in table.columns
             if name.startswith("param.") and table[name].map(str).nunique() > 1]
    for name in ("opacity", "detail", "pixels", "path", "triangles"):
        values = NAMED[name].values(table)
        if len(numpy.unique(values[~numpy.isnan(values)])) > 1:
            found.append(name)
    return found


def in_order(values: list) -> list:
    """Distinct values by size, texts as a reader would sort them; special values last."""
    special = sorted({v for v in values if isinstance(v, Special)}, key=lambda v: v.value)
    plain = {v for v in values if not isinstance(v, Special)}
    return sorted(plain, key=lambda v: natural_key(v) if isinstance(v, str) else v) + special
