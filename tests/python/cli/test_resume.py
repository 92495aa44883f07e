"""What of a results folder counts as there: whole groups of one run, measured as they would be now."""

import json
import os
import random
import signal
import subprocess
import time

import pytest
from program import ROOT

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
# Of the test with random kills. In continuous integration few, since each costs seconds.
ROUNDS = int(os.environ.get("OITLAB_KILL_ROUNDS", "5"))


@pytest.fixture
def toml(tmp_path):
    path = tmp_path / "resumed.toml"
    path.write_text(EXPERIMENT)
    return path


@pytest.fixture
def results(tmp_path):
    return tmp_path / "results"


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


def test_half_a_group_is_measured_again_as_a_whole(oitlab, toml, results):
    """Two of three methods were measured again alone: their ratios had another baseline."""
    assert oitlab("run", toml, "--results", results).returncode == 0
    first = cells(results)
    for name, cell in first.items():
        if cell["size"] == [48, 27] and cell["method"] == "blend":
            (results / "cells" / name).unlink()
    done = oitlab("run", toml, "--results", results)
    assert done.returncode == 0 and measured(done) == (3, 3)
    assert "measured again, with all 3 cells of its group: 2 of 3 cells are missing" in done.stderr
    second = cells(results)
    assert second.keys() == first.keys()
    assert baselines(results) == {(48, 27): (1, 3), (32, 18): (1, 3)}
    for name, cell in second.items():
        assert (cell == first[name]) == (cell["size"] == [32, 18])
        assert cell["image_hash"] == first[name]["image_hash"]


def test_a_method_that_is_added_is_measured_with_its_group(oitlab, toml, results):
    toml.write_text(EXPERIMENT.replace('order = ["submission", "sorted"]', ""))
    assert measured(oitlab("run", toml, "--results", results)) == (4, 0)
    toml.write_text(EXPERIMENT)
    assert measured(oitlab("run", toml, "--results", results)) == (6, 0)
    assert baselines(results) == {(48, 27): (1, 3), (32, 18): (1, 3)}
    # One that is left out changes nothing in the others.
    toml.write_text(EXPERIMENT.replace('order = ["submission", "sorted"]', ""))
    assert measured(oitlab("run", toml, "--results", results)) == (0, 4)


def damage_text(cell, _):
    return json.dumps(cell)[:100]


def damage_empty(_, __):
    return "{}"


def damage_status_only(_, __):
    return '{"status": "ok"}'


def damage_id(cell, other):
    return json.dumps({**cell, "id": other["id"]})


def damage_status(cell, _):
    return json.dumps({**cell, "status": "fine"})


def damage_samples(cell, _):
    return json.dumps({**cell, "samples": {"frame_ms": [], "block": []}})


def damage_quality(cell, _):
    return json.dumps({**cell, "quality": None})


@pytest.mark.parametrize("damage", [damage_text, damage_empty, damage_status_only, damage_id,
                                    damage_status, damage_samples, damage_quality])
def test_a_broken_cell_is_not_there(oitlab, toml, results, damage):
    """`{}` and `{"status": "ok"}` used to count as measured."""
    run = ("run", toml, "--results", results, "--size", "32x18")
    assert oitlab(*run).returncode == 0
    (name, cell), (_, other), _ = sorted(cells(results).items())
    (results / "cells" / name).write_text(damage(cell, other))
    dry = oitlab(*run, "--dry-run")
    assert "0 there already, 3 to measure" in dry.stderr and "is no whole cell" in dry.stdout
    done = oitlab(*run)
    assert done.returncode == 0 and measured(done) == (3, 0)
    assert f"{name} is no whole cell" in done.stderr
    assert cells(results)[name]["status"] == "ok"
    assert baselines(results) == {(32, 18): (1, 3)}


def test_a_cell_whose_image_is_gone_is_not_there(oitlab, toml, results):
    run = ("run", toml, "--results", results, "--size", "32x18")
    oitlab(*run)
    sorted((results / "images").iterdir())[0].unlink()
    done = oitlab(*run)
    assert measured(done) == (3, 0) and "is not there" in done.stderr
    assert len(list((results / "images").iterdir())) == 3


def change_limit(text):
    return text.replace("time_limit = 0.1", "time_limit = 0.12")


def change_seed(text):
    return text.replace('name = "resumed"', 'name = "resumed"\nseed = 7')


def change_reference(text):
    return text.replace('name = "resumed"', 'name = "resumed"\nreference = "blend"')


@pytest.mark.parametrize(("change", "said"), [
    (change_limit, "measure.time_limit is 0.1, now 0.12"),
    (change_seed, "measure.seed is 1, now 7"),
    (change_reference, "the reference is reference, now blend")])
def test_what_was_measured_otherwise_is_measured_again(oitlab, toml, results, change, said):
    """Or kept and named: cells of other settings used to satisfy a run without a word."""
    assert oitlab("run", toml, "--results", results).returncode == 0
    first = cells(results)
    toml.write_text(change(EXPERIMENT))
    kept = oitlab("run", toml, "--results", results, "--keep")
    assert measured(kept) == (0, 6) and kept.stderr.count(said) == 6
    assert cells(results) == first
    done = oitlab("run", toml, "--results", results)
    assert measured(done) == (6, 0) and said in done.stderr
    assert measured(oitlab("run", toml, "--results", results)) == (0, 6)


def test_brief_cells_do_not_count_for_a_full_run(oitlab, toml, results):
    toml.write_text(EXPERIMENT + "[profile.brief.measure]\ntime_limit = 0.05\n")
    run = ("run", toml, "--results", results, "--size", "32x18")
    assert measured(oitlab(*run, "--profile", "brief")) == (3, 0)
    done = oitlab(*run, "--profile", "full")
    assert measured(done) == (3, 0) and "the profile is brief, now full" in done.stderr
    assert {cell["profile"] for cell in cells(results).values()} == {"full"}


def test_an_edited_shader_makes_its_groups_old(oitlab, toml, results, tmp_path):
    root = tmp_path / "root"
    root.mkdir()
    for folder in ("shaders", "experiments"):
        subprocess.run(["cp", "-r", ROOT / folder, root], check=True)
    env = {"OITLAB_ROOT": str(root), "OITLAB_CACHE": str(tmp_path / "cache")}
    run = ("run", toml, "--results", results, "--size", "32x18")
    assert measured(oitlab(*run, env=env)) == (3, 0)
    assert measured(oitlab(*run, env=env)) == (0, 3)
    unused = root / "shaders" / "wboit" / "composite.frag"
    unused.write_text(unused.read_text() + "\n// edited\n")
    assert measured(oitlab(*run, env=env)) == (0, 3)
    edited = root / "shaders" / "blend" / "blend.frag"
    edited.write_text(edited.read_text() + "\n// edited\n")
    done = oitlab(*run, env=env)
    assert measured(done) == (3, 0) and "shader blend/blend.frag has changed" in done.stderr


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


@pytest.mark.parametrize(("name", "code"), [("SIGINT", 130), ("SIGTERM", 143)])
def test_a_signal_drops_the_group_and_says_how_to_go_on(oitlab, toml, results, name, code):
    toml.write_text(EXPERIMENT.replace("time_limit = 0.1", "time_limit = 20\nmin_blocks = 150"))
    run = subprocess.Popen([oitlab.program, "run", toml, "--results", results],
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
