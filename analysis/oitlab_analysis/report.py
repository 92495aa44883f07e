"""Writes report.html (see `page`), report.md and cells.csv, and makes the text for the terminal."""

from __future__ import annotations

import shlex
import subprocess
import textwrap
from dataclasses import dataclass
from pathlib import Path

import pandas

from . import formats, images, plots
from .cells import Collection, Problem, collect
from .clock import clock_summary
from .labels import parameter_text, parameters_of, records
from .page import html_page
from .sections import Section, add_comparisons, make_sections, mixture_warnings
from .table import (TERMINAL_WIDTH, describe, error_caption, markdown_table, markdown_text,
                    setting_heading, terminal_table, terminal_warnings)

MOST_NAMED = 20  # files, commands: beyond these a count says enough

@dataclass(frozen=True)
class Result:
    """What the command line shows: the table, the files written, whether some cells failed."""

    text: str
    files: list[Path]
    failed: bool


def make_report(paths: list[Path], out: Path | None = None, metric: str = "rmse",
                all_charts: bool = False) -> Result:
    """Reads all cells of the paths (see collect()) and writes the report into `out`.

    Without `out` it is written into the results folder, where the paths name exactly one, and
    nowhere otherwise: packs and folders of packs are somebody's data. Raises BadResults, OSError.
    """
    collection = collect(*paths)
    table = add_comparisons(collection.table, collection.cells)
    sections = make_sections(collection, table)
    notes = mixture_warnings(table) + left_out(collection.problems)
    if collection.repeated:
        notes.append(f"{collection.repeated} cells were given twice, and count once.")
    clock = clock_summary(list(collection.cells.values()))
    folder = out or own_folder(paths)
    if folder is None:
        text = terminal_text(sections, notes, table, clock)
        return Result(f"{text}Nothing was written: --out DIR says where the page, the charts and the CSV go.",
                      [], bool((table["status"] == "failed").any()))
    folder.mkdir(parents=True, exist_ok=True)
    charts, missing = plots.save_charts(sections, folder / "plots", metric, all_charts)
    command = command_of(paths, out)
    if missing:
        notes.append(f"{missing} charts were left out to keep the page short: "
                     f"{command} --all-charts draws them.")

    csv, markdown, html = folder / "cells.csv", folder / "report.md", folder / "report.html"
    table.to_csv(csv, index=False)
    markdown.write_text(markdown_report(folder, collection, sections, charts, notes, command), encoding="utf-8")
    contents = [
        {
            "section": section,
            "charts": section_charts,
            "parameters": all_parameters(section),
            "unmeasured": unmeasured(section),
            "commands": commands(command, section),
        }
        for section, section_charts in zip(sections, charts)
    ]
    html.write_text(html_page(folder, collection.sources, title(sections), summary(table), clock, notes,
                              contents), encoding="utf-8")
    return Result(terminal_text(sections, notes, table, clock), [html, markdown, csv],
                  bool((table["status"] == "failed").any()))


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


def command_of(paths: list[Path], out: Path | None) -> str:
    """The command that makes this report."""
    words = ["oitlab", "report", *map(str, paths), *(["--out", str(out)] if out else [])]
    return shlex.join(words)


def terminal_text(sections: list[Section], notes: list[str], table: pandas.DataFrame, clock: str) -> str:
    blocks = [terminal_table(section) for section in sections]
    blocks.append(terminal_warnings(notes) + f"{summary(table)}.")
    if clock:
        blocks[-1] += "\n" + textwrap.fill(clock, TERMINAL_WIDTH)
    return "\n\n".join(blocks) + "\n"


def left_out(problems: list[Problem]) -> list[str]:
    """What is said of the files that were left out: how many, and the first of them by name."""
    if not problems:
        return []
    named = [f"{formats.one_line(p.file)}: {p.reason}" for p in problems[:MOST_NAMED]]
    if len(problems) > MOST_NAMED:
        named.append(f"and {len(problems) - MOST_NAMED} more")
    files = "file was" if len(problems) == 1 else "files were"
    return [f"{len(problems)} {files} left out: {'; '.join(named)}."]


def summary(table: pandas.DataFrame) -> str:
    counts = table["status"].value_counts()
    parts = [f"{counts.get(status, 0)} {word}" for status, word in
             (("ok", "measured"), ("failed", "failed"), ("skipped", "skipped"))]
    return f"{len(table)} cells: {', '.join(parts)}"


def title(sections: list[Section]) -> str:
    experiments = dict.fromkeys(section.context["Experiment"] for section in sections)
    return "oitlab: " + ", ".join(experiments)


def all_parameters(section: Section) -> dict[str, str]:
    """Every method of a section, by its label in the tables, with all its parameters."""
    rows = records(section.table.drop_duplicates("label"))
    return {row["label"]: parameter_text(parameters_of(row)) or "none" for row in rows}


def place(row: dict) -> str:
    return f"{row['scene_label']} · {row['view']} · {row['size_label']}"


def unmeasured(section: Section) -> list[dict[str, str]]:
    """Failed and skipped cells, with what is needed to find them."""
    rows = section.table[section.table["status"] != "ok"]
    return [
        {
            "status": row["status"],
            "cell": row["id"],
            "label": row["label"],
            "setting": place(row),
            "reason": describe(row)["reason"],
        }
        for row in records(rows.sort_values("status", kind="stable"))
    ]


def commands(command: str, section: Section) -> list[str]:
    """The commands that were run, and the one that makes this report."""
    shown = section.commands[:MOST_NAMED]
    if len(section.commands) > MOST_NAMED:
        shown.append(f"# and {len(section.commands) - MOST_NAMED} more: column command of cells.csv")
    return [*shown, command]


def markdown_report(
    folder: Path, collection: Collection, sections: list[Section], charts: list, warnings: list[str],
    command: str,
) -> str:
    """The report as Markdown; pictures are links relative to `folder`."""
    lines = [f"# {markdown_text(title(sections))}", "", f"{summary(collection.table)}.", ""]
    if clock := clock_summary(list(collection.cells.values())):
        lines += [markdown_text(clock), ""]
    lines += [f"> **Warning.** {markdown_text(w)}\n" for w in warnings]
    for section, section_charts in zip(sections, charts):
        lines += [f"## {markdown_text(section.title)}", ""]
        lines += [f"> **Warning.** {markdown_text(w)}\n" for w in section.warnings]
        lines += [f"- {name}: {markdown_text(text)}" for name, text in section.context.items()]
        lines += ["", markdown_table(section), "", *_markdown_clock(section), "All parameters:", ""]
        lines += [f"- {markdown_text(m)}: {markdown_text(p)}" for m, p in all_parameters(section).items()]
        lines += [""]
        for chart in section_charts:
            lines += [f"![{markdown_text(chart.caption)}](plots/{chart.name}.png)", ""]
        lines += _markdown_images(folder, collection, section) + _markdown_unmeasured(section)
        lines += ["### How to reproduce", "", f"At commit {markdown_text(section.context['Commit'])}:", ""]
        lines += [f"    {command}" for command in commands(command, section)] + [""]
    return "\n".join(lines)


def _markdown_clock(section: Section) -> list[str]:
    lines = [f"- {markdown_text(row['label'])}, {markdown_text(place(row))}: {markdown_text(row['clock_note'])}"
             for row in records(section.table) if row["clock_note"]]
    return ["Cells with a note on the clock:", "", *lines, ""] if lines else []


def _markdown_images(folder: Path, collection: Collection, section: Section) -> list[str]:
    lines = []
    for _, cells in section.settings():
        in_folder = [collection.sources[key].is_dir() for key in cells["key"]]
        pictured = cells[cells["image"].notna() & in_folder]
        if pictured.empty:
            continue
        lines += [f"### {markdown_text(setting_heading(cells))}", ""]
        for row in records(pictured):
            caption = markdown_text(f"{row['label']}: {error_caption(row)}")
            link = images.relative_link(folder, collection.sources[row["key"]], row["image"])
            lines += [f"![{caption}]({link})", "", caption, ""]
    return lines


def _markdown_unmeasured(section: Section) -> list[str]:
    rows = unmeasured(section)
    if not rows:
        return []
    lines = ["### Failed and skipped cells", ""]
    lines += [
        f"- {row['status']}: {markdown_text(row['label'])}, {markdown_text(row['setting'])}: "
        f"{markdown_text(row['reason'])}"
        for row in rows
    ]
    return [*lines, ""]
