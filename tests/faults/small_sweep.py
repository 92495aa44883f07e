"""A small sweep that the tests of faults disturb, and what must hold of it all the same."""

import json
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python" / "support"))
from program import PROGRAM

LAYERS = PROGRAM.parent / "layers"

# Every method, every kind of fragment: all cells of one image size are one group. One frame a block
# and one block a cell: the same calls in every run, whatever the machine is busy with. Small, since
# the tests run it often: about a second of a CPU.
PLAN = """
name = "faults"
sizes = ["24x16"]
scenes = ["planes", { source = "boxes", detail = 0.05 }]
methods = [METHODS]
[measure]
time_limit = 60
min_blocks = 1
max_blocks = 1
min_frames = 1
max_frames = 1
stage_frames = 1
"""
HARDWARE = """"abuffer", { method = "blend", order = ["submission", "sorted"] }, "cpu_reference",
    { method = "depth_peeling", mode = ["front_to_back", "dual"] },
    { method = "local_memory", passes = 2, size = 8 }, "lucid", "reference", "wboit" """
# Every method that takes fragments of the compute rasterizer as well; what they are compared with as usual.
COMPUTE = """{ method = "abuffer", source = "compute" },
    { method = "blend", order = ["submission", "sorted"], source = "compute" },
    { method = "depth_peeling", mode = ["front_to_back", "dual"], source = "compute" },
    { method = "reference", source = ["hardware", "compute"] }, { method = "wboit", source = "compute" }"""
SWEEP, COMPUTE_SWEEP = PLAN.replace("METHODS", HARDWARE), PLAN.replace("METHODS", COMPUTE)


class Sweep:
    """The small sweep in a folder of its own; each run() goes on where the last one stopped."""

    def __init__(self, program, folder, text=SWEEP):
        self.program, self.folder = program, folder
        self.experiment, self.results = folder / "faults.toml", folder / "results"
        self.experiment.write_text(text)

    @property
    def command(self):
        return [str(self.program), "run", str(self.experiment), "--results", str(self.results),
                "--profile", "full"]

    def run(self, *options, **environment):
        # A run takes seconds. With four other processes on a busy machine of two cores, and nothing in the
        # driver's cache, one did not end within five minutes.
        return subprocess.run([*self.command, *options], capture_output=True, text=True, timeout=1800,
                              cwd=self.folder, env={**os.environ, **environment})

    def cells(self):
        """By id. Every file there has to parse, and to have its own id for its name."""
        cells = {}
        for path in (self.results / "cells").glob("*.json"):
            cell = json.loads(path.read_text())
            assert cell["id"] == path.stem
            cells[path.stem] = cell
        return cells


def assert_right(cell, expected):
    """A cell that says `ok` has the image, the picture's judgement and the counts that it should."""
    assert cell["image_hash"] == expected["image_hash"], cell["id"]
    assert cell["quality"] == expected["quality"], cell["id"]
    timed = {"cpu_ms"}
    assert ({k: v for k, v in cell["counters"].items() if k not in timed}
            == {k: v for k, v in expected["counters"].items() if k not in timed}), cell["id"]
