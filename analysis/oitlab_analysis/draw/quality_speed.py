"""Quality against speed: what an error costs, per scene and over all of them.

One colour for each method, one marker for each variant of it; bars are the 95% intervals of the times.
Errors are on a log axis; images without any stand on its lower end, which is marked.
"""

from __future__ import annotations

import numpy
import pandas
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, NullFormatter

from .. import formats
from ..compare.device_notes import NOTED
from ..compare.labels import short_labels
from ..compare.metrics import METRICS, Metric
from ..compare.sections import Section
from .layout import log_axis, mark_beyond, panel_grid, place_labels, robust_limit, shortened, wrap_label
from .style import MARKERS, mark_point, method_looks

PANELS_PER_CHART = 12
PANEL_COLUMNS = 3
MOST_VARIANTS_NAMED = 5
MOST_HINTS = 300  # points of one panel with an artist each, for the pointer
MOST_BARS = 24  # points with intervals in one panel: more are a smear
LABEL_CHARACTERS = 20
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


def pages(section: Section, metric: str = "rmse") -> int:
    """How many charts the scored settings of a section take."""
    return -(-scored(section, METRICS[metric])["setting"].nunique() // PANELS_PER_CHART)


def scored(section: Section, metric: Metric) -> pandas.DataFrame:
    """The measured cells whose error is known, with it in the column `error`."""
    table = section.table.assign(error=metric.errors(section.table))
    return table[(table["status"] == "ok") & table["error"].notna()]


def note(section: Section, name: str) -> str:
    """What the caption of the scenes must say of their names, or ""."""
    return short_labels(scored(section, METRICS[name]))[1]


def overall_note(section: Section, name: str) -> str:
    return short_labels(_of_overall(section, METRICS[name]))[1]


def _of_overall(section: Section, metric: Metric) -> pandas.DataFrame:
    """The cells of the variants that overall() has."""
    return section.table[section.table["label"].isin(overall(section, metric)["label"])]


def draw_scenes(section: Section, page: int, name: str) -> Figure | None:
    """A panel for each setting of this page; None if no image was scored."""
    metric = METRICS[name]
    table = scored(section, metric)
    groups = list(table.groupby("setting", sort=False))
    groups = groups[page * PANELS_PER_CHART:(page + 1) * PANELS_PER_CHART]
    if not groups:
        return None
    floor, looks = error_floor(table["error"]), looks_of(table)
    names, _ = short_labels(table)
    alone = len(groups) == 1
    columns = 1 if alone else 2 if len(groups) in (2, 4) else PANEL_COLUMNS
    height = 3.2 if alone else 2.2 if len(groups) <= 4 else 1.55
    figure, all_axes = panel_grid([setting for setting, _ in groups], columns, height,
                                  _handles(table, looks, names))
    for index, (axes, (_, cells)) in enumerate(zip(all_axes, groups)):
        times = cells["frame_ms.median"].to_numpy(dtype=float)
        ends = [cells[f"frame_ms.ci_{end}"].to_numpy(dtype=float) for end in ("low", "high")]
        _draw_points(axes, cells, times, ends, looks, names, floor, metric, table["error"], not alone)
        if index % columns == 0:
            axes.set_ylabel(metric.label, size=8)
        else:
            axes.tick_params(labelleft=False)
        if index + columns >= len(groups):
            axes.set_xlabel("frame time, ms (log scale)", size=8)
    return figure


def overall(section: Section, metric: Metric) -> pandas.DataFrame:
    """One row for each variant that was measured in every setting that has a baseline like most.

    Ratios to different baselines must not be averaged: only settings count whose baseline is of the
    method and source that most have for it, which is `blend` where there is one.
    Columns: label, method, error (mean), ratio (geometric mean), low, high (quartiles of the ratio),
    settings (how many). Variants that were not measured everywhere are left out: means over other
    sets of scenes say nothing beside these.
    """
    table = scored(section, metric)
    table = table[table["ratio"].notna()]
    baselines = section.table[section.table["verdict"] == "baseline"]
    if baselines.empty:
        return pandas.DataFrame()
    usual = usual_baseline(section)
    settings = set(baselines.loc[baselines["baseline_name"] == usual, "setting"])
    table = table[table["setting"].isin(settings)]
    table = table[["label", "method", "setting", "error", "ratio"]].assign(
        ratio=table["ratio"].astype(float), log=numpy.log(table["ratio"].astype(float)))
    table = table[table.groupby("label")["setting"].transform("nunique") == len(settings)]
    groups = table.groupby("label")
    return pandas.DataFrame({
        "method": groups["method"].first(), "error": groups["error"].mean(),
        "ratio": numpy.exp(groups["log"].mean()), "low": groups["ratio"].quantile(0.25),
        "high": groups["ratio"].quantile(0.75), "settings": len(settings)}).reset_index()


def usual_baseline(section: Section) -> str:
    """What most settings have for a baseline: `blend source=hardware`."""
    return section.table.loc[section.table["verdict"] == "baseline", "baseline_name"].mode().iloc[0]


def settings_in(section: Section, metric: Metric) -> int:
    """Over how many settings overall() takes its means."""
    table = overall(section, metric)
    return 0 if table.empty else int(table["settings"].iloc[0])


def has_overall(section: Section, metric: str = "rmse") -> int:
    """1 where there are two settings and two variants or more to sum up, else 0."""
    return int(len(overall(section, METRICS[metric])) >= 2 and settings_in(section, METRICS[metric]) >= 2)


def draw_overall(section: Section, page: int, name: str) -> Figure | None:
    """One point for each variant, over all settings; None where has_overall() says 0."""
    if not has_overall(section, name):
        return None
    metric = METRICS[name]
    table = overall(section, metric)
    looks, floor = looks_of(table), error_floor(table["error"])
    names, _ = short_labels(_of_overall(section, metric))
    figure, (axes,) = panel_grid([""], 1, 3.2, _handles(table, looks, names))
    ratios, ends = table["ratio"].to_numpy(dtype=float), [table[end].to_numpy(dtype=float) for end in ("low", "high")]
    _draw_points(axes, table, ratios, ends, looks, names, floor, metric, table["error"], False)
    axes.set_ylabel(f"{metric.label} (mean)", size=8)
    noted = NOTED if (section.table["device_note"] != "").any() else ""
    axes.set_xlabel(f"time over that of {usual_baseline(section)}{noted} (log scale)", size=8)
    return figure


def _draw_points(axes: Axes, cells: pandas.DataFrame, times: numpy.ndarray, ends: list[numpy.ndarray],
                 looks: dict, names: dict[str, str], floor: float, metric: Metric, all_errors: pandas.Series,
                 briefly: bool) -> None:
    """Points with intervals, hints for the pointer, the front, and labels where they find room."""
    errors = numpy.maximum(cells["error"].to_numpy(dtype=float), floor)
    labels = cells["label"].tolist()
    limit = robust_limit(times, log=True) or times.max()
    shown = numpy.nan_to_num(numpy.concatenate([times, *ends]), nan=times.min())
    log_axis(axes, "x", shown[shown > 0].min() / 1.15, max(limit, shown[shown <= limit].max()) * 1.25)
    set_error_axis(axes, metric, all_errors, floor)
    colours = [looks[label]["color"] for label in labels]
    sure = [i for i in range(len(times)) if numpy.isfinite(ends[0][i])]
    if sure and len(times) <= MOST_BARS:
        axes.hlines(errors[sure], ends[0][sure], ends[1][sure], colors=[colours[i] for i in sure], linewidth=1.1,
                    zorder=2)
    inside = times <= limit
    if len(times) > MOST_HINTS:
        axes.scatter(times[inside], errors[inside], s=8, c=[c for c, i in zip(colours, inside) if i], zorder=3)
    for index, label in enumerate(labels if len(times) <= MOST_HINTS else ()):
        if inside[index]:
            point, = axes.plot(times[index:index + 1], errors[index:index + 1], linestyle="none", markersize=5,
                               markeredgecolor="black", markeredgewidth=0.4, zorder=3, clip_on=False,
                               color=looks[label]["color"], marker=looks[label]["marker"])
            mark_point(point, _hint(label, times[index], cells["error"].iloc[index], metric))
    mark_beyond(axes, [(times[i], errors[i], f"{names[labels[i]]}: {formats.number(times[i])}")
                       for i in range(len(times)) if not inside[i]], "x", "black")
    front = pareto_front(times, errors)
    axes.step(times[front], errors[front], where="post", **FRONT)
    wanted = [*front, *(i for i in range(len(times)) if i not in front)]
    texts = point_names(cells, names, wanted, briefly)
    bars = [(ends[0][i], errors[i], ends[1][i], errors[i]) for i in sure] if len(times) <= MOST_BARS else []
    place_labels(axes, [(times[i], errors[i], texts[i], colours[i]) for i in wanted if inside[i]],
                 5.8 if briefly else 6.5, [*_corners(times[front], errors[front]), *bars])


def _corners(times: numpy.ndarray, errors: numpy.ndarray) -> list[tuple[float, float, float, float]]:
    """The level and upright lines of the front, which is drawn in steps."""
    level = [(times[i], errors[i], times[i + 1], errors[i]) for i in range(len(times) - 1)]
    return level + [(times[i + 1], errors[i], times[i + 1], errors[i + 1]) for i in range(len(times) - 1)]


def _hint(label: str, time: float, error: float, metric: Metric) -> str:
    """What the pointer over a point shows."""
    shown = metric.none if error == 0 else formats.number(metric.shown(error))
    return f"{label}: {formats.number(time)}, {metric.label} {shown}"


def point_names(cells: pandas.DataFrame, names: dict[str, str], order: list[int], briefly: bool) -> list[str]:
    """What stands at each point: its name, or where all are of one method what tells them apart. Where
    names are long, and `briefly`, it is the method, at the first of its points in this order."""
    methods, shown = cells["method"].tolist(), [names[label] for label in cells["label"]]
    one = len(set(methods)) == 1
    if one:
        shown = [name.removeprefix(method).strip().removeprefix("(").removesuffix(")") or name
                 for method, name in zip(methods, shown)]
    texts = [wrap_label(name, LABEL_CHARACTERS) for name in shown]
    named = set()
    for index in order:
        if not one and (briefly or texts[index].count("\n") > 1):
            texts[index] = "" if methods[index] in named else methods[index]
            named.add(methods[index])
    return texts


def error_floor(errors: pandas.Series) -> float:
    """Where images without error stand on the log axis: well below the least error there is."""
    positive = errors[errors > 0]
    return float(positive.min()) / 4 if len(positive) else 1e-4


def set_error_axis(axes: Axes, metric: Metric, errors: pandas.Series, floor: float) -> None:
    """Logarithmic, its lower end standing for no error."""
    none = bool((errors == 0).any())
    top = max(float(errors.max()), floor * (10 if none else 5))
    axes.set_yscale("log")
    axes.set_ylim(floor if none else floor * 2.5, top * 1.6)
    decades = numpy.arange(numpy.floor(numpy.log10(floor)), numpy.ceil(numpy.log10(top)) + 1)
    ticks = [t for t in 10.0**decades if floor * 2 < t < top * 1.6]
    ticks = ticks[:: max(1, len(ticks) // 5)]
    if len(ticks) < 2 and not none:
        ticks = [errors.min(), errors.max()] if errors.max() > 1.1 * errors.min() else [errors.max()]
    if none:
        ticks = [floor, *ticks]
    axes.yaxis.set_major_locator(FixedLocator(ticks))
    axes.yaxis.set_major_formatter(
        lambda error, _: metric.none if error <= floor * 1.01 else f"{metric.shown(error):.3g}")
    axes.yaxis.set_minor_formatter(NullFormatter())


def looks_of(table: pandas.DataFrame) -> dict[str, dict]:
    """Label -> colour of its method and marker of its variant."""
    methods = method_looks(list(table["method"]))
    pairs = table.drop_duplicates("label")[["method", "label"]].itertuples(index=False)
    ordered = sorted(pairs, key=lambda p: (p.method != "blend", p.method, formats.natural_key(p.label)))
    seen: dict[str, int] = {}
    looks = {}
    for method, label in ordered:
        variant = seen[method] = seen.get(method, -1) + 1
        first = MARKERS.index(methods[method]["marker"])
        looks[label] = {"color": methods[method]["color"], "marker": MARKERS[(first + variant) % len(MARKERS)],
                        "method": method}
    return looks


def _handles(table: pandas.DataFrame, looks: dict, names: dict[str, str]) -> list[Line2D]:
    """Legend entries: every variant by name, or only the method where it has many."""
    handles = []
    for method in dict.fromkeys(look["method"] for look in looks.values()):
        own = {label: look for label, look in looks.items() if look["method"] == method}
        if len(own) > MOST_VARIANTS_NAMED:
            first = next(iter(own.values()))
            own = {f"{method} ({len(own)} variants)": first | {"marker": "s"}}
        else:
            own = {names[label]: look for label, look in own.items()}
        handles += [Line2D([], [], linestyle="none", marker=look["marker"], color=look["color"],
                           markersize=5, markeredgecolor="black", markeredgewidth=0.4, label=label)
                    for label, look in own.items()]
    return [*shortened(handles), Line2D([], [], **FRONT, label="Pareto front")]
