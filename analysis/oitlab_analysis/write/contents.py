"""What a report says, whatever it is written as: page, Markdown or text."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from pathlib import Path

import pandas

from ..compare.labels import parameter_text, parameters_of, records
from ..compare.sections import Section
from ..draw.style import Chart
from ..formats import counted
from .table import describe

MOST_COMMANDS = 20  # beyond these a count says enough


@dataclass(frozen=True)
class Report:
    """All that is written of some cells.

    `sources` says from which folder or pack each cell is, by its key; `charts` has a list for each
    section. The files of the report lie in `folder`.
    """

    folder: Path
    sources: dict[str, Path]
    sections: list[Section]
    charts: list[list[Chart]]
    table: pandas.DataFrame
    clock: str  # one line on the clock of the device, or ""
    notes: list[str]
    command: str  # that makes this report
    more: str = ""  # how many charts were left out, and how to see them

    @property
    def title(self) -> str:
        experiments = dict.fromkeys(section.context["Experiment"] for section in self.sections)
        return "oitlab: " + ", ".join(experiments)


def command_of(paths: list[Path], out: Path | None) -> str:
    """The command that makes a report of these paths."""
    return shlex.join(["oitlab", "report", *map(str, paths), *(["--out", str(out)] if out else [])])


def summary(table: pandas.DataFrame) -> str:
    """`12 cells: 11 measured, 1 failed, 0 skipped`."""
    counts = table["status"].value_counts()
    parts = [f"{counts.get(status, 0)} {word}" for status, word in
             (("ok", "measured"), ("failed", "failed"), ("skipped", "skipped"))]
    return f"{counted(len(table), 'cell')}: {', '.join(parts)}"


def all_parameters(section: Section) -> dict[str, str]:
    """Every method of a section, by its label in the tables, with all its parameters."""
    rows = records(section.table.drop_duplicates("label"))
    return {row["label"]: parameter_text(parameters_of(row)) or "none" for row in rows}


def place(row: dict) -> str:
    return f"{row['scene_label']} · {row['view']} · {row['size_label']}"


def unmeasured(section: Section) -> list[dict[str, str]]:
    """Failed and skipped cells, with what is needed to find them."""
    rows = section.table[section.table["status"] != "ok"]
    return [{"status": row["status"], "cell": row["id"], "label": row["label"], "setting": place(row),
             "reason": describe(row)["reason"]}
            for row in records(rows.sort_values("status", kind="stable"))]


def commands(report: Report, section: Section) -> list[str]:
    """The commands that were run, and the one that makes the report."""
    shown = section.commands[:MOST_COMMANDS]
    if len(section.commands) > MOST_COMMANDS:
        shown.append(f"# and {len(section.commands) - MOST_COMMANDS} more: column command of cells.csv")
    return [*shown, report.command]
