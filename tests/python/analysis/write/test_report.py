"""The report from end to end, on synthetic results."""

import base64
import csv
import hashlib
import html
import io
import json
import os
import re
import subprocess
import sys
from html.parser import HTMLParser

import numpy
import pytest
from oitlab_analysis.compare.tidy import as_table
from oitlab_analysis.read.cells import collect
from oitlab_analysis.write.images import smaller
from oitlab_analysis.write.report import make_report
from PIL import Image
from program import ROOT
from synthetic import DEVICE, LAVAPIPE, make_cell, make_results, without_measurement, write_cell, write_image


def run(*arguments):
    """The command as the C++ program runs it."""
    environment = os.environ | {"PYTHONPATH": str(ROOT / "analysis")}
    return subprocess.run([sys.executable, "-m", "oitlab_analysis", *map(str, arguments)],
                          env=environment, capture_output=True, text=True, timeout=120)


def html_of(folder):
    make_report([folder])
    return (folder / "report.html").read_text(encoding="utf-8")


def embedded_pictures(html):
    data = re.search(r'<script type="application/json" id="picture-data">(.*?)</script>', html, re.S)
    return json.loads(data[1])


class Page(HTMLParser):
    """What a test needs of a page: its resources, its tables and whether its tags match."""

    VOID = frozenset({"meta", "img", "br", "link", "input"})

    def __init__(self, text):
        super().__init__()
        self.open, self.sources, self.links, self.text = [], [], [], text
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.sources += [attributes[key] for key in ("src", "srcset") if key in attributes]
        self.links += [attributes["href"]] if "href" in attributes else []
        assert tag != "img" or attributes["alt"]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def tables(self):
        """The rows of each section's table."""
        found = re.findall(r'<script type="application/json" class="rows">(.*?)</script>', self.text, re.S)
        return [json.loads(text) for text in found]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Four methods on two scenes; one cell failed, one was skipped."""
    folder = make_results(tmp_path_factory.mktemp("results"), methods=4, scenes=2)
    for method, status, reason in (("adaptive|2", "failed", "device lost after 3 | frames <b>"),
                                   ("interlock", "skipped", "needs fragment interlock")):
        write_cell(folder, without_measurement(make_cell("boxes", method), status, reason))
    make_report([folder])
    return folder


@pytest.fixture(autouse=True)
def without_charts(monkeypatch):
    """Charts take most of the time of a report; `results` and `run` make them all the same."""
    monkeypatch.setattr("oitlab_analysis.write.report.save_charts", lambda sections, *_: ([[]] * len(sections), 0))


@pytest.fixture
def page(results):
    return Page((results / "report.html").read_text(encoding="utf-8"))


def test_command_prints_the_table_and_then_the_paths(results):
    done = run("report", results)
    lines = done.stdout.splitlines()
    assert done.returncode == 1, "one cell failed"
    assert done.stderr == ""
    assert lines[-3:] == [f"{results}/report.html", f"{results}/report.md", f"{results}/cells.csv"]
    assert max(map(len, lines)) <= 100
    assert "10 cells: 8 measured, 1 failed, 1 skipped." in lines
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


def test_page_is_self_contained_and_well_formed(results, page):
    assert len(re.findall(r'<figure class="chart lead">\s*<svg ', page.text)) == 1
    assert len(page.sources) == 4  # the other charts: per scene, times, stages, memory
    assert all(source.startswith("data:image/svg+xml") for source in page.sources)
    pictures = embedded_pictures(page.text)
    # Those of the two exact methods are the same, bit for bit, in each of the two scenes.
    assert len(pictures) == 2 * 3
    assert all(p["uri"].startswith("data:image/png") and p["scale"] == 1 for p in pictures.values())
    assert not [link for link in page.links if ":" in link]
    for link in page.links:
        assert link.startswith("#") or (results / link).is_file()


def test_the_policy_allows_the_scripts_of_the_page_and_no_others(page):
    policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', page.text)[1]
    policy = html.unescape(policy)
    assert policy.startswith("default-src 'none'; ") and "http" not in policy
    script_src, = [part for part in policy.split("; ") if part.startswith("script-src")]
    scripts = re.findall(r"<script>(.*?)</script>", page.text, re.S)
    hashes = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in scripts]
    assert script_src.split()[1:] == [f"'sha256-{digest}'" for digest in hashes] and len(hashes) == 2


def test_the_pointer_over_a_point_shows_its_variant(page):
    chart = page.text[page.text.index("<svg "):page.text.index("</svg>")]
    assert re.search(r'<g id="chart1-hint[0-9]+"><title>lucid: 1.70, RMSE 0</title>', chart)


def test_the_first_screen_has_title_plot_and_table_in_this_order(page):
    marks = [page.text.index(mark) for mark in ("<h1>", "<svg ", 'class="table"', 'class="viewer"', "<img ")]
    assert marks == sorted(marks)


def test_warnings_are_one_line_with_their_count(tmp_path):
    make_results(tmp_path, 2, 1, device=LAVAPIPE)
    for number in range(70):
        (tmp_path / "cells" / f"half{number}.json").write_text("{")
    text = html_of(tmp_path)
    summary, = re.findall(r'<details class="warnings"><summary>(.*?)</summary>', text)
    assert "<strong>2 warnings</strong>" in summary and "70 files were left out" in summary
    assert "CPU device: these times say nothing about GPUs." in text


def test_page_table_holds_the_figures_of_the_cells(results, page):
    table, = page.tables()
    rows = {(row["scene"], row["label"]): row for row in table["rows"]}
    assert len(rows) == 10
    for path in (results / "cells").glob("*.json"):
        cell = json.loads(path.read_text())
        row = rows[cell["scene"]["name"], cell["method"]]
        if cell["status"] != "ok":
            assert row["frame"] == f"{cell['status']}: {cell['reason']}"
            continue
        shown = [float(x) for x in re.findall(r"[\d.]+", row["frame"])]
        frame = cell["statistics"]["frame"]
        assert shown == pytest.approx([frame["median"], *frame["ci95"]], rel=0.006)
        assert row["sort"]["frame"] == frame["median"]
        equal = cell["quality"]["psnr"] is None
        assert row["psnr"] == "∞ (equal)" if equal else float(row["psnr"]) > 20
        assert float(row["memory"]) == pytest.approx(cell["memory_bytes"]["total"] / 2**20, rel=0.006)
        # The generator makes every method a known multiple of blend.
        factor = {"blend": 1, "reference": 3.1, "wboit": 1.003, "lucid": 1.7}[cell["method"]]
        assert float(row["ratio"].split()[0]) == pytest.approx(factor, rel=0.01)
        assert row["verdict"] == {"blend": "baseline", "wboit": "same"}.get(cell["method"], "slower")
        assert all(f"{name}=" in row["hints"]["label"] for name in cell["parameters"])


def test_text_from_cells_is_escaped(results):
    text = (results / "report.html").read_text(encoding="utf-8")
    assert "3 | frames &lt;b&gt;" in text and "3 | frames \\u003cb>" in text and "<b>" not in text
    markdown = (results / "report.md").read_text(encoding="utf-8")
    assert "3 \\| frames &lt;b>" in markdown


def test_markdown_table_is_regular_and_its_links_lead_somewhere(results):
    markdown = (results / "report.md").read_text(encoding="utf-8")
    table = [line for line in markdown.splitlines() if line.startswith("|")]
    assert len(table) == 2 + 10
    assert {len(re.findall(r"(?<!\\)\|", line)) for line in table} == {17}
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


def test_report_is_the_same_for_the_same_cells(results):
    first = (results / "report.html").read_bytes()
    run("report", results)
    assert first == (results / "report.html").read_bytes()


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
    result = make_report([tmp_path])
    text = result.text
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


@pytest.mark.parametrize(
    "changes, warning",
    [
        ({"provenance": {"build": "Debug"}}, "Debug build"),
        ({"provenance": {"build": "Release"}}, None),
        ({"provenance": {"validation": True}}, "Validation layers were on"),
        ({"device": {"type": "cpu"}}, "CPU device"),
        ({"stop": {"reason": "time_limit"}}, "1 of 1 cells stopped at a limit"),
        ({"stop": {"rejected_samples": 4}}, "4 frame times were rejected"),
        ({"statistics": {"frame": make_cell()["statistics"]["frame"] | {"p95": 0.1}}},
         "contradicts its own samples"),
    ],
)
def test_warnings(tmp_path, changes, warning):
    cell = make_cell()
    for key, change in changes.items():
        cell[key] = cell[key] | change
    write_cell(tmp_path, cell)
    result = make_report([tmp_path])
    flat = " ".join(result.text.split())
    assert (warning in flat) if warning else ("warning" not in flat)
    assert ("†" in flat) == ("time_limit" in str(changes))
    if warning:
        assert warning in (tmp_path / "report.html").read_text(encoding="utf-8")
        assert warning in (tmp_path / "report.md").read_text(encoding="utf-8")


def test_an_edited_shader_within_a_commit_is_noticed(tmp_path):
    for method, digest in (("a", "11"), ("b", "22")):
        cell = make_cell(method=method)
        cell["provenance"] = cell["provenance"] | {"shaders": {"common/shade.glsl": digest}}
        write_cell(tmp_path, cell)
    assert "Shader common/shade.glsl has 2 versions" in make_report([tmp_path]).text


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
    text = make_report([resumed(tmp_path)]).text
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
    assert "1 cells were given twice" in again and "1 cells: 1 measured" in again


def test_nothing_is_written_into_a_folder_that_git_tracks(tmp_path):
    make_results(tmp_path, 1, 1)
    for command in (["git", "init", "-q"], ["git", "add", "cells"]):
        subprocess.run(command, cwd=tmp_path, check=True)
    assert make_report([tmp_path]).files == []
    assert sorted(p.name for p in tmp_path.iterdir()) == [".git", "cells", "images"]


def test_names_are_defused_in_csv(tmp_path):
    """Spreadsheets take a text that begins with = + - @ for a formula."""
    for number, name in enumerate(("=1+1", "+1", "-1", "@x", "plain")):
        write_cell(tmp_path, make_cell(scene=f"s{number}", method=name))
    make_report([tmp_path])
    with open(tmp_path / "cells.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["method"] for row in rows] == ["'=1+1", "'+1", "'-1", "'@x", "plain"]
    assert not [text for row in rows for text in row.values() if text.startswith(("=", "+", "@"))]


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


def test_wide_images_become_smaller_copies(tmp_path, monkeypatch):
    monkeypatch.setattr("oitlab_analysis.write.images.MOST_BYTES", 1_000_000)
    write_cell(tmp_path, make_cell(size=(2000, 1000)), image=False)
    write_image(tmp_path / make_cell(size=(2000, 1000))["image"]["file"], 2000, 1000, detail=8)
    picture, = embedded_pictures(html_of(tmp_path)).values()
    assert (picture["width"], picture["height"]) == (2000, 1000)
    assert picture["scale"] == pytest.approx(2000 / 1280, rel=1e-3)
    assert picture["uri"].startswith("data:image/jpeg")


def test_pictures_of_a_big_report_share_the_room_there_is(tmp_path, monkeypatch):
    monkeypatch.setattr("oitlab_analysis.write.images.MOST_BYTES", 60_000)
    for number in range(6):
        cell = make_cell(method=f"m{number}", size=(400, 300), rmse=0.1)
        write_cell(tmp_path, cell, image=False)
        write_image(tmp_path / cell["image"]["file"], 400, 300, cell["image_hash"], detail=60)
    text = html_of(tmp_path)
    pictures = embedded_pictures(text)
    assert len(pictures) == 6 and all(p["scale"] > 1.5 for p in pictures.values())
    assert sum(len(p["uri"]) for p in pictures.values()) < 60_000 * 1.4
    assert "6 of 6 pictures are smaller copies" in text


@pytest.mark.parametrize("kind, said", [("missing", "is missing"), ("cut", "cannot be read"),
                                        ("outside", "outside the results folder"),
                                        ("none", "no image was written")])
def test_images_that_cannot_be_shown_are_said_so(tmp_path, kind, said):
    results = tmp_path / "results"
    cell = make_cell()
    if kind == "outside":
        write_image(tmp_path / "secret.png", 8, 8)
        cell["image"] = {"file": "../secret.png"}
    if kind == "none":
        cell["image"] = None
    write_cell(results, cell, image=False)
    if kind == "cut":
        path = results / cell["image"]["file"]
        write_image(path, 64, 36)
        path.write_bytes(path.read_bytes()[:90])
    text = html_of(results)
    assert said in text and "data:image/png" not in text


def test_an_unscored_image_is_not_called_equal(tmp_path):
    write_cell(tmp_path, make_cell(rmse=None))
    text = html_of(tmp_path)
    assert "not compared with a reference" in text
    assert "(equal)" not in text and "equal to the reference</figcaption>" not in text


def test_pictures_never_take_more_than_their_room(tmp_path, monkeypatch):
    monkeypatch.setattr("oitlab_analysis.write.images.MOST_BYTES", 12_000)  # for two of the smallest copies
    for number in range(6):
        cell = make_cell(method=f"m{number}", size=(400, 300), rmse=0.1)
        write_cell(tmp_path, cell, image=False)
        write_image(tmp_path / cell["image"]["file"], 400, 300, cell["image_hash"], detail=60)
    text = html_of(tmp_path)
    pictures = embedded_pictures(text)
    assert 0 < len(pictures) < 6
    assert sum(len(p["uri"]) for p in pictures.values()) < 12_000 * 1.4
    assert f"{6 - len(pictures)} did not fit into the page" in text


def test_a_picture_that_cells_share_takes_its_room_once(tmp_path, monkeypatch):
    for number in range(5):
        write_cell(tmp_path, make_cell(method=f"exact{number}", rmse=0.0))
    size = next((tmp_path / "images").iterdir()).stat().st_size
    write_cell(tmp_path, make_cell(method="other", rmse=0.1))
    monkeypatch.setattr("oitlab_analysis.write.images.MOST_BYTES", 2 * size + 20)
    text = html_of(tmp_path)
    assert len(embedded_pictures(text)) == 2 and "did not fit" not in text


def test_a_copy_averages_the_pixels_that_it_drops():
    y, x = numpy.mgrid[0:900, 0:1600]
    board = ((x + y) % 2 * 255).astype(numpy.uint8)  # a fine chequer: grey from afar
    board[:, 800:] = 0
    file = io.BytesIO()
    Image.fromarray(board).save(file, "PNG")
    shown = numpy.asarray(Image.open(io.BytesIO(smaller(file.getvalue(), 800))), int)
    assert shown.shape == (450, 800, 3)
    assert numpy.abs(shown[:, :390] - 127.5).max() < 3 and shown[:, 410:].max() < 3


def test_a_device_note_stands_beside_every_ratio_to_blend(tmp_path):
    h200 = DEVICE | {"name": "NVIDIA H200"}
    make_results(tmp_path, methods=3, scenes=2, device=h200)
    result = make_report([tmp_path])
    ratios = [line for line in result.text.splitlines() if line.startswith(("wboit", "reference"))]
    assert len(ratios) == 4 and all("‡" in line for line in ratios)
    assert "2 of its 66 TPCs" in " ".join(result.text.split())
    for file in ("report.html", "report.md"):
        text = (tmp_path / file).read_text(encoding="utf-8")
        assert text.count(" ‡") >= 4 and "2 of its 66 TPCs" in text
    with open(tmp_path / "cells.csv", encoding="utf-8", newline="") as file:
        assert sum("TPCs" in row["device_note"] for row in csv.DictReader(file)) == 6


def test_other_devices_have_no_such_note(tmp_path):
    make_results(tmp_path, methods=3, scenes=1)
    assert "‡" not in make_report([tmp_path]).text
