"""An experiment of two groups that takes seconds, and what a results folder holds of it."""

import json

EXPERIMENT = """
name = "resumed"
sizes = ["48x27", "32x18"]
scenes = ["planes"]
[[methods]]
method = "blend"
order = ["submission", "sorted"]
[[methods]]
method = "reference"
[measure]
time_limit = 0.1
stage_frames = 2
"""


def cells(results):
    return {p.name: json.loads(p.read_text()) for p in (results / "cells").glob("*.json")}


def groups(results):
    """By image size, the `group` of each cell."""
    found = {}
    for cell in cells(results).values():
        found.setdefault(tuple(cell["size"]), []).append(cell["group"])
    return found


def measured(done):
    """"3 measured, 3 there before" -> (3, 3)."""
    line = next(line for line in done.stderr.splitlines() if " measured, " in line)
    words = line.replace(",", "").split()
    return int(words[0]), int(words[2])


def baselines(results):
    """For each group the ids of the cells that a ratio may be taken to: what the report prints."""
    return {size: (len(set(of_cells)), len(of_cells)) for size, of_cells in groups(results).items()}
