"""How every chart looks: legible in grey, in print at the width of a column, and to the colour-blind."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from matplotlib.artist import Artist
from matplotlib.figure import Figure

from ..compare.device_notes import NOTED
from ..compare.sections import Section

# Okabe and Ito's colours, told apart by all common forms of colour blindness; black is for text.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999")
# For prints in grey.
HATCHES = ("", "///", "...", "xx", "\\\\\\", "--", "oo", "++", "||", "**")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<", ">", "*", "p", "d")
DASHES = ("-", "--", "-.", ":")
GRID = {"color": "#e4e4e4", "linewidth": 0.5}
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
TALLEST = 9.0  # inches: what fits on a page with its caption
DOTS_PER_INCH = 150
KINDS = ("png", "svg", "pdf")


@dataclass(frozen=True)
class Chart:
    """A chart that was saved as `name`.png, .svg and .pdf in the folder plots.

    `hints` says of marks in the SVG, by their id, what the pointer over them shows.
    """

    name: str
    caption: str
    hints: dict[str, str]


def mark_point(artist: Artist, hint: str) -> None:
    """Makes the pointer over a mark of a page's chart show a text (hints_of())."""
    artist.set_label(hint)
    artist.set_gid("hint")


def hints_of(figure: Figure) -> dict[str, str]:
    """Numbers the marks that have a hint; the text of each by its id in the SVG."""
    marks = figure.findobj(lambda artist: artist.get_gid() == "hint")
    for number, mark in enumerate(marks):
        mark.set_gid(f"hint{number}")
    return {mark.get_gid(): mark.get_label() for mark in marks}


def method_looks(methods: list[str]) -> dict[str, dict[str, str]]:
    """Colour and marker of each method. Blend, the usual baseline, has the first colour; from the
    ninth method on colours come again with other markers."""
    ordered = sorted(set(methods), key=lambda method: (method != "blend", method))
    return {method: series_look(i) for i, method in enumerate(ordered)}


def series_look(index: int) -> dict[str, str]:
    """Colour and marker of a series: at most 8 colours, no two markers the same among 12."""
    return {"color": COLOURS[index % len(COLOURS)], "marker": MARKERS[index % len(MARKERS)]}


def source_line(section: Section) -> str:
    """What a chart was measured on, for its caption: device, build and commit."""
    commit = f"commit {section.context['Commit']}"
    return section.title if commit in section.title else f"{section.title}, {commit}"


def footnotes(section: Section) -> str:
    """What a caption says of the measurement; charts get copied around."""
    notes = [f"{NOTED.strip()} {note}" for note in dict.fromkeys(section.table["device_note"]) if note]
    said = [source_line(section) + ".", *notes]
    if section.is_cpu:
        said.append("CPU device: these times say nothing about GPUs.")
    return " ".join(said)


def save(figure: Figure, path: Path, caption: str = "") -> None:
    """Writes PNG, SVG and PDF with the caption inside, and without a date, so that the same data
    gives the same files."""
    # What bbox_inches="tight" does, but laid out once for all files: layout is the slow part.
    if figure.get_layout_engine() is not None:
        figure.draw_without_rendering()
        figure.set_layout_engine(None)
    box = figure.get_tightbbox().padded(0.08)
    metadata = {"png": {"Description": caption}, "svg": {"Date": None, "Description": caption},
                "pdf": {"CreationDate": None, "Subject": caption}}
    for kind in KINDS:
        figure.savefig(path.with_name(f"{path.name}.{kind}"), bbox_inches=box, facecolor="white",
                       dpi=DOTS_PER_INCH, metadata=metadata[kind])
