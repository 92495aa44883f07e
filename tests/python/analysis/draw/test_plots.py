"""The charts: right lengths, nothing drawn over something else, legible without colour."""

import itertools

import matplotlib
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from oitlab_analysis.draw import bars
from oitlab_analysis.draw import charts
from oitlab_analysis.draw import style
from oitlab_analysis.compare.tidy import as_table
from oitlab_analysis.read.cells import collect
from oitlab_analysis.compare.sections import add_comparisons, make_sections
from synthetic import make_cell, make_results, make_sweep, without_measurement, write_cell


def section_of(folder):
    collection = collect(folder)
    return make_sections(collection.cells, add_comparisons(as_table(collection.cells), collection.cells))[0]


def draw(section, kind, page=0):
    with matplotlib.rc_context(style.STYLE):
        figure = charts.KINDS[kind].draw(section, page, "rmse")
        FigureCanvasAgg(figure).draw()
    return figure


def boxes(artists):
    """Boxes in pixels with what is in them; a pixel less, since touching is no overlap."""
    found = [(artist.get_window_extent().padded(-1), artist) for artist in artists]
    return [(box, artist) for box, artist in found if box.width > 0 and box.height > 0]


def assert_nothing_overlaps(figure):
    texts, bars, legends = [], [], []
    for axes in figure.axes:
        texts += [*axes.texts, axes._left_title, axes.xaxis.label, *tick_labels(axes)]
        bars += axes.patches
        legends += [axes.get_legend()] if axes.get_legend() else []
    assert legends and bars
    texts = boxes(text for text in texts if text.get_text().strip())
    legends, bars = boxes(legends), boxes(bars)
    pairs = [*itertools.combinations(texts, 2), *itertools.product(texts, bars),
             *itertools.product(legends, texts + bars)]
    for (one, first), (two, second) in pairs:
        assert not one.overlaps(two), (first, second)


def tick_labels(axes):
    """Labels beyond the ends of an axis exist, but are not drawn."""
    low, high = axes.get_xlim()
    shown = [t for t in axes.get_xticklabels() if low <= t.get_position()[0] <= high]
    return axes.get_yticklabels() + shown


@pytest.fixture(scope="module", params=[(2, 3), (4, 12), (6, 12), (1, 1)], ids=str)
def section(request, tmp_path_factory):
    folder = make_results(tmp_path_factory.mktemp("results"), *request.param)
    method = "a method with a very long name and, for once, no result"
    write_cell(folder, without_measurement(make_cell("boxes", method), "failed", "lost"))
    for hour in ("dusk", "dawn"):
        name = f"the cathedral of a town with a rather long name, seen from the hill in fog at {hour}"
        write_cell(folder, make_cell(name, "blend"))
    return section_of(folder)


@pytest.mark.parametrize("kind", ["frame-times", "stages", "memory"])
def test_nothing_overlaps(section, kind):
    for page in range(len(bars.paginate(section))):
        assert_nothing_overlaps(draw(section, kind, page))


def test_pages_hold_every_cell_once(section):
    pages = bars.paginate(section)
    cells = [identity for page in pages for _, cells in page for identity in cells["id"]]
    assert sorted(cells) == sorted(section.table["id"])
    lengths = [sum(len(cells) for _, cells in page) for page in pages]
    assert max(lengths) <= bars.BARS_PER_CHART * 1.2 and max(lengths) < 3 * min(lengths)


def test_bars_end_at_the_medians_and_intervals_at_their_ends(tmp_path):
    section = section_of(make_results(tmp_path, 3, 2))
    axes = draw(section, "frame-times").axes[0]
    ends = sorted(bar.get_x() + bar.get_width() for bar in axes.patches)
    assert ends == pytest.approx(sorted(section.table["frame_ms.median"]))
    lines = [segment for group in axes.collections for segment in group.get_segments()]
    assert sorted(line[0][0] for line in lines) == pytest.approx(
        sorted(section.table["frame_ms.ci_low"]))
    assert sorted(line[1][0] for line in lines) == pytest.approx(
        sorted(section.table["frame_ms.ci_high"]))


def test_stages_are_stacked_to_their_sum(tmp_path):
    section = section_of(make_results(tmp_path, 2, 1))
    axes = draw(section, "stages").axes[0]
    columns = bars.stage_columns(section.table)
    ends = {}
    for bar in axes.patches:
        row = round(bar.get_y() + bar.get_height() / 2)
        ends[row] = max(ends.get(row, 0), bar.get_x() + bar.get_width())
    assert [ends[0], ends[1]] == pytest.approx(section.table[columns].sum(axis=1).tolist())


@pytest.mark.parametrize("slow, scale", [(29, "linear"), (31, "log")])
def test_log_scale_beyond_a_span_of_30(tmp_path, slow, scale):
    for method, time in (("blend", 1.0), ("slow", slow)):
        cell = make_cell(method=method)
        cell["statistics"]["frame"]["median"] = time
        write_cell(tmp_path, cell)
    axes = draw(section_of(tmp_path), "frame-times").axes[0]
    assert axes.get_xscale() == scale
    assert ("log scale" in axes.get_xlabel()) == (scale == "log")
    assert (axes.get_xlim()[0] == 0) == (scale == "linear")


def test_methods_are_told_apart_by_colour_and_also_without(tmp_path):
    styles = bars.method_styles(section_of(make_results(tmp_path, 6, 1)).table)
    colours = {label: colour for label, (colour, _) in styles.items()}
    assert len({hatch for _, hatch in styles.values()}) == 6
    assert colours["lucid (tile=8)"] == colours["lucid (tile=16)"]
    assert len(set(colours.values())) == 5
    assert list(styles)[0] == "blend"


def test_colours_are_far_apart_also_for_the_red_green_blind():
    """Deuteranopia by Viénot, Brettel and Mollon (1999), in linear RGB."""
    def seen(colour):
        red, green, blue = (c**2.2 for c in to_rgb(colour))
        same = 0.293 * red + 0.707 * green
        return same, same, -0.022 * red + 0.022 * green + blue

    for one, two in itertools.combinations(style.COLOURS[:5], 2):
        assert sum((a - b) ** 2 for a, b in zip(seen(one), seen(two))) ** 0.5 > 0.1, (one, two)


def test_a_dollar_in_a_name_is_drawn_as_it_is(tmp_path):
    write_cell(tmp_path, make_cell(scene="$\\frac{$", method="a$_b"))
    axes = draw(section_of(tmp_path), "frame-times").axes[0]
    assert axes.get_yticklabels()[0].get_text() == "$\\frac{$"


def test_saved_charts_exist_as_png_svg_and_pdf_and_are_reproducible(tmp_path):
    section = section_of(make_results(tmp_path, 2, 1))
    (tmp_path / "plots").mkdir()
    (tmp_path / "plots" / "stages-7.png").write_text("of an earlier report")
    (tmp_path / "plots" / "mine.png").write_text("of the user")
    saved = charts.save_charts([section], tmp_path / "plots")[0][0]
    (tmp_path / "plots" / "mine.png").unlink()
    first = {p.name: p.read_bytes() for p in (tmp_path / "plots").iterdir()}
    assert set(first) == {f"{chart.name}.{kind}" for chart in saved for kind in ("png", "svg", "pdf")}
    charts.save_charts([section], tmp_path / "plots")
    assert first == {p.name: p.read_bytes() for p in (tmp_path / "plots").iterdir()}


def test_a_page_of_failed_cells_only_is_drawn(tmp_path):
    write_cell(tmp_path, make_cell("aaa"))
    for number in range(70):
        cell = make_cell("zzz", parameters={"size": number})
        write_cell(tmp_path, without_measurement(cell, "failed", "lost"))
    section = section_of(tmp_path)
    figure = draw(section, "frame-times", page=len(bars.paginate(section)) - 1)
    assert len(figure.axes[0].texts) == 70 and not figure.axes[0].patches


def test_no_chart_where_nothing_was_measured(tmp_path):
    write_cell(tmp_path, without_measurement(make_cell(), "failed", "lost"))
    assert charts.save_charts([section_of(tmp_path)], tmp_path / "plots") == ([[]], 0)


def test_only_so_many_charts_are_drawn_unless_all_are_wanted(tmp_path, monkeypatch):
    monkeypatch.setattr(charts, "save", lambda figure, path: None)
    section = section_of(make_sweep(tmp_path, 160, blocks=7, frames=1))
    some, left_out = charts.save_charts([section], tmp_path / "plots")
    every, none = charts.save_charts([section], tmp_path / "plots", everything=True)
    assert len(some[0]) == charts.MOST_CHARTS and none == 0
    assert len(every[0]) == charts.MOST_CHARTS + left_out > charts.MOST_CHARTS
    kinds = {chart.name.split("-1")[0] for chart in some[0]}
    wanted = {kind for kind in charts.KINDS if not kind.startswith("bma")}
    assert kinds == wanted, "the first chart of every kind is among them"


def test_figures_of_a_paper_are_drawn_for_its_experiment_only(tmp_path, monkeypatch):
    monkeypatch.setattr(charts, "save", lambda figure, path: None)
    counters = {"pixels_8": 100, "pixels_16": 20, "fragments": 900}
    for experiment, wanted in (("bma", True), ("methods", False)):
        folder = tmp_path / experiment
        write_cell(folder, make_cell(method="abuffer", experiment=experiment, counters=counters))
        saved = charts.save_charts([section_of(folder)], tmp_path / "plots")[0][0]
        assert any(chart.name.startswith("bma") for chart in saved) == wanted
