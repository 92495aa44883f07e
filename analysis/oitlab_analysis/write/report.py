"""Reads cells and writes report.html, report.md, cells.csv and the charts."""

from __future__ import annotations

import subprocess
import textwrap
from dataclasses import dataclass
from pathlib import Path

import pandas

from ..compare.clock import clock_summary
from ..compare.sections import add_comparisons, make_sections, mixture_warnings
from ..compare.tidy import as_table
from ..draw.charts import crowded_notes, save_charts
from ..draw.curve_lines import Curve, check
from ..read.cells import collect, left_out
from .contents import Report, command_of, summary
from .markdown import markdown_report
from .page import html_page
from .table import TERMINAL_WIDTH, terminal_table, terminal_warnings

ALL_WARNINGS = "(all: --warnings)"
NOT_WRITTEN = "Nothing was written: --out DIR says where the page, the charts and the CSV go."
FORMULA = ("=", "+", "-", "@", "\t", "\r")


@dataclass(frozen=True)
class Result:
    """What the command line shows: the table, the files written, whether some cells failed."""

    text: str
    files: list[Path]
    failed: bool


def make_report(paths: list[Path], out: Path | None = None, metric: str = "rmse",
                all_charts: bool = False, curves: tuple[Curve, ...] = (), all_warnings: bool = False) -> Result:
    """Reads all cells of the paths (see collect()) and writes the report into `out`.

    Without `out` it is written into the results folder, where the paths name exactly one, and
    nowhere otherwise: packs and folders of packs are somebody's data. `curves` are drawn besides the
    usual charts. The text folds warnings into one line, unless `all_warnings`. Raises BadResults, OSError.
    """
    collection = collect(*paths)
    table = add_comparisons(as_table(collection.cells), collection.cells)
    sections = make_sections(collection.cells, table)
    for curve in curves:
        check(sections, curve)
    notes = mixture_warnings(table) + left_out(collection.problems)
    if collection.repeated:
        notes.append("1 cell was given twice, and counts once." if collection.repeated == 1 else
                     f"{collection.repeated} cells were given twice, and count once.")
    notes += crowded_notes(sections)
    folder, command = out or own_folder(paths), command_of(paths, out)
    charts, more = [[] for _ in sections], ""
    if folder:
        folder.mkdir(parents=True, exist_ok=True)
        charts, missing = save_charts(sections, folder / "plots", metric, all_charts, curves)
        if missing:
            more = f"{missing} more charts: {command} --all-charts"
    report = Report(folder or Path(), collection.sources, sections, charts, table,
                    clock_summary(list(collection.cells.values())), notes, command, more)
    files = []
    if folder:
        files = [folder / "plots" / f"{chart.name}.png" for own in charts for chart in own
                 if chart.name.startswith("curve-")]
        files += write_files(report)
    return Result(terminal_text(report, bool(folder), all_warnings), files, bool((table["status"] == "failed").any()))


def write_files(report: Report) -> list[Path]:
    """Writes the page, the Markdown and the CSV; returns their paths."""
    files = [report.folder / name for name in ("report.html", "report.md", "cells.csv")]
    files[0].write_text(html_page(report), encoding="utf-8")
    files[1].write_text(markdown_report(report), encoding="utf-8")
    defused(report.table).to_csv(files[2], index=False)
    return files


def defused(table: pandas.DataFrame) -> pandas.DataFrame:
    """The table with an apostrophe before texts that a spreadsheet would take for formulas."""
    texts = table.select_dtypes("object").columns
    return table.assign(**{name: table[name].map(
        lambda value: f"'{value}" if isinstance(value, str) and value.startswith(FORMULA) else value)
        for name in texts})


def own_folder(paths: list[Path]) -> Path | None:
    """The results folder that the paths name, if they name one and nothing else, and git does not
    track its cells."""
    if len(paths) != 1 or not (paths[0] / "cells").is_dir():
        return None
    try:
        tracked = subprocess.run(["git", "ls-files", "cells"], cwd=paths[0], capture_output=True, check=False)
    except OSError:  # no git: nothing is tracked by it
        return paths[0]
    return None if tracked.stdout else paths[0]


def terminal_text(report: Report, written: bool, all_warnings: bool = False) -> str:
    """For each section its title, the path of its first chart, the table, and its warnings."""
    blocks = []
    for section, charts in zip(report.sections, report.charts):
        lines = textwrap.wrap(section.title, TERMINAL_WIDTH)
        if charts:
            lines.append(str(report.folder / "plots" / f"{charts[0].name}.png"))
        warnings = section.warnings + (report.notes if len(report.sections) == 1 else [])
        said = terminal_warnings(warnings, all_warnings, ALL_WARNINGS)
        blocks.append("\n".join([*lines, terminal_table(section), *(["", said] if said else [""])]))
    notes = report.notes if len(report.sections) > 1 else []
    blocks.append(terminal_warnings(notes, all_warnings, ALL_WARNINGS) + f"{summary(report.table)}.\n")
    if report.more:
        blocks[-1] += f"{report.more}\n"
    if report.clock:
        blocks[-1] += textwrap.fill(report.clock, TERMINAL_WIDTH) + "\n"
    return "\n".join(blocks) + ("" if written else f"\n{NOT_WRITTEN}\n")
