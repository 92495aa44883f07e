"""Raw cells as small files: `*.json.gz`, one cell each, or all cells of a folder in one pack.

A pack is {"schema": 1, "pack": "oitlab cells", "cells": [cell, ...]}, compressed. The cells are kept
as they are, with every sample, but for the folders in which somebody's files lay; pictures are not
packed.
"""

from __future__ import annotations

import gzip
import json
import zlib
from pathlib import Path

from .checks import cell_of
from .limits import LARGEST, MOST_CELLS, NotACell, most_unpacked, parse

PACK_SUFFIX = ".json.gz"
PACK = "oitlab cells"


def read_bytes(path: Path) -> bytes:
    """The content of a file that may be a cell, unpacked. Raises NotACell."""
    if not path.name.endswith((".json", PACK_SUFFIX)) or path.name.startswith("."):
        raise NotACell("a temporary file of a running or killed run, or a foreign one")
    try:
        size = path.stat().st_size
        most = LARGEST if path.suffix == ".json" else most_unpacked(size)
        with path.open("rb") if path.suffix == ".json" else gzip.open(path) as file:
            content = file.read(most + 1)
    except (EOFError, gzip.BadGzipFile, zlib.error) as error:
        raise NotACell(f"half-written or not compressed JSON: {error}") from error
    except OSError as error:
        raise NotACell(f"cannot be read: {error.strerror}") from error
    if len(content) > most:
        raise NotACell(f"holds more than {most >> 20} MiB, the most that a file of {size >> 10} KiB may")
    return content


def read_pack(path: Path) -> list[bytes | dict]:
    """The cells of a pack, unchecked; a compressed cell is a pack of one. Raises NotACell."""
    content = read_bytes(path)
    document = parse(content)
    if not isinstance(document, dict) or document.get("pack") != PACK:
        return [content]
    del content
    cells = document.get("cells")
    if document.get("schema") != 1 or not isinstance(cells, list):
        raise NotACell("not a pack of cells that this version can read")
    if len(cells) > MOST_CELLS:
        raise NotACell(f"a pack of {len(cells)} cells, at most {MOST_CELLS}")
    return cells


def without_folders(command: str) -> str:
    """Of absolute paths the last two parts, `experiments/bma.toml`: the rest is one machine's."""
    return " ".join("/".join(Path(word).parts[-2:]) if word.startswith("/") and len(Path(word).parts) > 3
                    else word for word in command.split(" "))


def write_pack(results: Path, target: Path) -> tuple[int, list[str]]:
    """Packs the cells of a results folder; returns how many, and what was left out and why.

    The same cells give the same file. Raises OSError.
    """
    cells, left_out = [], []
    for path in sorted((results / "cells").iterdir()):
        try:
            content = read_bytes(path)
            cell_of(content)
            cell = json.loads(content)
            if command := cell["provenance"].get("command"):
                cell["provenance"]["command"] = without_folders(command)
            cells.append(cell)
        except NotACell as error:
            left_out.append(f"{path.name}: {error}")
    if cells:
        text = json.dumps({"schema": 1, "pack": PACK, "cells": cells}, separators=(",", ":"),
                          ensure_ascii=False)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(gzip.compress(text.encode("utf-8"), mtime=0))
    return len(cells), left_out
