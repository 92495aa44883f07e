"""What may be read at all: files come from elsewhere, and a megabyte can unpack to a gigabyte.

With these limits `report`, `diff` and `paper` stay under 2 GB and 30 s on any input of 1 MB. They lie
well above what is measured: a cell holds about a thousand numbers, the published packs 20 times their
compressed size, and 62 columns of one experiment.
"""

from __future__ import annotations

import json
import re

LARGEST = 1 << 30  # bytes of a file, unpacked
# Bytes that a file may unpack to, over those it has: DEFLATE can do 1000, measured cells 20.
MOST_UNPACKED, SMALL = 100, 16 << 20
MOST_VALUES = 12_000_000  # numbers and texts of one file: 32 bytes each in Python
MOST_CONTAINERS = 1_000_000  # objects and lists of one file: 64 bytes and more each
DEEPEST = 60  # containers within one another; a cell has 5
LONGEST_TEXT = 8192  # characters; a command line
LONGEST_NAME = 300  # a scene, a method, a stage: what tables and charts show
MOST_CELLS = 10_000  # in packs that are read together
MOST_NAMES = 1000  # parameters, stages, counters, buffers: columns of one table
LONG_INTEGER = re.compile(rb"[0-9]{19}")


class NotACell(Exception):
    """One file is not a whole cell; the message says what was found and what was wanted."""


def most_unpacked(size: int) -> int:
    """How many bytes a compressed file of this size may unpack to."""
    return min(LARGEST, max(SMALL, MOST_UNPACKED * size))


def parse(content: bytes) -> object:
    """A JSON document of bounded size and depth, without NaN and numbers of more than 64 bits. Raises
    NotACell."""
    values, containers = content.count(b","), content.count(b"{") + content.count(b"[")
    if values > MOST_VALUES or containers > MOST_CONTAINERS:
        raise NotACell(f"not JSON that a cell can hold: {values} commas and {containers} brackets; at most "
                       f"{MOST_VALUES} and {MOST_CONTAINERS}")
    try:
        # Checking every whole number is slow, and few files hold one that could be too long.
        limits = {"parse_int": _int_of_64_bits} if LONG_INTEGER.search(content) else {}
        document = json.loads(content.decode("utf-8"), parse_constant=_refuse_constant, **limits)
    except RecursionError as error:
        raise NotACell("not JSON that a cell can hold: nested too deeply") from error
    except ValueError as error:  # bad JSON or bad UTF-8
        raise NotACell(f"half-written or not JSON: {error}") from error
    return document


def check_shape(value: object, depth: int = 0) -> None:
    """Refuses a cell with texts or names that are too long, or nested too deeply. Raises NotACell."""
    if depth > DEEPEST:
        raise NotACell("nested too deeply")
    if isinstance(value, str):
        if len(value) > LONGEST_TEXT:
            raise NotACell(f"a text of {len(value)} characters, at most {LONGEST_TEXT}")
    elif isinstance(value, dict):
        for name, child in value.items():
            if len(name) > LONGEST_TEXT:
                raise NotACell(f"a name of {len(name)} characters, at most {LONGEST_TEXT}")
            check_shape(child, depth + 1)
    elif isinstance(value, list) and value and isinstance(value[0], (dict, list)):
        for child in value:
            check_shape(child, depth + 1)


class Budget:
    """What all cells that are read together may take."""

    def __init__(self) -> None:
        self.packed = 0
        self._names: set[str] = set()

    def spend(self, cell: dict, packed: bool) -> None:
        """Counts a cell. Raises NotACell where there is no room for it."""
        self.packed += packed
        if self.packed > MOST_CELLS:
            raise NotACell(f"beyond the first {MOST_CELLS} cells in packs")
        names = {f"{family}.{name}" for family, of in _families(cell) for name in of}
        if any(len(name) > LONGEST_NAME for name in names):
            raise NotACell(f"a parameter, stage, counter or buffer with a name of more than {LONGEST_NAME} characters")
        if len(self._names | names) > MOST_NAMES:
            raise NotACell(f"with it, parameters, stages, counters and buffers would have more than {MOST_NAMES} names")
        self._names |= names


def _families(cell: dict) -> list[tuple[str, dict]]:
    found = [("param", cell["parameters"]), ("quality", cell.get("quality")), ("counter", cell.get("counters")),
             ("stage", cell.get("gpu_ms", {}).get("stages")), ("memory", cell.get("memory_bytes", {}).get("buffers")),
             ("stop", cell.get("stop"))]
    return [(family, of) for family, of in found if isinstance(of, dict)]


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not a JSON number")


def _int_of_64_bits(digits: str) -> int:
    value = int(digits)
    if abs(value) >= 2**64:
        raise ValueError("a whole number of more than 64 bits")
    return value
