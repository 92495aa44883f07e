"""The figures of Knowles, Leach and Zambetta 2013, "Backwards Memory Allocation and Improved OIT",
from cells of the methods `abuffer` and `local_memory` (experiments/bma.toml).

Every function takes the tidy table (`cells.as_table`) of one section, that is of one device, build
and commit, and returns a table, a figure, or None where the table does not have the cells. OIT is the
paper's word for one shader with room for `Max alloc` fragments of a pixel (sort_memory = max), BMA-OIT
for a shader an interval. Times in ms are medians; speed-ups are their ratios, above 1 where BMA-OIT
is faster. What the paper printed stands in paper/published.
"""

from __future__ import annotations

import functools

import matplotlib
import pandas
from matplotlib.figure import Figure

from .style import COLOURS, GRID, MARKERS, PAGE, STYLE

# Scene -> the paper's name of what it stands in for.
PAPER_SCENES = {"sponza_like": "Atrium", "smoke": "Smoke", "powerplant": "Power Plant"}
INTERVALS = (8, 16, 32, 64, 128, 256, 512, 1024)
SETTING = ["scene", "view", "width", "height"]
# What the paper's OIT and BMA-OIT are, beside how much memory they sort in.
PAPER_CHOICES = {"sort": "auto", "mask": "stencil", "deep": "exact", "on_overflow": "grow",
                 "node_color": "rgba32f", "local": "keys"}
SORTS = ("insertion", "merge", "shell", "bitonic", "register")
# Intervals go from light to dark.
SHADES = ("#e8eef2", "#cfdde6", "#b0c7d6", "#8dafc4", "#6893b0", "#457899", "#275d80", "#0e4060",
          "#04263d")


def _drawn(draw):
    """Draws in the style of the other charts; None from an empty table."""
    @functools.wraps(draw)
    def styled(table: pandas.DataFrame) -> Figure | None:
        with matplotlib.rc_context(STYLE):
            return draw(table)
    return styled


@_drawn
def bma_figure3(table: pandas.DataFrame) -> Figure | None:
    """Frame time against the local memory of a shader that hardly uses it."""
    cells = _measured(table, "local_memory", "size", "passes")
    if cells.empty:
        return None
    figure, axes = _figure()
    for index, (passes, same) in enumerate(cells.groupby("param.passes")):
        same = same.sort_values("param.size")
        axes.plot(same["param.size"] * 16, same["frame_ms.median"], color=COLOURS[index % len(COLOURS)],
                  marker=MARKERS[index % len(MARKERS)], markersize=4, linewidth=1,
                  label=f"{passes:g} full-screen passes")
    axes.set_xlabel("local memory of a thread, bytes")
    axes.set_ylabel("frame time, ms")
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False)
    return figure


@_drawn
def bma_figure5(table: pandas.DataFrame) -> Figure | None:
    """Pixels by interval of their number of fragments, on a log scale."""
    cells = _measured(table, "abuffer")
    if cells.empty:
        return None
    cells = cells[~cells["view"].str.startswith("path:")]
    counted = [(name, rows.iloc[0]) for name, rows in by_setting(cells)
               if any(rows.iloc[0].get(_pixels(i), 0) > 0 for i in INTERVALS)]
    if not counted:
        return None
    figure, axes = _figure()
    most = max(i for i in INTERVALS for _, row in counted if row.get(_pixels(i), 0) > 0)
    shown = [interval for interval in INTERVALS if interval <= most]
    width = 0.8 / len(counted)
    scenes = [scene for (scene, *_), _ in counted]
    for index, ((scene, view, *_), row) in enumerate(counted):
        places = [i + (index - (len(counted) - 1) / 2) * width for i in range(len(shown))]
        axes.bar(places, [row.get(_pixels(i), 0) for i in shown], width,
                 color=COLOURS[index % len(COLOURS)], edgecolor="black", linewidth=0.5,
                 label=scene_name(scene) + ("" if scenes.count(scene) == 1 else f", {view}"))
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")  # powers would need parse_math
    axes.set_xticks(range(len(shown)), [_range(i) for i in shown])
    axes.set_xlabel("fragments of a pixel")
    axes.set_ylabel("pixels")
    axes.legend(frameon=False)
    return figure


@_drawn
def bma_figure7(table: pandas.DataFrame) -> Figure | None:
    """A fly-through: times of OIT and BMA-OIT over the depth complexity of each frame; below, the
    deep intervals by themselves (the paper's figure 8)."""
    cells = abuffer_cells(table, **PAPER_CHOICES)
    cells = cells[cells["view"].str.startswith("path:")] if not cells.empty else cells
    if cells.empty:
        return None
    cells = cells.assign(
        path=cells["view"].str.partition("@")[0], at=cells["view"].str.partition("@")[2].astype(float))
    first = cells.iloc[0]  # one scene, path, size and allocation a figure
    key = ["scene", "path", "width", "height", "param.max_fragments"]
    cells = cells[(cells[key] == first[key]).all(axis=1)].sort_values("at")
    bma, oit = (cells[cells["param.sort_memory"] == memory] for memory in ("bma", "max"))
    counted = bma if not bma.empty else oit
    if len(counted) < 2:
        return None
    figure, axes = _figure(rows=2)
    times, deep = axes
    shown = [i for i in INTERVALS if _pixels(i) in counted and counted[_pixels(i)].sum() > 0]
    pixels = times.twinx()
    pixels.stackplot(counted["at"], [counted[_pixels(i)] for i in shown],
                     colors=[SHADES[INTERVALS.index(i)] for i in shown],
                     labels=[_range(i) for i in shown])
    times.set_zorder(pixels.get_zorder() + 1)
    times.patch.set_visible(False)
    for rows, label, colour, marker in ((oit, "OIT", COLOURS[1], "s"),
                                        (bma, "BMA-OIT", "black", "o")):
        times.plot(rows["at"], rows["frame_ms.median"], color=colour, marker=marker, markersize=4,
                   label=label)
    allocated = int(first["param.max_fragments"])
    figure.suptitle(f"{scene_name(first['scene'])}, {first['path']}, max alloc {allocated}",
                    size=9, weight="bold")
    times.set_ylabel("frame time, ms")
    times.set_ylim(bottom=0)
    pixels.set_ylabel("pixels, by their fragments")
    handles = [*times.get_legend_handles_labels()[0], *pixels.get_legend_handles_labels()[0]]
    times.legend(handles=handles, loc="lower left", bbox_to_anchor=(0, 1), frameon=False,
                 ncol=min(len(handles), 6))
    deepest = [i for i in shown if i > 32] or shown[-1:]
    bottom = [0.0] * len(counted)
    for interval in deepest:
        top = [b + p for b, p in zip(bottom, counted[_pixels(interval)])]
        deep.fill_between(counted["at"], bottom, top, color=SHADES[INTERVALS.index(interval)],
                          label=_range(interval))
        bottom = top
    deep.set_ylim(bottom=0)
    deep.set_ylabel("pixels")
    deep.set_xlabel("place on the path, 0 to 1")
    deep.legend(loc="upper left", frameon=False)
    return figure


@_drawn
def bma_figure9(table: pandas.DataFrame) -> Figure | None:
    """Times of the sorts relative to insertion sort's, by interval."""
    choices = {name: value for name, value in PAPER_CHOICES.items() if name != "sort"}
    cells = abuffer_cells(table, sort_memory="bma", **choices)
    best: tuple[int, list] | None = None
    for name, same in by_setting(cells):
        for allocated, rows in same.groupby("param.max_fragments"):
            rows = rows.drop_duplicates("param.sort").set_index("param.sort")
            sorts = [sort for sort in SORTS if sort in rows.index]
            if "insertion" in sorts and len(sorts) > 1 and (best is None or len(sorts) >= best[0]):
                best = (len(sorts), [name, int(allocated), rows, sorts])
    if best is None:
        return None
    (scene, *_), _, rows, sorts = best[1]
    base = rows.loc["insertion"]
    shown = [i for i in timed_intervals(base) if base[f"stage.sort {i}_ms"] > 0]
    if not shown:
        return None
    figure, axes = _figure()
    for index, sort in enumerate(sorts):
        times = [rows.loc[sort].get(f"stage.sort {i}_ms") for i in shown]
        axes.plot(range(len(shown)), [t / base[f"stage.sort {i}_ms"] for t, i in zip(times, shown)],
                  color=COLOURS[index], marker=MARKERS[index], markersize=5, label=sort)
    axes.set_title(scene_name(scene), loc="left", size=9, weight="bold")
    axes.set_xticks(range(len(shown)), [_range(i) for i in shown])
    axes.set_xlabel("fragments of a pixel")
    axes.set_ylabel("time, relative to insertion sort")
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(0, 1.06), ncol=len(sorts))  # above the title
    return figure


def _measured(table: pandas.DataFrame, method: str, *parameters: str) -> pandas.DataFrame:
    """The measured cells of a method that have all of these parameters; without columns if none."""
    columns = [f"param.{name}" for name in parameters]
    if not {"method", *columns} <= set(table.columns):
        return pandas.DataFrame()
    table = table[(table["method"] == method) & (table["status"] == "ok")].dropna(subset=columns)
    return table if len(table) else pandas.DataFrame()


def abuffer_cells(table: pandas.DataFrame, **choices: str) -> pandas.DataFrame:
    cells = _measured(table, "abuffer", "sort_memory", "max_fragments", *choices)
    for name, value in choices.items():
        if cells.empty:
            break
        cells = cells[cells[f"param.{name}"] == value]
    return cells


def by_setting(cells: pandas.DataFrame) -> list[tuple[tuple, pandas.DataFrame]]:
    """The cells by scene, view and size, the paper's scenes first and in its order."""
    order = list(PAPER_SCENES)
    groups = [] if cells.empty else list(cells.groupby(SETTING, sort=False))
    return sorted(groups, key=lambda group: order.index(group[0][0]) if group[0][0] in order
                  else len(order))


def timed_intervals(row: pandas.Series) -> list[int]:
    """The intervals that held pixels and whose stage was timed."""
    return [i for i in INTERVALS
            if row.get(_pixels(i), 0) > 0 and row.get(f"stage.sort {i}_ms", 0) > 0]


def _pixels(interval: int) -> str:
    return f"counter.pixels_{interval}"


def _range(interval: int) -> str:
    return f"1–{interval}" if interval == 8 else f"{interval // 2 + 1}–{interval}"


def scene_name(scene: str) -> str:
    return f"{scene} ({PAPER_SCENES[scene]})" if scene in PAPER_SCENES else scene


def _figure(rows: int = 1):
    """A figure and its axes."""
    figure = Figure(figsize=(PAGE, 3.6 if rows == 1 else 5.5), layout="constrained")
    axes = figure.subplots(rows, 1, sharex=True, height_ratios=(3, 2)[:rows] if rows > 1 else None)
    for each in axes if rows > 1 else [axes]:
        each.spines[["top", "right"]].set_visible(False)
        each.grid(axis="y", **GRID)
        each.set_axisbelow(True)
    return figure, axes
