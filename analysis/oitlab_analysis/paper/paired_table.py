"""A table of a paper with its measured columns, and how it is written: Markdown, LaTeX, CSV."""

from __future__ import annotations

import csv
import dataclasses
import itertools
from dataclasses import dataclass, field
from pathlib import Path

from .. import formats
from ..write.table import markdown_text

GAP = formats.NOTHING
SLOW = "†"  # beside or instead of a time that was taken at a lower clock (clock.py)
MOST_NAMED = 6


@dataclass(frozen=True)
class Number:
    """A figure and, where it has one, its 95% interval; a published one stays as it was printed."""

    value: float
    low: float | None = None
    high: float | None = None
    digits: int = 3
    printed: str = ""
    mark: str = ""  # of a note under the table

    def text(self) -> str:
        if self.printed:
            return self.printed
        mark = f" {self.mark}" if self.mark else ""
        if self.low is not None and self.high is not None:
            return formats.with_interval(self.value, self.low, self.high) + mark
        return formats.number(self.value, self.digits) + mark


@dataclass(frozen=True)
class Column:
    """`device` stands in the head below the name; empty for columns that name the row."""

    key: str
    name: str
    device: str = ""


@dataclass
class Table:
    name: str  # of the files
    title: str
    source: str  # of the published figures
    columns: list[Column]
    rows: list[dict[str, str | Number | None]]
    measured_on: str
    agreement: list[str] = field(default_factory=list)  # sentences
    notes: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)  # what would have to be measured
    command: str = ""  # that would fill the gaps


def text_of(value: str | Number | None) -> str:
    if value is None or value == "":
        return GAP
    return value.text() if isinstance(value, Number) else value


def sentences(table: Table) -> list[str]:
    """The lines under a table: agreement, gaps with the command that fills them, notes."""
    lines = list(table.agreement)
    if table.missing:
        lines.append(f"Not measured: {missing_text(table)}. Run: {table.command}")
    return lines + table.notes


def missing_text(table: Table) -> str:
    """The rows without a measured figure, by name where they are few."""
    measured = any(row.get(c.key) for row in table.rows for c in table.columns if c.key.startswith("m."))
    if not measured:
        return "any row"
    named = "; ".join(table.missing[:MOST_NAMED])
    return named + (f"; and {len(table.missing) - MOST_NAMED} more" if len(table.missing) > MOST_NAMED else "")


def markdown(table: Table) -> str:
    heads = [c.name + (f", {c.device}" if c.device else "") for c in table.columns]
    rules = ["---" if not c.device else "---:" for c in table.columns]
    lines = [f"## {markdown_text(table.title)}", "",
             f"Published: {markdown_text(table.source)}. Measured: {markdown_text(table.measured_on)}.", "",
             f"| {' | '.join(markdown_text(head) for head in heads)} |", f"| {' | '.join(rules)} |"]
    lines += [f"| {' | '.join(markdown_text(text_of(row.get(c.key))) for c in table.columns)} |"
              for row in table.rows]
    lines.append("")
    lines += [f"{markdown_text(sentence)}\n" for sentence in sentences(table)]
    return "\n".join(lines)


LATEX = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_",
         "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
         "–": "--", "×": r"$\times$", "µ": r"\textmu{}", "τ": r"$\tau$", "<": r"$<$", ">": r"$>$",
         "‡": r"\ddag{}", "†": r"\dag{}", "∞": r"$\infty$", "·": r"$\cdot$", "≥": r"$\geq$"}


def latex_text(text: str) -> str:
    return "".join(LATEX.get(character, character) for character in text)


def latex(table: Table) -> str:
    """A floating table of the width of the page; the sentences stand under it.

    Twenty columns leave no room for a device in each head: the first line of the head names the
    devices by letters, and intervals are left to the other formats.
    """
    align = "".join("r" if c.device else "l" for c in table.columns)
    devices = list(dict.fromkeys(c.device for c in table.columns if c.device))
    letters = dict(zip(devices, "PMQRS"))
    legend = ", ".join(f"{letter}: {latex_text(device)}" for device, letter in letters.items())
    names = []
    for _name, group in itertools.groupby(table.columns, key=lambda c: c.name.rstrip(" ‡")):
        group = list(group)
        # The last name has the mark, if any: only measured columns are marked.
        text = latex_text(group[-1].name)
        names.append(rf"\multicolumn{{{len(group)}}}{{c}}{{{text}}}" if len(group) > 1 else text)
    letters_row = " & ".join(letters.get(c.device, "") for c in table.columns)
    body = [" & ".join(latex_text(_without_interval(row.get(c.key))) for c in table.columns) + r" \\"
            for row in table.rows]
    said = [latex_text(sentence) + r"\par" for sentence in sentences(table)]
    caption = f"{table.title}. Published: {table.source}. Measured: {table.measured_on}."
    return "\n".join([
        r"\begin{table*}", r"\centering", rf"\caption{{{latex_text(caption)}}}",
        rf"\label{{tab:{table.name}}}", r"\setlength{\tabcolsep}{3pt}",
        r"\resizebox{\ifdim\width>\textwidth\textwidth\else\width\fi}{!}{%",
        rf"\begin{{tabular}}{{{align}}}", r"\toprule",
        rf"\multicolumn{{{len(table.columns)}}}{{l}}{{{legend}}} \\", r"\midrule",
        " & ".join(names) + r" \\", letters_row + r" \\", r"\midrule", *body, r"\bottomrule",
        r"\end{tabular}}", r"\smallskip", r"\begin{minipage}{\textwidth}\footnotesize", *said,
        r"\end{minipage}", r"\end{table*}", ""])


def _without_interval(value: str | Number | None) -> str:
    return text_of(dataclasses.replace(value, low=None, high=None) if isinstance(value, Number) else value)


def write_csv(table: Table, path: Path) -> None:
    """Full figures; an interval takes two more columns."""
    columns = []
    for c in table.columns:
        interval = any(isinstance(row.get(c.key), Number) and row[c.key].low is not None
                       for row in table.rows)
        columns.append((c, interval))
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        head = []
        for c, interval in columns:
            name = c.name + (f" ({c.device})" if c.device else "")
            head += [name, f"{name} low", f"{name} high"] if interval else [name]
        writer.writerow(head)
        for row in table.rows:
            line = []
            for c, interval in columns:
                value = row.get(c.key) if row.get(c.key) != SLOW else None
                if isinstance(value, Number):
                    line += [value.value, value.low, value.high] if interval else [value.value]
                else:
                    line += [value or "", "", ""] if interval else [value or ""]
            writer.writerow(line)


def write(table: Table, folder: Path) -> None:
    """NAME.md, NAME.tex and NAME.csv. Raises OSError."""
    (folder / f"{table.name}.md").write_text(markdown(table), encoding="utf-8")
    (folder / f"{table.name}.tex").write_text(latex(table), encoding="utf-8")
    write_csv(table, folder / f"{table.name}.csv")
