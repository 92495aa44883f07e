#!/usr/bin/env python3
"""Prints the table of docs/sources.md, and the means below it, from the raw cells.

    docs/make_sources_table.py [docs/data/sources_h100.json.gz]
"""

import gzip
import json
import statistics
import sys
from pathlib import Path

CELLS = Path(__file__).parent / "data" / "sources_h100.json.gz"
METHODS = ("blend", "wboit", "abuffer", "depth_peeling")
COMMON = ("opaque", "setup", "binning", "blocks")  # stages of everything that the compute rasterizer feeds


def views_of(pack):
    """By scene and view: the cell of each (method, source); lucid has no source."""
    views = {}
    for cell in pack["cells"]:
        name = cell["scene"] if isinstance(cell["scene"], str) else cell["scene"]["name"]
        key = cell["method"], cell["parameters"].get("source", "")
        views.setdefault((name, cell["view"]), {})[key] = cell
    return views


def spread(ratios):
    return f"{statistics.geometric_mean(ratios):.3g} ({min(ratios):.3g} to {max(ratios):.3g})"


def main():
    pack = json.loads(gzip.decompress(Path(*sys.argv[1:] or [CELLS]).read_bytes()))
    faster, against_lucid, common = {}, {}, []
    for (name, view), cells in sorted(views_of(pack).items()):
        lucid = cells["lucid", ""]
        counters, row = lucid["counters"], []
        common.append(sum(lucid["gpu_ms"]["stages"][stage] for stage in COMMON) / lucid["gpu_ms"]["frame"])
        for method in METHODS:
            hardware, compute = (cells[method, source]["gpu_ms"]["frame"] for source in ("hardware", "compute"))
            row.append(f"{hardware:.3g} / {compute:.3g}")
            faster.setdefault(method, []).append(hardware / compute)
            against_lucid.setdefault(method, []).append(compute / lucid["gpu_ms"]["frame"])
        print(f"| {name} {view} | {counters['fragments'] / 1e6:.2f} "
              f"| {counters['fragments'] / counters['half_blocks']:.1f} | {' | '.join(row)} "
              f"| {lucid['gpu_ms']['frame']:.3g} |")
    for method in METHODS:
        print(f"{method}: compute is faster by {spread(faster[method])}; it takes {spread(against_lucid[method])} "
              "of lucid's time")
    print(f"{', '.join(COMMON)}: {spread(common)} of lucid's frame")


if __name__ == "__main__":
    main()
