"""Makes results folders that look like those of the C++ program. The same arguments give the same
files.

Run by hand to look at a report: python3 tests/python/support/synthetic.py FOLDER [METHODS] [SCENES],
or, with the methods and parameters of the sweeps, a number of cells: ... FOLDER --cells 2000
"""

from __future__ import annotations

import json
import os
import sys
import zlib
from pathlib import Path

import numpy
from PIL import Image

SCENES = ("boxes", "teapot", "hairball", "tree", "courtyard", "pipes", "sponza", "plants", "smoke",
          "glassware", "city", "engine")
# Method, parameters, frame time relative to blend, RMSE.
METHODS = (
    ("blend", {"order": "submission"}, 1.0, 0.081),
    ("reference", {"order": "sorted"}, 3.1, 0.0),
    ("wboit", {}, 1.003, 0.034),
    ("lucid", {"tile": 8, "early_out": True}, 1.7, 0.0),
    ("lucid", {"tile": 16, "early_out": True}, 1.55, 0.0),
    ("moment", {"moments": 4, "precision": "half"}, 2.2, 0.012),
)
DEVICE = {"name": "Example GPU 4000", "type": "discrete", "driver": "exampledriver",
          "driver_info": "550.1", "api_version": "1.3.230", "subgroup_size": 32,
          "timestamp_period_ns": 1.0}
LAVAPIPE = {**DEVICE, "name": "llvmpipe (LLVM 15.0.6, 256 bits)", "type": "cpu",
            "driver": "llvmpipe", "driver_info": "Mesa 22.3.6 (LLVM 15.0.6)", "subgroup_size": 8}


def quantiles(samples: list[float]) -> dict:
    """The `statistics` object of a series of times in ms."""
    at = lambda percent: float(numpy.percentile(samples, percent))  # noqa: E731
    spread = 1.96 * float(numpy.std(samples)) / len(samples) ** 0.5
    return {"count": len(samples), "median": at(50), "q1": at(25), "q3": at(75),
            "mean": float(numpy.mean(samples)), "min": min(samples), "max": max(samples),
            "p95": at(95), "ci95": [at(50) - spread, at(50) + spread]}


def make_cell(scene: str = "boxes", method: str = "blend", parameters: dict | None = None,
              frame_ms: float = 2.0, rmse: float | None = 0.0, size: tuple[int, int] = (64, 36),
              blocks: int = 12, frames: int = 5, device: dict = DEVICE,
              experiment: str = "quickstart", **changes) -> dict:
    """An ok cell; `changes` replace whole top-level keys."""
    parameters = parameters or {}
    text = f"{scene}-{method}-{json.dumps(parameters)}-{size}-{device['name']}-{experiment}"
    identity = f"{scene}-default-{size[0]}x{size[1]}-{method}-{zlib.crc32(text.encode()):08x}"
    group = f"{zlib.crc32(f'{scene}-{size}-{device}'.encode()):08x}"
    # What slows a block slows all methods of the group alike: that is why blocks are paired.
    drift = numpy.random.default_rng(zlib.crc32(group.encode())).normal(1, 0.03, blocks)
    own = numpy.random.default_rng(zlib.crc32(text.encode())).normal(1, 0.004, (blocks, frames))
    times = (frame_ms * drift[:, None] * own).round(6)
    samples, numbers = times.ravel().tolist(), numpy.repeat(range(blocks), frames).tolist()
    triangles = 900 + zlib.crc32(scene.encode()) % 2_000_000
    stages = {"opaque": frame_ms * 0.1, "capture": frame_ms * 0.6, "resolve": frame_ms * 0.35}
    if method in ("blend", "wboit"):
        stages = {"opaque": frame_ms * 0.1, "accumulate": frame_ms * 0.95}
    cell = {
        "schema": 1, "id": identity, "experiment": experiment, "status": "ok", "reason": "",
        "group": group, "seed": 1,
        "scene": {"name": scene, "source": scene, "triangles": triangles,
                  "transparent_triangles": triangles, "opacity": None, "detail": 1.0,
                  "content_hash": f"{zlib.crc32(scene.encode()):08x}"},
        "view": "default", "size": list(size), "format": "rgba16f", "method": method,
        "camera": {"eye": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0], "fov_y_degrees": 60,
                   "near": 0.01},
        "parameters": parameters, "device": device,
        "gpu_ms": {"frame": float(numpy.median(samples)), "stages": stages},
        "statistics": {"frame": quantiles(samples), "stages": {}},
        "samples": {"frame_ms": samples, "block": numbers, "stages": {}},
        "stop": {"reason": "spread", "relative_spread": 0.004, "blocks": blocks, "seconds": 3.2,
                 "rejected_samples": 0},
        "quality": None if rmse is None else {
            "reference": "reference", "rmse": rmse, "max_error": rmse * 4,
            "psnr": None if rmse == 0 else round(-20 * float(numpy.log10(rmse)), 3),
            "pixels_off": min(1.0, rmse * 6), "ssim": 1 - rmse * 2, "flip": min(1.0, rmse * 3),
            "flip_hdr": None},
        "counters": {"fragments": triangles * 7, "overflow": 0},
        "memory_bytes": {"total": 3 * 2**20 + triangles, "buffers": {"fragment pool": triangles,
                                                                     "colour": 3 * 2**20}},
        "image": {"file": f"images/{identity}.png"},
        # Exact methods make the same image, bit for bit.
        "image_hash": f"{zlib.crc32((group if rmse == 0 else text).encode()):x}",
        "provenance": {"commit": "abc1234", "build": "Release", "validation": False,
                       "command": "oitlab run experiments/quickstart.toml",
                       "date": "2026-11-21T22:40:00Z",
                       "shaders": {f"{method}/{method}.frag": "11aa22bb"}},
    }
    return cell | changes


def without_measurement(cell: dict, status: str, reason: str) -> dict:
    """The same cell as the C++ program writes it when it failed or was skipped."""
    kept = ("schema", "id", "experiment", "group", "seed", "view", "size", "format", "method",
            "parameters", "device", "provenance")
    scene = {key: cell["scene"][key] for key in ("name", "source", "opacity", "detail")}
    return {key: cell[key] for key in kept} | {"status": status, "reason": reason, "scene": scene}


def with_slow_stages(cell: dict, factor: float = 3) -> dict:
    """The same cell, its stages timed at a lower clock than its frames."""
    stages = {name: factor * time for name, time in cell["gpu_ms"]["stages"].items()}
    return cell | {"gpu_ms": cell["gpu_ms"] | {"stages": stages}}


def with_slow_blocks(cell: dict, slow: int, factor: float = 3) -> dict:
    """The same cell, its first blocks of frames timed at a lower clock."""
    times = [time * (factor if block < slow else 1)
             for time, block in zip(cell["samples"]["frame_ms"], cell["samples"]["block"])]
    return cell | {"samples": cell["samples"] | {"frame_ms": times},
                   "gpu_ms": cell["gpu_ms"] | {"frame": float(numpy.median(times))},
                   "statistics": cell["statistics"] | {"frame": quantiles(times)}}


def write_cell(folder: Path, cell: dict, image: bool = True) -> None:
    (folder / "cells").mkdir(parents=True, exist_ok=True)
    (folder / "cells" / f"{cell['id']}.json").write_text(json.dumps(cell), encoding="utf-8")
    if image and cell.get("image"):
        write_image(folder / cell["image"]["file"], *cell["size"], cell["image_hash"])


def tint_of(seed: str) -> int:
    """What tells images of one size apart."""
    return zlib.crc32(seed.encode()) % 200


def write_image(path: Path, width: int, height: int, seed: str = "", detail: int = 0) -> None:
    """A gradient; `detail` adds noise, so that the file takes as many bytes as a rendering."""
    path.parent.mkdir(parents=True, exist_ok=True)
    y, x = numpy.mgrid[0:height, 0:width]
    tint = tint_of(seed)
    pixels = numpy.stack([x * 255 // width, y * 255 // height, numpy.full_like(x, tint)], axis=2)
    if detail:
        noise = numpy.random.default_rng(tint).integers(0, detail, (height, width, 3))
        pixels = numpy.minimum(255, pixels + noise)
    Image.fromarray(pixels.astype(numpy.uint8)).save(path)


def make_results(folder: Path, methods: int = 4, scenes: int = 3, device: dict = DEVICE,
                 size: tuple[int, int] = (64, 36), **changes) -> Path:
    """Scenes of very different cost, all with the same methods."""
    for index, scene in enumerate(SCENES[:scenes]):
        for method, parameters, factor, rmse in METHODS[:methods]:
            write_cell(folder, make_cell(scene, method, parameters, (0.3 + 0.41 * index**2) * factor,
                                         rmse, size, device=device, **changes))
    return folder


# The scenes of the LucidRaster paper, and the frame time of blend at 2560x1330 in ms.
PAPER_SCENES = {"boxes": 0.4, "bunny": 0.08, "conference": 0.23, "dragon": 0.25, "gallery": 0.68,
                "hairball": 3.6, "powerplant": 4.8, "sanmiguel": 3.7, "scrubpine": 0.19,
                "sponza_like": 1.7, "teapot": 0.11, "whiteoak": 6.0}
LUCID_STAGES = {"setup": 0.14, "binning": 0.05, "blocks": 0.2, "sort": 0.1, "low_raster": 0.3,
                "high_raster": 0.18, "repair": 0.03}


def lucid_cell(scene: str, blend_ms: float, factor: float = 3.3, invalid: int = 0,
               parameters: dict | None = None, **changes) -> dict:
    """A cell of the method lucid: `factor` times blend, with its stages and counters.

    `invalid` pixels came out in the wrong order; they are mended unless repair is off.
    """
    parameters = {"depth_filter": 3, "alpha_threshold": 0.0, "repair": True,
                  "visualize_errors": False, "workgroups": 0} | (parameters or {})
    repaired = parameters["repair"]
    time = blend_ms * factor
    cell = make_cell(scene, "lucid", parameters, time, 0.0 if repaired else invalid * 1e-7,
                     **changes)
    fragments = cell["scene"]["triangles"] * 7
    quads = cell["scene"]["triangles"] * 52 // 100
    visible = quads * 3 // 4
    cell["gpu_ms"]["stages"] = {name: time * share for name, share in LUCID_STAGES.items()}
    cell["stage_order"] = list(LUCID_STAGES)
    cell["counters"] = {
        "fragments": fragments, "half_blocks": fragments // 9, "input_quads": quads,
        "visible_quads": visible, "small_quads": visible - 3, "large_quads": 3,
        "degenerate_quads": quads // 25, "invalid_pixels": invalid,
        "repaired_pixels": invalid if repaired else 0, "scratch_bytes": 768 * 1024,
        "bins_empty": 3, "bins_low": 20, "bins_high": 2}
    return cell


def sweep_cells(count: int, **changes):
    """Cells as a large results folder holds them: `count` of them, the sweeps of lucid among others.

    A depth filter of n leaves 2000 / n^2 wrong pixels; an alpha threshold saves a tenth of the time.
    """
    made = 0
    for size in ((64, 36), (128, 72), (48, 28), (80, 46)):
        for opacity in (None, 0.5, 0.8, 0.3):
            for scene, time in PAPER_SCENES.items():
                group = [make_cell(scene, "blend", {"order": "submission"}, time, 0.08, size, **changes),
                         make_cell(scene, "wboit", {"weight": "eq7"}, time * 1.17, 0.03, size, **changes),
                         make_cell(scene, "reference", {}, time * 7, 0.0, size, **changes)]
                group += [
                    lucid_cell(scene, time, 3.3 + 0.04 * filter, 2000 // filter**2,
                               {"depth_filter": filter, "repair": repair}, size=size, **changes)
                    for filter in range(1, 17) for repair in (True, False)]
                group += [
                    lucid_cell(scene, time, 3.3 * (0.9 + 0.1 * (1 - threshold)), 222,
                               {"alpha_threshold": threshold}, size=size, **changes)
                    for threshold in (0.9, 0.95, 0.9921875, 0.999)]
                for cell in group:
                    if made == count:
                        return
                    made += 1
                    cell["scene"]["opacity"] = opacity
                    marker = f"{opacity}-{size[0]}"
                    yield cell | {"id": f"{cell['id']}-{marker}", "group": f"{cell['group']}-{marker}",
                                  "image": {"file": f"images/{cell['id']}-{marker}.png"}}


def make_sweep(folder: Path, count: int = 2000, image_size: tuple[int, int] | None = None,
               **changes) -> Path:
    """A results folder of `count` cells; images of another size than the cells say, if wanted."""
    made: dict[tuple, Path] = {}
    for cell in sweep_cells(count, **changes):
        write_cell(folder, cell, image=False)
        path, size = folder / cell["image"]["file"], image_size or tuple(cell["size"])
        if (like := made.setdefault((size, tint_of(cell["image_hash"])), path)) != path:
            os.link(like, path)  # the same pixels: drawing 2,000 of them takes minutes
        else:
            write_image(path, *size, cell["image_hash"], detail=8)
    return folder


if __name__ == "__main__":
    if "--cells" in sys.argv:
        make_sweep(Path(sys.argv[1]), int(sys.argv[sys.argv.index("--cells") + 1]), (640, 360),
                   blocks=20, frames=15)
    else:
        make_results(Path(sys.argv[1]), *(int(argument) for argument in sys.argv[2:]))
