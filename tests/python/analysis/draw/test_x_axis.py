"""The x axis of a curve: where values stand, and that special ones stand apart."""

import json
import re
import subprocess

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from oitlab_analysis.compare.special_values import Special, meaning, special_values
from oitlab_analysis.draw.curve_lines import Curve, lines_of
from oitlab_analysis.draw.curves import draw_curves
from oitlab_analysis.draw.x_axis import XAxis
from program import PROGRAM, needs_program
from sections import drawn, section_of
from synthetic import make_cell, write_cell

ALL = Special(0.0, "all")


def ticks_of(axis):
    """The axis on a panel of a chart: coordinate and text of each tick in sight, and the figure's axes."""
    figure = Figure(figsize=(7, 3))
    axes = figure.add_axes((0.1, 0.2, 0.3, 0.7))
    axes.plot([axis.at(value) for value in axis._places], range(len(axis._places)))
    axis.apply(axes)
    FigureCanvasAgg(figure).draw()
    low, high = axes.get_xlim()
    return {label.get_text(): at for at, label in zip(axes.get_xticks(), axes.get_xticklabels())
            if low <= at <= high}, axes


@pytest.fixture
def peeling(tmp_path):
    """0 layers are all layers: the slowest, without an error."""
    for layers in (0, 1, 2, 4, 8):
        write_cell(tmp_path, make_cell(method="depth_peeling", parameters={"layers": layers},
                                       frame_ms=layers or 16, rmse=0.1 / layers if layers else 0.0))
    return section_of(tmp_path)


def test_a_value_that_means_all_is_the_last_of_its_line(peeling):
    line, = lines_of(peeling, Curve("layers", "time"))
    assert line.x == [1, 2, 4, 8, ALL]
    assert line.cells["y"].tolist() == pytest.approx([1, 2, 4, 8, 16], rel=0.05)


@pytest.mark.parametrize("base", ["0", "all"])
def test_it_can_be_the_base_by_its_number_and_its_word(peeling, base):
    axes, = drawn(draw_curves, peeling, (Curve("layers", "time", base=base),)).axes
    assert list(axes.lines[0].get_ydata())[-2:] == [pytest.approx(50, rel=0.02), 100]
    assert axes.get_ylabel() == "frame time, % of that at “all”"


@pytest.mark.parametrize("numbers", [[1, 2, 4, 8], [1, 16, 512], [0.9, 0.95, 0.999]])
def test_it_stands_right_of_the_numbers_with_its_word(numbers):
    axis = XAxis([*numbers, ALL], True)
    ticks, axes = ticks_of(axis)
    assert ticks["all"] == axis.at(ALL) > axis.at(numbers[-1])
    edge = axes.lines[-1].get_xdata()[0]
    assert axis.at(numbers[-1]) < edge < axis.at(ALL) < axes.get_xlim()[1]
    assert "0" not in ticks and len(ticks) >= 3
    assert (axes.get_xscale() == "log") == (numbers[-1] == 512)


def test_a_word_beyond_many_places_is_never_left_out():
    ticks, _ = ticks_of(XAxis([0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.9992, Special(0.0, "never")], True))
    assert list(ticks)[-1] == "never" and next(iter(ticks)) == "0.9"


def test_without_special_values_nothing_is_added():
    ticks, axes = ticks_of(XAxis([0, 1, 2], True))
    assert len(axes.lines) == 1 and "0" in ticks


def test_only_the_method_that_means_it_says_so():
    assert meaning("depth_peeling", "layers", 0) == ALL
    assert meaning("other", "layers", 0) == 0 and meaning("depth_peeling", "layers", 1) == 1
    assert meaning("depth_peeling", "layers", None) is None and meaning("depth_peeling", "layers", "0") == "0"


@needs_program
def test_the_list_agrees_with_what_the_program_says_of_its_parameters():
    done = subprocess.run([PROGRAM, "list", "methods", "--json"], capture_output=True, text=True, check=True)
    said = {(method["name"], parameter["name"]) for method in json.loads(done.stdout)["methods"]
            for parameter in method["parameters"]
            if parameter["type"] != "enum" and re.search(r"(^|; )0: ", parameter["help"])}
    assert said == set(special_values())
