"""The cells as one tidy table, one row per cell.

Units: times in milliseconds, memory in bytes, `pixels_off` a share of 1.
"""

from __future__ import annotations

import math

import numpy
import pandas

from ..read.checks import FRAME_STATISTICS
from .clock import clock_line, stages_are_slow
from .fragment_source import source_of
from .memory import own_memory
from .statistics import FEWEST_BLOCKS


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
        "fragment_source": source_of(cell),
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
