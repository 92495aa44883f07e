"""How every chart looks: legible in grey, in print at the width of a column, and to the colour-blind."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

from ..compare.sections import Section

# Okabe and Ito's colours, told apart by all common forms of colour blindness; black is for text.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999")
# For prints in grey.
HATCHES = ("", "///", "...", "xx", "\\\\\\", "--", "oo", "++", "||", "**")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<", ">", "*", "p", "d")
DASHES = ("-", "--", "-.", ":")
STYLE = {
    "font.family": "DejaVu Sans",  # comes with matplotlib: the same on every machine
    "font.size": 9,
    "hatch.linewidth": 0.5,
    "svg.hashsalt": "oitlab",  # the same file for the same data
    # Texts stay texts: a third of the size. DejaVu is wide, so that another font fits as well.
    "svg.fonttype": "none",
    "pdf.fonttype": 42,  # what printers ask for
    "axes.axisbelow": True,
    "text.parse_math": False,  # a $ in a name is a $
}
COLUMN, PAGE = 3.4, 7.0  # inches: the width of a column and of a page of a two-column paper
KINDS = ("png", "svg", "pdf")


@dataclass(frozen=True)
class Chart:
    """A chart that was saved as `name`.png, .svg and .pdf in the folder plots."""

    name: str
    caption: str


def method_colours(methods: list[str]) -> dict[str, str]:
    """One colour a method; blend, the usual baseline, has the first."""
    ordered = sorted(set(methods), key=lambda method: (method != "blend", method))
    return {method: COLOURS[i % len(COLOURS)] for i, method in enumerate(ordered)}


def line_style(index: int, variant: int = 0) -> dict[str, str]:
    """The look of a line: colour and marker by its `index`, dashes by its variant."""
    return {"color": COLOURS[index % len(COLOURS)], "marker": MARKERS[index % len(MARKERS)],
            "linestyle": DASHES[variant % len(DASHES)]}


def source_line(section: Section) -> str:
    """What a chart was measured on: charts get copied around."""
    commit = f"commit {section.context['Commit']}"
    return section.title if commit in section.title else f"{section.title}, {commit}"


def save(figure: Figure, path: Path) -> None:
    """Writes PNG, SVG and PDF without a date, so that the same data gives the same files."""
    # What bbox_inches="tight" does, but laid out once for all files: layout is the slow part.
    if figure.get_layout_engine() is not None:
        figure.draw_without_rendering()
        figure.set_layout_engine(None)
    box = figure.get_tightbbox().padded(0.12)
    dates = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}
    for kind in KINDS:
        figure.savefig(path.with_name(f"{path.name}.{kind}"), bbox_inches=box, facecolor="white",
                       dpi=150, metadata=dates.get(kind))
