"""The command line: `python3 -m oitlab_analysis report RESULTS_DIR`, or `histogram FILE OUT`."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

# As in `metrics`, which would load pandas: --help should not wait for it.
METRICS = ("rmse", "psnr", "ssim", "flip", "pixels_off", "wrong_order")

EXIT_DONE = 0
EXIT_CELLS_FAILED = 1
EXIT_BAD_INPUT = 2


def parse_arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="oitlab_analysis", description="Analyses a results folder that `oitlab run` wrote."
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    report = commands.add_parser(
        "report",
        help="table, plots and report of a results folder",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Reads every cell in RESULTS_DIR/cells and prints a table, then the paths of the\n"
        "files that it wrote.",
        epilog="written into RESULTS_DIR:\n"
        "  report.html   one self-contained page: tables, charts, pictures\n"
        "  report.md     the same, with relative links\n"
        "  cells.csv     one row per cell, every number of the report\n"
        "  plots/        the charts as PNG, SVG and PDF\n\n"
        "exit codes:\n"
        "  0  done\n"
        "  1  done, but some cells failed\n"
        "  2  bad input, or nothing to report",
    )
    report.add_argument(
        "results", metavar="RESULTS_DIR", type=Path, help="the folder that holds cells/ and images/"
    )
    report.add_argument("--metric", choices=METRICS, default="rmse",
                        help="error of the quality-against-speed charts (default rmse)")
    report.add_argument("--all-charts", action="store_true",
                        help="draw every chart, however many there are")
    histogram = commands.add_parser(
        "histogram",
        help="chart of a scene's depth complexity",
        description="Draws how many pixels have how many fragments, on a log scale.",
    )
    histogram.add_argument("depth", metavar="FILE.json", type=Path,
                           help="what `oitlab depth --json` prints")
    histogram.add_argument("chart", metavar="OUT.png", type=Path, help="the chart to write")
    return parser.parse_args(arguments)


def run_histogram(source: Path, target: Path) -> int:
    try:
        from .histogram import BadDepth, draw_histogram
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


def main(arguments: list[str] | None = None) -> int:
    options = parse_arguments(arguments)
    if options.command == "histogram":
        return run_histogram(options.depth, options.chart)
    # Late, so that --help does not wait for matplotlib, and works without it.
    try:
        from .cells import BadResults
        from .report import make_report
    except ModuleNotFoundError as error:
        print(
            f"oitlab report: {sys.executable} has no Python module {error.name}; wanted: pandas, "
            "numpy, matplotlib and jinja2",
            file=sys.stderr,
        )
        return EXIT_BAD_INPUT
    try:
        result = make_report(options.results, options.metric, options.all_charts)
    except BadResults as error:
        print(f"oitlab report: {error}", file=sys.stderr)
        return EXIT_BAD_INPUT
    except OSError as error:
        print(f"oitlab report: {error.filename}: {error.strerror}", file=sys.stderr)
        return EXIT_BAD_INPUT
    sys.stdout.reconfigure(errors="replace")  # a terminal may know no ×
    try:
        print(result.text)
        for path in result.files:
            print(path)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader (`| head`) has seen enough. Python would complain again when it closes stdout.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return EXIT_CELLS_FAILED if result.failed else EXIT_DONE


if __name__ == "__main__":
    sys.exit(main())
