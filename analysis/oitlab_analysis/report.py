"""Writes report.html, report.md and cells.csv, and makes the text for the terminal."""

from __future__ import annotations

import shlex
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import jinja2
import pandas

from . import formats, images, plots
from .cells import Collection, Problem, collect
from .labels import parameter_text, parameters_of
from .sections import Section, add_comparisons, make_sections, mixture_warnings
from .table import describe, error_caption, markdown_table, markdown_text, setting_heading, terminal_table, terminal_warnings

MOST_NAMED = 20  # files, commands: beyond these a count says enough

# Column head, name in describe(), column to sort by, what it means.
FIGURES = (
    ("Frame, ms", "frame", "frame_ms.median", "median time of a whole frame, with its 95% interval"),
    ("Ratio", "ratio", "ratio", "frame time over that of the baseline, with its 95% interval"),
    ("Verdict", "verdict", "verdict", "against the baseline"),
    ("RMSE", "rmse", "quality.rmse", "root mean square error against the reference image"),
    ("PSNR, dB", "psnr", "quality.psnr", "∞ means equal to the reference"),
    ("Pixels off", "pixels_off", "quality.pixels_off", "share of pixels off by more than 1/255"),
    ("SSIM", "ssim", "quality.ssim", "structural similarity of display values; 1 means equal"),
    ("FLIP", "flip", "quality.flip", "visible difference of display values, from 0 to 1"),
    ("Fragments", "fragments", "counter.fragments", "transparent fragments of a frame"),
    ("Memory, MiB", "memory", "memory_total_bytes", "all buffers and images of the method"),
)


@dataclass(frozen=True)
class Result:
    """What the command line shows: the table, the files written, whether some cells failed."""

    text: str
    files: list[Path]
    failed: bool


def make_report(folder: Path) -> Result:
    """Reads RESULTS/cells and writes the report into RESULTS. Raises BadResults, OSError."""
    collection = collect(folder)
    table = add_comparisons(collection.table, collection.cells)
    sections = make_sections(collection, table)
    notes = mixture_warnings(table) + left_out(collection.problems)
    charts = plots.save_charts(sections, folder / "plots")

    csv, markdown, html = folder / "cells.csv", folder / "report.md", folder / "report.html"
    table.to_csv(csv, index=False)
    markdown.write_text(markdown_report(collection, sections, charts, notes), encoding="utf-8")
    html.write_text(html_report(collection, sections, charts, notes), encoding="utf-8")

    blocks = [terminal_table(section) for section in sections]
    blocks.append(terminal_warnings(notes) + f"{summary(table)}.")
    text = "\n\n".join(blocks) + "\n"
    return Result(text, [html, markdown, csv], bool((table["status"] == "failed").any()))


def left_out(problems: list[Problem]) -> list[str]:
    """What is said of the files that were left out: how many, and the first of them by name."""
    if not problems:
        return []
    named = [f"{formats.one_line(p.file)}: {p.reason}" for p in problems[:MOST_NAMED]]
    if len(problems) > MOST_NAMED:
        named.append(f"and {len(problems) - MOST_NAMED} more")
    files = "file in cells/ was" if len(problems) == 1 else "files in cells/ were"
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
    rows = section.table.drop_duplicates("label")
    return {row["label"]: parameter_text(parameters_of(row)) or "none" for _, row in rows.iterrows()}


def unmeasured(section: Section) -> list[dict[str, str]]:
    """Failed and skipped cells, with what is needed to find them."""
    rows = section.table[section.table["status"] != "ok"]
    return [
        {
            "status": row["status"],
            "cell": row["id"],
            "label": row["label"],
            "setting": f"{row['scene_label']} · {row['view']} · {row['size_label']}",
            "reason": describe(row)["reason"],
        }
        for _, row in rows.sort_values("status", kind="stable").iterrows()
    ]


def commands(collection: Collection, section: Section) -> list[str]:
    """The commands that were run, and the one that makes this report."""
    shown = section.commands[:MOST_NAMED]
    if len(section.commands) > MOST_NAMED:
        shown.append(f"# and {len(section.commands) - MOST_NAMED} more: column command of cells.csv")
    return [*shown, f"oitlab report {shlex.quote(str(collection.folder))}"]


def markdown_report(
    collection: Collection, sections: list[Section], charts: list, warnings: list[str]
) -> str:
    """The report as Markdown; pictures are relative links."""
    lines = [f"# {markdown_text(title(sections))}", "", f"{summary(collection.table)}.", ""]
    lines += [f"> **Warning.** {markdown_text(w)}\n" for w in warnings]
    for section, section_charts in zip(sections, charts):
        lines += [f"## {markdown_text(section.title)}", ""]
        lines += [f"> **Warning.** {markdown_text(w)}\n" for w in section.warnings]
        lines += [f"- {name}: {markdown_text(text)}" for name, text in section.context.items()]
        lines += ["", markdown_table(section), "", "All parameters:", ""]
        lines += [f"- {markdown_text(m)}: {markdown_text(p)}" for m, p in all_parameters(section).items()]
        lines += [""]
        for chart in section_charts:
            lines += [f"![{markdown_text(chart.caption)}](plots/{chart.name}.png)", ""]
        lines += _markdown_images(section) + _markdown_unmeasured(section)
        lines += ["### How to reproduce", "", f"At commit {markdown_text(section.context['Commit'])}:", ""]
        lines += [f"    {command}" for command in commands(collection, section)] + [""]
    return "\n".join(lines)


def _markdown_images(section: Section) -> list[str]:
    lines = []
    for _, cells in section.settings():
        pictured = cells[cells["image"].notna()]
        if pictured.empty:
            continue
        lines += [f"### {markdown_text(setting_heading(cells))}", ""]
        for _, row in pictured.iterrows():
            caption = markdown_text(f"{row['label']}: {error_caption(row)}")
            link = images.relative_link(row["image"])
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


def html_report(
    collection: Collection, sections: list[Section], charts: list, warnings: list[str]
) -> str:
    """The report as one HTML page without external resources."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent / "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    files = [f for f in collection.table["image"] if isinstance(f, str)]
    with ThreadPoolExecutor() as pool:  # decoding and scaling run outside Python's lock
        previews = dict(zip(files, pool.map(lambda f: images.preview(collection.folder, f), files)))
    return environment.get_template("report.html.jinja").render(
        title=title(sections),
        summary=summary(collection.table),
        warnings=warnings,
        figures=FIGURES,
        sections=[
            {
                "title": section.title,
                "context": section.context,
                "warnings": section.warnings,
                "rows": [_html_row(row) for _, row in section.table.iterrows()],
                "parameters": all_parameters(section),
                "charts": [_html_chart(collection.folder, chart) for chart in section_charts],
                "pictures": _html_pictures(section, previews),
                "unmeasured": unmeasured(section),
                "commands": commands(collection, section),
            }
            for section, section_charts in zip(sections, charts)
        ],
    )


def _html_row(row: pandas.Series) -> dict[str, object]:
    texts = describe(row)
    return {
        "status": row["status"],
        "reason": texts["reason"],
        "baseline": row["baseline"] or "",
        "keys": [
            (row["scene_label"], row["scene_label"], parameter_text(scene_facts(row))),
            (row["view"], row["view"], ""),
            (row["size_label"], row["width"] * row["height"], ""),
            (row["label"], row["label"], ""),
        ],
        "figures": [
            (name, texts.get(name, formats.NOTHING), _sort_value(row, column))
            for _, name, column, _ in FIGURES
        ],
    }


def scene_facts(row: pandas.Series) -> dict[str, object]:
    facts = {key: row[key] for key in ("source", "triangles", "opacity", "detail")}
    return {key: value for key, value in facts.items() if formats.is_number(value) or
            (isinstance(value, str) and value)}


def _sort_value(row: pandas.Series, column: str) -> object:
    """What the column sorts by; empty goes last. An infinite PSNR is the greatest."""
    value = row.get(column)
    if column == "quality.psnr" and not formats.is_number(value) and row.get("quality.rmse") == 0:
        return "Infinity"
    return value if formats.is_number(value) or isinstance(value, str) else ""


def _html_chart(folder: Path, chart: plots.Chart) -> dict[str, str]:
    content = (folder / "plots" / f"{chart.name}.svg").read_bytes()
    return {"uri": images.data_uri(content, "svg+xml"), "caption": chart.caption,
            "link": f"plots/{chart.name}.png"}


def _html_pictures(section: Section, previews: dict[str, images.Preview]) -> list[dict]:
    result = []
    for _, cells in section.settings():
        measured = cells[cells["status"] == "ok"]
        pictures = [
            {
                "label": row["label"],
                "parameters": parameter_text(parameters_of(row)),
                "error": error_caption(row),
                "preview": previews.get(row["image"]) or images.preview(Path(), None),
            }
            for _, row in measured.iterrows()
        ]
        if pictures:
            result.append({"heading": setting_heading(cells), "pictures": pictures})
    return result
