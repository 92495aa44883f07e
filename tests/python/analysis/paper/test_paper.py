"""`oitlab paper`: published beside measured, gaps with the command that fills them, words by rules."""

import csv
import itertools
import json
import re
import shutil

import pytest
from oitlab_analysis.__main__ import main
from oitlab_analysis.paper import agreement, published
from oitlab_analysis.paper.make import make_paper
from oitlab_analysis.paper.measured import Want, find, gather, ratio
from oitlab_analysis.paper.paired_table import LATEX, Column, Number, Table, latex, latex_text, markdown, write_csv
from synthetic import (
    DEVICE,
    LAVAPIPE,
    LUCID_STAGES,
    PAPER_SCENES,
    lucid_cell,
    make_cell,
    with_slow_blocks,
    with_slow_stages,
    without_measurement,
    write_cell,
)

SIZE = (2560, 1330)
SMALL = {"blocks": 7, "frames": 1}


def write_performance(folder, scenes=tuple(PAPER_SCENES), factor=3.0, commit="abc1234", **changes):
    """blend, and lucid that takes `factor` times as long, 1.1 times that when it repairs."""
    provenance = make_cell()["provenance"] | {"commit": commit}
    changes = {"size": SIZE, "experiment": "performance", "provenance": provenance} | SMALL | changes
    for scene in scenes:
        time = PAPER_SCENES[scene]
        for cell in (make_cell(scene, "blend", {"order": "submission"}, time, 0.1, **changes),
                     lucid_cell(scene, time, factor, 100, {"repair": False}, **changes),
                     lucid_cell(scene, time, factor * 1.1, 100, **changes)):
            write_cell(folder, cell | {"id": f"{cell['id']}-{commit}"}, image=False)
    return folder


def table_of(out, name):
    with open(out / f"{name}.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {row[next(iter(row))]: row for row in rows}


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    folder = tmp_path_factory.mktemp("paper")
    write_performance(folder / "results")
    make_paper([folder / "results"], folder / "out")
    return folder / "out"


# -- published ----------------------------------------------------------------------------------------

@pytest.mark.parametrize("path", sorted(published.PUBLISHED.glob("*.csv")), ids=lambda p: p.stem)
def test_every_published_row_names_its_source(path):
    rows = published.read(path.stem)
    assert rows
    for row in rows:
        assert row["source"] and (row.get("table") or row.get("figure"))
        assert None not in row.values(), "as many fields as the head"


def test_published_performance_is_consistent_with_itself():
    rows = published.read("lucidraster_performance")
    assert len(rows) == 24
    for row in rows:
        sw, hw = float(row["sw_us"]), float(row["hw_us"])
        assert sw / hw == pytest.approx(float(row["sw_hw"]), abs=0.006)
        stages = [row[f"{stage}_us"] for stage in ("setup", "binning", "low_raster", "high_raster")]
        if all(stages):  # the rest is between the stages: about 20 us in one table, 6 in the other
            assert 4 < sw - sum(map(float, stages)) < 22
    # "The score for LucidRaster is an average ... for all scenes and all tested GPUs": 3.30.
    assert sum(float(row["sw_hw"]) for row in rows) / 24 == pytest.approx(3.30, abs=0.01)


def test_published_error_rates_are_consistent_with_themselves():
    shares = {3: [], 8: [], 12: []}
    for row in published.read("lucidraster_depth_filter"):
        for n in shares:
            share = 100 * float(row[f"invalid_df{n}"]) / (2560 * 1330)
            shares[n].append(share)
            printed = row[f"percent_df{n}"]
            assert share < 0.01 if printed in ("", "<0.01") else share == pytest.approx(float(printed), abs=0.0051)
    averages = [round(sum(values) / 12, 2) for values in shares.values()]
    assert averages == [0.17, 0.02, 0.01], "as printed under the table"


def test_published_tables_of_bma_are_consistent_with_themselves():
    for row in published.read("bma_table2"):
        assert float(row["oit_ms"]) / float(row["bma_oit_ms"]) == pytest.approx(float(row["speedup"]), abs=0.01)


def test_every_published_scene_has_a_stand_in():
    for name in ("lucidraster_performance", "lucidraster_scenes", "lucidraster_depth_filter",
                 "lucidraster_alpha_threshold", "bma_table1", "bma_table2"):
        assert {row["scene"] for row in published.read(name)} <= published.STAND_INS.keys()


# -- the tables ---------------------------------------------------------------------------------------

def test_published_and_measured_stand_side_by_side(out):
    rows = table_of(out, "performance-2560x1330-example-gpu-4000")
    assert len(rows) == 12 + 1
    boxes = rows["Boxes"]
    assert boxes["SW/HW (GTX 3050 TI)"] == "4.26"
    assert float(boxes["SW/HW (Example GPU 4000 (measured))"]) == pytest.approx(3.0, rel=0.01)
    assert float(boxes["SW/HW, repaired (Example GPU 4000 (measured))"]) == pytest.approx(3.3, rel=0.01)
    assert float(boxes["HW, µs (Example GPU 4000 (measured))"]) == pytest.approx(400, rel=0.05)
    assert float(boxes["S/HB (Example GPU 4000 (measured))"]) == pytest.approx(9, rel=0.01)
    assert float(rows["mean"]["SW/HW (GTX 3050 TI)"]) == pytest.approx(3.32, abs=0.01), "as printed"
    text = (out / "performance-2560x1330-example-gpu-4000.md").read_text(encoding="utf-8")
    assert "GTX 3050 TI" in text and "Example GPU 4000" in text and "commit abc1234" in text
    assert "| 12.11 |" in text and "| 24 |" in text, "published figures stay as printed"


def test_every_table_exists_in_three_formats_and_main_tex_includes_it(out):
    tables = {p.stem for p in out.glob("*.csv")}
    wanted = {"methods", "scenes", "performance-2560x1330", "performance-1920x1031", "alpha-threshold",
              "depth-filter", "memory", "bma-table1", "bma-table2"}
    assert tables == {f"{name}-example-gpu-4000" for name in wanted}
    included = re.findall(r"\\input\{\\generated/([^}]*)\}", (out / "all.tex").read_text())
    assert set(included) == tables
    whole = (out / "paper.md").read_text(encoding="utf-8")
    for name in tables:
        tex = (out / f"{name}.tex").read_text(encoding="utf-8")
        assert tex.count("{") == tex.count("}") and r"\toprule" in tex and r"\bottomrule" in tex
        assert (out / f"{name}.md").read_text(encoding="utf-8") in whole


def test_every_markdown_table_is_regular(out):
    for path in out.glob("*-gpu-4000.md"):
        lines = [x for x in path.read_text(encoding="utf-8").splitlines() if x.startswith("|")]
        assert len({len(re.findall(r"(?<!\\)\|", line)) for line in lines}) == 1, path


def test_a_gap_is_shown_with_the_command_that_fills_it(tmp_path):
    write_performance(tmp_path / "results", [s for s in PAPER_SCENES if s != "teapot"])
    said = make_paper([tmp_path / "results"], tmp_path / "out")
    rows = table_of(tmp_path / "out", "performance-2560x1330-example-gpu-4000")
    assert rows["Teapot"]["SW, µs (GTX 3050 TI)"] == "373.0"
    assert rows["Teapot"]["SW, µs (Example GPU 4000 (measured))"] == ""
    text = (tmp_path / "out" / "performance-2560x1330-example-gpu-4000.md").read_text()
    assert "Not measured: Teapot. Run: oitlab run experiments/performance.toml\n" in text
    assert "not measured: Teapot; run: oitlab run experiments/performance.toml" in said
    assert "bma-table2-example-gpu-4000: not measured: any row; run: oitlab run experiments/bma.toml" in said


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


def test_the_depth_filter_table(tmp_path):
    group = [lucid_cell("hairball", 3.5, 3.3 * f, n, {"depth_filter": size, "repair": False}, size=SIZE,
                        experiment="depth_filter", **SMALL)
             for size, n, f in ((3, 34048, 1), (8, 3405, 1.03), (12, 0, 1.1))]
    for cell in group:
        write_cell(tmp_path, cell, image=False)
    make_paper([tmp_path], tmp_path / "out")
    row = table_of(tmp_path / "out", "depth-filter-example-gpu-4000")["Hairball"]
    measured = {k: v for k, v in row.items() if "measured" in k and v}
    assert float(measured["invalid, DF=3 (Example GPU 4000 (measured))"]) == 34048
    assert float(measured["%, DF=3 (Example GPU 4000 (measured))"]) == pytest.approx(1.0, rel=1e-3)
    assert float(measured["time, % of DF=3, DF=12 (Example GPU 4000 (measured))"]) == pytest.approx(110, rel=0.01)
    text = (tmp_path / "out/depth-filter-example-gpu-4000.md").read_text()
    assert "fall or stay as the filter grows in 1 of 1 scenes" in text
    assert (tmp_path / "out" / "depth-filter-curve-example-gpu-4000.pdf").is_file()


def test_the_alpha_threshold_table_takes_the_opacity(tmp_path):
    for opacity, gain in ((0.5, 1.25), (0.800000011920929, 2.0)):
        cells = [make_cell("boxes", "blend", {"order": "submission"}, 0.4, 0.1, SIZE, **SMALL),
                 lucid_cell("boxes", 0.4, 4, 0, {"repair": False}, size=SIZE, **SMALL),
                 lucid_cell("boxes", 0.4, 4 / gain, 0, {"repair": False, "alpha_threshold": 0.9921875},
                            size=SIZE, **SMALL)]
        for cell in cells:
            cell["scene"]["opacity"] = opacity
            write_cell(tmp_path, cell | {"id": f"{cell['id']}-{opacity}", "group": str(opacity)}, image=False)
    make_paper([tmp_path], tmp_path / "out")
    rows = table_of(tmp_path / "out", "alpha-threshold-example-gpu-4000")
    key = "speed-up (Example GPU 4000 (measured))"
    assert [float(rows[f"Boxes {o}"][key]) for o in ("0.5", "0.8")] == pytest.approx([1.25, 2.0], rel=0.01)


def test_a_device_note_marks_the_ratios_to_blend(tmp_path):
    write_performance(tmp_path, ["boxes"], device=DEVICE | {"name": "NVIDIA H200"})
    make_paper([tmp_path], tmp_path / "out")
    text = (tmp_path / "out" / "performance-2560x1330-h200.md").read_text()
    assert "SW/HW ‡, H200 (measured)" in text and "2 of its 66 TPCs" in text
    assert "HW, µs, H200 (measured)" in text


def test_the_note_stands_beside_every_ratio_to_blend_in_every_format(tmp_path):
    h200 = DEVICE | {"name": "NVIDIA H200"}
    for scene in ("boxes", "teapot"):
        write_performance(tmp_path, [scene], device=h200)
        write_performance(tmp_path, [scene], device=h200, experiment="methods", format="rgba16f")
        for opacity in (0.5, 0.800000011920929):
            cells = [make_cell(scene, "blend", {"order": "submission"}, 2, 0.1, **SMALL)]
            cells += [lucid_cell(scene, 1, 3, 0, {"repair": False, "alpha_threshold": t}, **SMALL)
                      for t in (0, 1 - 1 / 128)]
            for cell in cells:
                cell |= {"size": list(SIZE), "experiment": "alpha_threshold", "device": h200,
                         "group": f"{scene}{opacity}", "id": f"alpha-{cell['id']}-{opacity}"}
                cell["scene"] = cell["scene"] | {"opacity": opacity}
                write_cell(tmp_path, cell, image=False)
    make_paper([tmp_path], tmp_path / "out")
    ratios = {"performance-2560x1330": ["SW/HW", "SW/HW, repaired"],
              "alpha-threshold": ["SW/HW off", "SW/HW on"], "methods": ["relative time"]}
    for table, names in ratios.items():
        path = tmp_path / "out" / f"{table}-h200"
        csv_head, text, tex = (path.with_suffix(s).read_text(encoding="utf-8") for s in (".csv", ".md", ".tex"))
        assert "2 of its 66 TPCs" in text and "2 of its 66 TPCs" in tex, table
        for name in names:
            assert f"{name} ‡ (H200 (measured))" in csv_head.splitlines()[0]
            assert f"| {name} ‡, H200 (measured) |" in text
            assert re.search(rf"[{{ ]{re.escape(name)} \\ddag{{}}", tex), (table, name)
    for unmarked in ("depth-filter", "scenes", "memory"):
        assert "‡" not in (tmp_path / "out" / f"{unmarked}-h200.md").read_text(encoding="utf-8"), "no ratio to blend"


# -- times of a lower clock -----------------------------------------------------------------------------

def change_cells(folder, pattern, change):
    paths = sorted((folder / "cells").glob(pattern))
    assert paths
    for path in paths:
        path.write_text(json.dumps(change(json.loads(path.read_text()))))


def unrepaired_only(change):
    return lambda cell: change(cell) if cell["parameters"].get("repair") is False else cell


def test_blocks_and_sort_are_measured_only_and_count_as_raster(out):
    rows = table_of(out, "performance-2560x1330-example-gpu-4000")
    heads = [head for head in rows["Boxes"] if head.startswith(("blocks", "sort"))]
    assert heads == ["blocks, µs (Example GPU 4000 (measured))", "sort, µs (Example GPU 4000 (measured))"]
    for stage in ("blocks", "sort"):
        wanted = 1000 * 3 * PAPER_SCENES["boxes"] * LUCID_STAGES[stage]
        assert float(rows["Boxes"][f"{stage}, µs (Example GPU 4000 (measured))"]) == pytest.approx(wanted)
    text = (out / "performance-2560x1330-example-gpu-4000.md").read_text(encoding="utf-8")
    assert "compare its low + high with blocks + sort + low + high" in text
    # 0.78 of 0.97; without blocks and sort it would be 72 %.
    assert "the dearest is the same in 12 of 12 scenes; raster takes 80 % of the three here" in text


def test_stage_times_of_a_lower_clock_are_left_out(tmp_path):
    write_performance(tmp_path, ["boxes", "bunny", "teapot"])
    change_cells(tmp_path, "boxes*lucid*", unrepaired_only(with_slow_stages))
    change_cells(tmp_path, "teapot*blend*", with_slow_stages)  # none of its stages are printed
    make_paper([tmp_path], tmp_path / "out")
    device = "(Example GPU 4000 (measured))"
    name = "performance-2560x1330-example-gpu-4000"
    rows = table_of(tmp_path / "out", name)
    for stage in ("setup", "binning", "blocks", "sort", "low", "high"):
        assert rows["Boxes"][f"{stage}, µs {device}"] == ""
        assert float(rows["Bunny"][f"{stage}, µs {device}"]) > 0
    assert rows["Boxes"][f"SW, µs {device}"] != "", "its frames are as good as any"
    text, tex = ((tmp_path / "out" / f"{name}{s}").read_text(encoding="utf-8") for s in (".md", ".tex"))
    assert "† Stage times of 1 of 3 cells were left out" in text and "lower clock" in text
    assert next(x for x in text.splitlines() if x.startswith("| Boxes")).count("†") == 6
    assert r"\dag{} Stage times of 1 of 3" in tex
    assert "the same in 2 of 2 scenes" in text
    assert "median frame of" not in text


def test_frames_of_a_lower_clock_are_marked_and_stay_out_of_words_on_times(tmp_path):
    write_performance(tmp_path, ["boxes", "bunny", "teapot", "dragon"])
    change_cells(tmp_path, "boxes*lucid*", unrepaired_only(lambda cell: with_slow_blocks(cell, 4)))
    change_cells(tmp_path, "bunny*lucid*", unrepaired_only(lambda cell: with_slow_blocks(cell, 2)))
    make_paper([tmp_path], tmp_path / "out")
    text = (tmp_path / "out/performance-2560x1330-example-gpu-4000.md").read_text(encoding="utf-8")
    marked = {line.split(" | ")[0]: line.count("†") for line in text.splitlines() if line.startswith("| ")}
    assert marked["| Boxes"] == 1 and marked["| Bunny"] == 0, "two slow blocks of seven leave the median be"
    assert "† The median frame of 1 of 12 cells" in text
    assert re.search(r"\nSW: .* of 3 pairs agree", text), "of four rows one has no time to speak of"


def test_stages_of_a_lower_clock_have_no_part_in_table_1_of_bma(tmp_path):
    choices = {"sort": "auto", "mask": "stencil", "deep": "exact", "on_overflow": "grow", "node_color": "rgba32f",
               "local": "keys", "max_fragments": 512}
    for scene, slow in (("powerplant", 1), ("smoke", 3)):
        for memory, ms in (("max_by_interval", 3.0), ("bma", 1.5)):
            cell = make_cell(scene, "abuffer", choices | {"sort_memory": memory}, 10, experiment="bma", **SMALL)
            cell["gpu_ms"]["stages"] = {"sort 8": ms, "sort 16": ms, "build": 3}
            cell["counters"] |= {"pixels_8": 9, "pixels_16": 9, "pixels_512": 0}
            write_cell(tmp_path, with_slow_stages(cell, slow if memory == "bma" else 1), image=False)
    make_paper([tmp_path], tmp_path / "out")
    key = "speed-up (Example GPU 4000 (measured))"
    rows = table_of(tmp_path / "out", "bma-table1-example-gpu-4000")
    assert float(rows["Power Plant, 8"][key]) == pytest.approx(2) and rows["Smoke, 8"][key] == ""
    text = (tmp_path / "out/bma-table1-example-gpu-4000.md").read_text(encoding="utf-8")
    assert "† Stage times of 1 of 4 cells were left out" in text
    assert "No pixel of the stand-in has so many fragments: Power Plant, 512." in text
    assert "Smoke, 8" in re.search("Not measured: (.*) Run", text)[1]
    # Of 17 rows two are measured and one cannot be: no run fills that gap.
    assert "; and 8 more. Run: oitlab run experiments/bma.toml" in text


# -- what a table takes -----------------------------------------------------------------------------------

def test_hardware_blending_relative_to_itself_agrees_with_nothing(tmp_path):
    write_performance(tmp_path, ["boxes"], experiment="methods")
    make_paper([tmp_path], tmp_path / "out")
    text = (tmp_path / "out/methods-example-gpu-4000.md").read_text(encoding="utf-8")
    assert "Relative time: within 1.25 times the published figure in 1 of 1 rows." in text


def test_the_memory_table_takes_one_mode_of_depth_peeling(tmp_path):
    write_cell(tmp_path, lucid_cell("boxes", 1, size=SIZE, **SMALL), image=False)
    for mode, size in (("front_to_back", 2), ("dual", 5)):
        cell = make_cell("boxes", "depth_peeling", {"mode": mode, "layers": 0}, size=SIZE, **SMALL)
        write_cell(tmp_path, cell | {"memory_bytes": {"total": size << 20, "buffers": {}}}, image=False)
    make_paper([tmp_path], tmp_path / "out")
    row = table_of(tmp_path / "out", "memory-example-gpu-4000")["Boxes"]
    assert float(row["depth_peeling, MiB (Example GPU 4000 (measured))"]) == 2


def test_the_depth_filter_table_names_rows_with_gaps(tmp_path):
    write_performance(tmp_path, ["boxes"])  # with a filter of 3 only
    make_paper([tmp_path], tmp_path / "out")
    text = (tmp_path / "out/depth-filter-example-gpu-4000.md").read_text(encoding="utf-8")
    assert "Not measured: Boxes; " in text and "Run: oitlab run experiments/depth\\_filter.toml" in text
    assert "| Boxes | 3 | 100 | 0 | – |" in text, "counts are whole numbers"


# -- words --------------------------------------------------------------------------------------------

def pairs(published_values, measured_values):
    return dict(zip("abcdefghij", zip(published_values, measured_values)))


def test_order_counts_pairs():
    assert "the same order of rows (3 of 3 pairs agree, Kendall's τ = 1.00)" in agreement.order(
        "x", pairs((1, 2, 3), (10, 20, 30)))
    assert "the opposite order of rows (0 of 3" in agreement.order("x", pairs((1, 2, 3), (3, 2, 1)))
    # One swap of neighbours among five: 9 of 10 pairs.
    assert "the same order of rows (9 of 10 pairs agree, Kendall's τ = 0.80)" in agreement.order(
        "x", pairs((1, 2, 3, 4, 5), (1, 2, 3, 5, 4)))
    assert "mostly the same order" in agreement.order("x", pairs((1, 2, 3, 4, 5), (1, 2, 4, 5, 3)))
    assert agreement.order("x", pairs((1, 2, 3), (1, None, 3))) == "", "two rows have no order to speak of"


def test_factor_names_what_is_furthest_off():
    assert agreement.factor("x", pairs((100, 100), (125, 80))) == (
        "x: within 1.25 times the published figure in 2 of 2 rows.")
    text = agreement.factor("x", pairs((100, 100, 0, 0), (126, 300, 0, None)))
    assert "in 1 of 3 rows; furthest off: b, 300 measured, 100 published" in text
    assert "furthest off: b, 5.00 measured, 0 published" in agreement.factor("x", pairs((100, 0), (300, 5)))
    assert "in 1 of 2 rows; furthest off: b, 79.0 measured" in agreement.factor("x", pairs((100, 100), (80, 79)))
    assert agreement.factor("x", pairs((1,), (None,))) == ""


# -- writing ------------------------------------------------------------------------------------------

def test_texts_are_escaped_in_each_format(tmp_path):
    table = Table("t", "50% of a_b & $c", "x|y", [Column("n", "a|b"), Column("v", "µs", "GPU_1")],
                  [{"n": "a_b|c", "v": Number(1.5, 1.4, 1.6)}, {"n": "gap", "v": None}], "here <b>")
    text = markdown(table)
    assert "a\\_b\\|c" in text and "&lt;b>" in text and "| gap | – |" in text
    tex = latex(table)
    assert r"50\% of a\_b \& \$c" in tex and r"GPU\_1" in tex and "µ" not in tex
    write_csv(table, tmp_path / "t.csv")
    with open(tmp_path / "t.csv", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[1] == ["a_b|c", "1.5", "1.4", "1.6"] and rows[2] == ["gap", "", "", ""]
    assert latex_text("".join(LATEX)).isascii()


def test_all_texts_for_latex_are_ascii(out):
    for path in itertools.chain(out.glob("*.tex")):
        assert path.read_text(encoding="utf-8").isascii(), path


@pytest.mark.skipif(not shutil.which("latexmk") or not shutil.which("pdflatex"), reason="no LaTeX here")
def test_the_pdf_is_built(out):
    assert (out / "main.pdf").stat().st_size > 10_000


# -- wrong input --------------------------------------------------------------------------------------

def test_wrong_input_is_one_line(tmp_path, capsys):
    (tmp_path / "empty").mkdir()
    (tmp_path / "bad" / "cells").mkdir(parents=True)
    (tmp_path / "bad" / "cells" / "x.json").write_text('{"schema": 1')
    for name in ("missing", "empty", "bad"):
        assert main(["paper", str(tmp_path / name), "--out", str(tmp_path / "out")]) == 2
        said = capsys.readouterr().err
        assert said.count("\n") == 1 and "Traceback" not in said
    assert not (tmp_path / "out").exists()


def test_what_cannot_be_read_is_named_and_the_rest_goes_on(tmp_path):
    write_performance(tmp_path / "good", ["boxes"])
    (tmp_path / "good" / "cells" / "half.json").write_text("{")
    (tmp_path / "gone" / "cells").mkdir(parents=True)
    said = " ".join(make_paper([tmp_path / "good", tmp_path / "gone", tmp_path / "good"], tmp_path / "out").split())
    assert "half.json: half-written" in said and "gone/cells is empty" in said
    assert "3 cells were given twice, and count once" in said
    assert "half.json" in (tmp_path / "out" / "paper.md").read_text()


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
