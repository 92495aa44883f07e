"""Any quantity over any parameter: which cells a line joins, and where its points lie."""

import itertools

import numpy
import pytest
from oitlab_analysis.compare.quantities import find_quantity, varying
from oitlab_analysis.draw import curves
from oitlab_analysis.draw.curve_lines import ALPHA_THRESHOLD, DEPTH_FILTER, Curve, check, lines_of
from oitlab_analysis.draw.curves import draw_curves
from oitlab_analysis.draw.style import TALLEST
from oitlab_analysis.read.sources import BadResults
from sections import drawn, section_of
from synthetic import lucid_cell, make_cell, make_results, write_cell


def points(line):
    return list(zip(line.get_xdata(), line.get_ydata()))


@pytest.fixture
def peeling(tmp_path):
    """Depth peeling of 1, 2 and 8 layers, in two modes and two scenes; blend has no layers."""
    for scene, time in (("boxes", 1), ("teapot", 2)):
        write_cell(tmp_path, make_cell(scene, "blend", frame_ms=time, rmse=0.5))
        for (layers, error), mode in itertools.product(((8, 0.0), (1, 0.1), (2, 0.05)), ("dual", "single")):
            write_cell(tmp_path, make_cell(scene, "depth_peeling", {"layers": layers, "mode": mode},
                                           time * layers, error))
    return section_of(tmp_path)


def test_a_line_joins_cells_that_differ_in_nothing_but_x(peeling):
    lines = lines_of(peeling, Curve("layers", "rmse", "scene"))
    assert [(line.panel, line.setting, line.variant) for line in lines] == [
        (scene, "", f"mode={mode}") for scene in ("boxes", "teapot") for mode in ("dual", "single")]
    assert all(line.x == [1, 2, 8] for line in lines)
    assert all(line.cells["y"].tolist() == [0.1, 0.05, 0] for line in lines)


def test_a_panel_for_each_scene_and_a_line_for_each_mode(peeling):
    figure = drawn(draw_curves, peeling, (Curve("layers", "rmse", "scene"),))
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["boxes", "teapot"]
    for axes in figure.axes:
        floor = axes.get_ylim()[0]
        assert [points(line) for line in axes.lines] == [[(1, 0.1), (2, 0.05), (8, floor)]] * 2
    assert [t.get_text() for t in figure.legends[0].get_texts()] == ["mode=dual", "mode=single"]


def test_times_over_a_parameter_without_panels(peeling):
    axes, = drawn(draw_curves, peeling, (Curve("layers", "time"),)).axes
    assert len(axes.lines) == 4 and axes.get_ylabel() == "frame time, ms"
    assert points(axes.lines[0])[2][1] == pytest.approx(8, rel=0.05)


def test_a_time_is_related_to_that_at_the_base(peeling):
    axes, = drawn(draw_curves, peeling, (Curve("layers", "time", base="2"),)).axes
    values = points(axes.lines[0])
    assert values == [(1, pytest.approx(50, rel=0.01)), (2, 100), (8, pytest.approx(400, rel=0.01))]
    assert axes.get_ylabel() == "frame time, % of that at 2"


@pytest.mark.parametrize("x, count", [("opacity", 2), ("pixels", 2), ("view", 0)])
def test_knobs_of_the_scene_and_sizes_can_be_x(tmp_path, x, count):
    for method, opacity, size in itertools.product(("blend", "wboit"), (0.2, 0.5, 0.8), ((64, 36), (128, 72))):
        cell = make_cell(method=method, frame_ms=1 + opacity, rmse=0.1, size=size)
        cell["scene"] |= {"opacity": opacity, "content_hash": f"{opacity}"}
        write_cell(tmp_path, cell | {"id": f"{cell['id']}-{opacity}"})
    lines = lines_of(section_of(tmp_path), Curve(x, "time", "method"))
    wanted = {"opacity": [0.2, 0.5, 0.8], "pixels": [64 * 36, 128 * 72]}
    assert all(line.x == wanted[x] for line in lines)
    assert len({line.panel for line in lines}) == count


def test_a_path_is_followed_in_order(tmp_path):
    for at, time in ((1.0, 3), (0.0, 1), (0.5, 2)):
        cell = make_cell(frame_ms=time, view=f"path:fly@{at}")
        write_cell(tmp_path, cell | {"id": f"at-{at}"})
    write_cell(tmp_path, make_cell())
    line, = lines_of(section_of(tmp_path), Curve("path", "time"))
    assert line.x == [0, 0.5, 1] and line.cells["y"].tolist() == pytest.approx([1, 2, 3], rel=0.05)


def test_words_and_truth_values_have_even_places(tmp_path):
    for weight in ("eq10", "eq7", "none"):
        write_cell(tmp_path, make_cell(method="wboit", parameters={"weight": weight, "early": weight == "none"}))
    line, = lines_of(section_of(tmp_path), Curve("weight", "time"))
    assert line.x == ["eq7", "eq10"], "none differs in early, too"
    write_cell(tmp_path, make_cell(method="wboit", parameters={"weight": "eq7", "early": True}))
    section = section_of(tmp_path)
    line, = lines_of(section, Curve("early", "time"))
    assert line.x == ["false", "true"]
    axes, = drawn(draw_curves, section, (Curve("weight", "time"),)).axes
    assert [t.get_text() for t in axes.get_xticklabels()] == ["eq7", "eq10", "none"]


def test_stages_counters_and_columns_have_names(peeling):
    table = peeling.table
    assert find_quantity("capture", table).label == "capture, ms"
    assert find_quantity("fragments", table).values(table)[0] == table["counter.fragments"].iloc[0]
    assert find_quantity("memory.colour", table).values(table)[0] == 3 * 2**20
    assert {"layers", "mode"} <= set(varying(table))


@pytest.mark.parametrize("curve, said", [
    (Curve("layer", "rmse"), "'layer'; did you mean layers"),
    (Curve("layers", "qqqqq"), "'qqqqq'; there are time, ratio, memory, rmse, and columns of cells.csv; "
     "of the parameters vary: layers, mode"),
    (Curve("layers", "time", method="lucid"), "no cell is of the method 'lucid'; there are: blend, depth_peeling"),
    (Curve("layers", "time", base="3"), "no line has layers = 3; there are: 1, 2, 8"),
    (Curve("opacity", "time"), "no two cells differ in opacity alone and have time; these vary: layers, mode"),
    (Curve("layers", "time", "qqqqq"), "'qqqqq'")])
def test_what_cannot_be_drawn_is_told_with_what_can(peeling, curve, said):
    with pytest.raises(BadResults) as caught:
        check([peeling], curve)
    assert said in str(caught.value) and "\n" not in str(caught.value)
    assert curves.pages((curve,))(peeling) == 0 or curve.per or curve.base


def test_many_variants_of_many_scenes_get_a_panel_for_each_scene(tmp_path):
    for scene, mode, n in itertools.product(("a", "b", "c"), range(6), (1, 2)):
        write_cell(tmp_path, make_cell(scene, "lucid", {"n": n, "mode": mode}))
    figure = drawn(draw_curves, section_of(tmp_path), (Curve("n", "time"),))
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["a", "b", "c"]
    assert all(len(axes.lines) == 6 for axes in figure.axes)
    assert figure.get_figheight() <= TALLEST


def test_a_panel_is_not_crushed_by_one_value(tmp_path):
    for n, time in enumerate((1, 1.1, 1.2, 1.1, 1, 1.1, 20)):
        write_cell(tmp_path, make_cell(method="lucid", parameters={"n": n}, frame_ms=time))
    axes, = drawn(draw_curves, section_of(tmp_path), (Curve("n", "time"),)).axes
    assert axes.get_ylim()[1] < 2
    assert [text.get_text()[:4] for text in axes.texts] == ["↑ 20"] or axes.texts[0].get_text().startswith("↑ 19")


# -- the two curves that are built in -----------------------------------------------------------------

@pytest.fixture
def filters(tmp_path):
    """Two scenes, filters of 1 to 4 with and without repair; time grows by a tenth a step from 3."""
    for scene in ("boxes", "teapot"):
        for n, repair in itertools.product((1, 2, 3, 4), (True, False)):
            write_cell(tmp_path, lucid_cell(scene, 2.0, 3 * 1.1 ** (n - 3), 2304 // 10**n,
                                            {"depth_filter": n, "repair": repair}))
        write_cell(tmp_path, lucid_cell(scene, 2.0, 1.5, 23, {"depth_filter": 3, "alpha_threshold": 0.5}))
    return section_of(tmp_path)


def test_the_depth_filter_chart_shows_shares_and_ratios(filters):
    left, right = drawn(draw_curves, filters, DEPTH_FILTER).axes
    assert left.lines[0].get_ydata() == pytest.approx([100 * n / 2304 for n in (230, 23, 2)] + [100 * 2 / 2304 / 4])
    assert right.lines[0].get_ydata() == pytest.approx([82.6, 90.9, 100, 110], rel=0.01)
    assert len(left.lines) == 4 and len(right.lines) == 4 + 1, "and the line at 100 %"


def test_the_alpha_chart_shows_speed_ups(filters):
    figure = drawn(draw_curves, filters, ALPHA_THRESHOLD)
    assert len(figure.axes) == 2
    for axes in figure.axes:
        assert list(axes.lines[0].get_ydata()) == [pytest.approx(2, rel=0.01), 1]
        assert [t.get_text() for t in axes.get_xticklabels()] == ["0.5", "never"], "0 means no threshold"
        assert axes.get_title(loc="left") in ("boxes", "teapot")
    assert figure.axes[0].get_ylabel() == "speed-up against “never”"


def test_there_is_no_curve_without_a_sweep(tmp_path):
    section = section_of(make_results(tmp_path, 5, 2))
    for asked in (DEPTH_FILTER, ALPHA_THRESHOLD):
        assert draw_curves(section, asked) is None and curves.pages(asked)(section) == 0


def test_intervals_are_of_paired_blocks(filters):
    line = lines_of(filters, DEPTH_FILTER[1])[0]
    assert numpy.all(numpy.diff(line.x) == 1)
    axes = drawn(draw_curves, filters, DEPTH_FILTER).axes[1]
    spans = [segment[1][1] - segment[0][1] for group in axes.collections for segment in group.get_segments()]
    assert 0 < max(spans) < 3, "the drift that all share is cancelled"
