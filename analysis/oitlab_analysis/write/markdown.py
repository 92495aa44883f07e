"""The report as Markdown."""

from __future__ import annotations

from ..compare.labels import records
from ..compare.sections import Section
from .contents import Report, all_parameters, commands, place, summary, unmeasured
from .images import relative_link
from .table import error_caption, markdown_table, markdown_text, setting_heading


def markdown_report(report: Report) -> str:
    """The report as Markdown; pictures are links relative to its folder."""
    lines = [f"# {markdown_text(report.title)}", "", f"{summary(report.table)}.", ""]
    if report.clock:
        lines += [markdown_text(report.clock), ""]
    lines += [f"> **Warning.** {markdown_text(w)}\n" for w in report.notes]
    for section, section_charts in zip(report.sections, report.charts):
        lines += [f"## {markdown_text(section.title)}", ""]
        lines += [f"> **Warning.** {markdown_text(w)}\n" for w in section.warnings]
        lines += [f"- {name}: {markdown_text(text)}" for name, text in section.context.items()]
        lines += ["", markdown_table(section), "", *_clock(section), "All parameters:", ""]
        lines += [f"- {markdown_text(m)}: {markdown_text(p)}" for m, p in all_parameters(section).items()]
        lines += [""]
        for chart in section_charts:
            lines += [f"![{markdown_text(chart.caption)}](plots/{chart.name}.png)", ""]
        if report.more and section is report.sections[-1]:
            lines += [markdown_text(report.more), ""]
        lines += _images(report, section) + _unmeasured(section)
        lines += ["### How to reproduce", "", f"At commit {markdown_text(section.context['Commit'])}:", ""]
        lines += [f"    {command}" for command in commands(report, section)] + [""]
    return "\n".join(lines)


def _clock(section: Section) -> list[str]:
    lines = [f"- {markdown_text(row['label'])}, {markdown_text(place(row))}: {markdown_text(row['clock_note'])}"
             for row in records(section.table) if row["clock_note"]]
    return ["Cells with a note on the clock:", "", *lines, ""] if lines else []


def _images(report: Report, section: Section) -> list[str]:
    lines = []
    for cells in section.rows.values():
        pictured = [row for row in cells if isinstance(row["image"], str) and report.sources[row["key"]].is_dir()]
        if not pictured:
            continue
        lines += [f"### {markdown_text(setting_heading(cells))}", ""]
        for row in pictured:
            caption = markdown_text(f"{row['label']}: {error_caption(row)}")
            link = relative_link(report.folder, report.sources[row["key"]], row["image"])
            lines += [f"![{caption}]({link})", "", caption, ""]
    return lines


def _unmeasured(section: Section) -> list[str]:
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
