"""Collects the cells of results folders and packs into one tidy table, one row per cell.

A results folder may be shared by running processes and may hold files of other origin, so whatever
is not a whole cell of a known schema is named and counted, and never stops the report.
Units: times in milliseconds, memory in bytes, `pixels_off` a share of 1.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path

import numpy
import pandas

from .checks import FRAME_STATISTICS, NotACell, cell_of, check_samples
from .clock import clock_line, stages_are_slow
from .formats import one_line
from .memory import own_memory
from .packs import read_bytes
from .sources import HINT, BadResults, documents, sources_in
from .statistics import FEWEST_BLOCKS


@dataclass(frozen=True)
class Problem:
    """A file that was left out of the report."""

    file: str
    reason: str


@dataclass(frozen=True)
class Collection:
    """What the sources hold: the table, the JSON behind each row by its key, the files left out.

    Of the samples of a cell only those of the whole frame are kept, as arrays. `sources` says from
    which folder or pack each cell is. `repeated` counts cells that several sources hold alike.
    """

    table: pandas.DataFrame
    cells: dict[str, dict]
    sources: dict[str, Path]
    problems: list[Problem]
    repeated: int = 0


def collect(*paths: Path) -> Collection:
    """Reads every cell of results folders, packs, and folders of either.

    A cell is known by its experiment and id: experiments that share a setting share ids. What
    several sources hold alike counts once; other versions of a cell are cells of their own.
    Raises BadResults if there is no cell.
    """
    cells: dict[str, dict] = {}
    sources: dict[str, Path] = {}
    problems: list[Problem] = []
    seen: set[str] = set()
    repeated = 0
    found = sources_in(list(paths))
    for source in found:
        own: set[tuple[str, str]] = set()
        for name, content in documents(source):
            try:
                if isinstance(content, NotACell):
                    raise content
                cell = check_samples(cell_of(content))
                identity = cell["experiment"], cell["id"]
                if identity in own:
                    raise NotACell(f"its id {cell['id']} is that of another file of this experiment")
            except NotACell as error:
                problems.append(Problem(name, one_line(str(error))))
                continue
            own.add(identity)
            if (text := fingerprint(cell)) in seen:
                repeated += 1
                continue
            seen.add(text)
            key = free_key("/".join(identity), cells)
            cells[key], sources[key] = cell, source
    if not cells:
        raise BadResults(f"{_nothing_in(found, problems)}; {HINT}")
    return Collection(as_table(cells), cells, sources, problems, repeated)


def fingerprint(cell: dict) -> str:
    """Equal for two copies of one measurement, and for nothing else."""
    times = cell.get("samples", {}).get("frame_ms")
    return json.dumps([cell["experiment"], cell["id"], cell["group"], cell["provenance"].get("date"),
                       cell["provenance"]["commit"], cell["status"],
                       None if times is None else list(times[:8])])


def free_key(name: str, taken: dict) -> str:
    """The name, numbered where it is taken."""
    key, number = name, 1
    while key in taken:
        number += 1
        key = f"{name} ({number})"
    return key


def _nothing_in(sources: list[Path], problems: list[Problem]) -> str:
    where = ", ".join(str(source / "cells" if source.is_dir() else source) for source in sources[:3])
    where += ", ..." if len(sources) > 3 else ""
    if not problems:
        return f"{where} is empty"
    first = problems[0]
    return f"{where} has no whole cell in {len(problems)} file(s); {first.file}: {first.reason}"


def read_cell(path: Path) -> dict:
    """One file, checked. Raises NotACell."""
    return check_samples(cell_of(read_bytes(path)))


def as_table(cells: dict[str, dict]) -> pandas.DataFrame:
    """One row per cell, in the order of the file names; columns that no cell has are absent.

    Stages keep the order in which the cells list them, which is that in which they run.
    """
    rows = pandas.DataFrame([{"key": key} | flatten(cell) for key, cell in cells.items()])
    fixed = [name for name in rows.columns if "." not in name or name.startswith("frame_ms.")]
    families = ("param.", "quality.", "counter.", "memory.", "stop.")
    open_ended = [
        name for family in families for name in sorted(rows.columns) if name.startswith(family)
    ] + [name for name in rows.columns if name.startswith("stage.")]
    return rows[fixed + open_ended]


def block_count(cell: dict) -> int:
    """How many blocks of frames the times of a cell are from; 0 where it has none."""
    return len(numpy.unique(cell["samples"]["block"])) if cell["status"] == "ok" else 0


def flatten(cell: dict) -> dict[str, object]:
    """The columns of one cell. What a failed or skipped cell does not have stays empty, and so do
    stages that were timed at a lower clock than the frames, and intervals of too few blocks."""
    scene, device, provenance = cell["scene"], cell["device"], cell["provenance"]
    frame = cell.get("statistics", {}).get("frame", {})
    blocks = block_count(cell)
    interval = (frame.get("ci95") if blocks >= FEWEST_BLOCKS else None) or (math.nan, math.nan)
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
        "blocks": blocks or None,
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
