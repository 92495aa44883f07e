"""The command line: `python3 -m oitlab_analysis report RESULTS_DIR`, and the other verbs."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import NoReturn

# As in `metrics`, which would load pandas: --help should not wait for it.
METRICS = ("rmse", "psnr", "ssim", "flip", "pixels_off", "wrong_order")

PAPER = Path(__file__).resolve().parents[2] / "paper"

EXIT_DONE = 0
EXIT_CELLS_FAILED = 1
EXIT_BAD_INPUT = 2


class Parser(argparse.ArgumentParser):
    """One line for wrong input, as of the program itself."""

    def error(self, message: str) -> NoReturn:
        self.exit(EXIT_BAD_INPUT, f"{self.prog}: {message}; see `{self.prog} --help`\n")


def parse_arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = Parser(
        prog="oitlab", description="Analyses results folders that `oitlab run` wrote."
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def add(name: str, **texts) -> argparse.ArgumentParser:
        return commands.add_parser(name, formatter_class=argparse.RawDescriptionHelpFormatter, **texts)

    report = add(
        "report",
        help="table, plots and report of results folders and packs",
        description="Reads every cell of the given results folders, packs (*.json.gz) and folders of\n"
        "either, prints a table, then the paths of the files that it wrote.",
        epilog="written into DIR, or into RESULTS where that is one results folder. Of packs and of\n"
        "several folders nothing is written without --out.\n"
        "  report.html   one self-contained page: tables, charts, pictures to compare\n"
        "  report.md     the same, with relative links\n"
        "  cells.csv     one row per cell, every number of the report\n"
        "  plots/        the charts as PNG, SVG and PDF\n\n"
        "example: how the error of depth peeling falls with its layers, a panel for each scene:\n"
        "  oitlab report results/classic --x layers --y rmse --per scene\n\n"
        "exit codes:\n"
        "  0  done\n"
        "  1  done, but some cells failed\n"
        "  2  bad input, or nothing to report",
    )
    report.add_argument(
        "results", metavar="RESULTS", type=Path, nargs="+",
        help="a folder that holds cells/ and images/, a pack, or a folder of these"
    )
    report.add_argument("--out", metavar="DIR", type=Path, help="where to write the report")
    report.add_argument("--metric", choices=METRICS, default="rmse",
                        help="error of the quality-against-speed charts (default rmse)")
    report.add_argument("--all-charts", action="store_true",
                        help="draw every chart, however many there are")
    report.add_argument("--warnings", action="store_true",
                        help="print every warning in full, instead of their count and the first one")
    own = report.add_argument_group(
        "a chart of your own",
        "Lines over any parameter, for what else differs: the second chart of each section, and\n"
        "plots/curve-*. NAME is a parameter (layers), opacity, detail, triangles, pixels, path (the place\n"
        "on a camera path), time, ratio, memory, an error as above, a stage (sort), a counter\n"
        "(fragments), or any column of cells.csv.")
    own.add_argument("--x", metavar="NAME", help="what lies on the x axis")
    own.add_argument("--y", metavar="NAME", default="time", help="what lies on the y axis (default time)")
    own.add_argument("--per", metavar="NAME", default="",
                     help="a panel for each scene, method, view, size, setting, or value of a parameter")
    own.add_argument("--base", metavar="VALUE", help="relate y to that at this value of x (times: of paired blocks)")
    own.add_argument("--only", metavar="METHOD", default="", help="cells of this method only")

    diff = add(
        "diff",
        help="what became faster, slower or different from one results folder to another",
        description="Compares every cell that both hold: times with intervals and verdicts, images,\n"
        "shaders. What is only in one of them is named.",
        epilog="exit codes: 0 done, 2 bad input, or nothing in common",
    )
    diff.add_argument("a", metavar="RESULTS_A", type=Path, help="before: a results folder or a pack")
    diff.add_argument("b", metavar="RESULTS_B", type=Path, help="after")
    diff.add_argument("--details", action="store_true", help="name the shaders that changed")
    diff.add_argument("--out", metavar="FILE.md", type=Path, help="write it as Markdown too")

    paper = add(
        "paper",
        help="the papers' tables and figures, published beside measured",
        description="Writes every table and figure of the LucidRaster and BMA papers as Markdown, LaTeX\n"
        "and CSV, with what was published beside what the given cells say.",
        epilog="exit codes: 0 done, 2 bad input",
    )
    paper.add_argument("results", metavar="RESULTS_DIR", type=Path, nargs="*",
                       help="results folders or packs (default: all of paper/data)")
    paper.add_argument("--out", metavar="DIR", type=Path, default=PAPER / "generated",
                       help="where to write (default: %(default)s)")

    pack = add(
        "pack",
        help="the raw cells of a results folder as one small file",
        description="Writes every whole cell of a results folder into one compressed JSON file, which\n"
        "`diff` and `paper` read like a folder. Pictures are not packed.",
        epilog="exit codes: 0 done, 2 bad input, or nothing to pack",
    )
    pack.add_argument("results", metavar="RESULTS_DIR", type=Path, help="what `oitlab run` wrote")
    pack.add_argument("pack", metavar="FILE.json.gz", type=Path, help="the file to write")

    histogram = commands.add_parser(
        "histogram",
        help="chart of a scene's depth complexity",
        description="Draws how many pixels have how many fragments, on a log scale.",
    )
    histogram.add_argument("depth", metavar="FILE.json", type=Path,
                           help="what `oitlab depth --json` prints")
    histogram.add_argument("chart", metavar="OUT.png", type=Path, help="the chart to write")
    options, unknown = parser.parse_known_args(arguments)
    if unknown:  # the parser of the verb knows what it takes
        commands.choices[options.command].error(f"'{unknown[0]}' is not known here")
    return options


def run_histogram(source: Path, target: Path) -> int:
    try:
        from .draw.histogram import BadDepth, draw_histogram
    except ModuleNotFoundError as error:
        print(f"oitlab depth: {sys.executable} has no Python module {error.name}; wanted: matplotlib",
              file=sys.stderr)
        return EXIT_BAD_INPUT
    try:
        draw_histogram(source, target)
    except BadDepth as error:
        print(f"oitlab depth: {error}", file=sys.stderr)
        return EXIT_BAD_INPUT
    except OSError as error:
        print(f"oitlab depth: {error.filename}: {error.strerror}", file=sys.stderr)
        return EXIT_BAD_INPUT
    return EXIT_DONE


def run_report(options: argparse.Namespace) -> tuple[str, int]:
    from .draw.curve_lines import Curve
    from .read.sources import BadResults
    from .write.report import make_report

    curves = ()
    if options.x:
        curves = (Curve(options.x, options.y, options.per, options.only, options.base),)
    elif options.per or options.base or options.only:
        raise BadResults("--per, --base and --only are of a chart that --x asks for")
    result = make_report(options.results, options.out, options.metric, options.all_charts, curves,
                         options.warnings)
    text = "\n".join(filter(None, [result.text, *map(str, result.files)]))
    return text, EXIT_CELLS_FAILED if result.failed else EXIT_DONE


def run_diff(options: argparse.Namespace) -> tuple[str, int]:
    from .compare.diff import diff
    from .write.diff_text import markdown, terminal

    result = diff(options.a, options.b)
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(markdown(result, (options.a, options.b)), encoding="utf-8")
    return terminal(result, options.details), EXIT_DONE


def run_paper(options: argparse.Namespace) -> tuple[str, int]:
    from .paper.make import make_paper
    from .read.sources import BadResults

    if not options.results and not (PAPER / "data").is_dir():
        raise BadResults(f"{PAPER / 'data'} is not there: give results folders, for example: oitlab paper "
                         "results/performance results/methods")
    return make_paper(options.results or [PAPER / "data"], options.out), EXIT_DONE


def run_pack(options: argparse.Namespace) -> tuple[str, int]:
    from .formats import counted
    from .read.packs import PACK_SUFFIX, write_pack
    from .read.sources import BadResults

    if not (options.results / "cells").is_dir():
        raise BadResults(f"{options.results}: " + ("not a results folder (it has no folder cells)"
                                                   if options.results.exists() else "no such folder"))
    if not options.pack.name.endswith(PACK_SUFFIX):
        raise BadResults(f"{options.pack}: wanted a name that ends with {PACK_SUFFIX}")
    count, left_out = write_pack(options.results, options.pack)
    lines = [f"left out: {text}" for text in left_out]
    if count == 0:
        raise BadResults("; ".join([f"{options.results}: no whole cell to pack", *lines[:3]]))
    size = options.pack.stat().st_size
    return "\n".join([*lines, f"{options.pack}: {counted(count, 'cell')}, {size / 1024:.0f} KiB"]), EXIT_DONE


RUN = {"report": run_report, "diff": run_diff, "paper": run_paper, "pack": run_pack}


def main(arguments: list[str] | None = None) -> int:
    options = parse_arguments(arguments)
    if options.command == "histogram":
        return run_histogram(options.depth, options.chart)
    name = f"oitlab {options.command}"
    # Late, so that --help does not wait for matplotlib, and works without it.
    try:
        from .read.sources import BadResults
    except ModuleNotFoundError as error:
        return missing_module(name, error)
    try:
        text, code = RUN[options.command](options)
    except ModuleNotFoundError as error:
        return missing_module(name, error)
    except BadResults as error:
        print(f"{name}: {error}", file=sys.stderr)
        return EXIT_BAD_INPUT
    except (FileExistsError, NotADirectoryError) as error:
        print(f"{name}: {error.filename}: a file is there, where a folder is wanted", file=sys.stderr)
        return EXIT_BAD_INPUT
    except OSError as error:
        print(f"{name}: {error.filename}: {error.strerror}", file=sys.stderr)
        return EXIT_BAD_INPUT
    sys.stdout.reconfigure(errors="replace")  # a terminal may know no ×
    try:
        print(text)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader (`| head`) has seen enough. Python would complain again when it closes stdout.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return code


def missing_module(name: str, error: ModuleNotFoundError) -> int:
    print(f"{name}: {sys.executable} has no Python module {error.name}; wanted: pandas, numpy, "
          "matplotlib and jinja2", file=sys.stderr)
    return EXIT_BAD_INPUT


if __name__ == "__main__":
    sys.exit(main())
