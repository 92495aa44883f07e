"""What a reader is warned of: in one line under the table, in full where asked, on the page and in Markdown."""

import csv
import re

import pytest
from oitlab_analysis.write.report import make_report
from reports import html_of
from synthetic import DEVICE, LAVAPIPE, make_cell, make_results, write_cell

pytestmark = pytest.mark.usefixtures("without_charts")


def write_warned(folder):
    """Results with two warnings, one of them about many files."""
    make_results(folder, 2, 1, device=LAVAPIPE)
    for number in range(70):
        (folder / "cells" / f"half{number}.json").write_text("{")


def test_the_terminal_has_title_table_and_then_one_line_of_warnings(tmp_path):
    write_warned(tmp_path)
    lines = make_report([tmp_path]).text.splitlines()
    places = [next(i for i, line in enumerate(lines) if line.startswith(start))
              for start in ("quickstart on llvmpipe", "method ", "reference ", "2 warnings: ", "2 cells: ")]
    assert places == sorted(places) and places[0] == 0
    warning = lines[places[3]]
    assert warning == "2 warnings: CPU device: these times say nothing about GPUs. (all: --warnings)"
    full = make_report([tmp_path], all_warnings=True).text
    assert "warning: 70 files were left out: half0.json" in full and "--warnings" not in full
    assert full.index("reference ") < full.index("warning: ")


def test_a_long_warning_is_cut_at_a_word(tmp_path):
    name = "a_shader_with_quite_a_long_name_so_that_the_line_that_names_it_cannot_hold_it.glsl"
    for method, digest in (("a", "11"), ("b", "22")):
        cell = make_cell(method=method)
        write_cell(tmp_path, cell | {"provenance": cell["provenance"] | {"shaders": {name: digest}}})
    line, = [line for line in make_report([tmp_path]).text.splitlines() if "warning" in line]
    assert len(line) <= 100 and line.startswith("1 warning: Shader") and line.endswith(" ... (all: --warnings)")


def test_warnings_are_one_line_with_their_count(tmp_path):
    write_warned(tmp_path)
    text = html_of(tmp_path)
    summary, = re.findall(r'<details class="warnings"><summary>(.*?)</summary>', text)
    assert "<strong>2 warnings</strong>" in summary and "70 files were left out" in summary
    assert "CPU device: these times say nothing about GPUs." in text


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
    result = make_report([tmp_path], all_warnings=True)
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
    assert "Shader common/shade.glsl has 2 versions" in make_report([tmp_path], all_warnings=True).text


def test_a_device_note_stands_beside_every_ratio_to_blend(tmp_path):
    h200 = DEVICE | {"name": "NVIDIA H200"}
    make_results(tmp_path, methods=3, scenes=2, device=h200)
    result = make_report([tmp_path], all_warnings=True)
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
