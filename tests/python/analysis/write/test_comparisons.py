"""What a report compares, and what it keeps apart: contexts, runs, few blocks, names of variants."""

import csv
import re

import pytest
from oitlab_analysis.write.report import make_report
from synthetic import DEVICE, LAVAPIPE, make_cell, make_results, write_cell

pytestmark = pytest.mark.usefixtures("without_charts")


def test_cells_of_different_context_are_kept_apart(tmp_path):
    """The same group on two devices and two commits: four sections, no ratio across them."""
    for device in (DEVICE, LAVAPIPE):
        for commit in ("abc1234", "def5678-dirty"):
            provenance = make_cell()["provenance"] | {"commit": commit}
            for method, time in (("blend", 1.0), ("lucid", 2.0)):
                # Each context is 10 times as slow as the one before.
                scale = {DEVICE["name"]: 1, LAVAPIPE["name"]: 100}[device["name"]]
                scale *= 1 if commit == "abc1234" else 10
                cell = make_cell(method=method, frame_ms=time * scale, device=device,
                                 provenance=provenance, group="one")
                write_cell(tmp_path, cell | {"id": f"{commit}-{cell['id']}"})
    text = make_report([tmp_path], all_warnings=True).text
    assert text.count("\n\nboxes ·") == 4
    with open(tmp_path / "cells.csv", encoding="utf-8", newline="") as file:
        rows = {row["id"]: row for row in csv.DictReader(file)}
    lucid = [row for row in rows.values() if row["method"] == "lucid"]
    assert [float(row["ratio"]) for row in lucid] == pytest.approx([2] * 4, rel=0.01)
    for row in lucid:
        baseline = rows[row["baseline"]]
        assert (baseline["device"], baseline["commit"]) == (row["device"], row["commit"])
    assert text.count("CPU device: these times say nothing about GPUs.") == 2
    assert "2 devices" in text and "2 commits" in text and "kept apart" in text
    assert text.count("changes that no commit holds") == 2


def test_few_blocks_give_a_ratio_without_a_verdict(tmp_path):
    for method, time in (("blend", 1.0), ("lucid", 3.0)):
        write_cell(tmp_path, make_cell(method=method, frame_ms=time, blocks=4))
    line = next(x for x in make_report([tmp_path]).text.splitlines() if x.startswith("lucid"))
    assert re.search(r"\s(2\.9\d|3\.0\d) \(n = 4\)\s+ambiguous", line)


def test_one_sample_has_no_interval(tmp_path):
    """A bootstrap of one value has no width, and says nothing."""
    write_cell(tmp_path, make_cell(blocks=1, frames=1))
    text = make_report([tmp_path]).text
    assert re.search(r"^blend  .*\d \(n = 1\) ", text, re.M) and "[" not in text.split("verdict")[1]
    with open(tmp_path / "cells.csv", encoding="utf-8", newline="") as file:
        row, = csv.DictReader(file)
    assert (row["frame_ms.ci_low"], row["frame_ms.ci_high"], row["blocks"]) == ("", "", "1")


def test_a_cell_without_an_interval_is_a_cell(tmp_path):
    cell = make_cell(blocks=2)
    cell["statistics"]["frame"]["ci95"] = None
    write_cell(tmp_path, cell)
    assert "(n = 2)" in make_report([tmp_path]).text


def resumed(folder):
    """A group of which two methods were lost, and measured again by another run."""
    for method, parameters, time, rmse in (("blend", {}, 2.0, 0.1), ("reference", {}, 6.0, 0.0),
                                           ("wboit", {}, 2.4, 0.05)):
        write_cell(folder, make_cell(method=method, parameters=parameters, frame_ms=time, rmse=rmse, group="1"))
    for method, time in (("lucid", 5.0), ("moment", 4.0)):
        write_cell(folder, make_cell(method=method, frame_ms=time, group="2"))
    return folder


def test_a_group_measured_in_two_runs_has_one_baseline(tmp_path):
    text = make_report([resumed(tmp_path)], all_warnings=True).text
    lines = {line.split()[0]: line for line in text.splitlines() if line and line[0] != " "}
    assert text.count(" baseline") == 1 + 1, "blend, and the warning"
    assert re.search(r" 1\.200 \[.* slower ", lines["wboit"])
    for method in ("lucid", "moment"):
        assert re.search(r"–\s+other run", lines[method]), "a dash, and a word why"
    assert "2 of 5 cells have no ratio: another run" in " ".join(text.split())
    with open(tmp_path / "cells.csv", encoding="utf-8", newline="") as file:
        rows = {row["method"]: row for row in csv.DictReader(file)}
    assert rows["lucid"]["ratio"] == rows["lucid"]["baseline"] == ""
    assert rows["wboit"]["baseline"].startswith("boxes-default-64x36-blend")


def test_labels_show_only_parameters_that_differ(tmp_path):
    make_results(tmp_path, methods=5, scenes=1)
    text = make_report([tmp_path]).text
    assert "lucid (tile=8)" in text and "lucid (tile=16)" in text
    assert "early_out" not in text and "submission" not in text


def test_scenes_that_differ_by_opacity_are_not_merged(tmp_path):
    for opacity in (None, 0.25):
        cell = make_cell()
        cell["scene"]["opacity"] = opacity
        write_cell(tmp_path, cell | {"id": f"at-{opacity}"})
    text = make_report([tmp_path]).text
    assert "boxes (opacity=0.25)" in text and "boxes (opacity as modelled)" in text


def test_cells_that_nothing_tells_apart_are_numbered(tmp_path):
    for seed in (1, 2):
        write_cell(tmp_path, make_cell(seed=seed) | {"id": f"seed-{seed}"})
    text = make_report([tmp_path]).text
    assert re.search(r"^blend  ", text, re.M) and re.search(r"^blend #2  ", text, re.M)


def test_a_long_name_has_a_line_of_its_own_and_a_shorter_one_the_room_there_is(tmp_path):
    for n in (1, 2):
        parameters = {"a_parameter_with_a_long_name": n, "another_one_that_tells_nothing_apart": n}
        write_cell(tmp_path, make_cell(method="m", parameters=parameters))
    for order in ("sorted", "submission"):
        write_cell(tmp_path, make_cell(parameters={"order": order}, blocks=3))
    lines = make_report([tmp_path]).text.splitlines()
    assert any(re.match(r"blend \(order=submission\) +[0-9.]+ \(n = 3\)", line) for line in lines)
    place = next(i for i, line in enumerate(lines) if line.startswith("m (a_parameter_with_a_long_name=1, another"))
    assert re.match(r" {20,}[0-9.]+ \[", lines[place + 1])
    assert max(map(len, lines)) <= 100
