"""Collects RESULTS/cells/*.json into one tidy table, one row per cell.

A results folder may be shared by running processes and may hold files of other origin, so whatever
is not a whole cell of a known schema is named and counted, and never stops the report.
Units: times in milliseconds, memory in bytes, `pixels_off` a share of 1.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pandas

from .formats import is_number, one_line
from .memory import own_memory

SCHEMA = 1
STATUSES = ("ok", "failed", "skipped")
FRAME_STATISTICS = ("median", "q1", "q3", "mean", "min", "max", "p95")


class BadResults(Exception):
    """The results folder can't be reported on; the message is one line for the user."""


class NotACell(Exception):
    """One file is not a whole cell; the message says what was found and what was wanted."""


@dataclass(frozen=True)
class Problem:
    """A file in cells/ that was left out of the report."""

    file: str
    reason: str


@dataclass(frozen=True)
class Collection:
    """What a results folder holds: the table, the JSON behind each row, the files left out."""

    folder: Path
    table: pandas.DataFrame
    cells: dict[str, dict]
    problems: list[Problem]


def collect(folder: Path) -> Collection:
    """Reads every cell. Raises BadResults if there is none."""
    cell_folder = folder / "cells"
    hint = "run an experiment first, for example: oitlab run experiments/quickstart.toml"
    if not folder.exists():
        raise BadResults(f"{folder}: no such folder; {hint}")
    if not cell_folder.is_dir():
        raise BadResults(f"{folder}: not a results folder (it has no folder cells); {hint}")
    cells: dict[str, dict] = {}
    problems: list[Problem] = []
    for path in sorted(cell_folder.iterdir()):
        try:
            cell = read_cell(path)
            if cell["id"] in cells:
                raise NotACell(f"its id {cell['id']} is that of another file")
            cells[cell["id"]] = cell
        except NotACell as error:
            problems.append(Problem(path.name, one_line(str(error))))
    if not cells:
        found = "is empty"
        if problems:
            first = problems[0]
            found = f"has no whole cell in {len(problems)} file(s); {first.file}: {first.reason}"
        raise BadResults(f"{cell_folder} {found}; {hint}")
    return Collection(folder, as_table(cells), cells, problems)


def read_cell(path: Path) -> dict:
    """One file, checked. Raises NotACell."""
    if path.suffix != ".json" or path.name.startswith("."):
        raise NotACell("a temporary file of a running or killed run, or a foreign one")
    try:
        text = path.read_text(encoding="utf-8")
        cell = json.loads(text, parse_constant=_refuse_constant, parse_int=_int_of_64_bits)
    except OSError as error:
        raise NotACell(f"cannot be read: {error.strerror}") from error
    except RecursionError as error:
        raise NotACell("not JSON that a cell can hold: nested too deeply") from error
    except ValueError as error:  # bad JSON or bad UTF-8
        raise NotACell(f"half-written or not JSON: {error}") from error
    if not isinstance(cell, dict) or "schema" not in cell:
        raise NotACell("foreign JSON: it has no /schema")
    if cell["schema"] != SCHEMA:
        raise NotACell(f"/schema: found {cell['schema']!r}, wanted {SCHEMA}")
    cell = _printable(cell)
    check_cell(cell)
    return cell


def _printable(value: object) -> object:
    """The same document with texts of one line each; numbers stay as they are."""
    if isinstance(value, str):
        return one_line(value)
    if isinstance(value, dict):
        return {one_line(key): _printable(child) for key, child in value.items()}
    return value


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not a JSON number")


def _int_of_64_bits(digits: str) -> int:
    value = int(digits)
    if abs(value) >= 2**64:
        raise ValueError("a whole number of more than 64 bits")
    return value


def _get(cell: dict, pointer: str, wanted: str, good) -> object:
    """The value at a JSON pointer. Raises NotACell unless `good` accepts it."""
    value: object = cell
    for key in pointer.strip("/").split("/"):
        if not isinstance(value, dict) or key not in value:
            raise NotACell(f"{pointer}: missing, wanted {wanted}")
        value = value[key]
    if not good(value):
        raise NotACell(f"{pointer}: found {json.dumps(value)[:60]}, wanted {wanted}")
    return value


def _get_if_there(cell: dict, pointer: str, wanted: str, good) -> None:
    """Checks a value that may be missing or null."""
    *parents, key = pointer.strip("/").split("/")
    value: object = cell
    for parent in parents:
        value = value.get(parent) if isinstance(value, dict) else value
    if value is None:
        return
    if not isinstance(value, dict):
        raise NotACell(f"/{'/'.join(parents)}: found {json.dumps(value)[:60]}, wanted an object")
    if value.get(key) is not None:
        _get(cell, pointer, wanted, good)


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _is_object(value: object) -> bool:
    return isinstance(value, dict)


def _is_flat(value: object) -> bool:
    return isinstance(value, dict) and not any(isinstance(v, (dict, list)) for v in value.values())


def _is_numbers(value: object) -> bool:
    return isinstance(value, dict) and all(is_number(v) for v in value.values())


def _is_size(value: object) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(type(v) is int for v in value)


def _is_time(value: object) -> bool:
    """A time in ms, less than a day."""
    return is_number(value) and 0 < value < 24 * 3600 * 1000


def _is_interval(value: object) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(_is_time(v) for v in value)


def _is_times(value: object) -> bool:
    return isinstance(value, list) and bool(value) and all(_is_time(v) for v in value)


def check_cell(cell: dict) -> None:
    """Checks everything that the report uses. Raises NotACell with a JSON pointer."""
    _get(cell, "/status", "ok, failed or skipped", lambda v: v in STATUSES)
    for pointer in ("id", "experiment", "view", "format", "method", "scene/name", "device/name"):
        _get(cell, f"/{pointer}", "a name", lambda v: isinstance(v, str) and v.strip() != "")
    for pointer in ("reason", "group", "device/type", "device/driver", "provenance/commit"):
        _get(cell, f"/{pointer}", "text", _is_text)
    _get(cell, "/provenance/build", "text", _is_text)
    _get(cell, "/provenance/validation", "true or false", lambda v: isinstance(v, bool))
    _get(cell, "/size", "[width, height]", _is_size)
    _get(cell, "/parameters", "an object of plain values", _is_flat)
    for pointer in ("device/driver_info", "device/api_version", "provenance/date"):
        _get_if_there(cell, f"/{pointer}", "text", _is_text)
    for pointer in ("scene/source", "scene/content_hash", "provenance/command", "image_hash"):
        _get_if_there(cell, f"/{pointer}", "text", _is_text)
    for pointer in ("seed", "scene/triangles", "scene/transparent_triangles", "scene/opacity"):
        _get_if_there(cell, f"/{pointer}", "a number", is_number)
    for pointer in ("scene/detail", "device/subgroup_size"):
        _get_if_there(cell, f"/{pointer}", "a number", is_number)
    _get_if_there(cell, "/provenance/shaders", "an object of hashes", _is_flat)
    if cell["status"] != "ok":
        return
    for key in FRAME_STATISTICS:
        _get(cell, f"/statistics/frame/{key}", "a time in ms above 0", _is_time)
    _get(cell, "/statistics/frame/count", "a whole number", lambda v: type(v) is int)
    _get(cell, "/statistics/frame/ci95", "[low, high]", _is_interval)
    times = _get(cell, "/samples/frame_ms", "a list of times in ms above 0", _is_times)
    _get(cell, "/samples/block", f"a list of {len(times)} block numbers",
         lambda v: isinstance(v, list) and len(v) == len(times) and all(type(b) is int for b in v))
    _get(cell, "/gpu_ms/stages", "an object of times in ms",
         lambda v: isinstance(v, dict) and all(t == 0 or _is_time(t) for t in v.values()))
    _get_if_there(cell, "/stage_order", "a list of names",
                  lambda v: isinstance(v, list) and all(isinstance(name, str) for name in v))
    _get(cell, "/counters", "an object of numbers", _is_numbers)
    _get(cell, "/memory_bytes/total", "a number", is_number)
    _get(cell, "/memory_bytes/buffers", "an object of numbers", _is_numbers)
    _get(cell, "/stop", "an object of plain values", _is_flat)
    _get_if_there(cell, "/stop/rejected_samples", "a number", is_number)
    _get_if_there(cell, "/quality", "an object of plain values", _is_flat)
    for metric in ("rmse", "psnr", "max_error", "pixels_off", "ssim", "flip", "flip_hdr"):
        _get_if_there(cell, f"/quality/{metric}", "a number or null", is_number)
    _get_if_there(cell, "/image/file", "a path", _is_text)


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
    """The columns of one cell. What a failed or skipped cell does not have stays empty."""
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
    # JSON objects have no order; the stages have one, and charts follow it.
    order = [key for key in cell.get("stage_order", []) if key in stages] or list(stages)
    row |= {f"stage.{key}_ms": stages[key] for key in order}
    buffers = cell.get("memory_bytes", {}).get("buffers", {})
    row |= {f"memory.{key}": value for key, value in buffers.items()}
    row |= {f"stop.{key}": value for key, value in cell.get("stop", {}).items()}
    return row
