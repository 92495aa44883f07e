"""The tables and figures of the BMA paper, from cells whose times are known."""

import pandas
import pytest
from oitlab_analysis.compare.memory import memory_table
from oitlab_analysis.compare.tidy import as_table
from oitlab_analysis.draw import bma_figures
from oitlab_analysis.paper import bma_tables
from synthetic import make_cell

DEFAULTS = {"sort_memory": "bma", "max_fragments": 64, "mask": "stencil", "sort": "auto",
            "deep": "exact", "on_overflow": "grow", "initial_depth": 4.0, "node_color": "rgba32f",
            "local": "keys"}
# Interval -> pixels of the scene.
PIXELS = {8: 1000, 16: 400, 32: 20, 64: 0}


def abuffer(scene="smoke", frame_ms=10.0, stages=None, view="default", pixels=PIXELS, **parameters):
    stages = {f"sort {i}": ms for i, ms in (stages or {}).items()}
    cell = make_cell(scene, "abuffer", DEFAULTS | parameters, frame_ms, view=view)
    counters = {f"pixels_{i}": n for i, n in pixels.items()}
    counters |= {"fragments": 9000, "max_fragments_per_pixel": 30}
    return cell | {"id": f"{cell['id']}-{view}", "counters": counters,
                   "gpu_ms": cell["gpu_ms"] | {"stages": stages}}


def table_of(*cells):
    return as_table({str(i): cell for i, cell in enumerate(cells)})


def test_table1_compares_each_interval_that_holds_pixels():
    table = bma_tables.speedups_by_interval(table_of(
        abuffer(stages={8: 1, 16: 2, 32: 3, 64: 0.1}, max_fragments=64),
        abuffer(stages={8: 9, 16: 9, 32: 9, 64: 9}, max_fragments=32),
        abuffer(stages={8: 2, 16: 5, 32: 3, 64: 0.1}, max_fragments=64,
                sort_memory="max_by_interval")))
    own = table["smoke (Smoke), max alloc 64"].dropna()
    assert own.to_dict() == {8: 2.0, 16: 2.5, 32: 1.0}  # no pixels of 33 to 64 fragments
    assert list(table.index) == sorted(table.index)


def test_figure3_has_the_local_memory_in_bytes():
    figure = bma_figures.bma_figure3(table_of(*(
        make_cell("boxes", "local_memory", {"size": size, "passes": 64}, 1 + size / 8)
        for size in (64, 8, 1))))
    line = figure.axes[0].lines[0]
    assert list(line.get_xdata()) == [16, 128, 1024]
    assert list(line.get_ydata()) == pytest.approx([1.125, 2, 9], rel=0.05)


def test_figure5_counts_pixels_by_interval_once_a_scene():
    figure = bma_figures.bma_figure5(table_of(abuffer(), abuffer(sort_memory="max"), abuffer("powerplant")))
    heights = [bar.get_height() for bar in figure.axes[0].patches]
    assert heights == [1000, 400, 20] * 2
    assert [t.get_text() for t in figure.axes[0].get_xticklabels()] == ["1–8", "9–16", "17–32"]


def test_figure7_follows_the_path_in_order_and_keeps_out_other_views():
    cells = [abuffer("sponza_like", time, view=f"path:fly@{at}", sort_memory=memory)
             for at, time in ((1.0, 30), (0.0, 10), (0.5, 20)) for memory in ("max", "bma")]
    figure = bma_figures.bma_figure7(table_of(*cells, abuffer("sponza_like", 99)))
    times, deep = figure.axes[:2]
    assert [line.get_label() for line in times.lines] == ["OIT", "BMA-OIT"]
    assert list(times.lines[0].get_xdata()) == [0.0, 0.5, 1.0]
    assert list(times.lines[0].get_ydata()) == pytest.approx([10, 20, 30], rel=0.05)
    assert deep.collections


def test_figure9_is_relative_to_insertion_sort():
    figure = bma_figures.bma_figure9(table_of(
        abuffer("powerplant", stages={8: 1, 16: 2, 32: 8}, sort="insertion"),
        abuffer("powerplant", stages={8: 2, 16: 2, 32: 4}, sort="merge")))
    lines = {line.get_label(): list(line.get_ydata()) for line in figure.axes[0].lines}
    assert lines == {"insertion": [1, 1, 1], "merge": [2, 1, 0.5]}


@pytest.mark.parametrize("make", [bma_tables.speedups_by_interval, bma_figures.bma_figure3, bma_figures.bma_figure5,
                                  bma_figures.bma_figure7, bma_figures.bma_figure9, memory_table])
def test_nothing_comes_from_nothing(make):
    assert make(pandas.DataFrame()) is None
    without = make_cell("boxes", "blend", {}) | {"memory_bytes": {"total": 0, "buffers": {}}}
    assert make(table_of(without)) is None


def test_memory_is_a_row_for_each_buffer_of_the_method():
    cell = make_cell("boxes", "abuffer", DEFAULTS, size=(10, 10)) | {
        "counters": {"fragments": 500},
        "memory_bytes": {"total": 9, "buffers": {"method: heads": 400, "method: nodes": 14000,
                                                 "scene: vertices": 77}}}
    table = memory_table(table_of(cell))
    assert list(table["buffer"]) == ["all", "nodes", "heads"]
    assert list(table["bytes"]) == [14400, 14000, 400]
    assert list(table["bytes_per_pixel"]) == [144, 140, 4]
    assert list(table["bytes_per_fragment"]) == [28.8, 28, 0.8]
