"""Which measured cells answer to a row of a published table.

Cells are kept apart by device, driver, commit, build and validation: every table is made from one
such context, and says how many others there were.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ..compare.fragment_source import source_of, usual_source
from ..compare.statistics import Comparison, compare_cells
from ..read.cells import Collection, collect, fingerprint, left_out
from ..read.sources import BadResults, sources_in

MOST_DEVICES, MOST_CONTEXTS = 8, 40  # each device has its own tables, each context may fill them


@dataclass
class Context:
    """The cells that may stand in one table, newest last."""

    device: str
    device_type: str
    driver: str
    commit: str
    build: str
    validation: bool
    cells: list[dict] = field(default_factory=list)

    @property
    def newest(self) -> str:
        return max(cell["provenance"].get("date") or "" for cell in self.cells)

    def describe(self) -> str:
        said = [f"{self.device}", f"driver {self.driver}", f"commit {self.commit}"]
        if self.build.lower() not in ("release", "relwithdebinfo", "minsizerel"):
            said.append(f"{self.build or 'unnamed'} build: do not quote its times")
        if self.validation:
            said.append("validation layers on: do not quote its times")
        return ", ".join(said)


@dataclass(frozen=True)
class Measurements:
    """All that the given folders hold."""

    contexts: list[Context]
    warnings: list[str]

    def devices(self) -> list[str]:
        return sorted({context.device for context in self.contexts})

    def of(self, device: str) -> list[Context]:
        return [context for context in self.contexts if context.device == device]


def gather(paths: list[Path]) -> Measurements:
    """Reads all folders. One that cannot be read is named; BadResults if none can."""
    warnings, collections = [], []
    for path in sources_in(paths):
        try:
            collections.append((path, collect(path)))
        except BadResults as error:
            warnings.append(f"{error}")
    if not collections:
        if warnings:
            raise BadResults(warnings[0])
        raise BadResults(f"{', '.join(map(str, paths))}: no results there; run the experiments first, for "
                         "example: oitlab run experiments/performance.toml")
    contexts: dict[tuple, Context] = {}
    seen: set[str] = set()
    repeated = 0
    for path, collection in collections:
        warnings += [f"{path}: {text}" for text in left_out(collection.problems)]
        for cell in collection.cells.values():
            text = fingerprint(cell)
            if text in seen:
                repeated += 1
                continue
            seen.add(text)
            _context(contexts, cell).cells.append(cell)
    if repeated:
        warnings.append(f"{repeated} cells were given twice, and count once.")
    contexts, beyond = _largest(contexts)
    warnings += beyond
    for context in contexts.values():
        context.cells.sort(key=lambda cell: cell["provenance"].get("date") or "")
    return Measurements(list(contexts.values()), warnings + _states([collection for _, collection in collections]))


def _largest(contexts: dict[tuple, Context]) -> tuple[dict[tuple, Context], list[str]]:
    """The contexts with most cells, of a bounded number of devices, and what is said of the others."""
    order = sorted(contexts, key=lambda key: -len(contexts[key].cells))
    devices = list(dict.fromkeys(key[0] for key in order))[:MOST_DEVICES]
    kept = [key for key in order if key[0] in devices][:MOST_CONTEXTS]
    beyond = len(contexts) - len(kept)
    said = [f"{beyond} of {len(contexts)} devices, commits and builds were left out: those with fewest cells."]
    return {key: contexts[key] for key in kept}, said if beyond else []


def _context(contexts: dict[tuple, Context], cell: dict) -> Context:
    device, provenance = cell["device"], cell["provenance"]
    values = (device["name"], device["type"],
              f"{device['driver']} {device.get('driver_info') or ''}".strip(),
              provenance["commit"], provenance["build"], provenance["validation"])
    return contexts.setdefault(values, Context(*values))


def _states(collections: list[Collection]) -> list[str]:
    warnings = []
    for state in ("failed", "skipped"):
        cells = [cell for c in collections for cell in c.cells.values() if cell["status"] == state]
        if cells:
            first = cells[0]
            warnings.append(f"{len(cells)} cells {state}, for example {first['id']}: {first['reason']}.")
    return warnings


@dataclass(frozen=True)
class Want:
    """What a cell must be. A parameter that a cell does not have, because its method had none such
    then, passes for off or 0. Its fragments come from where the papers took them."""

    method: str
    parameters: dict[str, object] = field(default_factory=dict)

    def fits(self, cell: dict) -> bool:
        return cell["status"] == "ok" and cell["method"] == self.method and all(
            cell["parameters"].get(name, 0) == value for name, value in self.parameters.items()) and \
            source_of(cell) == usual_source(self.method)


# Experiments whose tables are of times, and blocks of frames without which a time has no interval
# (min_blocks of their profiles): an experiment that takes a frame for its counts gives no times.
TIMED = ("performance", "methods", "alpha_threshold", "depth_filter")
FEWEST_BLOCKS = 6


def find(context: Context, scene: str, wants: dict[str, Want], size: tuple[int, int] | None,
         needed: str, experiment: str, opacity: float | None = None,
         any_opacity: bool = True) -> dict[str, dict]:
    """The cells of one scene that a row needs, by role, all of one setting.

    `needed` is the role without which there is no row. Prefers a still view, then the published size,
    cells of the experiment that is made for the table, the whole scene (detail 1), more of the roles,
    the default view, larger images, the newest; and within the setting those that were
    measured in turn, in one group. Others are taken where there is no such group: ratio() gives
    none for them.
    """
    settings: dict[tuple, list[dict[str, dict]]] = {}
    groups: dict[str, dict[str, dict]] = {}
    for cell in context.cells:
        if cell["scene"]["name"] != scene:
            continue
        if not any_opacity and cell["scene"].get("opacity") != opacity:
            continue
        # A cell that failed has no blocks, and its reason is told.
        if experiment in TIMED and (cell.get("stop") or {}).get("blocks", FEWEST_BLOCKS) < FEWEST_BLOCKS:
            continue
        for role, want in wants.items():
            if want.fits(cell):
                key = (*cell["size"], cell["scene"].get("detail") or 1,
                       cell["scene"].get("opacity"), cell["view"], cell["format"])
                if cell["group"] not in groups:
                    groups[cell["group"]] = {}
                    settings.setdefault(key, []).append(groups[cell["group"]])
                groups[cell["group"]][role] = cell
    settings = {key: groups for key, groups in settings.items() if any(needed in g for g in groups)}
    if not settings:
        return {}

    def rank(key: tuple) -> tuple:
        roles = len({role for group in settings[key] for role in group})
        newest = max(c["provenance"].get("date") or "" for g in settings[key] for c in g.values())
        made_for_it = any(c["experiment"] == experiment for g in settings[key] for c in g.values())
        view = key[4]
        return (not view.startswith("path:"), key[:2] == size, made_for_it, key[2], roles, view == "default",
                key[0] * key[1], newest)

    # Those of the experiment last, which have the last word: another may have taken a single frame.
    chosen = sorted(settings[max(settings, key=rank)],
                    key=lambda group: any(c["experiment"] == experiment for c in group.values()))
    union = {role: cell for group in chosen for role, cell in group.items()}
    whole = [group for group in chosen if len(group) == len(union)]
    return whole[-1] if whole else union


def ratio(cells: dict[str, dict], role: str, base: str) -> Comparison | None:
    """Of frame times, from paired blocks; None unless both are there and were measured in turn."""
    if role not in cells or base not in cells:
        return None
    found = compare_cells(cells[role], cells[base])
    return found if found.ratio is not None else None


def choose(contexts: list[Context], rows_of: Callable[[Context], int]) -> Context | None:
    """The context that fills most rows, the newest of equals; None where none fills any."""
    best = max(contexts, key=lambda context: (rows_of(context), context.newest), default=None)
    return best if best is not None and rows_of(best) > 0 else None
