"""`oitlab paper`: the tables and figures of the papers, published beside measured."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import matplotlib

from ..compare.sections import add_comparisons, make_sections
from ..compare.tidy import as_table
from ..draw.charts import KINDS
from ..draw.style import STYLE, footnotes, save
from ..write.table import markdown_text, terminal_warnings
from . import bma_tables, lucidraster, methods
from .common import file_name
from .measured import Context, Measurements, gather
from .paired_table import Table, latex_text, markdown, missing_text, write

PAPER = Path(__file__).resolve().parents[3] / "paper"
NO_DEVICE = "no device yet"
# Of our own cells: name, experiment, what it shows, the kind of chart of a report.
PLOTS = (
    ("quality-speed", "methods", "Quality against speed of every method, over all scenes", "quality-speed"),
    ("quality-speed-scenes", "methods", "Quality against speed of every method, per scene",
     "quality-speed-scenes"),
    ("depth-filter-curve", "depth_filter", "Invalid pixels and time over the size of the depth filter",
     "depth-filter"),
    ("alpha-threshold-curve", "alpha_threshold", "Speed-up over the alpha threshold", "alpha-threshold"),
)


def make_paper(paths: list[Path], out: Path) -> str:
    """Writes everything into `out`; returns what to tell. Raises BadResults, OSError."""
    found = gather(paths)
    out.mkdir(parents=True, exist_ok=True)
    devices = found.devices() or [NO_DEVICE]
    tables, pictures = [], []
    for device in devices:
        tables += tables_of(found, device)
        pictures += draw_pictures(found, device, out)
    for table in tables:
        write(table, out)
    (out / "paper.md").write_text(whole_markdown(tables, pictures, found.warnings), encoding="utf-8")
    (out / "all.tex").write_text(whole_latex(tables, pictures), encoding="utf-8")
    gaps = sum(bool(table.missing) for table in tables)
    lines = [f"{len(tables)} tables ({gaps} with gaps) and {sum(drawn for _, _, drawn in pictures)} of "
             f"{len(pictures)} figures, for {', '.join(devices)}"]
    lines += [f"{table.name}: not measured: {missing_text(table)}; run: {table.command}"
              for table in tables if table.missing]
    return "\n".join([*lines, terminal_warnings(found.warnings) + str(out / "paper.md"), build_pdf(out)])


def tables_of(found: Measurements, device: str) -> list[Table]:
    return [
        methods.opening(found, device),
        lucidraster.scenes(found, device),
        lucidraster.performance(found, device, "first"),
        lucidraster.performance(found, device, "second"),
        lucidraster.alpha_threshold(found, device),
        lucidraster.depth_filter(found, device),
        methods.memory(found, device),
        bma_tables.table1(found, device),
        bma_tables.table2(found, device),
    ]


def draw_pictures(found: Measurements, device: str, out: Path) -> list[tuple[str, str, bool]]:
    """Saves the figures as PDF, SVG and PNG; (name, caption, whether there was anything to draw)."""
    suffix = file_name(device)
    drawn = []
    with matplotlib.rc_context(STYLE):
        for name, experiment, caption, chart in PLOTS:
            section, kind = section_of(found.of(device), experiment), KINDS[chart]
            count = kind.pages(section, "rmse") if section else 0
            figure = kind.draw(section, 0, "rmse") if count else None
            rest = f" The first of {count} charts: `oitlab report` draws the others." if count > 1 else ""
            said = footnotes(section) if section else f"{device}."
            drawn.append((f"{name}-{suffix}", f"{caption}.{rest} {said}", figure))
        for name, says, figure in bma_tables.figures(found, device):
            caption = f"Measured on {device}. Published ({name.split('-')[1]} of the BMA paper): {says}."
            drawn.append((name, caption, figure))
        for name, caption, figure in drawn:
            if figure is not None:
                save(figure, out / name, caption)
            else:  # of an earlier run
                for kind in ("png", "svg", "pdf"):
                    (out / f"{name}.{kind}").unlink(missing_ok=True)
    return [(name, caption, figure is not None) for name, caption, figure in drawn]


def section_of(contexts: list[Context], experiment: str):
    """The cells of an experiment in the context that has most of them; None where none has any."""
    counts = [(sum(c["experiment"] == experiment and c["status"] == "ok" for c in context.cells),
               context.newest, i) for i, context in enumerate(contexts)]
    if not counts or max(counts)[0] == 0:
        return None
    context = contexts[max(counts)[2]]
    cells = {c["id"]: c for c in context.cells if c["experiment"] == experiment}
    return make_sections(cells, add_comparisons(as_table(cells), cells))[0]


def whole_markdown(tables: list[Table], pictures: list[tuple[str, str, bool]], warnings: list[str]) -> str:
    lines = ["# Published beside measured", "",
             "Made by `oitlab paper` from raw cells. Published figures: paper/published/. Scenes are stand-ins.", ""]
    lines += [f"> **Warning.** {markdown_text(w)}\n" for w in warnings]
    lines += [markdown(table) for table in tables]
    lines += ["## Figures", ""]
    for name, caption, drawn in pictures:
        picture = f"![{markdown_text(caption)}]({name}.png)" if drawn else f"*{name}: nothing was measured for it.*"
        lines += [f"{picture}\n",
                  f"{markdown_text(caption)}\n"]
    return "\n".join(lines)


def whole_latex(tables: list[Table], pictures: list[tuple[str, str, bool]]) -> str:
    lines = [rf"\input{{\generated/{table.name}}}" for table in tables]
    for name, caption, drawn in pictures:
        if drawn:
            lines += [r"\begin{figure*}", r"\centering",
                      rf"\includegraphics[width=\linewidth,height=0.75\textheight,keepaspectratio]{{\generated/{name}.pdf}}",
                      rf"\caption{{{latex_text(caption)}}}", r"\end{figure*}", r"\clearpage"]
    return "\n".join(lines) + "\n"


def build_pdf(out: Path) -> str:
    """Builds paper/main.tex with what is in `out`, where LaTeX is; says what came of it."""
    if shutil.which("latexmk") is None or shutil.which("pdflatex") is None:
        return "No latexmk and pdflatex here: the Markdown version is the paper."
    command = ["latexmk", "-pdf", "-interaction=nonstopmode", "-halt-on-error", f"-outdir={out.resolve()}",
               f"-usepretex=\\def\\generated{{{out.resolve()}}}", "main.tex"]
    done = subprocess.run(command, cwd=PAPER, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        log = out / "main.log"
        said = (done.stdout + done.stderr).strip().splitlines() or ["without a word"]
        return f"latexmk failed: see {log}" if log.is_file() else f"latexmk failed: {said[-1].strip()}"
    return str(out / "main.pdf")
