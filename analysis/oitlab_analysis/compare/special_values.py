"""Values of parameters that stand for something else than a quantity (special_values.toml): 0 layers are
all layers, and no point on a line from 1 to 16."""

from __future__ import annotations

import functools
import tomllib
from dataclasses import dataclass
from pathlib import Path

from ..formats import is_number

FILE = Path(__file__).parent / "special_values.toml"


@dataclass(frozen=True)
class Special:
    """A value and the word that says what it means."""

    value: float
    word: str

    def __str__(self) -> str:
        return self.word


@functools.cache
def special_values() -> dict[tuple[str, str], dict[float, Special]]:
    """By method and parameter: the special ones among its values."""
    listed = tomllib.loads(FILE.read_text(encoding="utf-8"))
    return {(method, parameter): {float(value): Special(float(value), word) for value, word in words.items()}
            for method, parameters in listed.items() for parameter, words in parameters.items()}


def meaning(method: str, parameter: str, value: object) -> object:
    """The Special that a value of a parameter is, or the value itself."""
    if not is_number(value):
        return value
    return special_values().get((method, parameter), {}).get(float(value), value)
