"""`oitlab run`: resumes, shards, survives a kill, and writes rows for what cannot be measured."""

import json
import os

import pytest
from runs import cells

EXPERIMENT = """
name = "tiny"
sizes = ["48x27"]
scenes = ["planes", { source = "boxes", detail = 0.03 }]
[[methods]]
method = "blend"
order = ["submission", "sorted"]
[[methods]]
method = "reference"
[measure]
time_limit = 0.2
stage_frames = 3
"""


@pytest.fixture
def tiny(tmp_path):
    path = tmp_path / "tiny.toml"
    path.write_text(EXPERIMENT)
    return path


def test_measures_then_resumes(oitlab, tiny, tmp_path):
    results = tmp_path / "results"
    done = oitlab("run", tiny, "--results", results)
    assert done.returncode == 0, done.stderr
    first = cells(results)
    assert len(first) == 6
    for cell in first.values():
        assert cell["status"] == "ok" and cell["experiment"] == "tiny"
        assert len(cell["samples"]["frame_ms"]) == len(cell["samples"]["block"]) >= 3
        assert cell["statistics"]["frame"]["median"] == cell["gpu_ms"]["frame"] > 0
        frame = cell["statistics"]["frame"]
        assert frame["blocks"] == len(set(cell["samples"]["block"]))
        assert (frame["ci95"] is None) == (frame["blocks"] < 6)
        if frame["ci95"]:
            assert frame["ci95"][0] <= cell["gpu_ms"]["frame"] <= frame["ci95"][1]
        assert cell["stop"]["reason"] in ("spread", "settled", "time_limit", "max_blocks")
        assert cell["counters"]["fragments"] > 0
        assert set(cell["stage_order"]) == set(cell["gpu_ms"]["stages"])
        assert (results / cell["image"]["file"]).exists()
        assert cell["quality"]["reference"] == "reference"
        exact = cell["method"] == "reference"
        assert (cell["quality"]["rmse"] == 0) == exact
    groups = {}
    for cell in first.values():
        groups.setdefault(cell["group"], []).append(cell["scene"]["name"])
    assert sorted(map(len, groups.values())) == [3, 3]
    assert len({cell["run"] for cell in first.values()}) == 1
    assert {cell["group_cells"] for cell in first.values()} == {3}
    # The same fragments, whoever counts them: the query of blend, the lists of the reference.
    for name in ("planes", "boxes"):
        counts = {c["counters"]["fragments"] for c in first.values() if c["scene"]["name"] == name}
        assert len(counts) == 1

    again = oitlab("run", tiny, "--results", results)
    assert again.returncode == 0 and "0 measured, 6 there before" in again.stderr
    assert cells(results) == first


def test_a_cell_says_the_shaders_of_its_own_method(oitlab, tiny, tmp_path):
    """Not those of the other methods that the process measured, nor their variants."""
    results = tmp_path / "results"
    assert oitlab("run", tiny, "--results", results).returncode == 0
    for cell in cells(results).values():
        shaders = cell["provenance"]["shaders"]
        mine = {label for label in shaders if not label.startswith("common/")}
        own = cell["method"] + "/"  # its folder, or a source's shader with its fragment program
        assert mine and all(label.startswith(own) or f"FRAGMENT_PROGRAM={own}" in label for label in mine)
        sorts = any("centroid_keys" in label for label in mine)
        assert sorts == (cell["parameters"].get("order") == "sorted")


def test_dry_run_measures_nothing(oitlab, tiny, tmp_path):
    done = oitlab("run", tiny, "--results", tmp_path / "results", "--dry-run")
    assert done.returncode == 0 and len(done.stdout.splitlines()) == 6
    assert not (tmp_path / "results").exists()
    assert "0 there already, 6 to measure: about 00:" in done.stderr


def test_shards_make_the_whole(oitlab, tiny, tmp_path):
    results = tmp_path / "results"
    for shard in ("2/2", "1/2"):
        assert oitlab("run", tiny, "--results", results, "--shard", shard).returncode == 0
        assert len(cells(results)) == (3 if shard == "2/2" else 6)
    done = oitlab("run", tiny, "--results", results)
    assert "0 measured, 6 there before" in done.stderr


def test_a_shard_beyond_the_groups_has_nothing_to_do_and_says_so(oitlab, tiny, tmp_path):
    results = tmp_path / "results"
    done = oitlab("run", tiny, "--results", results, "--shard", "3/3")
    assert done.returncode == 0 and not results.exists()
    assert "--shard 3/3: nothing to do: there are 2 groups" in done.stderr


def test_nothing_is_begun_after_the_time_that_a_job_has(oitlab, tiny, tmp_path):
    """At most the group that was under way; the same command measures the rest."""
    results = tmp_path / "results"
    done = oitlab("run", tiny, "--results", results, "--stop-after", "0.0001")
    assert done.returncode == 0 and "0 measured" in done.stderr
    assert "6 not begun when 0.0001 s were over" in done.stderr
    assert not cells(results)
    done = oitlab("run", tiny, "--results", results, "--stop-after", "600")
    assert done.returncode == 0 and "6 measured" in done.stderr and "not begun" not in done.stderr
    done = oitlab("run", tiny, "--results", results, "--stop-after", "0")
    assert done.returncode == 2 and "--stop-after" in done.stderr


def test_cells_of_one_image_have_one_quality(oitlab, tmp_path):
    """Whatever is found of an image is found once a group; all have it, and their picture."""
    experiment = tmp_path / "same.toml"
    experiment.write_text("""
sizes = ["48x27", "32x18"]
scenes = [{ source = "boxes", detail = 0.03 }]
methods = ["blend", { method = "wboit", weight = "none" }, { method = "abuffer", sort_memory = ["max", "bma"] }]
[measure]
time_limit = 0.1
""")
    results = tmp_path / "results"
    assert oitlab("run", experiment, "--results", results).returncode == 0
    made = cells(results).values()
    assert len(made) == 8
    for size in ([48, 27], [32, 18]):
        here = [c for c in made if c["size"] == size]
        exact = [c for c in here if c["method"] == "abuffer"]
        assert exact[0]["image_hash"] == exact[1]["image_hash"]
        assert exact[0]["quality"] == exact[1]["quality"] and exact[0]["quality"]["rmse"] == 0
        pictures = {c["image"]["file"]: (results / c["image"]["file"]).read_bytes() for c in here}
        assert len(pictures) == 4 and len(set(pictures.values())) == 3
        assert len({c["quality"]["rmse"] for c in here}) == 3


def test_what_cannot_be_measured_is_a_row_with_the_reason(oitlab, tmp_path):
    (tmp_path / "broken.glb").write_bytes(b"glTF nonsense")
    experiment = tmp_path / "mixed.toml"
    experiment.write_text("""
sizes = ["32x18"]
scenes = ["broken.glb", "planes"]
methods = ["blend"]
[measure]
time_limit = 0.1
""")
    results = tmp_path / "results"
    done = oitlab("run", experiment, "--results", results)
    assert done.returncode == 1
    by_status = {c["status"]: c for c in cells(results).values()}
    assert by_status.keys() == {"ok", "failed"}
    assert "broken.glb" in by_status["failed"]["reason"]


def test_results_folder_that_cannot_be_written(oitlab, tiny, tmp_path):
    (tmp_path / "file").write_text("")
    done = oitlab("run", tiny, "--results", tmp_path / "file" / "results")
    assert done.returncode == 4 and "cannot be written" in done.stderr


def test_size_beyond_the_device_is_bad_input_before_anything_is_measured(oitlab, tmp_path):
    experiment = tmp_path / "huge.toml"
    experiment.write_text('scenes = ["planes"]\nmethods = ["blend"]\nsizes = ["32x18", "99999x18"]\n')
    done = oitlab("run", experiment, "--results", tmp_path / "results")
    assert done.returncode == 2 and "99999" in done.stderr
    assert not (tmp_path / "results").exists()


def test_report_of_a_run(oitlab, tiny, tmp_path):
    results = tmp_path / "results"
    oitlab("run", tiny, "--results", results)
    done = oitlab("report", results)
    assert done.returncode == 0, done.stderr
    for name in ("report.html", "report.md", "cells.csv"):
        assert str(results / name) in done.stdout and (results / name).stat().st_size > 0
    page = (results / "report.html").read_text()
    assert "data:image/" in page and "http" + "s://" not in page.split("<body")[1]
    assert os.path.getsize(results / "plots" / "frame-times-1.png") > 0


def test_cells_say_which_profile_and_overrides_they_were_measured_with(oitlab, tmp_path):
    experiment = tmp_path / "p.toml"
    experiment.write_text('scenes = ["boxes"]\nmethods = ["blend"]\nsizes = ["64x36"]\n'
                          "[measure]\ntime_limit = 0.1\n"
                          '[profile.cpu]\nsizes = ["32x18"]\ndetail = 0.03\n')
    device = json.loads(oitlab("info", "--json").stdout)["devices"]
    automatic = "cpu" if next(d for d in device if d["best"])["type"] == "cpu" else "full"
    for arguments, profile, size, overrides in (
            ([], automatic, [32, 18] if automatic == "cpu" else [64, 36], None),
            (["--profile", "full"], "full", [64, 36], None),
            (["--profile", "cpu", "--size", "16x9", "--detail", "0.05"], "cpu", [16, 9],
             {"detail": pytest.approx(0.05), "size": [16, 9]})):
        results = tmp_path / f"results{len(arguments)}"
        done = oitlab("run", experiment, "--results", results, *arguments)
        assert done.returncode == 0, done.stderr
        assert f"profile {profile}" in done.stderr
        cell, = cells(results).values()
        assert (cell["profile"], cell["size"], cell.get("overrides")) == (profile, size, overrides)
    assert cell["scene"]["detail"] == pytest.approx(0.05)
