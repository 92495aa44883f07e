"""A sweep that is killed at random moments and gone on with: nothing is lost, doubled or mixed."""

import os
import random
import shutil
import signal
import subprocess
import time

import pytest
from small_sweep import Sweep, assert_right

# Four groups, so that most kills come after some and before others; about a second in all. The number
# of frames is fixed, and so is the size of the cells.
GROUPS = """
name = "faults"
sizes = ["48x27", "32x18"]
scenes = ["planes", { source = "boxes", detail = 0.3 }]
methods = [{ method = "blend", order = ["submission", "sorted"] }, "reference", "wboit"]
[measure]
time_limit = 60
min_blocks = 3
max_blocks = 3
min_frames = 3
max_frames = 3
stage_frames = 2
"""


@pytest.fixture(scope="module")
def whole(program, tmp_path_factory):
    """The cells of a run that nobody kills, how long it took, and the pages of memory that it fills."""
    sweep = Sweep(program, tmp_path_factory.mktemp("whole"), GROUPS)
    start = time.monotonic()
    done = sweep.run()
    assert done.returncode == 0, done.stderr
    cells = sweep.cells()
    assert len(cells) == 16
    seconds = time.monotonic() - start
    pages = sum(-(-path.stat().st_size // 4096) for path in sweep.results.rglob("*") if path.is_file())
    return cells, seconds, pages


def files(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def check(sweep, expected):
    """Every cell there is whole and right, and has its picture."""
    cells = sweep.cells()
    assert cells.keys() <= expected.keys()
    for cell in cells.values():
        assert cell["status"] == "ok", cell["reason"]
        assert_right(cell, expected[cell["id"]])
        picture = (sweep.results / cell["image"]["file"]).read_bytes()
        assert picture.startswith(b"\x89PNG") and picture.endswith(b"IEND\xaeB\x60\x82")
    return cells


@pytest.mark.parametrize("kill", [signal.SIGKILL, signal.SIGTERM], ids=["SIGKILL", "SIGTERM"])
def test_a_killed_sweep_goes_on_where_it_was(program, tmp_path, whole, long, kill):
    expected, seconds, _ = whole
    sweep = Sweep(program, tmp_path, GROUPS)
    random_moments = random.Random(1)
    kills = sweeps = 0
    while kills < (50 if long else 5):
        before = files(sweep.results / "cells") if sweep.results.exists() else {}
        run = subprocess.Popen(sweep.command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               text=True, cwd=tmp_path)
        try:
            run.wait(random_moments.uniform(0, seconds))
        except subprocess.TimeoutExpired:
            run.send_signal(kill)
            kills += 1
        said = run.communicate()[1]
        # Before the program listens, SIGTERM ends it as it ends any other.
        ends = {signal.SIGKILL: (0, -9), signal.SIGTERM: (0, 143, -15)}
        assert run.returncode in ends[kill], said
        cells = check(sweep, expected)
        after = files(sweep.results / "cells") if sweep.results.exists() else {}
        assert before.items() <= after.items(), "a finished cell was lost or measured again"
        # Cells that were measured against each other say so by their group, and all are there.
        groups = {}
        for cell in cells.values():
            groups.setdefault((cell["scene"]["source"], *cell["size"]), set()).add(cell["group"])
        assert all(len(names) == 1 for names in groups.values()), "a group is a mixture"
        if len(cells) == len(expected):
            sweeps += 1
            shutil.rmtree(sweep.results)
    done = sweep.run()
    assert done.returncode == 0, done.stderr
    assert check(sweep, expected).keys() == expected.keys()
    left = [path.name for path in sweep.results.rglob("*")
            if path.is_file() and path.parent.name not in ("cells", "images")]
    assert not left, "temporary files of the killed runs are still there"
    names = {path.stem for path in (sweep.results / "images").iterdir()}
    assert names == expected.keys()


def mounted(folder, size):
    """A file system of that size, or a skip where none can be made."""
    if os.geteuid() != 0:
        pytest.skip("a small file system takes root to mount")
    folder.mkdir()
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        pytest.skip(f"a small file system cannot be mounted here: {done.stderr.strip()}")


def test_a_full_disk_ends_the_run_and_leaves_what_was_there(program, tmp_path, whole):
    expected, _, pages = whole
    disk = tmp_path / "disk"
    mounted(disk, f"{4 * pages * 6 // 10}k")  # for two groups of the four
    try:
        sweep = Sweep(program, disk, GROUPS)
        done = sweep.run()
        assert done.returncode == 4, done.stderr  # cannot write
        assert "disk" in done.stderr or "space" in done.stderr, done.stderr
        there = check(sweep, expected)
        assert 0 < len(there) < len(expected)
        before = files(sweep.results / "cells")
        subprocess.run(["mount", "-o", "remount,size=20m", disk], check=True)
        done = sweep.run()
        assert done.returncode == 0, done.stderr
        assert f"{len(there)} there before" in done.stderr
        assert check(sweep, expected).keys() == expected.keys()
        assert before.items() <= files(sweep.results / "cells").items()
    finally:
        subprocess.run(["umount", disk], check=True)


def test_a_results_folder_removed_under_the_run(program, tmp_path, whole):
    """The run ends by itself, with a sentence, and nothing is half there."""
    expected, _, _ = whole
    sweep = Sweep(program, tmp_path, GROUPS)
    run = subprocess.Popen(sweep.command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                           text=True, cwd=tmp_path)
    deadline = time.monotonic() + 60
    while not list(sweep.results.glob("cells/*.json")) and time.monotonic() < deadline:
        time.sleep(0.005)
    shutil.rmtree(sweep.results, ignore_errors=True)
    said = run.communicate(timeout=120)[1]
    # 0 where the folder came back in time for all that was still to be written.
    assert run.returncode in (0, 4), said
    check(sweep, expected)
    done = sweep.run()
    assert done.returncode == 0, done.stderr
    assert check(sweep, expected).keys() == expected.keys()
