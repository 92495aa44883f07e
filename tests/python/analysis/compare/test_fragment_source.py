"""Sources of fragments: which a cell has, which baseline makes the headline, and that ratios name it."""

import csv

import pytest
from oitlab_analysis.compare.fragment_source import named, source_of
from oitlab_analysis.compare.sections import baselines_of, has_hardware_ratio
from oitlab_analysis.compare.statistics import headline_source
from oitlab_analysis.draw import quality_speed
from oitlab_analysis.paper.measured import Want
from oitlab_analysis.write.report import make_report
from sections import drawn, section_of
from synthetic import make_cell, write_cell


def sourced(method, source, **parameters):
    return method, {"source": source, **parameters}


def make_both(folder, hardware, compute, scenes=("boxes", "teapot")):
    """blend from both sources, `hardware` and `compute` ms; lucid takes 1 ms, wboit 2 from the hardware."""
    for scene in scenes:
        for (method, parameters), time in ((sourced("blend", "hardware", order="submission"), hardware),
                                           (sourced("blend", "compute", order="submission"), compute),
                                           (sourced("blend", "compute", order="sorted"), 0.1),
                                           (sourced("lucid", "compute"), 1.0), (sourced("wboit", "hardware"), 2.0)):
            write_cell(folder, make_cell(scene, method, parameters, time))
    return folder


@pytest.mark.parametrize("method, parameters, source", [
    ("blend", {}, "hardware"), ("lucid", {}, "compute"), ("cpu_reference", {}, ""), ("new", {}, "hardware"),
    ("blend", {"source": "compute"}, "compute"), ("lucid", {"source": "hardware"}, "hardware")])
def test_older_cells_have_the_source_that_their_method_had(method, parameters, source):
    cell = make_cell(method=method, parameters=parameters)
    assert source_of(cell) == source
    assert named(cell) == (f"{method} source={source}" if source else method)


@pytest.mark.parametrize("hardware, compute, headline", [(1.0, 2.0, "hardware"), (4.0, 2.0, "compute")])
def test_the_slower_blend_of_the_two_is_no_headline(tmp_path, hardware, compute, headline):
    section = section_of(make_both(tmp_path, hardware, compute))
    assert baselines_of(section.table) == f"blend source={headline}"
    assert has_hardware_ratio(section.table) == (headline == "compute")
    rows = {row["method"]: row for row in section.table.to_dict("records")}
    base = {"hardware": hardware, "compute": compute}[headline]
    assert rows["lucid"]["ratio"] == pytest.approx(1 / base, rel=0.01), "in submission order, though sorted is faster"
    if headline == "compute":
        assert rows["lucid"]["ratio_hardware"] == pytest.approx(1 / hardware, rel=0.01)


def test_the_median_of_the_settings_decides_for_all_of_them(tmp_path):
    for scene, hardware in (("a", 3), ("b", 3), ("c", 1)):
        make_both(tmp_path, hardware, 2.0, [scene])
    section = section_of(tmp_path)
    assert baselines_of(section.table) == "blend source=compute", "also where hardware is faster"
    assert len(set(section.table.loc[section.table["verdict"] == "baseline", "setting"])) == 3


def test_a_setting_with_one_blend_takes_that_and_says_so(tmp_path):
    make_both(tmp_path, 4.0, 2.0, ["boxes"])
    for method, time in (("blend", 3.0), ("lucid", 1.5)):  # the fastest is no baseline beside a blend
        write_cell(tmp_path, make_cell("only", method, frame_ms=time))
    table = section_of(tmp_path).table
    only = table[(table["scene"] == "only") & (table["method"] == "lucid")].iloc[0]
    assert only["baseline_name"] == "blend source=hardware" and only["ratio"] == pytest.approx(0.5, rel=0.01)
    assert set(table.loc[table["scene"] == "boxes", "baseline_name"]) == {"blend source=compute"}


def test_times_of_two_runs_say_nothing_about_the_device():
    cells = {source: make_cell(parameters={"source": source}, frame_ms=time, group=source)
             for source, time in (("hardware", 9.0), ("compute", 1.0))}
    assert headline_source([cells]) == "hardware"
    together = {key: cell | {"group": "one"} for key, cell in cells.items()}
    assert headline_source([together]) == "compute"
    assert headline_source([]) == "hardware"


@pytest.fixture
def fraction(tmp_path, monkeypatch):
    """The report of a GPU whose graphics are a fraction of its compute; it has a note on hardware blending."""
    monkeypatch.setattr("oitlab_analysis.write.report.save_charts", lambda sections, *_: ([[]] * len(sections), 0))
    for path in make_both(tmp_path, 4.0, 2.0).glob("cells/*.json"):
        path.write_text(path.read_text().replace("Example GPU 4000", "NVIDIA H200"))
    return tmp_path


def test_every_ratio_of_the_report_names_its_baseline(fraction):
    text = make_report([fraction]).text
    said = " · ratio to blend source=compute, beside it to blend source=hardware method"
    assert " ".join(text.split()).count(said) == 2
    assert max(map(len, text.splitlines())) <= 100
    row = next(line for line in text.splitlines() if line.startswith("lucid"))
    ratio, (beside, mark) = float(row.split()[4]), row.split("faster")[1].split()[:2]
    assert (ratio, float(beside), mark) == (pytest.approx(0.5, rel=0.01), pytest.approx(0.25, rel=0.01), "‡")
    markdown = (fraction / "report.md").read_text(encoding="utf-8")
    assert "| ratio [95%] | baseline | ratio to blend source=hardware [95%] | verdict |" in markdown
    assert "| blend source=compute | 0.25" in markdown
    page = (fraction / "report.html").read_text(encoding="utf-8")
    assert '"title":"Ratio to blend source=compute"' in page
    assert '"title":"Ratio to blend source=hardware","hint":"frame time over that of hardware blending' in page
    with open(fraction / "cells.csv", encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["method"] == "lucid"]
    assert {row["baseline_name"] for row in rows} == {"blend source=compute"}
    assert {row["fragment_source"] for row in rows} == {"compute"}


def test_a_note_on_hardware_blending_is_not_on_the_headline(fraction):
    text = make_report([fraction], all_warnings=True).text
    assert "Ratios marked ‡: On this chip hardware rasterization" in " ".join(text.split())
    with open(fraction / "cells.csv", encoding="utf-8", newline="") as file:
        assert {row["device_note"] for row in csv.DictReader(file)} == {""}


def test_the_axis_of_ratios_names_the_baseline(tmp_path):
    figure = drawn(quality_speed.draw_overall, section_of(make_both(tmp_path, 4.0, 2.0)), 0, "rmse")
    assert figure.axes[0].get_xlabel() == "time over that of blend source=compute (log scale)"


def test_the_papers_tables_take_hardware_blending_and_compute_lucid():
    assert Want("blend").fits(make_cell(method="blend")) and Want("lucid").fits(make_cell(method="lucid"))
    for method, right in (("blend", "hardware"), ("lucid", "compute")):
        for source in ("hardware", "compute"):
            cell = make_cell(method=method, parameters={"source": source})
            assert Want(method).fits(cell) == (source == right)
