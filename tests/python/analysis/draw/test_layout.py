"""Titles that tell panels apart, labels that cover nothing, axes that a few values do not crush."""

import itertools

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.lines import Line2D
from oitlab_analysis.draw.layout import (
    darker,
    legend_height,
    log_axis,
    panel_grid,
    panel_titles,
    place_labels,
    plain,
    robust_limit,
    shortened,
    wrap_label,
)
from oitlab_analysis.draw.style import COLOURS, TALLEST, method_looks, series_look

LONG = "the cathedral of a town with a rather long name, seen from the hill in the fog of a November at "


def test_short_titles_stay_and_long_ones_wrap():
    assert panel_titles(["boxes", "teapot"], 20) == ["boxes", "teapot"]
    title, = panel_titles(["hairball · view of the inside"], 16)
    assert title.split("\n") == ["hairball · view", "of the inside"]


def test_long_titles_keep_what_tells_them_apart():
    dusk, dawn = panel_titles([LONG + "dusk", LONG + "dawn"], 20)
    assert dusk.endswith("dusk") and dawn.endswith("dawn") and dusk != dawn
    middle = panel_titles([f"{LONG} one {LONG}", f"{LONG} two {LONG}"], 20)
    assert len(set(middle)) == 2
    assert all(title.count("\n") <= 2 for title in [dusk, dawn, *middle])


@pytest.mark.parametrize("values, log, limit", [
    ([1, 2, 3, 4, 100], False, 4),
    ([1, 2, 3, 4, 8], False, None),  # not far off
    ([1, 2, 3, 40, 41, 42], False, None),  # half of them: no outliers
    ([1, 2, 100], False, None),  # too few to say
    ([1, 2, 3, 4, 5, 4000], True, 5),
    ([1, 2, 3, 4, 5, 40], True, None),  # within ten times
    ([1, 10, 100, 1000, 10000], True, None),  # evenly spread
    ([1, 2, 3, None, float("nan"), 4, 100], False, 4),
])
def test_a_few_values_far_off_do_not_set_the_axis(values, log, limit):
    assert robust_limit(values, log) == limit


def test_more_may_stand_out_where_asked():
    values = [1] * 3 + [2] * 5 + [90, 100]
    assert robust_limit(values) is None and robust_limit(values, share=0.25) == 2


def test_labels_cover_neither_points_nor_labels_nor_lines():
    figure, (axes,) = panel_grid([""], 1, 3)
    points = [(x, y, f"variant {x}{y}", "#0072B2") for x, y in itertools.product(range(6), range(6))]
    points += [(2.1, 2.1, "a close one", "#D55E00")] * 5
    axes.set_xlim(-0.5, 6)
    axes.set_ylim(-0.5, 6)
    written = place_labels(axes, points, 6.5, [(0, 3.5, 5, 3.5)])
    assert 30 < sum(written) < len(points), "what finds no room has no label"
    axes.plot([p[0] for p in points], [p[1] for p in points], "o", markersize=5)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    boxes = [text.get_window_extent(canvas.get_renderer()).padded(-1) for text in axes.texts]
    for one, two in itertools.combinations(boxes, 2):
        assert not one.overlaps(two)
    for x, y, *_ in points:
        at = axes.transData.transform((x, y))
        assert not any(box.contains(*at) for box in boxes)


def test_a_figure_is_never_taller_than_a_page():
    figure, all_axes = panel_grid([f"{LONG}{i}" for i in range(12)], 1, 2)
    assert figure.get_figheight() <= TALLEST + 1e-9 and len(all_axes) == 12


def test_at_most_eight_colours_and_then_other_markers():
    looks = [series_look(i) for i in range(12)]
    assert len({look["color"] for look in looks}) == len(COLOURS) == 8
    assert len({(look["color"], look["marker"]) for look in looks}) == 12
    methods = method_looks([f"m{i}" for i in range(10)] + ["blend"])
    assert methods["blend"]["color"] == COLOURS[0]
    assert len({tuple(look.values()) for look in methods.values()}) == 11


@pytest.mark.parametrize("low, high", [(1, 1.2), (0.9, 1.1), (1, 9), (0.003, 4000), (5, 5.01)])
def test_a_log_axis_has_two_to_four_plain_numbers(low, high):
    _figure, (axes,) = panel_grid([""], 1, 2)
    log_axis(axes, "x", low, high)
    texts = [text.get_text() for text in axes.get_xticklabels()]
    assert 2 <= len(texts) <= 4 and not any("10^" in text for text in texts)


def test_numbers_on_axes():
    assert [plain(v) for v in (0.001, 12, 1234, 12345, 2.5e6)] == ["0.001", "12", "1230", "12.3 K", "2.5 M"]


def test_text_in_a_light_colour_is_darkened():
    assert darker("#0072B2") == "#0072b2" and darker("#F0E442") != "#f0e442"


def test_a_label_breaks_between_parameters_and_no_line_ends_in_a_comma():
    assert wrap_label("depth_filter=1, repair=false", 20) == "depth_filter=1\nrepair=false"
    assert wrap_label("a=1, b=2", 20) == "a=1, b=2"
    assert wrap_label("lucid (depth_filter=5, repair=on)", 20) == "lucid\n(depth_filter=5\nrepair=on)"


def test_a_label_keeps_clear_of_points_without_one_and_of_intervals():
    def places(*others, lines=()):
        _figure, (axes,) = panel_grid([""], 1, 2.0)
        axes.set_xlim(0, 10)
        axes.set_ylim(0, 10)
        place_labels(axes, [(5, 5, "label", "#000000"), *others], lines=lines)
        text, = axes.texts
        return text.get_horizontalalignment(), text.get_verticalalignment()
    assert places() == ("left", "center")
    assert places((5.3, 5, "", "#000000")) != ("left", "center")
    assert places(lines=[(5, 5, 6, 5)]) != ("left", "center")


def test_a_label_is_never_nearer_to_another_point_than_to_its_own():
    def written(text, colour):
        _, (axes,) = panel_grid([""], 1, 2.0)
        axes.set_xlim(0, 10)
        axes.set_ylim(0, 10)
        ring = [(5 + dx, 5 + dy, "", colour)  # 5 points away, where a label of 9 points away has room
                for dx in (-0.11, 0, 0.11) for dy in (-0.35, 0, 0.35) if dx or dy]
        return place_labels(axes, [(5, 5, text, "#000000"), *ring])[0]
    assert not written("m (n=1)", "#ff0000") and not written("m", "#ff0000"), "another method's points"
    assert not written("m (n=1)", "#000000") and written("m", "#000000"), "points of its own method"


def test_long_entries_of_a_legend_wrap_and_fit_below_its_height():
    handles = [Line2D([], [], label=f"depth_peeling (layers={n}, mode=front_to_back, back=list, atomics=auto)")
               for n in range(9)] + [Line2D([], [], label=f"m{n}") for n in range(10)]
    figure, _ = panel_grid(["x"], 1, 2.0, handles)
    FigureCanvasAgg(figure).draw()
    legend, = figure.legends
    height = legend.get_window_extent().height / figure.dpi
    assert legend._ncols == 2 and "\n" in legend.get_texts()[0].get_text()
    assert height <= legend_height([handle.get_label() for handle in handles], 7.0) < 1.2 * height + 0.08


def test_a_legend_of_very_many_entries_names_the_first_and_counts_the_others():
    handles = [Line2D([], [], label=f"method{i}") for i in range(5000)]
    assert [handle.get_label() for handle in shortened(handles, 3)] == ["method0", "method1", "and 4998 more"]
    assert shortened(handles[:3], 3) == handles[:3]
    _, axes = panel_grid(["one"], 1, 3.2, shortened(handles))  # it used to leave less than no height
    assert axes[0].get_position().height > 0.2
