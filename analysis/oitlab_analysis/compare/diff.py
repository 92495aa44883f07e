"""What became faster, slower or different from one results folder to another.

The two runs were not measured in turn, so that their blocks cannot be paired: the interval of
B / A is that of a ratio of two medians, whose blocks are drawn independently. A device that was
warmer or busier in one of the runs slows everything alike; therefore each cell is also compared
through the `blend` cell that was measured in turn with it ("against blend"), which cancels that.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy

from .. import formats
from ..read.cells import Collection, collect, left_out
from ..read.sources import BadResults
from .device_notes import NOTED, note_of
from .fragment_source import HARDWARE, SETTING, source_of
from .labels import parameter_text
from .statistics import FEWEST_BLOCKS, SEED, block_medians_of, interval_of, resampled_medians, verdict
from .tidy import block_count

ORDER = {"slower": 0, "faster": 1, "ambiguous": 2, "same": 3}
MOST_LISTED = 10
# Draws of A and of B must be independent of each other.
SEEDS = (SEED + 1, SEED + 2)


@dataclass(frozen=True)
class Shaders:
    """What changed in the shaders of a method.

    Only those that both cells name are compared. A cell made before each pipeline recorded its own
    shaders also names definitions of other methods of its process, which say nothing of this one.
    """

    changed: list[str]
    common: int
    alone: tuple[list[str], list[str]]  # only in A, only in B

    @classmethod
    def of(cls, before: dict, after: dict) -> Shaders:
        a, b = (cell["provenance"].get("shaders") or {} for cell in (before, after))
        common = sorted(a.keys() & b.keys())
        return cls([name for name in common if a[name] != b[name]], len(common),
                   (sorted(a.keys() - b.keys()), sorted(b.keys() - a.keys())))

    def line(self) -> str:
        """One line, empty where nothing is known to have changed."""
        if not self.changed and (self.common or not any(self.alone)):
            return ""
        if not self.common:
            return "shaders: none in common"
        return f"shaders: {len(self.changed)} of {self.common} changed"

    def details(self) -> list[str]:
        lines = [f"changed: {name}" for name in self.changed]
        return lines + [f"only in {side}: {name}" for side, names in zip("AB", self.alone) for name in names]


@dataclass(frozen=True)
class Change:
    """A cell of B against the same cell of A; `against_blend` is None where there is no such pair."""

    cell: dict
    label: str
    ratio: float
    interval: tuple[float, float] | None
    blocks: int  # of A or of B, whichever has fewer
    against_blend: tuple[float, tuple[float, float] | None] | None
    blend_source: str  # of the fragments of that blend; "" without one
    shaders: Shaders
    image_changed: bool
    error: tuple[float | None, float | None]  # RMSE before and after

    @property
    def verdict(self) -> str:
        return verdict(self.interval)

    @property
    def blend_verdict(self) -> str:
        return verdict(self.against_blend[1]) if self.against_blend else formats.NOTHING


@dataclass(frozen=True)
class Diff:
    """All that is said of two folders."""

    changes: list[Change]
    warnings: list[str]


def key_of(cell: dict) -> str:
    """What makes two cells the same measurement, whatever the version of the program."""
    scene = cell["scene"]
    return json.dumps([scene["name"], scene.get("detail"), scene.get("opacity"), cell["view"],
                       cell["size"], cell["format"], cell["method"], cell["parameters"] | {SETTING: source_of(cell)},
                       cell["device"]["name"]], sort_keys=True)


def varying_parameters(cells: list[dict]) -> dict[str, set[str]]:
    """For each method the parameters that have several values, which are all a label needs."""
    values: dict[tuple[str, str], set[str]] = {}
    for cell in cells:
        for name, value in cell["parameters"].items():
            values.setdefault((cell["method"], name), set()).add(str(value))
    found: dict[str, set[str]] = {}
    for (method, name), seen in values.items():
        if len(seen) > 1:
            found.setdefault(method, set()).add(name)
    return found


def label_of(cell: dict, varying: dict[str, set[str]]) -> str:
    """`boxes (opacity=0.5) 640×360 lucid (depth_filter=3)`."""
    parameters = {name: value for name, value in cell["parameters"].items()
                  if name in varying.get(cell["method"], ())}
    scene = cell["scene"]
    knobs = {key: scene.get(key) for key in ("opacity", "detail")
             if scene.get(key) is not None and (key, scene[key]) != ("detail", 1)}
    parts = [scene["name"] + (f" ({parameter_text(knobs)})" if knobs else "")]
    if cell["view"] != "default":
        parts.append(cell["view"])
    parts.append(f"{cell['size'][0]}×{cell['size'][1]}")
    parts.append(cell["method"] + (f" ({parameter_text(parameters)})" if parameters else ""))
    return " ".join(parts)


def newest(collection: Collection, name: str) -> tuple[dict[str, dict], list[str]]:
    """One cell for each key, the newest, and what is to be said of the choice."""
    chosen: dict[str, dict] = {}
    older = 0
    for cell in sorted(collection.cells.values(), key=lambda c: c["provenance"].get("date") or ""):
        older += key_of(cell) in chosen
        chosen[key_of(cell)] = cell
    warnings = [f"{name}: {text}" for text in left_out(collection.problems)]
    if older:
        warnings.append(f"{name} holds {older} cells in several versions: the newest of each is compared.")
    return chosen, warnings


def _ratio(before: list[float], after: list[float]) -> tuple[float, tuple[float, float] | None]:
    ratio = float(numpy.median(after) / numpy.median(before))
    if min(len(before), len(after)) < FEWEST_BLOCKS:
        return ratio, None
    return ratio, interval_of(resampled_medians(after, SEEDS[1]) / resampled_medians(before, SEEDS[0]))


Blends = dict[str, dict[str, dict]]  # group -> key -> the measured blend cell


def blends_of(cells: dict[str, dict]) -> Blends:
    """In each group those from the hardware and in submission order first: a pack may have thousands."""
    def rank(item: tuple[str, dict]) -> tuple:
        key, cell = item
        return source_of(cell) != HARDWARE, cell["parameters"].get("order") != "submission", key

    found: Blends = {}
    blends = [(key, cell) for key, cell in cells.items() if cell["method"] == "blend" and cell["status"] == "ok"]
    for key, cell in sorted(blends, key=rank):
        found.setdefault(cell["group"], {})[key] = cell
    return found


def _blends(before: dict, after: dict, blends: tuple[Blends, Blends]) -> tuple[dict, dict] | None:
    """The same blend cell of A and of B, each measured in turn with its cell: the first of those that
    blends_of() gives."""
    found = [own.get(cell["group"], {}) for cell, own in zip((before, after), blends)]
    key = next((key for key in found[0] if key in found[1]), None)
    return None if key is None else (found[0][key], found[1][key])


def _over_blend(cell: dict, blend: dict) -> list[float]:
    """Block by block, the time over that of blend; empty for blend itself."""
    if blend is cell:
        return []
    own, base = block_medians_of(cell), block_medians_of(blend)
    return [own[block] / base[block] for block in sorted(own.keys() & base.keys())]


def compare_pair(before: dict, after: dict, all_blends: tuple[Blends, Blends], label: str) -> Change:
    """Both must be measured; `all_blends` are those of A and of B, to find the blend of each."""
    ratio, interval = _ratio(list(block_medians_of(before).values()), list(block_medians_of(after).values()))
    blends = _blends(before, after, all_blends)
    relative = None
    if blends:
        ratios = [_over_blend(c, blend) for c, blend in zip((before, after), blends)]
        if all(ratios):
            relative = _ratio(*ratios)
    errors = tuple((c.get("quality") or {}).get("rmse") for c in (before, after))
    source = source_of(blends[1]) if blends and relative else ""
    return Change(after, label, ratio, interval, min(map(block_count, (before, after))), relative, source,
                  Shaders.of(before, after), before.get("image_hash") != after.get("image_hash"), errors)


def diff(folder_a: Path, folder_b: Path) -> Diff:
    """Compares every cell that both hold. Raises BadResults."""
    collections = collect(folder_a), collect(folder_b)
    (a, said_a), (b, said_b) = (newest(c, name) for c, name in zip(collections, "AB"))
    warnings = said_a + said_b
    common = [key for key in b if key in a]
    varying = varying_parameters([*a.values(), *b.values()])
    for name, own, other in (("A", a, b), ("B", b, a)):
        only = sorted(label_of(cell, varying) for key, cell in own.items() if key not in other)
        if only:
            named = "; ".join(only[:MOST_LISTED]) + ("; ..." if len(only) > MOST_LISTED else "")
            warnings.append(f"{len(only)} cells are only in {name}: {named}.")
    devices = [sorted({c["device"]["name"] for c in own.values()}) for own in (a, b)]
    if not common:
        raise BadResults(
            f"{folder_a} and {folder_b} have no cell in common (devices {', '.join(devices[0])} and "
            f"{', '.join(devices[1])}): nothing to compare")
    unmeasured: list[str] = []
    changes, blends = [], (blends_of(a), blends_of(b))
    for key in common:
        states = a[key]["status"], b[key]["status"]
        if states == ("ok", "ok"):
            changes.append(compare_pair(a[key], b[key], blends, label_of(b[key], varying)))
        else:
            reason = b[key]["reason"] or a[key]["reason"]
            unmeasured.append(f"{label_of(b[key], varying)}: {states[0]} in A, {states[1]} in B ({reason}).")
    warnings += unmeasured[:MOST_LISTED]
    if len(unmeasured) > MOST_LISTED:
        warnings.append(f"{len(unmeasured) - MOST_LISTED} more cells were not measured in A or in B.")
    if not changes:
        raise BadResults(f"{folder_a} and {folder_b} have no measured cell in common: {warnings[-1]}")
    changes.sort(key=lambda c: (c.cell["device"]["name"], ORDER[c.verdict], -abs(numpy.log(c.ratio))))
    return Diff(changes, warnings + _measurement_warnings(changes, a, b))


def _measurement_warnings(changes: list[Change], a: dict, b: dict) -> list[str]:
    warnings = []
    for change in changes:
        if (change.cell["method"] == "blend" and not change.shaders.changed
                and change.verdict in ("faster", "slower")):
            warnings.append(
                f"{change.label} is {change.verdict} ({formats.number(change.ratio)}) although "
                "its shaders are the same: the device was in another state; read the column against blend.")
    for what, of in (("driver", lambda c: c["device"].get("driver_info")),
                     ("build", lambda c: c["provenance"]["build"]),
                     ("validation", lambda c: c["provenance"]["validation"])):
        values = [sorted({str(of(c)) for c in own.values()}) for own in (a, b)]
        if values[0] != values[1]:
            warnings.append(f"Another {what}: {', '.join(values[0])} in A, {', '.join(values[1])} in B.")
    if any(c.cell["device"]["type"] == "cpu" for c in changes):
        warnings.append("CPU device: these times say nothing about GPUs.")
    notes = {note_of(c.cell["device"]["name"], "blend", c.blend_source) for c in changes} - {""}
    return warnings + [f"{NOTED.strip()} {note}" for note in sorted(notes)]
