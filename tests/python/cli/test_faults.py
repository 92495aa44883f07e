"""What a run makes of failures, with a method that goes wrong as it is told (tests/data/faults)."""

import json
import os
import signal
import subprocess
import time

import pytest
from program import PROGRAM

WITH_FAULTS = PROGRAM.with_name("oitlab_with_faults")


@pytest.fixture
def run(tmp_path):
    """Measures these methods with the scene `planes`; returns the process and the cells by method."""
    if not WITH_FAULTS.is_file():
        assert "CI" not in os.environ, f"{WITH_FAULTS} is not built"
        pytest.skip(f"{WITH_FAULTS} is not built")

    def measure(methods, *arguments, reference="reference", scenes='"planes"', fault=None,
                env=None):
        toml = tmp_path / "faults.toml"
        toml.write_text(f"""
name = "faults"
sizes = ["32x18"]
scenes = [{scenes}]
methods = [{methods}]
reference = "{reference}"
[measure]
time_limit = 0.1
stage_frames = 2
""")
        env = {**os.environ, **({"OITLAB_FAULT": fault} if fault else {}), **(env or {})}
        done = subprocess.run([WITH_FAULTS, "run", toml, "--results", tmp_path / "results",
                               *arguments], capture_output=True, text=True, env=env, timeout=300)
        cells = [json.loads(p.read_text()) for p in (tmp_path / "results" / "cells").glob("*.json")]
        return done, cells

    return measure


def by_method(cells):
    return {cell["method"]: cell for cell in cells}


def fault(kind):
    return f'{{ method = "fault", kind = "{kind}" }}'


@pytest.mark.parametrize("kind", ["prepare", "frame", "memory"])
def test_what_fails_is_a_row_and_the_others_are_measured(run, kind):
    done, cells = run(f'"blend", {fault(kind)}')
    assert done.returncode == 1, done.stderr
    rows = by_method(cells)
    assert rows["blend"]["status"] == "ok" and rows["fault"]["status"] == "failed"
    reason = {"prepare": "it cannot be made ready", "frame": "a frame failed",
              "memory": "not enough main memory"}[kind]
    assert rows["fault"]["reason"] == reason
    assert rows["fault"]["group"] == rows["blend"]["group"]
    # It fails again: nothing else of its group is measured again for that.
    again, cells = run(f'"blend", {fault(kind)}')
    assert again.returncode == 1 and "0 measured, 1 there before, 1 failed" in again.stderr
    assert by_method(cells) == rows


def test_no_memory_for_a_whole_group_leaves_the_other_groups(run):
    done, cells = run(fault("memory_later"), scenes='"planes", "boxes"')
    assert done.returncode == 1, done.stderr
    assert {cell["status"] for cell in cells} == {"failed"} and len(cells) == 2
    assert all("not enough main memory" in cell["reason"] for cell in cells)


def test_what_failed_and_works_now_is_measured_with_its_group(run):
    done, cells = run('"blend", "fault"', fault="frame")
    assert done.returncode == 1 and by_method(cells)["fault"]["status"] == "failed"
    done, cells = run('"blend", "fault"')
    assert done.returncode == 0 and "2 measured, 0 there before" in done.stderr
    assert {cell["status"] for cell in cells} == {"ok"}
    assert len({cell["group"] for cell in cells}) == 1


def test_a_device_that_is_lost_is_opened_anew(run):
    """An uncaught exception used to end the run, without a row."""
    done, cells = run(f'"blend", {fault("lost_once")}', scenes='"planes", "boxes"')
    assert done.returncode == 0, done.stderr
    assert "the device was lost (the device is lost): it is opened anew" in done.stderr
    assert len(cells) == 4 and {cell["status"] for cell in cells} == {"ok"}
    assert len({cell["group"] for cell in cells}) == 2


def test_a_group_that_loses_the_device_three_times_is_left(run):
    done, cells = run(f'"blend", {fault("lost")}', scenes='"planes", "boxes"')
    assert done.returncode == 1, done.stderr
    assert done.stderr.count("it is opened anew") == 4
    assert len(cells) == 4 and {cell["status"] for cell in cells} == {"failed"}
    assert all("lost 3 times in a row" in cell["reason"] for cell in cells)


def test_without_the_reference_no_cell_is_ok(run):
    """A passing fault used to leave cells that were ok, without a quality, for ever."""
    done, cells = run('"blend"', reference="fault", fault="frame")
    assert done.returncode == 1, done.stderr
    cell, = cells
    assert cell["status"] == "failed"
    assert cell["reason"].startswith("no reference image: a frame failed")
    done, cells = run('"blend"', reference="fault")
    assert done.returncode == 0 and "1 measured" in done.stderr
    cell, = cells
    assert cell["status"] == "ok" and cell["quality"]["reference"] == "fault"


def test_a_second_signal_ends_it_at_once(tmp_path, run):
    """Also where the program does not look for signals, here within a frame of a minute."""
    done, _ = run('"fault"')
    assert done.returncode == 0, done.stderr
    results = tmp_path / "results"
    toml = tmp_path / "faults.toml"
    arguments = [WITH_FAULTS, "run", toml, "--results", results, "--size", "40x20"]
    # A shell that starts the tests with `&` has them ignore SIGINT, and `run` respects that.
    stuck = subprocess.Popen(["env", "--default-signal=INT", *arguments], stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL, env={**os.environ, "OITLAB_FAULT": "stuck"})
    deadline = time.monotonic() + 60
    while not list(results.glob("running/*/*.owner")) and time.monotonic() < deadline:
        time.sleep(0.02)
    time.sleep(1)
    stuck.send_signal(signal.SIGINT)
    time.sleep(0.5)
    assert stuck.poll() is None
    stuck.send_signal(signal.SIGINT)
    assert stuck.wait(10) == -signal.SIGINT
    # What it held is taken over at once.
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "1 measured" in done.stderr
    assert sorted(p.name for p in results.iterdir()) == ["cells", "images"]


def test_a_scene_that_asks_for_too_much_is_a_row(run, tmp_path):
    """It used to end the run with no cells at all."""
    (tmp_path / "big.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "f 1 2 3\n" * 100)
    done, cells = run('"blend"', scenes='"big.obj", "planes"', env={"OITLAB_SCENE_VERTICES": "99"})
    assert done.returncode == 1, done.stderr
    rows = {cell["scene"]["name"]: cell for cell in cells}
    assert rows["planes"]["status"] == "ok" and rows["big"]["status"] == "failed"
    assert "OITLAB_SCENE_VERTICES sets another limit" in rows["big"]["reason"]


def test_words_of_the_validation_layers_are_counted(run):
    done, cells = run(f'"blend", {fault("invalid")}', "--validation")
    if "is not installed" in done.stderr:
        pytest.skip("no validation layers here")
    assert done.returncode == 1, done.stderr
    rows = by_method(cells)
    assert rows["fault"]["validation_messages"] > 0
    assert rows["blend"]["validation_messages"] == 0
    assert rows["fault"]["status"] == "ok"
    assert "the validation layers had something to say about 1 cells" in done.stderr
    again, _ = run(f'"blend", {fault("invalid")}', "--validation")
    assert again.returncode == 1 and "0 measured, 2 there before" in again.stderr
