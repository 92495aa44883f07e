"""Which times of a cell were taken while the device ran slower than it can.

A GPU that has idled runs what comes next at a lower clock, several times slower, until it has caught
up. The stages come from a run of their own, so that this may befall them and not the frames, or the
other way round; and it may befall some blocks of frames and not others.

The device's own speed is taken to be that of the quickest block of frames. Frames with timers
between the stages cost a few per cent more, for the barriers that part the stages, and blocks of
one clock lie within a few per cent of each other: SLOWER stands well above both, and below the steps
of the clock that were seen, of which the least is about 1.5.

Newer cells recorded the clock itself too (`clock`, docs/measuring.md): clock_line() and clock_summary()
put that into words.
"""

from __future__ import annotations

from .statistics import block_medians

SLOWER = 1.25


def quickest_block_ms(cell: dict) -> float:
    """The least median of a block of frames, in ms."""
    return min(block_medians(cell["samples"]["frame_ms"], cell["samples"]["block"]).values())


def stages_are_slow(cell: dict) -> bool:
    """Whether the stages together take so much longer than a frame that they say nothing of it."""
    return sum(cell["gpu_ms"]["stages"].values()) > SLOWER * quickest_block_ms(cell)


def frames_are_slow(cell: dict) -> bool:
    """Whether half of the frames or more took much longer than the quickest block, or than all the
    stages together, which cover the frame."""
    stages = sum(cell["gpu_ms"]["stages"].values())
    quickest = quickest_block_ms(cell)
    return cell["statistics"]["frame"]["median"] > SLOWER * min(quickest, stages or quickest)


def stage_note(cells: list[dict]) -> str:
    """How many cells of these have no stage times for it, and why; empty where none."""
    slow, counted = sum(map(stages_are_slow, cells)), len(cells)
    return (f"Stage times of {slow} of {counted} cells were left out: with timers between the stages these "
            f"took more than {SLOWER} times as long as the quickest block of frames, since the device was slower "
            "in that run, as a GPU that has idled is, at a lower clock. Remove these cells and run "
            "again.") if slow else ""


def frame_note(cells: list[dict]) -> str:
    """How many cells of these have a median frame that is not of the quickest clock; empty where none."""
    slow, counted = sum(map(frames_are_slow, cells)), len(cells)
    return (f"The median frame of {slow} of {counted} cells is more than {SLOWER} times their quickest block of "
            "frames, or their stages together: the device was slower, as a GPU is at a lower clock, in half of their "
            "blocks or more. "
            "Ratios are of blocks measured in turn, which cancels most of it, not all.") if slow else ""


def clock_line(cell: dict) -> str:
    """What the cell's own record of the clock says against its times; empty where nothing, or no record."""
    record = cell.get("clock")
    if not record:
        return ""
    said = []
    if record["rejected_blocks"]:
        said.append(f"{_blocks(record['rejected_blocks'])} left out because the clock moved meanwhile")
    if record["unsettled_blocks"]:
        said.append(f"{_blocks(record['unsettled_blocks'])} kept although steadily below full clock")
    elif not record["settled"]:  # all kept blocks were, so the stages were not
        said.append("stages timed below full clock, or while it moved")
    return f"{'; '.join(said)} (docs/measuring.md, At full clock)" if said else ""


def clock_summary(cells: list[dict]) -> str:
    """One line on all cells that recorded the clock; empty where none did."""
    records = [cell["clock"] for cell in cells if cell.get("clock")]
    if not records:
        return ""
    settled = sum(record["settled"] for record in records)
    rejected = sum(record["rejected_blocks"] for record in records)
    # Not each of them for certain: they count towards the limits of a cell.
    again = (f"{_blocks(rejected)} measured again, as far as limits allowed, because it had moved"
             if rejected else "no block measured again")
    return (f"The GPU's clock was settled, at full, in {settled} of the {len(records)} cells that recorded it; "
            f"{again} (docs/measuring.md, At full clock).")


def _blocks(count: int) -> str:
    return "1 block" if count == 1 else f"{count} blocks"
