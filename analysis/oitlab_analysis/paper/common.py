"""What all tables need: columns in pairs, the context that fills most rows, the notes under a table."""

from __future__ import annotations

import statistics
from collections.abc import Callable

from ..compare import clock
from ..compare.device_notes import NOTED, note_of
from ..compare.statistics import FEWEST_BLOCKS
from ..compare.tidy import block_count
from .agreement import Pairs
from .measured import Context, Measurements, choose
from .paired_table import SLOW, Column, Number
from .published import number


def short(device: str) -> str:
    """`llvmpipe` for `llvmpipe (LLVM 15.0.6, 256 bits)`: a head of a column has little room."""
    return device.split(" (")[0].removeprefix("NVIDIA ").removeprefix("NVidia ")


def size_of(text: str) -> tuple[int, int]:
    width, height = text.split("x")
    return int(width), int(height)


def frame_ms(cell: dict) -> Number:
    return _frame(cell, 1)


def frame_us(cell: dict) -> Number:
    return _frame(cell, 1000)


def _frame(cell: dict, scale: float) -> Number:
    """The median; marked and with its interval where it is not of the quickest clock."""
    frame = cell["statistics"]["frame"]
    if not clock.frames_are_slow(cell):
        return Number(scale * frame["median"])
    low, high = frame.get("ci95") or (None, None)
    if low is None or block_count(cell) < FEWEST_BLOCKS:
        return Number(scale * frame["median"], mark=SLOW)
    return Number(scale * frame["median"], scale * low, scale * high, mark=SLOW)


def stages_us(cell: dict, stages: tuple[str, ...]) -> dict[str, Number | str]:
    """Those of the stages that the cell has; a mark instead of times of a lower clock."""
    times = cell["gpu_ms"]["stages"]
    slow = clock.stages_are_slow(cell)
    return {stage: SLOW if slow else Number(1000 * times[stage]) for stage in stages if stage in times}


def clock_notes(timed: list[dict], staged: list[dict] = ()) -> list[str]:
    """What is said of times taken at a lower clock: of frames, and of stages."""
    timed = list({id(cell): cell for cell in timed}.values())  # a base may serve many rows
    return [f"{SLOW} {note}" for note in (clock.frame_note(timed), clock.stage_note(list(staged))) if note]


def mean_row(rows: list[dict], keys: list[str], label: str) -> dict:
    """The arithmetic means, as the paper has them; only over rows that have the figure."""
    means = {"scene": label}
    for key in keys:
        values = [row[key].value for row in rows if row.get(key)]
        if values:
            means[key] = Number(statistics.fmean(values))
    return means


def pairs_of(rows: list[dict], key: str, scale: float = 1) -> Pairs:
    """Published beside measured, for the rules of agreement; without times of a lower clock."""
    return {row["scene"]: (row[f"p.{key}"].value if row.get(f"p.{key}") else None,
                           row[f"m.{key}"].value * scale
                           if row.get(f"m.{key}") and not row[f"m.{key}"].mark else None)
            for row in rows}


def published(text: str) -> Number | str | None:
    """As printed; a bound such as `<0.01` stays a text."""
    value = number(text)
    return (text or None) if value is None else Number(value, printed=text)


# To hardware blending, which some devices do not do as others do (device_notes.toml).
RATIOS = ("sw_hw", "repaired", "off_hw", "on_hw", "relative")


def columns(metrics: list[tuple[str, str]], paper_device: str, device: str,
            only_measured: tuple[str, ...] = ()) -> list[Column]:
    """Published and measured side by side for each metric."""
    result = []
    noted = NOTED if note_of(device, "blend") else ""
    for key, name in metrics:
        if key not in only_measured:
            result.append(Column(f"p.{key}", name, paper_device))
        result.append(Column(f"m.{key}", name + (noted if key in RATIOS else ""),
                             f"{short(device)} (measured)"))
    return result


def conditions(cells: list[dict]) -> str:
    """`320×166, detail 0.005 to 1, profile cpu, 12 scenes`: what the cells of a table have in common."""
    sizes = sorted({tuple(c["size"]) for c in cells})
    details = sorted({c["scene"].get("detail") or 1 for c in cells})
    parts = [" and ".join(f"{w}×{h}" for w, h in sizes)]
    if details != [1]:
        parts.append(f"detail {details[0]:g}" + (f" to {details[-1]:g}" if len(details) > 1 else ""))
    parts.append(" and ".join(sorted({c["format"] for c in cells})))
    profiles = sorted({c.get("profile") or "full" for c in cells})
    return ", ".join([*parts, f"profile {' and '.join(profiles)}"])


def is_full_size(cells: list[dict], size: str) -> bool:
    """Whether all cells are of the published size and of whole scenes, so that counts compare."""
    return all(tuple(c["size"]) == size_of(size) and (c["scene"].get("detail") or 1) == 1
               for c in cells)


def general_notes(context: Context, used: list[dict], others: int, size: str) -> list[str]:
    """What holds for every table."""
    notes = []
    if not is_full_size(used, size):
        notes.append(f"The paper's figures are for {size.replace('x', '×')} and whole scenes: counts and times "
                     "compare by their order only.")
    if context.device_type == "cpu":
        notes.append("Measured on a CPU device: these times say nothing about GPUs.")
    if note := note_of(context.device, "blend"):
        notes.append(f"{NOTED.strip()} {note}")
    if others:
        notes.append(f"Cells of {others} other versions of the program or the driver on this device were "
                     "left out, not mixed in.")
    notes.append("The scenes are stand-ins, not the paper's meshes (docs/scenes.md).")
    return notes


def without_ratios(notes: list[str]) -> list[str]:
    """The notes of a table that has no ratio to hardware blending."""
    return [note for note in notes if not note.startswith(NOTED.strip())]


def not_in_turn(rows: list[dict], key: str, parts: tuple[str, str]) -> list[str]:
    """A note where both times are there but no ratio, because they are of different runs."""
    scenes = [row["scene"] for row in rows
              if row.get(parts[0]) and row.get(parts[1]) and not row.get(key)]
    return [f"No ratio for {', '.join(scenes)}: both times are there, but were not measured in turn. Remove "
            "these cells and run again."] if scenes else []


def build(name: str, rows_of: Callable[[Context], tuple[list[dict], list[dict]]], found: Measurements,
          device: str) -> tuple[Context | None, list[dict], list[dict], int]:
    """The context that fills most rows; its rows, the cells used, and how many other contexts
    could have filled some."""
    contexts = found.of(device)
    filled = {id(context): rows_of(context) for context in contexts}
    best = choose(contexts, lambda context: len(filled[id(context)][1]))
    if best is None:
        return None, rows_of(Context(device, "", "", "", "", False))[0], [], 0
    rows, used = filled[id(best)]
    others = sum(bool(filled[id(context)][1]) for context in contexts if context is not best)
    return best, rows, used, others


def head(context: Context | None, used: list[dict]) -> str:
    return f"{context.describe()}; {conditions(used)}" if context else "nothing yet"


def file_name(device: str) -> str:
    """`h200` for `NVIDIA H200`."""
    kept = "".join(c if c.isalnum() else "-" for c in short(device).lower())
    return "-".join(part for part in kept.split("-") if part) or "device"
