"""The tables and figures of the BMA paper, from cells whose times are known."""

import pandas
import pytest
from matplotlib.text import Text
from synthetic import DEVICE, LAVAPIPE, make_cell

from oitlab_analysis import bma
from oitlab_analysis.cells import as_table
from oitlab_analysis.memory import memory_table

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


def test_table2_is_the_ratio_of_the_times_beside_the_papers():
    table = bma.bma_table2(table_of(
        abuffer(frame_ms=30, sort_memory="max", max_fragments=256),
        abuffer(frame_ms=10, max_fragments=256),
        abuffer(frame_ms=12, max_fragments=512),  # without a counterpart
        abuffer("boxes", 8, sort_memory="max"), abuffer("boxes", 16),
        abuffer(frame_ms=1, max_fragments=256, mask="lists"),  # not the paper's
        abuffer(frame_ms=9, sort_memory="max", view="path:fly@0"), abuffer(view="path:fly@0"),
        make_cell("smoke", "blend", {}, 1.0)))
    assert list(table["Scene"]) == ["smoke", "boxes"]
    assert list(table["Max alloc"]) == [256, 64]
    assert list(table["Speedup"]) == pytest.approx([3.0, 0.5], rel=0.05)
    assert table["OIT (ms)"][0] == pytest.approx(30, rel=0.05)
    assert table["Total frags"][0] == 9000 and table["Peak depth"][0] == 30
    assert table["Speedup, paper"][0] == 2.08
    assert pandas.isna(table["Speedup, paper"][1])


def test_published_speedups_are_the_ratios_of_the_published_times():
    for oit, with_bma, speedup in bma.PUBLISHED_TABLE2.values():
        assert oit / with_bma == pytest.approx(speedup, abs=0.006)


def test_table1_compares_each_interval_that_holds_pixels():
    table = bma.bma_table1(table_of(
        abuffer(stages={8: 1, 16: 2, 32: 3, 64: 0.1}, max_fragments=64),
        abuffer(stages={8: 9, 16: 9, 32: 9, 64: 9}, max_fragments=32),
        abuffer(stages={8: 2, 16: 5, 32: 3, 64: 0.1}, max_fragments=64,
                sort_memory="max_by_interval")))
    own = table["smoke (Smoke), max alloc 64"].dropna()
    assert own.to_dict() == {8: 2.0, 16: 2.5, 32: 1.0}  # no pixels of 33 to 64 fragments
    assert table["Smoke (paper)"][128] == 1.68
    assert list(table.index) == sorted(table.index)


def test_figure3_has_the_local_memory_in_bytes():
    figure = bma.bma_figure3(table_of(*(
        make_cell("boxes", "local_memory", {"size": size, "passes": 64}, 1 + size / 8)
        for size in (64, 8, 1))))
    line = figure.axes[0].lines[0]
    assert list(line.get_xdata()) == [16, 128, 1024]
    assert list(line.get_ydata()) == pytest.approx([1.125, 2, 9], rel=0.05)


def test_figure5_counts_pixels_by_interval_once_a_scene():
    figure = bma.bma_figure5(table_of(abuffer(), abuffer(sort_memory="max"), abuffer("powerplant")))
    heights = [bar.get_height() for bar in figure.axes[0].patches]
    assert heights == [1000, 400, 20] * 2
    assert [t.get_text() for t in figure.axes[0].get_xticklabels()] == ["1–8", "9–16", "17–32"]


def test_figure7_follows_the_path_in_order_and_keeps_out_other_views():
    cells = [abuffer("sponza_like", time, view=f"path:fly@{at}", sort_memory=memory)
             for at, time in ((1.0, 30), (0.0, 10), (0.5, 20)) for memory in ("max", "bma")]
    figure = bma.bma_figure7(table_of(*cells, abuffer("sponza_like", 99)))
    times, deep = figure.axes[:2]
    assert [line.get_label() for line in times.lines] == ["OIT", "BMA-OIT"]
    assert list(times.lines[0].get_xdata()) == [0.0, 0.5, 1.0]
    assert list(times.lines[0].get_ydata()) == pytest.approx([10, 20, 30], rel=0.05)
    assert deep.collections


def test_figure9_is_relative_to_insertion_sort():
    figure = bma.bma_figure9(table_of(
        abuffer("powerplant", stages={8: 1, 16: 2, 32: 8}, sort="insertion"),
        abuffer("powerplant", stages={8: 2, 16: 2, 32: 4}, sort="merge")))
    lines = {line.get_label(): list(line.get_ydata()) for line in figure.axes[0].lines}
    assert lines == {"insertion": [1, 1, 1], "merge": [2, 1, 0.5]}


def test_times_of_a_cpu_device_say_so():
    for device, said in ((LAVAPIPE, True), (DEVICE, False)):
        cell = make_cell("boxes", "local_memory", {"size": 8, "passes": 64}, device=device)
        texts = [text.get_text() for text in bma.bma_figure3(table_of(cell)).findobj(Text)]
        assert any("CPU device" in text for text in texts) == said


@pytest.mark.parametrize("make", [bma.bma_table1, bma.bma_table2, bma.bma_figure3, bma.bma_figure5,
                                  bma.bma_figure7, bma.bma_figure9, memory_table])
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
