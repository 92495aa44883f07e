"""Collects the cells of results folders and packs.

A results folder may be shared by running processes and may hold files of other origin, so whatever
is not a whole cell of a known schema is named and counted, and never stops the report.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from ..formats import one_line
from .checks import cell_of, check_samples
from .limits import Budget, NotACell
from .packs import read_bytes
from .sources import HINT, BadResults, documents, sources_in


@dataclass(frozen=True)
class Problem:
    """A file that was left out of the report."""

    file: str
    reason: str


@dataclass(frozen=True)
class Collection:
    """What the sources hold: the cells as JSON, by their key, and the files left out.

    Of the samples of a cell only those of the whole frame are kept, as arrays. `sources` says from
    which folder or pack each cell is. `repeated` counts cells that several sources hold alike.
    """

    cells: dict[str, dict]
    sources: dict[str, Path]
    problems: list[Problem]
    repeated: int = 0


def collect(*paths: Path) -> Collection:
    """Reads every cell of results folders, packs, and folders of either.

    A cell is known by its experiment and id: experiments that share a setting share ids. What
    several sources hold alike counts once; other versions of a cell are cells of their own.
    Raises BadResults if there is no cell.
    """
    cells: dict[str, dict] = {}
    sources: dict[str, Path] = {}
    problems: list[Problem] = []
    seen: set[str] = set()
    repeated, budget = 0, Budget()
    found = sources_in(list(paths))
    for source in found:
        own: set[tuple[str, str]] = set()
        for name, content in documents(source):
            try:
                if isinstance(content, NotACell):
                    raise content
                cell = check_samples(cell_of(content))
                identity = cell["experiment"], cell["id"]
                if identity in own:
                    raise NotACell(f"its id {cell['id']} is that of another file of this experiment")
                budget.spend(cell, packed=source.is_file())
            except NotACell as error:
                problems.append(Problem(name, one_line(str(error))))
                continue
            own.add(identity)
            if (text := fingerprint(cell)) in seen:
                repeated += 1
                continue
            seen.add(text)
            key = free_key("/".join(identity), cells)
            cells[key], sources[key] = cell, source
    if not cells:
        raise BadResults(f"{_nothing_in(found, problems)}; {HINT}")
    return Collection(cells, sources, problems, repeated)


def fingerprint(cell: dict) -> str:
    """Equal for two copies of one measurement, and for nothing else."""
    times = cell.get("samples", {}).get("frame_ms")
    return json.dumps([cell["experiment"], cell["id"], cell["group"], cell["provenance"].get("date"),
                       cell["provenance"]["commit"], cell["status"],
                       None if times is None else list(times[:8])])


def free_key(name: str, taken: dict) -> str:
    """The name, numbered where it is taken."""
    key, number = name, 1
    while key in taken:
        number += 1
        key = f"{name} ({number})"
    return key


def _nothing_in(sources: list[Path], problems: list[Problem]) -> str:
    where = ", ".join(str(source / "cells" if source.is_dir() else source) for source in sources[:3])
    where += ", ..." if len(sources) > 3 else ""
    if not problems:
        return f"{where} is empty"
    first = problems[0]
    files = "" if len(problems) == 1 else f" in {len(problems)} files"
    return f"{where} has no whole cell{files}; {first.file}: {first.reason}"


def read_cell(path: Path) -> dict:
    """One file, checked. Raises NotACell."""
    return check_samples(cell_of(read_bytes(path)))


MOST_NAMED = 20  # files: beyond these a count says enough


def left_out(problems: list[Problem]) -> list[str]:
    """What is said of the files that were left out: how many, and the first of them by name."""
    if not problems:
        return []
    named = [f"{one_line(p.file)}: {p.reason}" for p in problems[:MOST_NAMED]]
    if len(problems) > MOST_NAMED:
        named.append(f"and {len(problems) - MOST_NAMED} more")
    files = "file was" if len(problems) == 1 else "files were"
    return [f"{len(problems)} {files} left out: {'; '.join(named)}."]
