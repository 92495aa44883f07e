#!/usr/bin/env python3
"""Prints and draws how the A-buffer from compute compares with lucid, by samples per list entry.

    docs/make_crossover.py [docs/data/crossover_h100.json.gz] [--out docs/images/crossover.png]
"""

import argparse
import gzip
import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).parent
MARKERS = {640: "v", 1280: "s", 2560: "o"}


def rows_of(pack):
    """(scene, width, samples per entry, ms of the A-buffer, ms of lucid) of each view and size."""
    groups = {}
    for cell in pack["cells"]:
        if cell["parameters"].get("node_color", "rgba32f") != "rgba32f":
            continue
        scene = cell["scene"] if isinstance(cell["scene"], dict) else {"name": cell["scene"]}
        key = json.dumps([cell["scene"], cell["view"], cell["size"]])
        groups.setdefault(key, {"scene": scene["name"], "width": cell["size"][0]})[cell["method"]] = cell
    for group in groups.values():
        counters = group["lucid"]["counters"]
        times = [group[method]["gpu_ms"]["frame"] for method in ("abuffer", "lucid")]
        yield group["scene"], group["width"], counters["fragments"] / counters["half_blocks"], *times


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cells", nargs="?", type=Path, default=HERE / "data" / "crossover_h100.json.gz")
    parser.add_argument("--out", type=Path, default=HERE / "images" / "crossover.png")
    given = parser.parse_args()
    rows = sorted(rows_of(json.loads(gzip.decompress(given.cells.read_bytes()))), key=lambda row: row[2])
    for scene, width, density, abuffer, lucid in rows:
        print(f"{scene:16} {width:5} {density:6.2f} {abuffer:7.3f} {lucid:7.3f} {abuffer / lucid:6.2f}")

    figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
    scenes = sorted({row[0] for row in rows})
    for scene in scenes:
        for width, marker in MARKERS.items():
            points = [(row[2], row[3] / row[4]) for row in rows if row[:2] == (scene, width)]
            axes.scatter(*zip(*points, strict=True), marker=marker, color=f"C{scenes.index(scene)}", s=36,
                         label=scene if width == max(MARKERS) else None)
    axes.axhline(1, color="#888888", linewidth=0.8)
    axes.set(xscale="log", yscale="log", xlabel="samples per list entry (one triangle in one half-block)",
             ylabel="frame time of abuffer / lucid", title="The A-buffer from compute against lucid")
    ticks = [1, 2, 5, 10, 20]
    axes.set_yticks(ticks, map(str, ticks))
    axes.set_xticks([1, 2, 5, 10, 20, 30], ["1", "2", "5", "10", "20", "30"])
    axes.minorticks_off()
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    figure.savefig(given.out, dpi=150)


if __name__ == "__main__":
    main()
