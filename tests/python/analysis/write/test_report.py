"""`oitlab report`: its text, its files and its exit codes, from folders and packs."""

import csv
import json
import re
import subprocess

import pytest
from oitlab_analysis.compare.tidy import as_table
from oitlab_analysis.read.cells import collect
from oitlab_analysis.write.report import make_report
from program import ROOT
from reports import embedded_pictures, run
from synthetic import make_cell, make_results, without_measurement, write_cell

pytestmark = pytest.mark.usefixtures("without_charts")


def test_command_prints_the_table_and_then_the_paths(results):
    done = run("report", results)
    lines = done.stdout.splitlines()
    assert done.returncode == 1, "one cell failed"
    assert done.stderr == ""
    assert lines[-3:] == [f"{results}/report.html", f"{results}/report.md", f"{results}/cells.csv"]
    assert max(map(len, lines)) <= 100
    assert "10 cells: 8 measured, 1 failed, 1 skipped." in lines
    assert lines[:2] == ["quickstart on Example GPU 4000", f"{results}/plots/quality-speed-1.png"]
    assert any(line.startswith("adaptive") and "failed: device lost" in line for line in lines)


def test_command_succeeds_where_nothing_failed(tmp_path):
    make_results(tmp_path, methods=1, scenes=1)
    write_cell(tmp_path, without_measurement(make_cell(method="x"), "skipped", "no interlock"))
    assert run("report", tmp_path).returncode == 0


@pytest.mark.parametrize("prepare", [lambda f: f / "missing", lambda f: f, lambda f: f / "file"])
def test_bad_input_is_one_line_and_exit_code_2(tmp_path, prepare):
    (tmp_path / "file").write_text("x")
    done = run("report", prepare(tmp_path))
    assert (done.returncode, done.stdout) == (2, "")
    assert len(done.stderr.splitlines()) == 1 and "oitlab run" in done.stderr


def test_a_results_folder_that_cannot_be_written_is_one_line(tmp_path):
    make_results(tmp_path, methods=1, scenes=1)
    (tmp_path / "report.html").mkdir()
    done = run("report", tmp_path)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1 and "report.html" in done.stderr


def test_help_says_what_is_written_and_the_exit_codes():
    done = run("report", "--help")
    assert done.returncode == 0
    for word in ("report.html", "cells.csv", "exit codes", "RESULTS", "--out"):
        assert word in done.stdout


def test_markdown_table_is_regular_and_its_links_lead_somewhere(results):
    markdown = (results / "report.md").read_text(encoding="utf-8")
    table = [line for line in markdown.splitlines() if line.startswith("|")]
    assert len(table) == 2 + 10
    assert {len(re.findall(r"(?<!\\)\|", line)) for line in table} == {18}
    links = re.findall(r"!\[[^\]]*\]\(([^)]*)\)", markdown)
    assert len(links) == 8 + 5
    assert all((results / link).is_file() for link in links)
    assert "device lost" in markdown and "needs fragment interlock" in markdown
    assert "oitlab run experiments/quickstart.toml" in markdown


def test_csv_has_one_row_per_cell_and_the_comparison(results):
    with open(results / "cells.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 10 and len({row["id"] for row in rows}) == 10
    lucid = next(row for row in rows if row["method"] == "lucid" and row["scene"] == "boxes")
    assert float(lucid["ratio"]) == pytest.approx(1.7, rel=0.01)
    assert float(lucid["ratio.low"]) < float(lucid["ratio"]) < float(lucid["ratio.high"])
    assert lucid["baseline"].startswith("boxes-default-64x36-blend")
    assert {"frame_ms.median", "stage.capture_ms", "param.tile", "memory.colour"} <= rows[0].keys()


def test_names_are_defused_in_csv(tmp_path):
    """Spreadsheets take a text that begins with = + - @ for a formula."""
    for number, name in enumerate(("=1+1", "+1", "-1", "@x", "plain")):
        write_cell(tmp_path, make_cell(scene=f"s{number}", method=name))
    make_report([tmp_path])
    with open(tmp_path / "cells.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["method"] for row in rows] == ["'=1+1", "'+1", "'-1", "'@x", "plain"]
    assert not [text for row in rows for text in row.values() if text.startswith(("=", "+", "@"))]


def test_report_is_the_same_for_the_same_cells(results):
    first = (results / "report.html").read_bytes()
    run("report", results)
    assert first == (results / "report.html").read_bytes()


def test_packs_and_several_folders(tmp_path):
    """Two experiments share a cell's id; both count. Nothing is written unless asked."""
    for experiment in ("one", "two"):
        make_results(tmp_path / experiment, 2, 1, experiment=experiment)
        for path in (tmp_path / experiment / "cells").iterdir():
            cell = json.loads(path.read_text())
            path.write_text(json.dumps(cell | {"id": f"boxes-{cell['method']}"}))
        assert run("pack", tmp_path / experiment, tmp_path / "data" / f"{experiment}.json.gz").returncode == 0
    before = sorted((tmp_path / "data").iterdir())
    for given in ([tmp_path / "data"], [tmp_path / "one", tmp_path / "two"], before):
        result = make_report(given)
        assert "4 cells: 4 measured" in result.text and "left out" not in result.text
        assert result.files == [] and "Nothing was written: --out" in result.text
    assert "2 cells: 2 measured" in make_report(before[:1]).text
    assert sorted((tmp_path / "data").iterdir()) == before
    assert not (tmp_path / "one" / "report.html").exists()
    result = make_report([tmp_path / "one", tmp_path / "two"], tmp_path / "out")
    assert len(embedded_pictures((tmp_path / "out" / "report.html").read_text(encoding="utf-8"))) == 3
    markdown = (tmp_path / "out" / "report.md").read_text(encoding="utf-8")
    links = [link for link in re.findall(r"!\[[^\]]*\]\(([^)]*)\)", markdown) if "plots/" not in link]
    assert len(links) == 4 and all((tmp_path / "out" / link).is_file() for link in links)
    packed = make_report([tmp_path / "data"], tmp_path / "packed")
    assert len(packed.files) == 3 and "a pack holds no images" in packed.files[0].read_text(encoding="utf-8")


def test_two_versions_of_a_cell_in_two_folders_are_both_shown(tmp_path):
    for commit in ("abc1234", "def5678"):
        provenance = make_cell()["provenance"] | {"commit": commit}
        write_cell(tmp_path / commit, make_cell(provenance=provenance))
    text = make_report([tmp_path / "abc1234", tmp_path / "def5678"]).text
    assert "2 cells: 2 measured" in text and "2 commits" in text
    again = make_report([tmp_path / "abc1234", tmp_path / "abc1234"]).text
    assert "1 cell was given twice" in again and "1 cell: 1 measured" in again


def test_nothing_is_written_into_a_folder_that_git_tracks(tmp_path):
    make_results(tmp_path, 1, 1)
    for command in (["git", "init", "-q"], ["git", "add", "cells"]):
        subprocess.run(command, cwd=tmp_path, check=True)
    assert make_report([tmp_path]).files == []
    assert sorted(p.name for p in tmp_path.iterdir()) == [".git", "cells", "images"]


def test_a_chart_of_ones_own_is_drawn_and_named(tmp_path):
    for layers in (1, 2, 4):
        write_cell(tmp_path, make_cell(method="depth_peeling", parameters={"layers": layers}, rmse=0.1 / layers))
    done = run("report", tmp_path, "--x", "layers", "--y", "rmse", "--per", "scene")
    chart = tmp_path / "plots" / "curve-rmse-over-layers-per-scene-1.png"
    assert done.returncode == 0 and chart.is_file() and str(chart) in done.stdout.splitlines()
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.index("curve-rmse-over-layers") < page.index("frame-times-1.png")
    wrong = run("report", tmp_path, "--x", "layer")
    assert wrong.returncode == 2 and "did you mean layers" in wrong.stderr and wrong.stderr.count("\n") == 1


@pytest.mark.skipif(not (ROOT / "paper/data/h200").is_dir(), reason="no published cells")
def test_every_published_cell_is_in_the_report():
    collection = collect(ROOT / "paper/data/h200")
    assert len(as_table(collection.cells)) == 1023 and collection.problems == [] and collection.repeated == 0
