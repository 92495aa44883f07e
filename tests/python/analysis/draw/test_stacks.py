"""Stages as shares, buffers as bars: their lengths, their notes, and that nothing is crushed."""

import itertools

import pytest
from oitlab_analysis.draw import stacks
from oitlab_analysis.draw.style import TALLEST
from sections import drawn, section_of
from synthetic import make_cell, make_results, write_cell


def ends(axes):
    """Row -> where its bar ends."""
    found = {}
    for bar in axes.patches:
        row = round(bar.get_y() + bar.get_height() / 2)
        found[row] = max(found.get(row, 0), bar.get_x() + bar.get_width())
    return found


def notes(axes):
    return [text.get_text() for text in axes.texts]


def test_stages_are_shares_with_their_sum_beside(tmp_path):
    section = section_of(make_results(tmp_path, 2, 1))
    axes = drawn(stacks.draw_stages, section, 0).axes[0]
    assert list(ends(axes).values()) == pytest.approx([100, 100])
    sums = section.table[stacks.stage_columns(section.table)].sum(axis=1)
    assert [float(note.split()[0]) for note in notes(axes)] == pytest.approx(sums.tolist(), rel=0.01)
    first = min(bar.get_width() for bar in axes.patches)
    assert first == pytest.approx(100 * 0.1 / 1.05, rel=0.01), "opaque, of the sum of the stages"


def test_memory_bars_end_at_the_whole_memory_and_name_the_largest_buffer(tmp_path):
    buffers = {"method: nodes": 3 * 2**20, "method: heads": 2**20, "scene: vertices": 2**19, "harness: target": 2**20}
    cell = make_cell(method="abuffer") | {"memory_bytes": {"total": sum(buffers.values()), "buffers": buffers,
                                                          "method": 4 * 2**20}}
    write_cell(tmp_path, cell)
    figure = drawn(stacks.draw_memory, section_of(tmp_path), 0)
    axes, = figure.axes
    assert ends(axes)[0] == pytest.approx(5.5)
    assert notes(axes) == ["5.50 MiB: nodes 75 %"]
    assert {t.get_text() for t in figure.legends[0].get_texts()} == {"nodes", "heads", "the scene", "the harness"}


def test_the_largest_buffer_of_every_method_has_a_colour_of_its_own(tmp_path):
    big = {f"method: b{i}": 2**30 - i for i in range(9)}
    for method, buffers in (("large", big), ("small", {"method: mine": 5})):
        write_cell(tmp_path, make_cell(method=method) | {
            "memory_bytes": {"total": sum(buffers.values()), "buffers": buffers}})
    figure = drawn(stacks.draw_memory, section_of(tmp_path), 0)
    names = {t.get_text() for t in figure.legends[0].get_texts()}
    assert "mine" in names and "3 smaller buffers" in names and len(names) == 8


def test_variants_that_take_the_same_memory_are_drawn_once(tmp_path):
    for tile in (8, 16):
        write_cell(tmp_path, make_cell(method="lucid", parameters={"tile": tile}))
    assert len(ends(drawn(stacks.draw_memory, section_of(tmp_path), 0).axes[0])) == 1


def test_one_bar_far_off_does_not_crush_the_others(tmp_path):
    for number, size in enumerate((1, 2, 3, 4, 5, 900)):
        write_cell(tmp_path, make_cell(method=f"m{number}") | {
            "memory_bytes": {"total": size * 2**20, "buffers": {"method: nodes": size * 2**20}}})
    axes = drawn(stacks.draw_memory, section_of(tmp_path), 0).axes[0]
    assert axes.get_xlim()[1] < 20
    assert notes(axes)[-1] == "900 MiB: nodes 100 % →"


@pytest.mark.parametrize("draw, pages", [(stacks.draw_stages, stacks.stage_pages),
                                         (stacks.draw_memory, stacks.memory_pages)])
def test_pages_fit_and_labels_do_not_overlap(tmp_path, draw, pages):
    section = section_of(make_results(tmp_path, 6, 12))
    assert pages(section) > 1
    for page in range(pages(section)):
        figure = drawn(draw, section, page)
        assert figure.get_figheight() <= TALLEST
        for axes in figure.axes:
            boxes = [t.get_window_extent().padded(-1) for t in axes.get_yticklabels()]
            assert not any(one.overlaps(two) for one, two in itertools.combinations(boxes, 2))


def test_a_setting_of_many_cells_is_taken_apart(tmp_path):
    for number in range(120):
        write_cell(tmp_path, make_cell(method="lucid", parameters={"n": number}), image=False)
    section = section_of(tmp_path)
    assert stacks.stage_pages(section) == 3
    assert sum(len(ends(drawn(stacks.draw_stages, section, page).axes[0])) for page in range(3)) == 120


def test_nothing_from_nothing(tmp_path):
    cell = make_cell() | {"memory_bytes": {"total": 0, "buffers": {}}}
    cell["gpu_ms"]["stages"] = {}
    write_cell(tmp_path, cell)
    section = section_of(tmp_path)
    assert stacks.stage_pages(section) == stacks.memory_pages(section) == 0
    assert stacks.draw_stages(section, 0) is None and stacks.draw_memory(section, 0) is None


def test_notes_have_room_right_of_their_bars_and_bars_most_of_the_panel(tmp_path):
    for method, size in (("a", 2**20), ("b", 60 * 2**20)):
        cell = make_cell(method=method)
        cell["memory_bytes"] = {"total": size, "buffers": {"a buffer with a long name": size}}
        write_cell(tmp_path, cell)
    axes, = drawn(stacks.draw_memory, section_of(tmp_path), 0).axes
    right = axes.get_window_extent().x1
    assert len(axes.texts) == 2 and all(text.get_window_extent().x1 <= right for text in axes.texts)
    assert axes.get_xlim()[1] < 60 / 0.55
