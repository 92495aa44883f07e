"""Collects the cells of a results folder, or of a packed file, into one tidy table, a row a cell.

A results folder may be shared by running processes and may hold files of other origin, so whatever
is not a whole cell of a known schema is named and counted, and never stops the report.
Units: times in milliseconds, memory in bytes, `pixels_off` a share of 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pandas

from .checks import FRAME_STATISTICS, NotACell, cell_of, check_samples
from .clock import clock_line, stages_are_slow
from .formats import one_line
from .memory import own_memory
from .packs import PACK_SUFFIX, read_bytes, read_pack

HINT = "run an experiment first, for example: oitlab run experiments/quickstart.toml"


class BadResults(Exception):
    """The results folder can't be reported on; the message is one line for the user."""


@dataclass(frozen=True)
class Problem:
    """A file in cells/ that was left out of the report."""

    file: str
    reason: str


@dataclass(frozen=True)
class Collection:
    """What a results folder holds: the table, the JSON behind each row, the files left out.

    Of the samples of a cell only those of the whole frame are kept, as arrays.
    """

    folder: Path
    table: pandas.DataFrame
    cells: dict[str, dict]
    problems: list[Problem]


def collect(folder: Path) -> Collection:
    """Reads every cell of a results folder, of a folder of packs, or of one pack.

    Raises BadResults if there is none.
    """
    if not folder.exists():
        raise BadResults(f"{folder}: no such folder; {HINT}")
    cells: dict[str, dict] = {}
    problems: list[Problem] = []
    for name, content in _documents(folder):
        try:
            if isinstance(content, NotACell):
                raise content
            cell = check_samples(cell_of(content))
            if cell["id"] in cells:
                raise NotACell(f"its id {cell['id']} is that of another file")
            cells[cell["id"]] = cell
        except NotACell as error:
            problems.append(Problem(name, one_line(str(error))))
    if not cells:
        found = "is empty"
        if problems:
            first = problems[0]
            found = f"has no whole cell in {len(problems)} file(s); {first.file}: {first.reason}"
        where = folder / "cells" if (folder / "cells").is_dir() else folder
        raise BadResults(f"{where} {found}; {HINT}")
    return Collection(folder, as_table(cells), cells, problems)


def _documents(folder: Path) -> Iterator[tuple[str, bytes | dict | NotACell]]:
    """The name and content of all that may be a cell; NotACell where there is no reading it."""
    packs, files = [], []
    if folder.is_file():
        packs = [folder]
    elif (folder / "cells").is_dir():
        files = sorted((folder / "cells").iterdir())
    else:
        packs = sorted(folder.glob("*" + PACK_SUFFIX))
        if not packs:
            raise BadResults(
                f"{folder}: not a results folder (it has no folder cells, and no *{PACK_SUFFIX}); "
                f"{HINT}")
    for path in files:
        try:
            yield path.name, read_bytes(path)
        except NotACell as error:
            yield path.name, error
    for path in packs:
        try:
            for index, content in enumerate(read_pack(path)):
                yield f"{path.name}, cell {index + 1}", content
        except NotACell as error:
            yield path.name, error


def read_cell(path: Path) -> dict:
    """One file, checked. Raises NotACell."""
    return check_samples(cell_of(read_bytes(path)))


def as_table(cells: dict[str, dict]) -> pandas.DataFrame:
    """One row per cell, in the order of the file names; columns that no cell has are absent.

    Stages keep the order in which the cells list them, which is that in which they run.
    """
    rows = pandas.DataFrame([flatten(cell) for cell in cells.values()])
    fixed = [name for name in rows.columns if "." not in name or name.startswith("frame_ms.")]
    families = ("param.", "quality.", "counter.", "memory.", "stop.")
    open_ended = [
        name for family in families for name in sorted(rows.columns) if name.startswith(family)
    ] + [name for name in rows.columns if name.startswith("stage.")]
    return rows[fixed + open_ended]


def flatten(cell: dict) -> dict[str, object]:
    """The columns of one cell. What a failed or skipped cell does not have stays empty, and so do
    stages that were timed at a lower clock than the frames."""
    scene, device, provenance = cell["scene"], cell["device"], cell["provenance"]
    frame = cell.get("statistics", {}).get("frame", {})
    interval = frame.get("ci95", [None, None])
    row: dict[str, object] = {key: cell[key] for key in ("id", "experiment", "status", "reason")}
    row |= {
        "scene": scene["name"],
        "source": scene.get("source"),
        "triangles": scene.get("triangles"),
        "transparent_triangles": scene.get("transparent_triangles"),
        "opacity": scene.get("opacity"),
        "detail": scene.get("detail"),
        "content_hash": scene.get("content_hash"),
        "view": cell["view"],
        "width": cell["size"][0],
        "height": cell["size"][1],
        "format": cell["format"],
        "method": cell["method"],
        "group": cell["group"],
        "seed": cell.get("seed"),
        "profile": cell.get("profile") or "full",
        "device": device["name"],
        "device_type": device["type"],
        "driver": device["driver"],
        "driver_info": device.get("driver_info") or "",
        "api_version": device.get("api_version") or "",
        "subgroup_size": device.get("subgroup_size"),
    }
    row |= {f"frame_ms.{key}": frame.get(key) for key in FRAME_STATISTICS}
    row |= {
        "frame_ms.ci_low": interval[0],
        "frame_ms.ci_high": interval[1],
        "frame_ms.count": frame.get("count"),
        "memory_total_bytes": cell.get("memory_bytes", {}).get("total"),
        **own_memory(cell),
        "image": (cell.get("image") or {}).get("file"),
        "image_hash": cell.get("image_hash"),
        "commit": provenance["commit"],
        "build": provenance["build"],
        "validation": provenance["validation"],
        "date": provenance.get("date") or "",
        "command": provenance.get("command") or "",
    }
    row |= {f"param.{key}": value for key, value in cell["parameters"].items()}
    row |= {f"quality.{key}": value for key, value in (cell.get("quality") or {}).items()}
    row |= {f"counter.{key}": value for key, value in cell.get("counters", {}).items()}
    stages = cell.get("gpu_ms", {}).get("stages", {})
    row["stages_left_out"] = bool(stages) and stages_are_slow(cell)
    row["clock_note"] = clock_line(cell)
    if row["stages_left_out"]:
        stages = {}
    # JSON objects have no order; the stages have one, and charts follow it.
    order = [key for key in cell.get("stage_order", []) if key in stages] or list(stages)
    row |= {f"stage.{key}_ms": stages[key] for key in order}
    buffers = cell.get("memory_bytes", {}).get("buffers", {})
    row |= {f"memory.{key}": value for key, value in buffers.items()}
    row |= {f"stop.{key}": value for key, value in cell.get("stop", {}).items()}
    return row
