"""Quality against speed: what an error costs, per scene and over all of them.

One colour a method, one marker a variant of it; bars are the 95% intervals of the times. Errors are
on a log axis; images without any stand on its lower end, which is marked.
"""

from __future__ import annotations

import textwrap

import numpy
import pandas
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, LogLocator, NullFormatter

from .. import formats
from ..compare.device_notes import NOTED
from ..compare.metrics import METRICS, Metric
from ..compare.sections import Section
from .style import COLUMN, MARKERS, PAGE, method_colours, source_line

PANELS_PER_CHART = 12
PANEL_COLUMNS = 3
LEGEND_CHARACTERS = 100  # of a row, at the width of a page
MOST_VARIANTS_NAMED = 5
FRONT = {"color": "black", "linewidth": 0.9, "linestyle": "--", "zorder": 1}
CAPTION = (
    "{metric} against frame time, per scene. Less is better on both axes; the dashed line joins what "
    "nothing beats on both (the Pareto front). Bars: 95% intervals. Points on the lower edge have no "
    "such error."
)
OVERALL_CAPTION = (
    "{metric} against time, over all {settings} scenes and settings: the mean error, and the geometric "
    "mean of the frame time over that of the baseline. Bars: from the first to the third quartile of "
    "the scenes. The dashed line is the Pareto front."
)


def pareto_front(times: numpy.ndarray, errors: numpy.ndarray) -> list[int]:
    """The indices of the points that no other point beats, fastest first.

    A point beats another if it is at least as good in both and better in one; of equal points the
    first stays.
    """
    front, least = [], numpy.inf
    for index in sorted(range(len(times)), key=lambda i: (times[i], errors[i], i)):
        if errors[index] < least:
            front.append(index)
            least = errors[index]
    return front


def pages(section: Section) -> int:
    """How many charts the settings of a section take; at least one."""
    return max(1, -(-len(section.settings()) // PANELS_PER_CHART))


def scored(section: Section, metric: Metric) -> pandas.DataFrame:
    """The measured cells whose error is known, with it in the column `error`."""
    table = section.table.assign(error=metric.errors(section.table))
    return table[(table["status"] == "ok") & table["error"].notna()]


def draw_scenes(section: Section, page: int, name: str) -> Figure | None:
    """A panel for each setting of this page; None if no image was scored."""
    metric = METRICS[name]
    table = scored(section, metric)
    groups = list(table.groupby("setting", sort=False))
    groups = groups[page * PANELS_PER_CHART:(page + 1) * PANELS_PER_CHART]
    if not groups:
        return None
    floor = error_floor(table["error"])
    rows = -(-len(groups) // PANEL_COLUMNS)
    height = 1.75 * rows + 0.45  # inches, as all below; a layout engine would take a second
    figure = Figure(figsize=(PAGE, height))
    grid = figure.subplots(rows, PANEL_COLUMNS, squeeze=False, sharey=True)
    figure.subplots_adjust(left=0.65 / PAGE, right=1 - 0.1 / PAGE, bottom=0.65 / height,
                           top=1 - 0.25 / height, wspace=0.12, hspace=0.4)
    for axes in grid.flat[len(groups):]:
        axes.remove()
    looks = looks_of(table)
    for axes, (setting, cells) in zip(grid.flat, groups):
        _draw_panel(axes, cells, looks, floor)
        axes.set_title(textwrap.shorten(setting, 34), size=8, loc="left")
        set_error_axis(axes, metric, table["error"], floor)
    for axes in grid[:, 0]:
        axes.set_ylabel(metric.label, size=8)
    figure.supxlabel("frame time, ms (log scale)\n" + textwrap.fill(source_line(section), 110),
                     size=7.5, y=0)
    _legend(figure, table, looks)
    return figure


def _draw_panel(axes: Axes, cells: pandas.DataFrame, looks: dict, floor: float) -> None:
    errors = numpy.maximum(cells["error"].to_numpy(), floor)
    times = cells["frame_ms.median"].to_numpy()
    low, high = (cells[f"frame_ms.ci_{end}"].to_numpy(dtype=float) for end in ("low", "high"))
    colours = [looks[label]["color"] for label in cells["label"]]
    axes.hlines(errors, low, high, colors=colours, linewidth=1.2, zorder=2)
    _draw_points(axes, times, errors, cells["label"], looks)
    _draw_front(axes, times, errors)
    _set_time_axis(axes, times)
    axes.tick_params(labelsize=7)
    axes.grid(color="#e4e4e4", linewidth=0.5)
    axes.spines[["top", "right"]].set_visible(False)


def _draw_points(axes: Axes, times, errors, labels, looks: dict) -> None:
    """All points of one look at once: a big sweep has few looks and many points."""
    by_look: dict[tuple, list[int]] = {}
    for index, label in enumerate(labels):
        by_look.setdefault((looks[label]["color"], looks[label]["marker"]), []).append(index)
    for (colour, marker), indices in by_look.items():
        axes.plot(times[indices], errors[indices], linestyle="none", marker=marker, color=colour,
                  markersize=5, markeredgecolor="black", markeredgewidth=0.4, zorder=3,
                  clip_on=False)


def _draw_front(axes: Axes, times: numpy.ndarray, errors: numpy.ndarray) -> None:
    front = pareto_front(times, errors)
    axes.step(times[front], errors[front], where="post", **FRONT)


def _set_time_axis(axes: Axes, times: numpy.ndarray) -> None:
    """Logarithmic, with plain numbers at few places, whatever the span."""
    low, high = times.min() / 1.25, times.max() * 1.25
    axes.set_xscale("log")
    axes.set_xlim(low, high)
    ticks = [t for t in LogLocator(subs=(1, 2, 5)).tick_values(low, high) if low <= t <= high]
    if len(ticks) < 2:
        ticks = numpy.linspace(times.min(), times.max(), 2) if times.max() > times.min() * 1.02 \
            else [times.min()]
    while len(ticks) > 4:
        ticks = ticks[::2]
    axes.xaxis.set_major_locator(FixedLocator(list(ticks)))
    axes.xaxis.set_major_formatter(lambda value, _: f"{float(f'{value:.2g}'):g}")
    axes.xaxis.set_minor_formatter(NullFormatter())


def error_floor(errors: pandas.Series) -> float:
    """Where images without error stand on the log axis: well below the least error there is."""
    positive = errors[errors > 0]
    return float(positive.min()) / 4 if len(positive) else 1e-4


def set_error_axis(axes: Axes, metric: Metric, errors: pandas.Series, floor: float) -> None:
    """Logarithmic, its lower end standing for no error."""
    top = max(float(errors.max()), floor * 10)
    axes.set_yscale("log")
    axes.set_ylim(floor if (errors == 0).any() else floor * 2, top * 1.6)
    decades = numpy.arange(numpy.floor(numpy.log10(floor)) , numpy.ceil(numpy.log10(top)) + 1)
    ticks = [t for t in 10.0**decades if floor * 2 < t < top * 1.6]
    ticks = ticks[:: max(1, len(ticks) // 5)] or [top]
    if (errors == 0).any():
        ticks = [floor, *ticks]
    axes.yaxis.set_major_locator(FixedLocator(ticks))
    axes.yaxis.set_major_formatter(
        lambda error, _: metric.none if error <= floor * 1.01 else f"{metric.shown(error):.3g}")
    axes.yaxis.set_minor_formatter(NullFormatter())


def looks_of(table: pandas.DataFrame) -> dict[str, dict]:
    """Label -> colour of its method and marker of its variant."""
    colours = method_colours(list(table["method"]))
    pairs = table.drop_duplicates("label")[["method", "label"]].itertuples(index=False)
    ordered = sorted(pairs, key=lambda p: (p.method != "blend", p.method, formats.natural_key(p.label)))
    place = {method: i for i, method in enumerate(colours)}
    seen: dict[str, int] = {}
    looks = {}
    for method, label in ordered:
        variant = seen[method] = seen.get(method, -1) + 1
        looks[label] = {"color": colours[method], "marker": MARKERS[(place[method] + variant) % len(MARKERS)],
                        "method": method}
    return looks


def _legend(figure: Figure, table: pandas.DataFrame, looks: dict, columns: int | None = None) -> None:
    """Every variant by name, or only the method where it has many; all above the axes."""
    handles = []
    for method in dict.fromkeys(look["method"] for look in looks.values()):
        own = {label: look for label, look in looks.items() if look["method"] == method}
        if len(own) > MOST_VARIANTS_NAMED:
            first = next(iter(own.values()))
            own = {f"{method} ({len(own)} variants)": first | {"marker": "s"}}
        handles += [Line2D([], [], linestyle="none", marker=look["marker"], color=look["color"],
                           markersize=5, markeredgecolor="black", markeredgewidth=0.4, label=label)
                    for label, look in own.items()]
    handles.append(Line2D([], [], **FRONT, label="Pareto front"))
    longest = max(len(handle.get_label()) for handle in handles)
    columns = columns or max(1, min(len(handles), LEGEND_CHARACTERS // (longest + 5)))
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.01, 1), ncol=columns, frameon=False, fontsize=7,
                  handletextpad=0.4, columnspacing=1.2)


def overall(section: Section, metric: Metric) -> pandas.DataFrame:
    """One row for each variant that was scored and compared in every setting that has the baseline.

    The baseline is the method that most settings have for it, which is `blend` where there is one.
    Columns: label, method, error (mean), ratio (geometric mean), low, high (quartiles of the ratio),
    settings (how many). Variants that were not measured everywhere are left out: means over other
    sets of scenes say nothing beside these.
    """
    table = scored(section, metric)
    table = table[table["ratio"].notna()]
    baselines = section.table[section.table["verdict"] == "baseline"]
    if baselines.empty:
        return pandas.DataFrame()
    usual = baselines["method"].mode().iloc[0]
    settings = set(baselines.loc[baselines["method"] == usual, "setting"])
    table = table[table["setting"].isin(settings)]
    rows = []
    for label, cells in table.groupby("label"):
        if set(cells["setting"]) >= settings:
            ratios = cells["ratio"].to_numpy(dtype=float)
            low, high = numpy.quantile(ratios, [0.25, 0.75])
            rows.append((label, cells["method"].iloc[0], cells["error"].mean(),
                         float(numpy.exp(numpy.log(ratios).mean())), low, high, len(settings)))
    return pandas.DataFrame(
        rows, columns=["label", "method", "error", "ratio", "low", "high", "settings"])


def draw_overall(section: Section, page: int, name: str) -> Figure | None:
    """One point a variant, over all settings; None for fewer than two settings or variants."""
    metric = METRICS[name]
    table = overall(section, metric)
    if len(table) < 2 or table["settings"].iloc[0] < 2:
        return None
    looks, floor = looks_of(table), error_floor(table["error"])
    figure = Figure(figsize=(COLUMN + 0.6, 3.2), layout="constrained")
    axes = figure.subplots()
    errors, ratios = numpy.maximum(table["error"].to_numpy(), floor), table["ratio"].to_numpy()
    axes.hlines(errors, table["low"], table["high"], zorder=2, linewidth=1.1,
                colors=[looks[label]["color"] for label in table["label"]])
    _draw_points(axes, ratios, errors, table["label"], looks)
    _draw_front(axes, ratios, errors)
    _set_time_axis(axes, numpy.concatenate([ratios, table["low"], table["high"]]))
    set_error_axis(axes, metric, table["error"], floor)
    axes.tick_params(labelsize=7.5)
    axes.grid(color="#e4e4e4", linewidth=0.5)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_ylabel(f"{metric.label} (mean)", size=8)
    # On the chart itself, because charts get copied around.
    said = [note for note in dict.fromkeys(section.table["device_note"]) if note]
    axes.set_xlabel("\n".join([f"time over that of the baseline{NOTED if said else ''} (log scale)",
                               textwrap.fill(source_line(section), 60),
                               *(textwrap.fill(f"{NOTED.strip()} {note}", 60) for note in said)]), size=7.5)
    _legend(figure, table, looks, columns=2)
    return figure
