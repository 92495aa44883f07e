"""The papers' own figures, from paper/published/*.csv; every row names its source."""

from __future__ import annotations

import csv
from pathlib import Path

PUBLISHED = Path(__file__).resolve().parents[3] / "paper" / "published"

# The generated scenes that stand in for those of the papers (docs/scenes.md).
STAND_INS = {
    "Boxes": "boxes", "Bunny": "bunny", "Conference": "conference", "Dragon": "dragon",
    "Gallery": "gallery", "Hairball": "hairball", "Powerplant": "powerplant",
    "San miguel": "sanmiguel", "Scrub pine": "scrubpine", "Sponza": "sponza_like",
    "Teapot": "teapot", "White oak": "whiteoak",
    # of the BMA paper
    "Atrium": "sponza_like", "Smoke": "smoke", "Power Plant": "powerplant",
}


def read(name: str) -> list[dict[str, str]]:
    """The rows of paper/published/NAME.csv."""
    with open(PUBLISHED / f"{name}.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def number(text: str) -> float | None:
    """A published figure; None where there is none, or only a bound such as `<0.01`."""
    try:
        return float(text)
    except ValueError:
        return None
