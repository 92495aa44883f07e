"""What a cell must hold, so that the rest of the analysis can rely on it."""

from __future__ import annotations

import json

import numpy

from ..formats import is_number, one_line
from .limits import LONGEST_NAME, NotACell, check_shape, parse

SCHEMA = 1
STATUSES = ("ok", "failed", "skipped")
FRAME_STATISTICS = ("median", "q1", "q3", "mean", "min", "max", "p95")
DAY_MS = 24 * 3600 * 1000


def cell_of(content: bytes | dict) -> dict:
    """The cell in a file's content, or in a document that was parsed already. Raises NotACell."""
    cell = parse(content) if isinstance(content, bytes) else content
    if not isinstance(cell, dict) or "schema" not in cell:
        raise NotACell("foreign JSON: it has no /schema")
    if cell["schema"] != SCHEMA:
        raise NotACell(f"/schema: found {cell['schema']!r}, wanted {SCHEMA}")
    check_shape(cell)
    cell = _printable(cell)
    check_cell(cell)
    return cell


def check_samples(cell: dict) -> dict:
    """The cell with its frame times and their block numbers as arrays, and without those of the
    stages, which nothing here uses: a large folder would fill the memory with them."""
    if cell["status"] == "ok":
        samples = cell["samples"]
        cell["samples"] = {"frame_ms": numpy.asarray(samples["frame_ms"], dtype=float),
                           "block": numpy.asarray(samples["block"], dtype=numpy.int64)}
    return cell


def _printable(value: object) -> object:
    """The same document with texts of one line each; numbers stay as they are."""
    if isinstance(value, str):
        return one_line(value)
    if isinstance(value, dict):
        return {one_line(key): _printable(child) for key, child in value.items()}
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


def _is_name(value: object) -> bool:
    return isinstance(value, str) and value.strip() != "" and len(value) <= LONGEST_NAME


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
    return is_number(value) and 0 < value < DAY_MS


def _is_interval(value: object) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(_is_time(v) for v in value)


def _is_times(value: object) -> bool:
    """A list of times as _is_time() has them, checked at once: a cell holds thousands."""
    if not isinstance(value, list) or not value or not set(map(type, value)) <= {int, float}:
        return False
    try:
        times = numpy.asarray(value, dtype=float)
    except OverflowError:
        return False
    return bool(((times > 0) & (times < DAY_MS)).all())


def _is_block_numbers(value: object, count: int) -> bool:
    return (isinstance(value, list) and len(value) == count and set(map(type, value)) == {int}
            and max(map(abs, value)) < 2**62)


def check_cell(cell: dict) -> None:
    """Checks everything that the report uses. Raises NotACell with a JSON pointer."""
    _get(cell, "/status", "ok, failed or skipped", lambda v: v in STATUSES)
    for pointer in ("id", "experiment", "view", "format", "method", "scene/name", "device/name"):
        _get(cell, f"/{pointer}", f"a name of at most {LONGEST_NAME} characters", _is_name)
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
    _get_if_there(cell, "/profile", "a name", _is_name)
    for pointer in ("seed", "scene/triangles", "scene/transparent_triangles", "scene/opacity"):
        _get_if_there(cell, f"/{pointer}", "a number", is_number)
    for pointer in ("scene/detail", "device/subgroup_size"):
        _get_if_there(cell, f"/{pointer}", "a number", is_number)
    _get_if_there(cell, "/provenance/shaders", "an object of hashes", _is_flat)
    if cell.get("clock") is not None:
        _get(cell, "/clock", "an object of plain values", _is_flat)
        for pointer in ("clock/rejected_blocks", "clock/unsettled_blocks"):
            _get(cell, f"/{pointer}", "a count", lambda v: type(v) is int and v >= 0)
        _get(cell, "/clock/settled", "true or false", lambda v: isinstance(v, bool))
    if cell["status"] != "ok":
        return
    for key in FRAME_STATISTICS:
        _get(cell, f"/statistics/frame/{key}", "a time in ms above 0", _is_time)
    _get(cell, "/statistics/frame/count", "a whole number", lambda v: type(v) is int)
    _get_if_there(cell, "/statistics/frame/ci95", "[low, high] or null", _is_interval)
    times = _get(cell, "/samples/frame_ms", "a list of times in ms above 0", _is_times)
    _get(cell, "/samples/block", f"a list of {len(times)} block numbers",
         lambda v: _is_block_numbers(v, len(times)))
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
