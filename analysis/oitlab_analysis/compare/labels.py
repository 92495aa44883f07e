"""Short names for methods and settings: only what tells the cells of a section apart.

A setting is what all methods of one comparison share: scene, view, size and format.
"""

from __future__ import annotations

from collections import Counter

import pandas

from ..formats import is_number, natural_key, parameter

MOST = 2 / 3  # of the variants: a parameter whose values are spread more evenly is what a chart is about
SCENE_KNOBS = ("opacity", "detail", "content_hash")


def records(table: pandas.DataFrame) -> list[dict]:
    """The rows as dictionaries: a pandas row of this many columns is slow to make and to read."""
    return table.to_dict("records")


def is_given(value: object) -> bool:
    """False for what a flat table holds where a cell had nothing."""
    return value is not None and not (isinstance(value, float) and value != value)


def parameters_of(row: dict) -> dict[str, object]:
    """All parameters of a cell by name."""
    prefix = "param."
    return {
        name[len(prefix):]: value
        for name, value in row.items()
        if name.startswith(prefix) and is_given(value)
    }


def parameter_text(parameters: dict[str, object]) -> str:
    return ", ".join(f"{name}={parameter(value)}" for name, value in parameters.items())


def varying_parameters(table: pandas.DataFrame) -> dict[str, list[str]]:
    """For each method the parameters that have more than one value among its cells."""
    names = [name for name in table.columns if name.startswith("param.")]
    if not names:
        return {method: [] for method in table["method"].unique()}
    # As text, because 1, 1.0 and True are equal to Python but not to a reader.
    texts = pandas.DataFrame({name: table[name].map(str) for name in names})
    counts = texts.groupby(table["method"]).nunique()
    varying = counts.to_numpy() > 1
    return {method: [name[len("param."):] for name, varies in zip(names, row) if varies]
            for method, row in zip(counts.index, varying)}


def short_labels(table: pandas.DataFrame) -> tuple[dict[str, str], str]:
    """Names for a chart of these rows, by label, and what its caption must say of them, or "".

    What all variants of a method in the chart have in common is not named. A value that most of them have is
    named once, in the caption: `abuffer`, `abuffer (sort=merge)`, and "Where a name does not say otherwise,
    abuffer has sort=auto."
    """
    variants = table.drop_duplicates("label")
    varying = varying_parameters(variants)
    by_method: dict[str, list[dict]] = {}
    # All at once, and only the columns that count: there may be thousands of methods.
    for row in records(variants[["method", "label", *(c for c in variants if c.startswith("param."))]]):
        by_method.setdefault(row["method"], []).append(row)
    names: dict[str, str] = {}
    usual: dict[str, str] = {}
    for method, rows in by_method.items():
        texts = [{name: parameter(value) for name, value in parameters_of(row).items() if name in varying[method]}
                 for row in rows]
        most = _held_by_most(texts)
        labels = [row["label"] for row in rows]
        short = [_name(method, {k: v for k, v in own.items() if most.get(k) != v}, label)
                 for own, label in zip(texts, labels)]
        if len(set(short)) < len(short):  # a variant that lacks a parameter that others have
            short, most = labels, {}
        names |= dict(zip(labels, short))
        if most:
            usual[method] = parameter_text(most)
    said = "; ".join(f"{method} has {text}" for method, text in usual.items())
    return names, f"Where a name does not say otherwise, {said}." if said else ""


def _held_by_most(texts: list[dict[str, str]]) -> dict[str, str]:
    """The values that most of the variants have, by parameter."""
    found = {}
    for name in dict.fromkeys(name for own in texts for name in own):
        value, count = Counter(own.get(name) for own in texts).most_common(1)[0]
        if value is not None and count >= MOST * len(texts):
            found[name] = value
    return found


def _name(method: str, parameters: dict[str, str], label: str) -> str:
    """The name of a variant with the number, if its label has one (add_labels())."""
    number = label.rpartition(" #")[2]
    text = f"{method} ({parameter_text(parameters)})" if parameters else method
    return f"{text} #{number}" if number.isdigit() and label.endswith(f" #{number}") else text


def scene_label(row: dict, knobs: list[str]) -> str:
    """`tree`, or `tree (opacity=0.3)` where the scene was run in more than one way."""
    parts = []
    for knob in knobs:
        value = row[knob]
        if knob == "content_hash":
            parts.append(str(value)[:8] if is_given(value) else "content unknown")
        elif is_number(value):
            parts.append(f"{knob}={parameter(float(value))}")
        else:
            parts.append(f"{knob} as modelled" if knob == "opacity" else f"{knob} not given")
    return f"{row['scene']} ({', '.join(parts)})" if parts else row["scene"]


def varying_knobs(table: pandas.DataFrame) -> dict[str, list[str]]:
    """For each scene name the knobs that differ among its cells.

    A content hash only counts where nothing else explains it: it changes with detail and opacity.
    Failed cells may lack it.
    """
    counts = table.groupby("scene")[list(SCENE_KNOBS[:2])].nunique(dropna=False)
    result = {scene: [knob for knob, count in zip(SCENE_KNOBS, row) if count > 1]
              for scene, row in zip(counts.index, counts.to_numpy())}
    hashes = table.groupby(["scene", "opacity", "detail"], dropna=False)["content_hash"].nunique()
    for (scene, *_), count in hashes.items():
        if count > 1 and "content_hash" not in result[scene]:
            result[scene].append("content_hash")
    return result


def add_labels(table: pandas.DataFrame) -> pandas.DataFrame:
    """Adds `label` (method), `scene_label`, `size_label` and `setting`, and sorts by them.

    Within a setting no two cells share a label: what nothing else tells apart gets a number, so
    that no chart or table can merge two cells.
    """
    table = table.copy()
    varying, knobs = varying_parameters(table), varying_knobs(table)
    sizes_vary = table[["width", "height"]].drop_duplicates().shape[0] > 1
    formats_vary, views_vary = table["format"].nunique() > 1, table["view"].nunique() > 1
    labels, scenes, sizes, settings = [], [], [], []
    for row in records(table):
        chosen = {k: v for k, v in parameters_of(row).items() if k in varying[row["method"]]}
        labels.append(row["method"] + (f" ({parameter_text(chosen)})" if chosen else ""))
        scene = scene_label(row, knobs[row["scene"]])
        size = f"{row['width']}×{row['height']}" + (f" {row['format']}" if formats_vary else "")
        parts = [scene, row["view"] if views_vary else "", size if sizes_vary or formats_vary else ""]
        scenes.append(scene)
        sizes.append(size)
        settings.append(" · ".join(part for part in parts if part))
    table["label"], table["scene_label"] = labels, scenes
    table["size_label"], table["setting"] = sizes, settings
    repeats = table.groupby(["setting", "label"]).cumcount()
    table["label"] += [f" #{n + 1}" if n else "" for n in repeats]
    keys = [
        (
            natural_key(row["scene_label"]),
            row["view"],
            row["width"] * row["height"],
            row["format"],
            row["method"] != "blend",  # the usual baseline first
            natural_key(row["label"]),
        )
        for row in records(table)
    ]
    return table.iloc[sorted(range(len(keys)), key=keys.__getitem__)].reset_index(drop=True)
