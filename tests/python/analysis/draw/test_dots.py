"""Frame times as dots with intervals: in their places, in bands, on pages of a page's height."""

import itertools

import pytest
from oitlab_analysis.draw import dots
from oitlab_analysis.draw.style import TALLEST
from sections import drawn, section_of
from synthetic import make_cell, make_results, without_measurement, write_cell


def points(axes):
    """The ends of the dots: x of every marker."""
    return sorted(x for line in axes.lines if line.get_linestyle() == "None" for x in line.get_xdata())


@pytest.fixture(scope="module", params=[(2, 3), (4, 12), (6, 12), (1, 1)], ids=str)
def section(request, tmp_path_factory):
    folder = make_results(tmp_path_factory.mktemp("results"), *request.param)
    method = "a method with a very long name and, for once, no result"
    write_cell(folder, without_measurement(make_cell("boxes", method), "failed", "lost"))
    for hour in ("dusk", "dawn"):
        name = f"the cathedral of a town with a rather long name, seen from the hill in fog at {hour}"
        write_cell(folder, make_cell(name, "blend"))
    return section_of(folder)


def test_dots_lie_at_the_medians_and_intervals_at_their_ends(tmp_path):
    section = section_of(make_results(tmp_path, 3, 2))
    axes = drawn(dots.draw_frame_times, section, 0).axes[0]
    assert points(axes) == pytest.approx(sorted(section.table["frame_ms.median"]))
    lines = [segment for group in axes.collections for segment in group.get_segments()]
    assert sorted(line[0][0] for line in lines) == pytest.approx(sorted(section.table["frame_ms.ci_low"]))
    assert sorted(line[1][0] for line in lines) == pytest.approx(sorted(section.table["frame_ms.ci_high"]))


def test_pages_hold_every_cell_once_and_fit_on_a_page(section):
    pages = dots.paginate(section)
    cells = [key for page in pages for _, cells in page for key in cells["key"]]
    assert sorted(cells) == sorted(section.table["key"])
    for page in range(len(pages)):
        figure = drawn(dots.draw_frame_times, section, page)
        assert figure.get_figheight() <= TALLEST


def test_texts_do_not_overlap(section):
    axes = drawn(dots.draw_frame_times, section, 0).axes[0]
    texts = [*axes.texts, *axes.get_yticklabels(), axes.xaxis.label,
             *(t for t in axes.get_xticklabels() if axes.get_xlim()[0] <= t.get_position()[0] <= axes.get_xlim()[1])]
    boxes = [text.get_window_extent().padded(-1) for text in texts if text.get_text()]
    for one, two in itertools.combinations(boxes, 2):
        assert one.width <= 0 or two.width <= 0 or not one.overlaps(two)


@pytest.mark.parametrize("slow, scale", [(3.9, "linear"), (4.5, "log")])
def test_log_scale_beyond_a_span_of_4(tmp_path, slow, scale):
    for method, time in (("blend", 1.0), ("slow", slow)):
        cell = make_cell(method=method)
        cell["statistics"]["frame"]["median"] = time
        write_cell(tmp_path, cell)
    axes = drawn(dots.draw_frame_times, section_of(tmp_path), 0).axes[0]
    assert axes.get_xscale() == scale
    assert ("log scale" in axes.get_xlabel()) == (scale == "log")
    assert (axes.get_xlim()[0] == 0) == (scale == "linear")


def test_an_outlier_is_marked_at_the_edge_with_its_value(tmp_path):
    for number, time in enumerate((1, 1.1, 1.2, 1.3, 1.4, 1.5, 900)):
        write_cell(tmp_path, make_cell(method=f"m{number}", frame_ms=time))
    axes = drawn(dots.draw_frame_times, section_of(tmp_path), 0).axes[0]
    assert axes.get_xlim()[1] < 10 and len(points(axes)) == 6
    text, = [text.get_text() for text in axes.texts]
    assert text.startswith("m6: ") and text.endswith("→")


def test_failed_cells_are_said(tmp_path):
    write_cell(tmp_path, make_cell())
    write_cell(tmp_path, without_measurement(make_cell(method="lost"), "failed", "gone"))
    for number in range(70):
        write_cell(tmp_path, without_measurement(make_cell(method="many", parameters={"n": number}), "failed", "gone"))
    axes = drawn(dots.draw_frame_times, section_of(tmp_path), 0).axes[0]
    assert sorted(text.get_text() for text in axes.texts) == ["lost: failed", "many: 70 not measured"]


def test_one_sample_has_a_dot_and_no_interval(tmp_path):
    write_cell(tmp_path, make_cell(blocks=1, frames=1))
    axes = drawn(dots.draw_frame_times, section_of(tmp_path), 0).axes[0]
    assert len(points(axes)) == 1


def test_a_dollar_in_a_name_is_drawn_as_it_is(tmp_path):
    write_cell(tmp_path, make_cell(scene="$\\frac{$", method="a$_b"))
    axes = drawn(dots.draw_frame_times, section_of(tmp_path), 0).axes[0]
    assert axes.get_legend() is None and axes.figure.legends[0].get_texts()[0].get_text() == "a$_b"
