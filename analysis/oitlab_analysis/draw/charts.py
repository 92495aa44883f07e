"""Which charts a report has, in which order and how many, and saving them."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

from ..compare.metrics import METRICS
from ..compare.sections import Section
from . import bma_figures, curves, dots, quality_speed, stacks
from .curve_lines import ALPHA_THRESHOLD, DEPTH_FILTER, Curve
from .style import STYLE, Chart, footnotes, hints_of, save

# A chart takes 0.3 to 1 s in its three formats. A section has its first chart in any case, then more
# as far as both numbers allow; --all-charts draws the rest.
PER_SECTION = 6
IN_ALL = 18
MOST_SECTIONS = 18  # with a chart: a report of more sections is a list of tables
FEW_CHARTS = 4
# Of a section with charts: nobody can tell more apart, and laying them out takes time that grows with the
# square of their number.
MOST_METHODS, MOST_CELLS = 100, 3000
MOST_SETTINGS = 500  # of all sections with charts: each takes some ms for each chart


@dataclass(frozen=True)
class Kind:
    """A kind of chart: its caption, how many a section takes, how one is drawn, and what the caption says
    of the names in it."""

    caption: str
    pages: Callable[[Section, str], int]
    draw: Callable[[Section, int, str], Figure | None]
    note: Callable[[Section, str], str] = lambda section, metric: ""


def _curves(caption: str, asked: tuple[Curve, ...]) -> Kind:
    pages = curves.pages(asked)
    return Kind(caption, lambda section, metric: pages(section),
                lambda section, page, metric: curves.draw_curves(section, asked, page))


BMA_CAPTIONS = {
    3: "Frame time against local memory of a shader that hardly uses it.",
    5: "Depth complexity: pixels by the number of their fragments (log scale).",
    7: "A fly-through: frame times, and the depth complexity of each frame.",
    9: "Time of each sort relative to insertion sort, by interval of fragments.",
}


def _bma_figure(number: int) -> Kind:
    """The counterpart of a figure of Knowles et al. 2013, which means something for the experiment
    that repeats it, and for no other."""
    draw = getattr(bma_figures, f"bma_figure{number}")
    return Kind(BMA_CAPTIONS[number] + f" After figure {number} of Knowles et al. 2013.",
                lambda section, metric: int(section.context["Experiment"] == "bma"),
                lambda section, page, metric: draw(section.table))


# In the order of the page: the first that a section has is the one that stands above its table.
KINDS = {
    "quality-speed": Kind(quality_speed.OVERALL_CAPTION, quality_speed.has_overall, quality_speed.draw_overall,
                          quality_speed.overall_note),
    "quality-speed-scenes": Kind(quality_speed.CAPTION, quality_speed.pages, quality_speed.draw_scenes,
                                 quality_speed.note),
    "depth-filter": _curves(
        "Depth filter of `lucid`: pixels that come out in the wrong order without repair, and frame time "
        "against that with a filter of 3 (intervals: 95%, of paired blocks).", DEPTH_FILTER),
    "alpha-threshold": _curves(
        "Alpha threshold of `lucid`: speed-up against shading every sample (intervals: 95%, of paired "
        "blocks).", ALPHA_THRESHOLD),
    "frame-times": Kind(dots.CAPTION, lambda section, metric: dots.pages(section), dots.draw_frame_times,
                        lambda section, metric: dots.note(section)),
    "stages": Kind(stacks.STAGE_CAPTION, lambda section, metric: stacks.stage_pages(section), stacks.draw_stages,
                   lambda section, metric: stacks.stage_note(section)),
    "memory": Kind(stacks.MEMORY_CAPTION, lambda section, metric: stacks.memory_pages(section),
                   stacks.draw_memory, lambda section, metric: stacks.memory_note(section)),
} | {f"bma-figure{number}": _bma_figure(number) for number in BMA_CAPTIONS}


@dataclass(frozen=True)
class Task:
    section: Section
    number: int  # of the section, from 1
    name: str  # of the kind
    kind: Kind
    page: int
    pages: int


_tasks: list[Task] = []  # what the processes of the pool inherit, instead of copies of every section


def kinds_with(asked: tuple[Curve, ...]) -> dict[str, Kind]:
    """All kinds of charts, the curves that the user asked for right after quality against speed."""
    kinds = dict(list(KINDS.items())[:2])
    kinds |= {f"curve-{curve.name}": _curves(curve.caption(), (curve,)) for curve in asked}
    return kinds | KINDS


def _crowded(sections: list[Section]) -> list[bool]:
    """Which sections have too much for charts, of their own or after those before them."""
    found, settings = [], 0
    for section in sections:
        count = section.table["setting"].nunique()
        found.append(section.table["method"].nunique() > MOST_METHODS or len(section.table) > MOST_CELLS
                     or settings + count > MOST_SETTINGS)
        settings += 0 if found[-1] else count
    return found


def crowded_notes(sections: list[Section]) -> list[str]:
    """What is said of sections that have too much for charts."""
    count = sum(_crowded(sections))
    whose = "a section" if count == 1 else f"{count} sections"
    return [f"No charts of {whose}: a section may have {MOST_METHODS} methods and {MOST_CELLS} cells, and all "
            f"sections with charts {MOST_SETTINGS} settings."] if count else []


def tasks_of(sections: list[Section], metric: str, asked: tuple[Curve, ...]) -> list[list[Task]]:
    """Every chart that each section could have, in the order of their worth: the first of each kind,
    then the second ones."""
    kinds = kinds_with(asked)
    found = []
    for number, (section, crowded) in enumerate(zip(sections, _crowded(sections)), 1):
        own = []
        if (section.table["status"] == "ok").any() and not crowded:
            for name, kind in kinds.items():
                count = kind.pages(section, metric)
                own += [Task(section, number, name, kind, page, count) for page in range(count)]
        found.append(sorted(own, key=lambda task: task.page))
    return found


def choose(tasks: list[list[Task]], everything: bool = False) -> list[Task]:
    """The charts that are drawn: one for each section, then the second of each, while there is room."""
    if everything:
        return [task for own in tasks for task in own]
    chosen = [own[0] for own in tasks[:MOST_SECTIONS] if own]
    for place in range(1, PER_SECTION):
        chosen += [own[place] for own in tasks[:MOST_SECTIONS] if len(own) > place][:max(0, IN_ALL - len(chosen))]
    return chosen


def save_charts(sections: list[Section], folder: Path, metric: str = "rmse", everything: bool = False,
                asked: tuple[Curve, ...] = ()) -> tuple[list[list[Chart]], int]:
    """Draws the charts of each section; long ones are spread over several files.

    Returns them by section, and how many were left out because there are too many.
    """
    global _tasks
    folder.mkdir(exist_ok=True)
    for kind in (*KINDS, "curve-*"):  # those of an earlier report would be taken for charts of this one
        for old in folder.glob(f"{kind}-[0-9]*"):
            old.unlink()
    possible = tasks_of(sections, metric, asked)
    order = list(kinds_with(asked))
    _tasks = sorted(choose(possible, everything), key=lambda t: (t.number, order.index(t.name), t.page))
    charts = _save_tasks(folder, metric)
    by_section: list[list[Chart]] = [[] for _ in sections]
    for task, chart in zip(_tasks, charts):
        if chart:
            by_section[task.number - 1].append(chart)
    return by_section, sum(map(len, possible)) - len(_tasks)


def _save_tasks(folder: Path, metric: str) -> list[Chart | None]:
    """The charts of `_tasks`, many of them in several processes: matplotlib does not run in threads."""
    arguments = (range(len(_tasks)), [folder] * len(_tasks), [metric] * len(_tasks))
    workers = min(len(os.sched_getaffinity(0)), len(_tasks))
    if len(_tasks) > FEW_CHARTS and workers > 1:
        try:
            pool = ProcessPoolExecutor(workers, multiprocessing.get_context("fork"))
        except OSError:
            pass  # its locks need shared memory: a container may have no /dev/shm that the user can write
        else:
            with pool:
                return list(pool.map(_save_chart, *arguments))
    return list(map(_save_chart, *arguments))


def _save_chart(index: int, folder: Path, metric: str) -> Chart | None:
    task = _tasks[index]
    with matplotlib.rc_context(STYLE):
        figure = task.kind.draw(task.section, task.page, metric)
        if figure is None:
            return None
        name = f"{task.name}-{task.number}" + (f"-{task.page + 1}" if task.pages > 1 else "")
        words = {"metric": METRICS[metric].label,
                 "settings": quality_speed.settings_in(task.section, METRICS[metric])}
        part = f" Chart {task.page + 1} of {task.pages}." if task.pages > 1 else ""
        said = task.kind.caption
        for word, text in words.items():  # not format(): a caption may hold what a user typed
            said = said.replace(f"{{{word}}}", str(text))
        caption = " ".join(filter(None, [f"{said}{part}", task.kind.note(task.section, metric),
                                         footnotes(task.section)]))
        hints = hints_of(figure)
        save(figure, folder / name, caption)
    return Chart(name, caption, hints)
