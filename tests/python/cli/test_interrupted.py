"""Runs that end early, or share a folder: every group that is there is of one run."""

import os
import random
import signal
import subprocess
import time

import pytest
from runs import EXPERIMENT, baselines, cells, groups

# Of the test with random kills. In continuous integration few, since each costs seconds.
ROUNDS = int(os.environ.get("OITLAB_KILL_ROUNDS", "5"))


def test_killed_at_any_moment_and_resumed_every_group_is_of_one_run(oitlab, toml, results):
    """The baseline column of a table that was killed at random and resumed is that of one that was
    not: every cell of a group is from one run, with its baseline."""
    whole = results.parent / "whole"
    started = time.monotonic()
    assert oitlab("run", toml, "--results", whole).returncode == 0
    duration = time.monotonic() - started
    chance = random.Random(1)
    kills = finished = 0
    while kills < ROUNDS:
        run = subprocess.Popen([oitlab.program, "run", toml, "--results", results],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            run.communicate(timeout=chance.uniform(0.3, 1.1) * duration)
            finished += 1
        except subprocess.TimeoutExpired:
            run.send_signal(chance.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGTERM]))
            run.communicate()
            kills += 1
        for cell in cells(results).values() if results.exists() else ():
            assert cell["status"] == "ok"
            assert (results / cell["image"]["file"]).read_bytes().endswith(b"IEND\xaeB`\x82")
        # A commit that was cut short is finished by the next run: here nothing is half there.
        for of_cells in groups(results).values() if results.exists() else ():
            assert len(set(of_cells)) == 1
        if len(cells(results)) == 6 and not (results / "running").exists():
            for path in (results / "cells").iterdir():  # from the beginning
                path.unlink()
    done = oitlab("run", toml, "--results", results)
    assert done.returncode == 0, done.stderr
    assert baselines(results) == baselines(whole) == {(48, 27): (1, 3), (32, 18): (1, 3)}
    assert cells(results).keys() == cells(whole).keys()
    assert sorted(p.name for p in results.iterdir()) == ["cells", "images"]


def test_two_runs_fill_one_folder_and_measure_everything_once(oitlab, toml, results):
    """They used to measure everything twice and overwrite each other's cells."""
    toml.write_text(EXPERIMENT.replace('"32x18"', '"32x18", "24x16", "40x24", "20x12"'))
    runs = [subprocess.Popen([oitlab.program, "run", toml, "--results", results],
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            for _ in range(2)]
    said = [run.communicate(timeout=300)[1] for run in runs]
    assert [run.returncode for run in runs] == [0, 0], said
    counts = []
    for text in said:
        line = next(line for line in text.splitlines() if " measured, " in line)
        counts.append(tuple(int(word) for word in line.replace(",", "").split()[:3:2]))
    assert sum(done for done, _ in counts) == 15, "each cell is measured by one of them"
    assert all(sum(count) == 15 for count in counts), "and both see them all at their end"
    assert all(count[0] > 0 for count in counts), "they share the work"
    assert set(baselines(results).values()) == {(1, 3)}
    assert len({cell["run"] for cell in cells(results).values()}) == 2
    assert any("another process measures on" in text for text in said), "and say that they disturb each other"


@pytest.mark.parametrize(("name", "code"), [("SIGINT", 130), ("SIGTERM", 143)])
def test_a_signal_drops_the_group_and_says_how_to_go_on(oitlab, toml, results, name, code):
    toml.write_text(EXPERIMENT.replace("time_limit = 0.1", "time_limit = 20\nmin_blocks = 150"))
    # A shell that starts the tests with `&` has them ignore SIGINT, and `run` respects that.
    run = subprocess.Popen(["env", "--default-signal=INT,TERM", oitlab.program, "run", toml, "--results", results],
                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while not list(results.glob("running/*/*.owner")) and time.monotonic() < deadline:
        time.sleep(0.02)
    time.sleep(0.5)
    run.send_signal(getattr(signal, name))
    said = run.communicate(timeout=60)[1]
    assert run.returncode == code, said
    assert f"stopped by {name}" in said and "the same command goes on" in said
    assert sorted(p.name for p in results.iterdir()) == ["cells", "images"]
    assert not cells(results) and not list((results / "images").iterdir())


def test_a_folder_that_is_removed_meanwhile_ends_the_run(oitlab, toml, results):
    toml.write_text(EXPERIMENT.replace("time_limit = 0.1", "time_limit = 2\nmin_blocks = 150"))
    run = subprocess.Popen([oitlab.program, "run", toml, "--results", results],
                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while not list(results.glob("running/*/*.owner")) and time.monotonic() < deadline:
        time.sleep(0.02)
    results.rename(results.with_name("moved"))
    said = run.communicate(timeout=120)[1]
    assert run.returncode == 4 and "cannot be written" in said


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can mount a small file system")
def test_a_full_disk_ends_the_run_and_leaves_what_was_there(oitlab, toml, tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", disk],
                      capture_output=True).returncode != 0:
        pytest.skip("mounts are not allowed here")
    try:
        results = disk / "results"
        run = ("run", toml, "--results", results)
        assert oitlab(*run, "--size", "32x18").returncode == 0
        first = cells(results)
        free = os.statvfs(disk).f_bavail * os.statvfs(disk).f_frsize
        (disk / "filler").write_bytes(b"x" * (free - 4096))
        done = oitlab(*run, "--size", "48x27")
        assert done.returncode == 4, done.stderr
        assert "what was there is as it was" in done.stderr
        assert cells(results) == first
        (disk / "filler").unlink()
        assert oitlab(*run, "--size", "48x27").returncode == 0
        assert sorted(p.name for p in results.iterdir()) == ["cells", "images"]
    finally:
        subprocess.run(["umount", disk], check=True)
