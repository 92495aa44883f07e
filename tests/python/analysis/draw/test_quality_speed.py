"""Quality against speed: what it draws, on data worked out by hand."""

import itertools

import numpy
import pytest
from oitlab_analysis.compare.metrics import METRICS, wrong_order
from oitlab_analysis.compare.tidy import as_table
from oitlab_analysis.draw import quality_speed
from oitlab_analysis.draw.style import footnotes
from oitlab_analysis.read.cells import collect
from sections import drawn, section_of
from synthetic import DEVICE, lucid_cell, make_cell, make_results, write_cell


@pytest.mark.parametrize("points, wanted", [
    ([(1, 9), (2, 5), (3, 7), (4, 0)], [0, 1, 3]),  # (3, 7) is beaten by (2, 5)
    ([(2, 2), (1, 1)], [1]),
    ([(1, 1), (1, 1)], [0]),  # of equal points the first
    ([(1, 5), (1, 3), (2, 3)], [1]),  # as fast and better; as good and faster
    ([], [])])
def test_the_pareto_front_is_what_nothing_beats(points, wanted):
    times, errors = numpy.array(points, dtype=float).reshape(-1, 2).T
    assert quality_speed.pareto_front(times, errors) == wanted


def test_the_front_by_its_definition():
    random = numpy.random.default_rng(3)
    for _ in range(50):
        times, errors = random.integers(0, 9, (2, 12)).astype(float)
        front = set(quality_speed.pareto_front(times, errors))
        for i in range(12):
            beaten = any(times[j] <= times[i] and errors[j] <= errors[i] and
                         (times[j] < times[i] or errors[j] < errors[i]) for j in range(12))
            equal_before = any((times[j], errors[j]) == (times[i], errors[i]) for j in range(i))
            assert (i in front) == (not beaten and not equal_before)


def test_every_metric_is_0_for_an_equal_image_and_grows_with_the_error(tmp_path):
    for name, rmse in (("none", 0.0), ("little", 0.001), ("much", 0.1), ("unscored", None)):
        write_cell(tmp_path, make_cell(method=name, rmse=rmse))
    invalid = [lucid_cell("boxes", 1, invalid=n, parameters={"repair": repair})
               for n, repair in ((0, False), (23, False), (230, False), (230, True))]
    table = as_table(collect(tmp_path).cells).set_index("method")
    for name, metric in METRICS.items():
        if name == "wrong_order":
            continue
        errors = dict(zip(table.index, metric.errors(table)))
        assert errors["none"] == 0 < errors["little"] < errors["much"], name
        assert numpy.isnan(errors["unscored"]), name
    assert METRICS["psnr"].shown(METRICS["psnr"].errors(table)[list(table.index).index("much")]) == 20
    for number, cell in enumerate(invalid):
        write_cell(tmp_path / "lucid", cell | {"id": f"{number}"})
    table = as_table(collect(tmp_path / "lucid").cells).sort_values("id")
    assert wrong_order(table).tolist() == pytest.approx([0, 23 / 2304, 230 / 2304, 0])


def test_the_overall_figures_are_the_means_over_all_scenes(tmp_path):
    # blend takes 1, 4 and 2 ms; x takes 2, 1/2 and 1 times as long, whose geometric mean is 1.
    for scene, time, factor, error in (("a", 1, 2, 0.1), ("b", 4, 0.5, 0.2), ("c", 2, 1, 0.6)):
        write_cell(tmp_path, make_cell(scene, "blend", frame_ms=time, rmse=0.5))
        write_cell(tmp_path, make_cell(scene, "x", frame_ms=time * factor, rmse=error))
    write_cell(tmp_path, make_cell("a", "partial", frame_ms=0.01, rmse=0.0))
    write_cell(tmp_path, make_cell("lonely", "x", frame_ms=1, rmse=0.9))  # without blend
    table = quality_speed.overall(section_of(tmp_path), METRICS["rmse"]).set_index("label")
    assert sorted(table.index) == ["blend", "x"], "what is not everywhere is left out"
    assert table.loc["x", "error"] == pytest.approx(0.3)
    assert table.loc["x", "ratio"] == pytest.approx(1.0, rel=0.01)
    assert (table.loc["x", "low"], table.loc["x", "high"]) == (
        pytest.approx(0.75, rel=0.01), pytest.approx(1.5, rel=0.01))
    assert table.loc["blend", "ratio"] == 1 and set(table["settings"]) == {3}


def test_points_lie_at_their_times_and_errors_and_zero_on_the_edge(tmp_path):
    section = section_of(make_results(tmp_path, 4, 1))
    axes = drawn(quality_speed.draw_scenes, section, 0, "rmse").axes[0]
    floor = axes.get_ylim()[0]
    points = {(x, y) for line in axes.lines if line.get_linestyle() == "None"
              for x, y in zip(line.get_xdata(), line.get_ydata())}
    wanted = {(row["frame_ms.median"], max(row["quality.rmse"], floor))
              for _, row in section.table.iterrows()}
    assert sorted(points) == [pytest.approx(p) for p in sorted(wanted)]
    labels = [t.get_text() for t in axes.get_yticklabels()]
    assert labels[0] == "0" and axes.get_yticks()[0] == floor
    assert axes.get_xscale() == axes.get_yscale() == "log"


@pytest.mark.parametrize("metric", METRICS)
def test_every_metric_can_be_drawn(tmp_path, metric):
    for scene in ("boxes", "teapot"):
        write_cell(tmp_path, make_cell(scene, "blend", frame_ms=1, rmse=0.1))
        for repair in (True, False):
            write_cell(tmp_path, lucid_cell(scene, 1, 3, 20, {"repair": repair}))
    section = section_of(tmp_path)
    assert drawn(quality_speed.draw_scenes, section, 0, metric).axes[0].get_ylabel() == METRICS[metric].label
    assert drawn(quality_speed.draw_overall, section, 0, metric)


def test_texts_of_the_panels_do_not_overlap(tmp_path):
    figure = drawn(quality_speed.draw_scenes, section_of(make_results(tmp_path, 6, 12)), 0, "rmse")
    for axes in figure.axes:
        texts = [t for t in [*axes.get_xticklabels(), *axes.get_yticklabels(), axes.title]
                 if t.get_text() and t.get_visible()]
        boxes = [t.get_window_extent().padded(-1) for t in texts]
        for (one, a), (two, b) in itertools.combinations(zip(boxes, texts), 2):
            assert one.width <= 0 or two.width <= 0 or not one.overlaps(two), (a, b)


def test_a_device_note_is_in_the_caption_of_a_chart_of_ratios(tmp_path):
    """Charts are copied out of reports, away from the note there."""
    for name, noted in (("NVIDIA H200", True), ("Example GPU 4000", False)):
        make_results(tmp_path / name, methods=3, scenes=2, device=DEVICE | {"name": name})
        section = section_of(tmp_path / name)
        label = drawn(quality_speed.draw_overall, section, 0, "rmse").axes[0].get_xlabel()
        assert ("blend source=hardware ‡" in label) == ("2 of its 66 TPCs" in footnotes(section)) == noted


def test_points_are_named_where_they_stand(tmp_path):
    figure = drawn(quality_speed.draw_overall, section_of(make_results(tmp_path, 5, 2)), 0, "rmse")
    texts = {text.get_text() for text in figure.axes[0].texts}
    assert {"blend", "wboit", "lucid (tile=16)", "reference"} <= texts
    panels = drawn(quality_speed.draw_scenes, section_of(tmp_path), 0, "rmse").axes
    for axes in panels:
        names = [text.get_text() for text in axes.texts]
        assert len(names) == len(set(names)) and set(names) <= {"blend", "wboit", "lucid", "reference"}


def test_variants_of_one_method_are_named_by_what_differs(tmp_path):
    for n in (1, 2):
        write_cell(tmp_path, make_cell(method="lucid", parameters={"n": n}, frame_ms=n, rmse=0.1 / n))
    axes, = drawn(quality_speed.draw_scenes, section_of(tmp_path), 0, "rmse").axes
    assert [text.get_text() for text in axes.texts] == ["n=1", "n=2"]


def test_one_slow_method_does_not_crush_a_panel(tmp_path):
    for number, time in enumerate((1, 1.1, 1.2, 1.3, 1.4, 900)):
        write_cell(tmp_path, make_cell(method=f"m{number}", frame_ms=time, rmse=0.1))
    axes, = drawn(quality_speed.draw_scenes, section_of(tmp_path), 0, "rmse").axes
    assert axes.get_xlim()[1] < 3
    assert any(text.get_text().startswith("m5: ") and text.get_text().endswith("→") for text in axes.texts)
