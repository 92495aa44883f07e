"""Where cells lie: results folders, packs, and folders of either."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from .limits import NotACell
from .packs import PACK_SUFFIX, read_bytes, read_pack

HINT = "run an experiment first, for example: oitlab run experiments/quickstart.toml"


class BadResults(Exception):
    """The given results can't be used; the message is one line for the user."""


def sources_in(paths: list[Path]) -> list[Path]:
    """The results folders and packs that the paths name: a folder of packs stands for each of them,
    any other folder for those right inside it. A path without any is itself in the list, so that
    reading it says what is wrong."""
    found = []
    for path in paths:
        if not path.is_dir() or (path / "cells").is_dir():
            found.append(path)
        elif packs := sorted(path.glob("*" + PACK_SUFFIX)):
            found += packs
        else:
            inside = sorted(folder for folder in path.iterdir() if folder.is_dir())
            found += [source for source in sources_in(inside) if _is_source(source)] or [path]
    return found


def _is_source(path: Path) -> bool:
    return path.is_file() or (path / "cells").is_dir()


def documents(source: Path) -> Iterator[tuple[str, bytes | dict | NotACell]]:
    """The name and content of all that may be a cell in a results folder or a pack; NotACell where
    it cannot be read. Raises BadResults."""
    if not source.exists():
        raise BadResults(f"{source}: no such folder; {HINT}")
    if source.is_file() or not source.is_dir():  # a device or a pipe is read by nobody
        if not source.is_file():
            raise BadResults(f"{source}: neither a file nor a folder")
        if not source.name.endswith((".json", PACK_SUFFIX)):
            raise BadResults(f"{source}: neither a results folder nor a pack (*{PACK_SUFFIX}); {HINT}")
        yield from _packed(source)
        return
    if not (source / "cells").is_dir():
        raise BadResults(f"{source}: not a results folder (it has no folder cells, and no "
                         f"*{PACK_SUFFIX}); {HINT}")
    for path in sorted((source / "cells").iterdir()):
        try:
            yield path.name, read_bytes(path)
        except NotACell as error:
            yield path.name, error


def _packed(pack: Path) -> Iterator[tuple[str, bytes | dict | NotACell]]:
    try:
        for index, content in enumerate(read_pack(pack)):
            yield f"{pack.name}, cell {index + 1}", content
    except NotACell as error:
        yield pack.name, error
