"""Keeps apart what must not be compared: one section per experiment, device, build and commit.

No number of a report is ever computed from cells of two sections.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import pandas

from ..formats import NOTHING
from .clock import frame_note, stage_note
from .device_notes import note_of
from .fragment_source import COMPUTE, HARDWARE, named, source_of
from .labels import add_labels, records
from .statistics import OTHER_RUN, Comparison, compare_setting, disagreements, headline_source

CONTEXT = ("experiment", "device", "driver", "driver_info", "commit", "build", "validation")
SETTING = ("scene", "opacity", "detail", "content_hash", "view", "width", "height", "format")
MOST_SECTIONS = 60  # experiments, devices and builds of one report
RELEASE_BUILDS = ("release", "relwithdebinfo", "minsizerel")


@dataclass(frozen=True)
class Section:
    """The cells that may be compared, labelled and sorted, and what a reader must know of them."""

    title: str
    table: pandas.DataFrame
    context: dict[str, str]
    warnings: list[str]
    commands: list[str]
    cells: dict[str, dict]  # the measured ones, by key

    @property
    def is_cpu(self) -> bool:
        return self.table["device_type"].iloc[0] == "cpu"

    def settings(self) -> list[tuple[str, pandas.DataFrame]]:
        """The cells of each setting, in the order of the table."""
        return self._settings

    @functools.cached_property
    def _settings(self) -> list[tuple[str, pandas.DataFrame]]:
        return list(self.table.groupby("setting", sort=False))

    @functools.cached_property
    def rows(self) -> dict[str, list[dict]]:
        """The cells of each setting as dictionaries, in the order of the table."""
        found: dict[str, list[dict]] = {}
        for row in records(self.table):
            found.setdefault(row["setting"], []).append(row)
        return found


def add_comparisons(table: pandas.DataFrame, cells: dict[str, dict]) -> pandas.DataFrame:
    """Adds `baseline`, `baseline_name`, `ratio`, `ratio.low`, `ratio.high`, `ratio.blocks`, `verdict` and
    `device_note`: what a reader must know of a ratio to this baseline on this device, or "".

    Compares only cells that share their whole context and setting, and of these only cells of one
    run. `baseline` is the id of the cell that the ratio is to, missing where there is no ratio;
    `baseline_name` is its method and source. Where the headline source is compute (statistics), the ratio
    to hardware blending stands beside it, in `ratio_hardware`, `ratio_hardware.low` and `.high`.
    """
    compared, beside = {}, {}
    measured = table[table["status"] == "ok"]
    # Grouped at once: a table for each group takes milliseconds, and a pack may have 10,000 settings.
    contexts: dict[int, dict[int, dict[str, dict]]] = {}
    for context, setting, key in zip(_group_numbers(measured, CONTEXT),
                                     _group_numbers(measured, CONTEXT + SETTING), measured["key"]):
        contexts.setdefault(context, {}).setdefault(setting, {})[key] = cells[key]
    for of_context in contexts.values():
        settings = list(of_context.values())
        source = headline_source(settings)
        for setting in settings:
            compared |= compare_setting(setting, source)
            if source == COMPUTE:
                beside |= compare_setting(setting, HARDWARE)
    table = table.copy()
    pairs = [compared.get(key) for key in table["key"]]
    table["baseline"] = [cells[pair[0]]["id"] if pair and pair[1].ratio is not None else None
                         for pair in pairs]
    table["baseline_name"] = [named(cells[pair[0]]) if pair and pair[1].ratio is not None else None
                              for pair in pairs]
    for column, field in (
        ("ratio", "ratio"),
        ("ratio.low", "low"),
        ("ratio.high", "high"),
        ("ratio.blocks", "blocks"),
        ("verdict", "verdict"),
    ):
        table[column] = [getattr(pair[1], field) if pair else None for pair in pairs]
    table["device_note"] = [
        note_of(device, cells[pair[0]]["method"], source_of(cells[pair[0]]))
        if pair and pair[1].ratio is not None else ""
        for device, pair in zip(table["device"], pairs)
    ]
    return _add_hardware_ratios(table, cells, beside) if beside else table


def _group_numbers(table: pandas.DataFrame, columns: tuple[str, ...]) -> pandas.Series:
    """For each row the number of its group, in the order of the groups' values."""
    return table.groupby(list(columns), dropna=False).ngroup()


def _add_hardware_ratios(table: pandas.DataFrame, cells: dict[str, dict],
                         compared: dict[str, tuple[str, Comparison]]) -> pandas.DataFrame:
    """Adds the ratios to hardware blending, where that was measured."""
    found = [compared.get(key) for key in table["key"]]
    found = [pair[1] if pair and cells[pair[0]]["method"] == "blend" and source_of(cells[pair[0]]) == HARDWARE
             else None for pair in found]
    return table.assign(**{f"ratio_hardware{suffix}": [getattr(one, name) if one else None for one in found]
                           for suffix, name in (("", "ratio"), (".low", "low"), (".high", "high"))})


def has_hardware_ratio(table: pandas.DataFrame) -> bool:
    """Whether ratios to hardware blending stand beside those to the baseline."""
    return "ratio_hardware" in table and bool(table["ratio_hardware"].notna().any())


def baselines_of(table: pandas.DataFrame) -> str:
    """What the ratios of these cells are to: `blend source=hardware`; "the baseline" where there is none."""
    return " or ".join(sorted(set(table["baseline_name"].dropna()))) or "the baseline"


def make_sections(cells: dict[str, dict], table: pandas.DataFrame) -> list[Section]:
    """One section for each context of the table, whose cells are given by key; largest first within an
    experiment. Of more than MOST_SECTIONS contexts those with most cells."""
    numbers = _group_numbers(table, CONTEXT)
    largest = sorted(numbers.value_counts().items(), key=lambda of: (-of[1], of[0]))[:MOST_SECTIONS]
    groups = [table[numbers == number] for number, _ in largest]
    groups.sort(key=lambda group: (group["experiment"].iloc[0], -len(group)))
    # Only the parts of the context that differ are needed to tell titles apart.
    varying = [c for c in ("commit", "build", "validation") if table[c].nunique() > 1]
    if (table.groupby("device")["driver_info"].nunique() > 1).any():
        varying.append("driver_info")
    return [_section(cells, group, varying) for group in groups]


def _section(cells: dict[str, dict], group: pandas.DataFrame, varying: list[str]) -> Section:
    first = group.iloc[0]
    said = {
        "commit": f"commit {first['commit']}",
        "build": f"{first['build'] or 'unnamed'} build",
        "validation": f"validation {'on' if first['validation'] else 'off'}",
        "driver_info": f"driver {first['driver_info']}",
    }
    title = ", ".join([f"{first['experiment']} on {first['device']}", *(said[c] for c in varying)])
    dates = sorted(date for date in group["date"] if date)
    subgroups = sorted({f"{size:g}" for size in group["subgroup_size"].dropna()})
    context = {
        "Experiment": first["experiment"],
        "Device": f"{first['device']} ({first['device_type']})",
        "Driver": f"{first['driver']}, {first['driver_info']}",
        "Vulkan": ", ".join(sorted(set(group["api_version"]))) or NOTHING,
        "Subgroup size": ", ".join(subgroups) or NOTHING,
        "Commit": first["commit"],
        "Build": first["build"] or NOTHING,
        "Validation layers": "on" if first["validation"] else "off",
        "Measured": " to ".join(dict.fromkeys((dates[0], dates[-1]))) if dates else NOTHING,
        "Profile": ", ".join(sorted(set(group["profile"]))),
        "Seeds": ", ".join(sorted({f"{seed:g}" for seed in group["seed"].dropna()})) or NOTHING,
    }
    own = {key: cells[key] for key in group.loc[group["status"] == "ok", "key"]}
    measured = list(own.values())
    return Section(
        title=title,
        table=add_labels(group),
        context=context,
        warnings=(_context_warnings(first) + _device_notes(group) + _other_runs(group)
                  + _measurement_warnings(measured)),
        commands=sorted(set(group["command"]) - {""}),
        cells=own,
    )


def _context_warnings(first: pandas.Series) -> list[str]:
    warnings = []
    if first["device_type"] == "cpu":
        warnings.append("CPU device: these times say nothing about GPUs.")
    if first["build"].lower() not in RELEASE_BUILDS:
        name = first["build"] or "Unnamed"
        warnings.append(f"{name} build, not a release build: do not quote these times.")
    if first["validation"]:
        warnings.append("Validation layers were on: do not quote these times.")
    if first["commit"].endswith("-dirty"):
        warnings.append(
            f"Commit {first['commit']}: the sources had changes that no commit holds, so that these "
            "results cannot be reproduced from the commit alone."
        )
    return warnings


def _device_notes(group: pandas.DataFrame) -> list[str]:
    notes = list(group["device_note"])
    if has_hardware_ratio(group):
        notes += [note_of(device, "blend", HARDWARE) for device in group["device"]]
    return [f"Ratios marked ‡: {note}" for note in dict.fromkeys(notes) if note]


def _other_runs(group: pandas.DataFrame) -> list[str]:
    """How many cells have no ratio because another run measured their baseline; empty where none."""
    alone = int((group["verdict"] == OTHER_RUN).sum())
    return [f"{alone} of {len(group)} cells have no ratio: another run of the program measured them than "
            "their baseline (verdict: other run). Remove all cells of these settings and run again to "
            "compare them."] if alone else []


def _measurement_warnings(cells: list[dict]) -> list[str]:
    warnings = []
    unsettled = [c["id"] for c in cells if c["stop"].get("reason") in ("time_limit", "max_blocks")]
    if unsettled:
        warnings.append(
            f"{len(unsettled)} of {len(cells)} cells stopped at a limit before their spread had "
            "settled (marked †); their intervals say how far to trust them."
        )
    rejected = sum(c["stop"].get("rejected_samples") or 0 for c in cells)
    if rejected:
        warnings.append(f"{rejected} frame times were rejected (zero or negative timestamps).")
    warnings += [note for note in (frame_note(cells), stage_note(cells)) if note]
    versions: dict[str, set[str]] = {}
    for cell in cells:
        for shader, digest in (cell["provenance"].get("shaders") or {}).items():
            versions.setdefault(shader, set()).add(str(digest))
    for shader, digests in sorted(versions.items()):
        if len(digests) > 1:
            warnings.append(
                f"Shader {shader} has {len(digests)} versions among these cells, of one commit: "
                "it was edited between runs. Run them again before comparing."
            )
    for cell in cells:
        found = disagreements(cell)
        if found:
            warnings.append(f"Cell {cell['id']} contradicts its own samples: {'; '.join(found)}.")
    return warnings


def mixture_warnings(table: pandas.DataFrame) -> list[str]:
    """What the cells mix, and that it was kept apart; how many contexts are not shown."""
    contexts = table.groupby(list(CONTEXT), dropna=False).ngroups
    beyond = [f"Only {MOST_SECTIONS} of {contexts} sections are shown; cells.csv has all cells."] \
        if contexts > MOST_SECTIONS else []
    named = {"device": "devices", "driver_info": "drivers", "commit": "commits", "build": "build types"}
    mixed = [
        f"{table[column].nunique()} {plural}"
        for column, plural in named.items()
        if table[column].nunique() > 1
    ]
    if table["validation"].nunique() > 1:
        mixed.append("runs with and without validation layers")
    if not mixed:
        return beyond
    return [f"These are cells of {', '.join(mixed)}: kept apart, each in its own section.", *beyond]
