"""Which charts a report has: quality against speed first, a budget for each section, files."""

import itertools

import pytest
from matplotlib.colors import to_rgb
from oitlab_analysis.draw import charts, style
from PIL import Image
from sections import section_of, sections_of
from synthetic import DEVICE, LAVAPIPE, make_cell, make_results, make_sweep, without_measurement, write_cell


def test_quality_against_speed_is_first_in_every_section(tmp_path):
    for experiment in ("one", "two"):
        make_results(tmp_path / experiment, 4, 2, experiment=experiment)
    tasks = charts.tasks_of(sections_of(tmp_path), "rmse", ())
    assert [own[0].name for own in tasks] == ["quality-speed"] * 2
    single = charts.tasks_of(sections_of(make_results(tmp_path / "three", 4, 1)), "rmse", ())
    assert single[0][0].name == "quality-speed-scenes"


def test_sections_share_the_charts_there_are_and_each_has_one(tmp_path):
    for number in range(8):
        make_results(tmp_path / f"r{number}", 3, 2, experiment=f"e{number}")
    tasks = charts.tasks_of(sections_of(tmp_path), "rmse", ())
    chosen = charts.choose(tasks)
    counts = [sum(task.number == number for task in chosen) for number in range(1, 9)]
    assert sum(counts) == charts.IN_ALL and min(counts) >= 2 and max(counts) - min(counts) <= 1
    assert len(charts.choose(tasks, everything=True)) == sum(map(len, tasks)) > charts.IN_ALL


def test_one_section_has_at_most_its_budget(tmp_path):
    section = section_of(make_sweep(tmp_path, 160, blocks=7, frames=1))
    tasks = charts.tasks_of([section], "rmse", ())
    chosen = charts.choose(tasks)
    assert len(chosen) == charts.PER_SECTION < len(tasks[0])
    assert len({task.name for task in chosen}) == charts.PER_SECTION, "the first of each kind before second ones"


def test_a_section_of_too_many_methods_has_no_charts_and_says_so(tmp_path):
    for number in range(charts.MOST_METHODS + 1):
        write_cell(tmp_path, make_cell(method=f"m{number}", blocks=7, frames=1), image=False)
    sections = sections_of(tmp_path)
    assert charts.tasks_of(sections, "rmse", ()) == [[]]
    assert charts.crowded_notes(sections) == [
        "No charts of a section: a section may have 100 methods and 3000 cells, and all sections with charts 500 "
        "settings."]
    (tmp_path / "cells" / f"{sections[0].table['id'].iloc[0]}.json").unlink()
    assert charts.crowded_notes(sections_of(tmp_path)) == []


def test_sections_have_charts_while_all_their_settings_are_few(tmp_path, monkeypatch):
    monkeypatch.setattr(charts, "MOST_SETTINGS", 5)
    for experiment, count in (("a", 3), ("b", 4), ("c", 2)):
        for number in range(count):
            write_cell(tmp_path, make_cell(f"s{number}", experiment=experiment, blocks=7, frames=1), image=False)
    assert [bool(own) for own in charts.tasks_of(sections_of(tmp_path), "rmse", ())] == [True, False, True]


def test_figures_of_a_paper_are_drawn_for_its_experiment_only(tmp_path):
    counters = {"pixels_8": 100, "pixels_16": 20, "fragments": 900}
    for experiment, wanted in (("bma", True), ("methods", False)):
        folder = tmp_path / experiment
        write_cell(folder, make_cell(method="abuffer", experiment=experiment, counters=counters))
        tasks, = charts.tasks_of([section_of(folder)], "rmse", ())
        assert any(task.name.startswith("bma") for task in tasks) == wanted


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    folder = tmp_path_factory.mktemp("charts")
    section = section_of(make_results(folder, 4, 12))
    (folder / "plots").mkdir()
    (folder / "plots" / "stages-7.png").write_text("of an earlier report")
    (folder / "plots" / "mine.png").write_text("of the user")
    found = charts.save_charts([section], folder / "plots")[0][0]
    (folder / "plots" / "mine.png").unlink()
    return section, folder / "plots", found


def test_saved_charts_exist_as_png_svg_and_pdf_and_are_the_same_from_one_process(saved, tmp_path, monkeypatch):
    section, folder, found = saved
    first = {p.name: p.read_bytes() for p in folder.iterdir()}
    assert set(first) == {f"{chart.name}.{kind}" for chart in found for kind in ("png", "svg", "pdf")}
    refused = []

    def refuse(*_):
        refused.append("no /dev/shm")
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(charts, "ProcessPoolExecutor", refuse)
    monkeypatch.setattr(charts.os, "sched_getaffinity", lambda _: {0, 1})
    charts.save_charts([section], tmp_path / "plots")
    assert refused
    assert first == {p.name: p.read_bytes() for p in (tmp_path / "plots").iterdir()}


def test_no_picture_is_taller_than_9_inches_or_wider_than_a_page(saved):
    for path in saved[1].glob("*.png"):
        with Image.open(path) as picture:
            width, height = (size / style.DOTS_PER_INCH for size in picture.size)
        assert height <= style.TALLEST + 0.2 and width <= style.PAGE + 0.3, path.name


def test_footnotes_are_in_the_caption_and_in_the_file_and_not_in_the_picture(saved):
    _, folder, found = saved
    for chart in found:
        assert "commit abc1234" in chart.caption
        svg = (folder / f"{chart.name}.svg").read_text(encoding="utf-8")
        assert "commit abc1234" in svg.split("</metadata>")[0]
        assert "commit abc1234" not in svg.split("</metadata>")[1]


def test_the_caption_says_that_times_of_a_cpu_device_mean_little(tmp_path):
    for device, said in ((LAVAPIPE, True), (DEVICE, False)):
        write_cell(tmp_path / device["type"], make_cell(device=device))
        assert ("CPU device" in style.footnotes(section_of(tmp_path / device["type"]))) == said


def test_the_points_of_quality_against_speed_have_hints(saved):
    chart = saved[2][0]
    assert chart.name == "quality-speed-1" and len(chart.hints) == 4
    svg = (saved[1] / f"{chart.name}.svg").read_text(encoding="utf-8")
    assert all(f'<g id="{identity}">' in svg for identity in chart.hints)
    assert any(text.startswith("lucid: 1.70, RMSE 0") for text in chart.hints.values())


def test_no_chart_where_nothing_was_measured(tmp_path):
    write_cell(tmp_path, without_measurement(make_cell(), "failed", "lost"))
    assert charts.save_charts([section_of(tmp_path)], tmp_path / "plots") == ([[]], 0)


def test_colours_are_far_apart_also_for_the_red_green_blind():
    """Deuteranopia by Viénot, Brettel and Mollon (1999), in linear RGB."""
    def seen(colour):
        red, green, blue = (c**2.2 for c in to_rgb(colour))
        same = 0.293 * red + 0.707 * green
        return same, same, -0.022 * red + 0.022 * green + blue

    for one, two in itertools.combinations(style.COLOURS[:5], 2):
        assert sum((a - b) ** 2 for a, b in zip(seen(one), seen(two))) ** 0.5 > 0.1, (one, two)
