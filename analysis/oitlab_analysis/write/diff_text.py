"""What `oitlab diff` found, as text for the terminal and as Markdown."""

from __future__ import annotations

import textwrap
from collections import Counter
from pathlib import Path

from .. import formats
from ..compare.device_notes import NOTED, note_of
from ..compare.diff import Change, Diff
from .table import TERMINAL_WIDTH, markdown_text, terminal_warnings


def summary(changes: list[Change]) -> str:
    counts = Counter(change.verdict for change in changes)
    parts = [f"{counts.get(word, 0)} {word}" for word in ("faster", "slower", "same", "ambiguous")]
    images = sum(change.image_changed for change in changes)
    return (f"{formats.counted(len(changes), 'cell')} in both: {', '.join(parts)}; "
            + ("all images are the same." if not images else "1 image differs." if images == 1
               else f"{images} images differ."))


def _row(change: Change) -> list[str]:
    relative = formats.NOTHING
    if change.against_blend:
        ratio, interval = change.against_blend
        relative = formats.with_interval(ratio, *(interval or (None, None)), change.blocks)
        relative += NOTED if note_of(change.cell["device"]["name"], "blend", change.blend_source) else ""
    notes = []
    if change.image_changed:
        before, after = (formats.number(error) for error in change.error)
        notes.append("image differs" + (f", RMSE {before} to {after}" if before != after else ""))
    if line := change.shaders.line():
        notes.append(line)
    ratio = formats.with_interval(change.ratio, *(change.interval or (None, None)), change.blocks)
    return [change.label, ratio, change.verdict, relative, change.blend_verdict, "; ".join(notes)]


HEAD = ["cell", "B / A [95%]", "verdict", "against blend [95%]", "verdict", "what changed"]


def _against(changes: list[Change]) -> str:
    """What "against blend" is against, as a line; "" where no cell has that."""
    sources = sorted({change.blend_source for change in changes} - {""})
    return f"against blend: {' or '.join(f'blend source={source}' for source in sources)}" if sources else ""


def _by_device(changes: list[Change]) -> dict[str, list[Change]]:
    found: dict[str, list[Change]] = {}
    for change in changes:
        found.setdefault(change.cell["device"]["name"], []).append(change)
    return found


def terminal(result: Diff, details: bool = False) -> str:
    """Blocks of at most 100 characters a line: what changed first. `details` names the shaders."""
    lines, against = [], _against(result.changes)
    for device, changes in _by_device(result.changes).items():
        lines += filter(None, [device, against])
        lines.append(f"{HEAD[1]:>23}  {HEAD[2]:<9}  {HEAD[3]:>23}  {HEAD[4]:<9}")
        for change in changes:
            name, ratio, word, relative, relative_word, notes = _row(change)
            lines += textwrap.wrap(name, TERMINAL_WIDTH, subsequent_indent="  ")
            lines.append(f"{ratio:>23}  {word:<9}  {relative:>23}  {relative_word:<9}".rstrip())
            if notes:
                lines += textwrap.wrap(notes, TERMINAL_WIDTH, initial_indent="    ",
                                       subsequent_indent="    ")
            for text in change.shaders.details() if details else ():
                lines += textwrap.wrap(text, TERMINAL_WIDTH, initial_indent="      ",
                                       subsequent_indent="        ", break_on_hyphens=False)
        lines.append("")
    return "\n".join(lines) + terminal_warnings(result.warnings) + summary(result.changes)


def markdown(result: Diff, folders: tuple[Path, Path]) -> str:
    """The same as a table."""
    lines = [f"# {markdown_text(str(folders[1]))} (B) against {markdown_text(str(folders[0]))} (A)", "",
             summary(result.changes), ""]
    if against := _against(result.changes):
        lines += [markdown_text(against), ""]
    lines += [f"> **Warning.** {markdown_text(w)}\n" for w in result.warnings]
    for device, changes in _by_device(result.changes).items():
        lines += [f"## {markdown_text(device)}", "", f"| {' | '.join(HEAD)} |",
                  "|---|---:|---|---:|---|---|"]
        lines += [f"| {' | '.join(markdown_text(text) for text in _row(change))} |"
                  for change in changes]
        lines.append("")
    return "\n".join(lines)
