"""Which cells a table takes: of one device, one version, one setting, measured in turn."""

import csv
import json

import pytest
from oitlab_analysis.__main__ import main
from oitlab_analysis.paper.make import make_paper
from oitlab_analysis.paper.measured import Want, find, gather, ratio
from papers import SIZE, SMALL, table_of, write_performance
from synthetic import (
    LAVAPIPE,
    lucid_cell,
    make_cell,
    without_measurement,
    write_cell,
)


def test_an_experiment_that_takes_a_frame_for_its_counts_gives_no_times(tmp_path):
    write_performance(tmp_path, ["boxes"])
    few = lucid_cell("teapot", 1, size=SIZE, experiment="memory", parameters={"repair": False}, blocks=5)
    enough = lucid_cell("bunny", 1, size=SIZE, experiment="other", parameters={"repair": False}, blocks=6)
    for cell in (few, enough):
        write_cell(tmp_path, cell)
    make_paper([tmp_path], tmp_path / "out")
    rows = table_of(tmp_path / "out", "performance-2560x1330-example-gpu-4000")
    assert rows["Teapot"]["SW, µs (Example GPU 4000 (measured))"] == ""
    assert rows["Bunny"]["SW, µs (Example GPU 4000 (measured))"] != ""


def test_failed_cells_are_gaps_and_said(tmp_path):
    write_performance(tmp_path, ["boxes"])
    cell = lucid_cell("teapot", 1, size=SIZE, experiment="performance", parameters={"repair": False})
    write_cell(tmp_path, without_measurement(cell, "failed", "device lost"))
    said = make_paper([tmp_path], tmp_path / "out")
    assert "1 cells failed" in said and "device lost" in said
    assert table_of(tmp_path / "out", "performance-2560x1330-example-gpu-4000")["Teapot"][
        "SW, µs (Example GPU 4000 (measured))"] == ""


def test_devices_have_tables_of_their_own(tmp_path):
    write_performance(tmp_path / "a", ["boxes"])
    write_performance(tmp_path / "b", ["boxes"], factor=9.0, device=LAVAPIPE)
    make_paper([tmp_path / "a", tmp_path / "b"], tmp_path / "out")
    for name, factor in (("example-gpu-4000", 3.0), ("llvmpipe", 9.0)):
        rows = table_of(tmp_path / "out", f"performance-2560x1330-{name}")
        found = next(v for k, v in rows["Boxes"].items() if k.startswith("SW/HW (") and "measured" in k)
        assert float(found) == pytest.approx(factor, rel=0.01)
    assert "say nothing about GPUs" in (tmp_path / "out/performance-2560x1330-llvmpipe.md").read_text()
    assert "say nothing" not in (tmp_path / "out/performance-2560x1330-example-gpu-4000.md").read_text()


def test_versions_are_never_mixed_in_one_table(tmp_path):
    write_performance(tmp_path / "old", ["boxes", "bunny", "teapot"], factor=5.0, commit="old")
    write_performance(tmp_path / "new", ["boxes", "bunny", "teapot", "dragon"], factor=3.0, commit="new")
    make_paper([tmp_path / "old", tmp_path / "new"], tmp_path / "out")
    text = (tmp_path / "out/performance-2560x1330-example-gpu-4000.md").read_text()
    rows = table_of(tmp_path / "out", "performance-2560x1330-example-gpu-4000")
    ratios = [float(rows[s]["SW/HW (Example GPU 4000 (measured))"]) for s in ("Boxes", "Bunny", "Teapot", "Dragon")]
    assert ratios == pytest.approx([3.0] * 4, rel=0.01)
    assert "commit new" in text and "Cells of 1 other versions" in text


def test_times_that_were_not_measured_in_turn_have_no_ratio(tmp_path):
    write_performance(tmp_path, ["boxes", "teapot"])
    path = next((tmp_path / "cells").glob("boxes*blend*"))
    cell = json.loads(path.read_text())
    path.write_text(json.dumps(cell | {"group": "another run"}))
    make_paper([tmp_path], tmp_path / "out")
    rows = table_of(tmp_path / "out", "performance-2560x1330-example-gpu-4000")
    assert rows["Boxes"]["SW/HW (Example GPU 4000 (measured))"] == ""
    assert rows["Boxes"]["HW, µs (Example GPU 4000 (measured))"] != ""
    assert rows["Teapot"]["SW/HW (Example GPU 4000 (measured))"] != ""
    text = (tmp_path / "out/performance-2560x1330-example-gpu-4000.md").read_text()
    assert "No ratio for Boxes: both times are there, but were not measured in turn" in text


def test_small_sizes_stand_in_and_are_said(tmp_path):
    write_performance(tmp_path, ["boxes"], size=(320, 166), profile="cpu")
    make_paper([tmp_path], tmp_path / "out")
    text = (tmp_path / "out/performance-2560x1330-example-gpu-4000.md").read_text()
    assert "320×166, rgba16f, profile cpu" in text
    assert "The paper's figures are for 2560×1330 and whole scenes" in text
    assert "within 1.25 times" not in text, "counts of another size are not compared"


def test_the_published_size_is_preferred(tmp_path):
    write_performance(tmp_path, ["boxes"], factor=7.0, size=(320, 166))
    write_performance(tmp_path, ["boxes"], factor=3.0)
    write_performance(tmp_path, ["boxes"], factor=9.0, size=(4000, 2000))
    context, = gather([tmp_path]).contexts
    wants = {"sw": Want("lucid", {"repair": False}), "hw": Want("blend", {})}
    cells = find(context, "boxes", wants, SIZE, "sw", "performance")
    assert cells["sw"]["size"] == [2560, 1330]
    assert ratio(cells, "sw", "hw").ratio == pytest.approx(3.0, rel=0.01)
    assert find(context, "boxes", wants, (1, 1), "sw", "performance")["sw"]["size"] == [4000, 2000]


def test_cells_of_the_experiment_for_the_table_are_preferred(tmp_path):
    write_performance(tmp_path, ["boxes"], factor=7.0, size=(640, 333), experiment="memory")
    write_performance(tmp_path, ["boxes"], factor=3.0, size=(320, 166))
    context, = gather([tmp_path]).contexts
    wants = {"sw": Want("lucid", {"repair": False})}
    assert find(context, "boxes", wants, SIZE, "sw", "performance")["sw"]["size"] == [320, 166]
    assert find(context, "boxes", wants, SIZE, "sw", "memory")["sw"]["size"] == [640, 333]


def test_the_memory_table_takes_one_mode_of_depth_peeling(tmp_path):
    write_cell(tmp_path, lucid_cell("boxes", 1, size=SIZE, **SMALL), image=False)
    for mode, size in (("front_to_back", 2), ("dual", 5)):
        cell = make_cell("boxes", "depth_peeling", {"mode": mode, "layers": 0}, size=SIZE, **SMALL)
        write_cell(tmp_path, cell | {"memory_bytes": {"total": size << 20, "buffers": {}}}, image=False)
    make_paper([tmp_path], tmp_path / "out")
    row = table_of(tmp_path / "out", "memory-example-gpu-4000")["Boxes"]
    assert float(row["depth_peeling, MiB (Example GPU 4000 (measured))"]) == 2


def test_experiments_that_share_cells_may_be_packed_into_one_folder(tmp_path):
    """The cell is the same, and so is its id; it was measured in each."""
    for experiment, time, factor in (("performance", 2.0, 3), ("methods", 5.0, 4), ("memory", 7.0, 9)):
        for cell in (make_cell("boxes", "blend", {"order": "submission"}, time, 0.1, size=SIZE,
                               experiment=experiment, **SMALL),
                     lucid_cell("boxes", time, factor, 100, {"repair": False}, size=SIZE,
                                experiment=experiment, **SMALL)):
            write_cell(tmp_path / experiment, cell | {"group": experiment}, image=False)
        main(["pack", str(tmp_path / experiment), str(tmp_path / "data" / "gpu" / f"{experiment}.json.gz")])
    said = make_paper([tmp_path / "data"], tmp_path / "out")
    assert "left out" not in said and "of another file" not in said
    device = "Example GPU 4000 (measured)"
    boxes = table_of(tmp_path / "out", "performance-2560x1330-example-gpu-4000")["Boxes"]
    assert float(boxes[f"HW, µs ({device})"]) == pytest.approx(2000, rel=0.05), "of its own experiment"
    assert float(boxes[f"SW/HW ({device})"]) == pytest.approx(3, rel=0.01)
    with open(tmp_path / "out" / "methods-example-gpu-4000.csv", encoding="utf-8", newline="") as file:
        lucid = next(row for row in csv.DictReader(file) if row["algorithm"] == "LucidRaster")
    assert float(lucid[f"relative time ({device})"]) == pytest.approx(4, rel=0.01)


def test_packs_and_a_folder_of_folders_are_read_too(tmp_path):
    write_performance(tmp_path / "results", ["boxes"])
    main(["pack", str(tmp_path / "results"), str(tmp_path / "data" / "gpu" / "performance.json.gz")])
    make_paper([tmp_path / "data"], tmp_path / "out")
    assert table_of(tmp_path / "out", "performance-2560x1330-example-gpu-4000")["Boxes"][
        "SW, µs (Example GPU 4000 (measured))"] != ""
