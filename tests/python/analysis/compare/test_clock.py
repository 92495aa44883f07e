"""Times that were taken while the device ran slower than it can: what counts as such, and that the
report leaves out such stages and says so; what it says of the clock that cells recorded."""

import json
import re

import pytest
from oitlab_analysis.compare import clock
from oitlab_analysis.compare.sections import add_comparisons, make_sections
from oitlab_analysis.compare.tidy import as_table
from oitlab_analysis.draw import stacks
from oitlab_analysis.read.cells import collect
from oitlab_analysis.write.report import make_report
from synthetic import make_cell, with_slow_blocks, with_slow_stages, without_measurement, write_cell


def even_cell(stage_share=1.05):
    """Every frame takes 2 ms."""
    cell = make_cell(frame_ms=2.0, blocks=6, frames=3)
    cell["samples"]["frame_ms"] = [2.0] * 18
    cell = with_slow_blocks(cell, 0)
    cell["gpu_ms"]["stages"] = {"a": 2 * stage_share / 4, "b": 2 * stage_share * 3 / 4}
    return cell


@pytest.mark.parametrize("share, slow", [(0.9, False), (1.05, False), (1.24, False), (1.26, True), (5, True)])
def test_stages_are_held_against_the_frame(share, slow):
    assert clock.stages_are_slow(even_cell(share)) == slow


def test_stages_are_held_against_the_quickest_block():
    """Where most frames were slow too, the median would let slow stages pass."""
    cell = with_slow_blocks(even_cell(3.1), 5)
    assert cell["statistics"]["frame"]["median"] == 6.0
    assert clock.stages_are_slow(cell)
    assert not clock.stages_are_slow(with_slow_blocks(even_cell(1.05), 5)), "these are of the full clock"


@pytest.mark.parametrize("blocks, factor, slow", [(0, 3, False), (2, 3, False), (4, 1.24, False),
                                                  (4, 1.5, True), (4, 3, True)])
def test_frames_are_slow_where_half_of_the_blocks_are(blocks, factor, slow):
    assert clock.frames_are_slow(with_slow_blocks(even_cell(), blocks, factor)) == slow


def test_frames_are_slow_where_their_stages_take_far_less():
    assert clock.frames_are_slow(with_slow_blocks(even_cell(), 6, 3)), "no block is quick"
    cell = even_cell()
    cell["gpu_ms"]["stages"] = {}
    assert not clock.frames_are_slow(cell) and not clock.stages_are_slow(cell)


def test_the_notes_count():
    cells = [even_cell(), even_cell(2), with_slow_blocks(even_cell(), 4)]
    assert "Stage times of 1 of 3 cells were left out" in clock.stage_note(cells)
    assert "The median frame of 1 of 3 cells" in clock.frame_note(cells)
    assert clock.stage_note(cells[:1]) == clock.frame_note(cells[:1]) == ""


def test_the_report_leaves_slow_stages_out_and_says_so(tmp_path):
    write_cell(tmp_path, with_slow_stages(make_cell("boxes")))
    write_cell(tmp_path, with_slow_blocks(make_cell("teapot"), 8))
    write_cell(tmp_path, without_measurement(make_cell("hairball"), "failed", "device lost"))
    collection = collect(tmp_path)
    table = as_table(collection.cells).set_index("scene")
    assert dict(table["stages_left_out"]) == {"boxes": True, "hairball": False, "teapot": False}
    assert dict(table["stage.opaque_ms"].notna()) == {"boxes": False, "hairball": False, "teapot": True}
    section, = make_sections(collection.cells, add_comparisons(as_table(collection.cells), collection.cells))
    figure = stacks.draw_stages(section, 0)
    assert len(figure.axes) == 1, "a panel for teapot alone"
    said = " ".join(make_report([tmp_path], all_warnings=True).text.split())
    assert "Stage times of 1 of 2 cells were left out" in said and "The median frame of 1 of 2 cells" in said


def with_clock(cell, rejected=0, unsettled=0, settled=True):
    return cell | {"clock": {"rejected_blocks": rejected, "unsettled_blocks": unsettled, "settled": settled}}


@pytest.mark.parametrize("record, line", [
    ((0, 0, True), ""),
    ((1, 0, True), "1 block left out because the clock moved meanwhile"),
    ((0, 0, False), "stages timed below full clock, or while it moved"),
    ((3, 2, False), "3 blocks left out because the clock moved meanwhile; "
                    "2 blocks kept although steadily below full clock"),
])
def test_a_line_says_what_the_clock_did(record, line):
    said = clock.clock_line(with_clock(make_cell(), *record))
    assert said == (line and line + " (docs/measuring.md, At full clock)")


def test_the_report_shows_the_clock_of_cells_that_recorded_it(tmp_path):
    def texts():
        terminal = " ".join(make_report([tmp_path], all_warnings=True).text.split())
        return terminal, *((tmp_path / f"report.{kind}").read_text(encoding="utf-8") for kind in ("html", "md"))

    write_cell(tmp_path, make_cell("city"))  # made before the clock was recorded
    assert not any("full clock" in text or "§" in text for text in texts())
    write_cell(tmp_path, with_clock(make_cell("boxes")))
    write_cell(tmp_path, with_clock(make_cell("teapot"), rejected=3))
    write_cell(tmp_path, with_clock(make_cell("tree"), unsettled=2, settled=False))
    write_cell(tmp_path, make_cell("pipes") | {"clock": {"settled": True}})
    terminal, html, markdown = texts()
    assert "1 file was left out" in terminal and "/clock/rejected_blocks: missing" in terminal
    for text in (terminal, html, markdown):
        assert "settled, at full, in 2 of the 3 cells that recorded it; 3 blocks measured again" in text
    rows = json.loads(re.search(r'class="rows">(.*?)</script>', html)[1])["rows"]
    marked = [json.dumps(row) for row in rows if row["frame"].endswith(" §")]
    listed = [line for line in markdown.splitlines() if line.startswith("- ") and "At full clock" in line]
    for teapot, tree in (marked, listed):
        assert "teapot" in teapot and "3 blocks left out" in teapot
        assert "tree" in tree and "2 blocks kept" in tree
