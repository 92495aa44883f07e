"""Tables 1 and 2 and figures 3, 5, 7 and 9 of "Backwards Memory Allocation and Improved OIT" (Knowles,
Leach and Zambetta 2013). The figures, and the speed-up of each interval, are worked out in
`bma_figures`."""

from __future__ import annotations

import pandas
from matplotlib.figure import Figure

from ..compare.tidy import as_table
from ..draw import bma_figures
from ..draw.bma_figures import PAPER_CHOICES, abuffer_cells, by_setting, scene_name, timed_intervals
from .agreement import factor, order
from .common import (
    build,
    clock_notes,
    columns,
    file_name,
    frame_ms,
    general_notes,
    head,
    pairs_of,
    published,
    size_of,
    without_ratios,
)
from .measured import Context, Measurements, Want, choose, find, ratio
from .paired_table import Column, Number, Table
from .published import STAND_INS, read

FIGURES = (3, 5, 7, 9)
COMMAND = "oitlab run experiments/bma.toml"


def table2(found: Measurements, device: str) -> Table:
    """OIT with fixed allocation against BMA-OIT at the same maximum."""
    paper = read("bma_table2")

    def rows_of(context: Context) -> tuple[list[dict], list[dict]]:
        rows, used = [], []
        for line in paper:
            allocated = int(line["max_alloc"])
            row = {"scene": f"{line['scene']}, {allocated}", "p.fragments": Number(float(line["fragments"]) / 1e6),
                   "p.peak": published(line["peak_depth"]), "p.oit": published(line["oit_ms"]),
                   "p.bma": published(line["bma_oit_ms"]), "p.speedup": published(line["speedup"])}
            wants = {memory: Want("abuffer", PAPER_CHOICES | {"sort_memory": memory, "max_fragments": allocated})
                     for memory in ("max", "bma")}
            cells = find(context, STAND_INS[line["scene"]], wants, size_of(line["size"]), "bma", "bma")
            for role, key in (("max", "m.oit"), ("bma", "m.bma")):
                if role in cells:
                    row[key] = frame_ms(cells[role])
            if cells:
                counters = cells["bma"]["counters"]
                row["m.fragments"] = Number(counters.get("fragments", 0) / 1e6)
                if "max_fragments_per_pixel" in counters:
                    row["m.peak"] = Number(counters["max_fragments_per_pixel"])
            if compared := ratio(cells, "max", "bma"):
                row["m.speedup"] = Number(compared.ratio, compared.low, compared.high)
            used += cells.values()
            rows.append(row)
        return rows, used

    context, rows, used, others = build("bma", rows_of, found, device)
    metrics = [("fragments", "fragments, M"), ("peak", "peak depth"), ("oit", "OIT, ms"), ("bma", "BMA-OIT, ms"),
               ("speedup", "speed-up")]
    agreement, notes = [], []
    if context:
        agreement = [s for s in (order("Speed-up", pairs_of(rows, "speedup")),
                                 factor("Speed-up", pairs_of(rows, "speedup"))) if s]
        notes = clock_notes(used) + without_ratios(general_notes(context, used, others, paper[0]["size"]))
    return Table(
        name=f"bma-table2-{file_name(device)}", title="BMA: fixed allocation (OIT) against BMA-OIT",
        source=f"{paper[0]['source']}, {paper[0]['table']}, {paper[0]['device']}",
        columns=[Column("scene", "scene, max alloc")] + columns(metrics, paper[0]["device"], device),
        rows=rows, measured_on=head(context, used), agreement=agreement, notes=notes,
        missing=[row["scene"] for row in rows if not row.get("m.speedup")], command=COMMAND,
    )


def cells_of(found: Measurements, device: str, method: str) -> tuple[Context | None, pandas.DataFrame | None]:
    """The context with most measured cells of a method, and their table: of the experiment that is
    made for it where there is one, since the same cell may have been measured in others too."""
    def count(context: Context) -> int:
        return sum(c["method"] == method and c["status"] == "ok" for c in own_cells(context))

    context = choose(found.of(device), count)
    return (context, as_table({c["id"]: c for c in own_cells(context)})) if context else (None, None)


def own_cells(context: Context) -> list[dict]:
    return [c for c in context.cells if c["experiment"] == "bma"] or context.cells


def table1(found: Measurements, device: str) -> Table:
    """The speed-up of each interval of fragment counts."""
    paper = read("bma_table1")
    context, cells = cells_of(found, device, "abuffer")
    measured = speedups_by_interval(cells) if cells is not None else None
    rows = []
    for line in paper:
        value = speedup_in(measured, STAND_INS[line["scene"]], int(line["interval"]))
        rows.append({"scene": f"{line['scene']}, {line['interval']}", "p.speedup": published(line["speedup"]),
                     "m.speedup": Number(value) if value is not None else None})
    agreement = [s for s in (order("Speed-up", pairs_of(rows, "speedup")),
                             factor("Speed-up", pairs_of(rows, "speedup"))) if s]
    shallow = [row["scene"] for row, line in zip(rows, paper)
               if is_shallow(cells, STAND_INS[line["scene"]], int(line["interval"]))]
    absent = [f"No pixel of the stand-in has so many fragments: {'; '.join(shallow)}."] if shallow else []
    notes = []
    if context:
        staged = [c for c in own_cells(context) if c["status"] == "ok" and c["method"] == "abuffer"]
        notes = absent + clock_notes([], staged) + without_ratios(general_notes(context, [], 0, "1680x1050"))
    return Table(
        name=f"bma-table1-{file_name(device)}", title="BMA: estimated speed-up at each interval",
        source=f"{paper[0]['source']}, {paper[0]['table']}, {paper[0]['device']}",
        columns=[Column("scene", "scene, interval")] + columns([("speedup", "speed-up")], paper[0]["device"], device),
        rows=rows, measured_on=context.describe() if context else "nothing yet", agreement=agreement,
        notes=notes,
        missing=[row["scene"] for row in rows if not row.get("m.speedup") and row["scene"] not in shallow],
        command=COMMAND,
    )


def is_shallow(cells: pandas.DataFrame | None, scene: str, interval: int) -> bool:
    """Whether the stand-in was measured, and no view of it but those of a path has a pixel in the interval."""
    name = f"counter.pixels_{interval}"
    if cells is None or name not in cells:
        return False
    counts = cells[(cells["scene"] == scene) & ~cells["view"].str.startswith("path:")][name].dropna()
    return not counts.empty and counts.max() == 0


def speedup_in(measured: pandas.DataFrame | None, scene: str, interval: int) -> float | None:
    """A cell of what speedups_by_interval() gives: one row an interval, one column a scene, whose name starts
    with that of the scene."""
    if measured is None or interval not in measured.index:
        return None
    for column in measured.columns:
        if column.split(" ")[0].rstrip(",") == scene and pandas.notna(measured.loc[interval, column]):
            return float(measured.loc[interval, column])
    return None


def figures(found: Measurements, device: str) -> list[tuple[str, str, Figure | None]]:
    """(name, what the paper's figure says, the measured one or None) for each figure."""
    says = {row["figure"]: row["says"] for row in read("bma_figures")}
    _, cells = cells_of(found, device, "abuffer")
    _, local = cells_of(found, device, "local_memory")
    result = []
    for number in FIGURES:
        draw = getattr(bma_figures, f"bma_figure{number}")
        table = local if number == 3 and local is not None else cells
        drawn = draw(table) if table is not None else None
        result.append((f"bma-figure{number}-{file_name(device)}", says[f"Figure {number}"], drawn))
    return result


def speedups_by_interval(table: pandas.DataFrame) -> pandas.DataFrame | None:
    """Speed-up of BMA-OIT over OIT by interval: how long the interval's pixels take in the shader of
    OIT (max_by_interval) over how long in their own. One column per setting."""
    cells = abuffer_cells(table, **PAPER_CHOICES)
    columns: dict[str, dict[int, float]] = {}
    for (scene, *_), same in by_setting(cells):
        rows = _latest_pair(same, "max_by_interval", "bma")
        if rows is None:
            continue
        allocated, oit, bma = rows
        name = _column_name(scene, bma, columns) + f", max alloc {allocated}"
        columns[name] = {
            interval: oit[f"stage.sort {interval}_ms"] / bma[f"stage.sort {interval}_ms"]
            for interval in timed_intervals(bma)
            if oit.get(f"stage.sort {interval}_ms", 0) > 0
            and bma[f"stage.sort {interval}_ms"] > 0
        }
    if not columns:
        return None
    result = pandas.DataFrame(columns).sort_index()
    result.index.name = "Interval"
    return result


def _cell(cells: pandas.DataFrame, memory: str) -> pandas.Series | None:
    found = cells[cells["param.sort_memory"] == memory]
    return None if found.empty else found.iloc[0]


def _latest_pair(cells: pandas.DataFrame, one: str, other: str):
    """The largest max_fragments that both have, and their cells."""
    for allocated in sorted(cells["param.max_fragments"].unique(), reverse=True):
        of = cells[cells["param.max_fragments"] == allocated]
        first, second = _cell(of, one), _cell(of, other)
        if first is not None and second is not None:
            return int(allocated), first, second
    return None


def _column_name(scene: str, row: pandas.Series, taken: dict) -> str:
    name = scene_name(scene)
    return f"{name}, {row['view']}" if any(c.startswith(name) for c in taken) else name
