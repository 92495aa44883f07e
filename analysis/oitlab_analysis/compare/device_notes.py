"""What readers must know of ratios that were taken on certain devices (device_notes.toml)."""

from __future__ import annotations

import functools
import tomllib
from pathlib import Path

from .fragment_source import HARDWARE

NOTED = " ‡"  # beside a ratio that a note qualifies
FILE = Path(__file__).parent / "device_notes.toml"


@functools.cache
def notes() -> list[dict]:
    return tomllib.loads(FILE.read_text(encoding="utf-8"))["note"]


def note_of(device: str, baseline: str, source: str = HARDWARE) -> str:
    """The note on ratios to the method `baseline`, with fragments of this source, on this device, or ""."""
    return " ".join(
        note["text"] for note in notes()
        if device.startswith(note["device"]) and baseline in note["baselines"]
        and source == note["source"]
    )
