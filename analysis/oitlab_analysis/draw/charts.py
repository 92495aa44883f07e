"""Which charts a report has, and saving them. What they show is in `scatter`, `sweeps` and `bars`."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

from . import bars, bma_figures, curves, quality_speed
from ..compare.metrics import METRICS
from ..compare.sections import Section
from .style import STYLE, Chart, save

# A chart takes 0.3 to 1 s in its three formats. Beyond this many the page shows the first of each
# kind, and --all-charts the rest.
MOST_CHARTS = 10
FEW_CHARTS = 4


@dataclass(frozen=True)
class Kind:
    """A kind of chart: its caption, how many pages a section takes, and how one is drawn."""

    caption: str
    pages: Callable[[Section], int]
    draw: Callable[[Section, int, str], Figure | None]


def _paginated(draw: Callable) -> Callable[[Section, int, str], Figure | None]:
    return lambda section, page, metric: draw(section, bars.paginate(section)[page])


def _bar_pages(section: Section) -> int:
    return len(bars.paginate(section))


# In the order of the page.
KINDS = {
    "quality-speed": Kind(quality_speed.OVERALL_CAPTION, lambda section: 1, quality_speed.draw_overall),
    "quality-speed-scenes": Kind(quality_speed.CAPTION, quality_speed.pages, quality_speed.draw_scenes),
    "depth-filter": Kind(curves.DEPTH_FILTER_CAPTION, curves.pages("lucid", "depth_filter"),
                         curves.draw_depth_filter),
    "alpha-threshold": Kind(curves.ALPHA_CAPTION, curves.pages("lucid", "alpha_threshold"),
                            curves.draw_alpha_threshold),
    "frame-times": Kind(bars.FRAME_CAPTION, _bar_pages, _paginated(bars.draw_frame_times)),
    "stages": Kind(bars.STAGE_CAPTION, _bar_pages, _paginated(bars.draw_stages)),
    "memory": Kind(bars.MEMORY_CAPTION, _bar_pages, _paginated(bars.draw_memory)),
}

BMA_CAPTIONS = {
    3: "Frame time against local memory of a shader that hardly uses it.",
    5: "Depth complexity: pixels by the number of their fragments (log scale).",
    7: "A fly-through: frame times, and the depth complexity of each frame.",
    9: "Time of each sort relative to insertion sort, by interval of fragments.",
}


def _is_of_bma(section: Section) -> int:
    """Figures of a paper mean something for the experiment that repeats it, and for no other."""
    return int(section.context["Experiment"] == "bma")


def _bma_figure(number: int) -> Kind:
    """The counterpart of a figure of Knowles et al. 2013."""
    draw = getattr(bma_figures, f"bma_figure{number}")
    return Kind(BMA_CAPTIONS[number] + f" After figure {number} of Knowles et al. 2013.", _is_of_bma,
                lambda section, page, metric: draw(section.table))


KINDS |= {f"bma-figure{number}": _bma_figure(number) for number in BMA_CAPTIONS}


@dataclass(frozen=True)
class Task:
    section: Section
    number: int  # of the section, from 1
    kind: str
    page: int
    pages: int


_tasks: list[Task] = []  # what the processes of the pool inherit, instead of copies of every section


def save_charts(
    sections: list[Section], folder: Path, metric: str = "rmse", everything: bool = False
) -> tuple[list[list[Chart]], int]:
    """Draws the charts of each section; long ones are spread over several files.

    Returns them by section, and how many were left out because there are too many.
    """
    global _tasks
    folder.mkdir(exist_ok=True)
    for kind in KINDS:  # those of an earlier report would be taken for charts of this one
        for old in folder.glob(f"{kind}-[0-9]*"):
            old.unlink()
    tasks = [
        Task(section, number, kind, page, kinds.pages(section))
        for number, section in enumerate(sections, 1)
        if (section.table["status"] == "ok").any()
        for kind, kinds in KINDS.items()
        for page in range(kinds.pages(section))
    ]
    left_out = 0
    if not everything and len(tasks) > MOST_CHARTS:
        # The first page of every kind and section, then the second ones, as far as they go.
        chosen = {id(task) for task in sorted(tasks, key=lambda task: task.page)[:MOST_CHARTS]}
        left_out = len(tasks) - len(chosen)
        tasks = [task for task in tasks if id(task) in chosen]
    _tasks = tasks
    arguments = (range(len(tasks)), [folder] * len(tasks), [metric] * len(tasks))
    workers = min(len(os.sched_getaffinity(0)), len(tasks))
    if len(tasks) > FEW_CHARTS and workers > 1:  # matplotlib does not run in threads
        with ProcessPoolExecutor(workers, multiprocessing.get_context("fork")) as pool:
            charts = list(pool.map(_save_chart, *arguments))
    else:
        charts = list(map(_save_chart, *arguments))
    by_section = [
        [chart for task, chart in zip(tasks, charts) if chart and task.section is section]
        for section in sections
    ]
    return by_section, left_out


def _save_chart(index: int, folder: Path, metric: str) -> Chart | None:
    task = _tasks[index]
    kind = KINDS[task.kind]
    with matplotlib.rc_context(STYLE):
        figure = kind.draw(task.section, task.page, metric)
        if figure is None:
            return None
        name = f"{task.kind}-{task.number}" + (f"-{task.page + 1}" if task.pages > 1 else "")
        save(figure, folder / name)
    part = f" Chart {task.page + 1} of {task.pages}." if task.pages > 1 else ""
    words = {"metric": METRICS[metric].label, "settings": len(task.section.settings())}
    return Chart(name, kind.caption.format(**words) + part)
