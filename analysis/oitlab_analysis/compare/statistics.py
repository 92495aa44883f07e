"""Comparing the frame times of two cells, and checking what a cell says of its own samples.

Cells of a group are measured interleaved, in blocks of some frames each: block 7 of method A ran
right beside block 7 of method B, under the same clocks and temperature. The unit of comparison is
therefore the pair of blocks, not the frame: frames of one block are not independent, and treating
them so makes intervals too narrow (Kalibera and Jones, "Rigorous Benchmarking in Reasonable Time",
ISMM 2013; Georges, Buytaert and Eeckhout, "Statistically Rigorous Java Performance Evaluation",
OOPSLA 2007).

Definitions
-----------
ratio     For each block that both cells have: the median frame time of the cell over the median
          frame time of the baseline. Reported is the median of these ratios; below 1 the cell is
          faster than its baseline.
interval  95% percentile bootstrap of that median, blocks drawn with replacement (Efron and
          Tibshirani, "An Introduction to the Bootstrap", 1993, chapter 13). Seeded, so that the
          same cells give the same report. With fewer than 6 common blocks there is none: the widest
          distribution-free interval of a median, from the least to the greatest of n values, covers
          it with 1 - 2^(1-n), which is 0.9375 for n = 5 and 0.969 for n = 6.
baseline  One cell of a setting (scene, view, size, format), never two. It is a `blend` cell where the
          setting has one, of the headline source where there is one of that: of the run with most
          cells of this setting, the newest of equals; in that run the one in submission order, or the
          fastest. A setting without `blend` takes the fastest cell, by median frame time, of the run
          with most cells.
headline  The source of the fragments of `blend` as a baseline: "compute" where hardware blending is
source    the slower one, by the median over the settings of one device, commit and experiment that
          measured both in submission order, in turn; else "hardware". A GPU whose graphics are a
          fraction of its compute is known by that.
run       Cells of one group were measured in turn, by one run of the program. Blocks of two runs are
          no pairs: a cell of another run than its baseline has no ratio.
verdict   The first of these that holds:
          "baseline"   the cell is the baseline itself
          "other run"  the cell was measured in another run than the baseline
          "unpaired"   the two have no block in common
          "ambiguous"  no interval
          "same"       the interval lies within [1/1.01, 1.01]: a difference above 1% is ruled out
                       (an equivalence test by interval inclusion, Schuirmann 1987, two-sided 95%)
          "faster"     the whole interval lies below 1
          "slower"     the whole interval lies above 1
          "ambiguous"  the interval holds 1 and reaches beyond 1%: more blocks are needed
          Verdicts are not corrected for the number of comparisons: of many true equalities about
          one in twenty may be called faster or slower.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy

from .fragment_source import COMPUTE, HARDWARE, source_of

LEVEL = 0.95
SAME_WITHIN = 1.01
FEWEST_BLOCKS = 6
RESAMPLES = 4000
MOST_DRAWN = 4000  # blocks of which every draw is made: 64 MB
# Verdicts of cells without a ratio.
OTHER_RUN, UNPAIRED = "other run", "unpaired"
SEED = 20240229


@dataclass(frozen=True)
class Comparison:
    """A cell against its baseline; `low` and `high` are None where there is no interval."""

    ratio: float | None
    low: float | None
    high: float | None
    blocks: int
    verdict: str


def percentile(values: Sequence[float], percent: float) -> float:
    """Linear between order statistics (type 7 of Hyndman and Fan, "Sample Quantiles", 1996)."""
    return float(numpy.percentile(numpy.asarray(values, dtype=float), percent))


def block_medians(times_ms: Sequence[float], blocks: Sequence[int]) -> dict[int, float]:
    """The median frame time of each block, in ms."""
    times, numbers = numpy.asarray(times_ms, dtype=float), numpy.asarray(blocks)
    order = numpy.lexsort((times, numbers))  # by block, and by time within a block
    times, numbers = times[order], numbers[order]
    found, starts, counts = numpy.unique(numbers, return_index=True, return_counts=True)
    medians = (times[starts + (counts - 1) // 2] + times[starts + counts // 2]) / 2
    return dict(zip(found.tolist(), medians.tolist()))


def block_medians_of(cell: dict) -> dict[int, float]:
    """block_medians() of the frames of a measured cell."""
    return block_medians(cell["samples"]["frame_ms"], cell["samples"]["block"])


@functools.lru_cache(maxsize=64)
def _median_ranks(count: int, seed: int) -> tuple[numpy.ndarray, numpy.ndarray]:
    """The ranks, among `count` sorted values, of the middle two of each resample.

    Which ranks a resample draws does not depend on the values: one set of draws serves every cell
    with as many blocks.
    """
    random = numpy.random.default_rng(seed)
    if count > MOST_DRAWN:
        # The middle one of `count` uniform draws has a beta distribution; the two in the middle of an
        # even count lie next to each other, as good as.
        ranks = (count * random.beta((count + 1) / 2, (count + 1) / 2, RESAMPLES)).astype(numpy.int64)
        return ranks, ranks
    draws = random.integers(0, count, (RESAMPLES, count), dtype=numpy.int32)
    middle = ((count - 1) // 2, count // 2)
    draws.partition(middle, axis=1)
    return draws[:, middle[0]], draws[:, middle[1]]


def resampled_medians(values: Sequence[float], seed: int = SEED) -> numpy.ndarray:
    """The medians of RESAMPLES samples of the values, drawn with replacement."""
    ordered = numpy.sort(numpy.asarray(values, dtype=float))
    low, high = _median_ranks(len(ordered), seed)
    return (ordered[low] + ordered[high]) / 2


def interval_of(draws: numpy.ndarray) -> tuple[float, float]:
    """The percentile interval of LEVEL of a bootstrap distribution."""
    tail = 100 * (1 - LEVEL) / 2
    low, high = numpy.percentile(draws, [tail, 100 - tail])
    return float(low), float(high)


def bootstrap_interval(values: Sequence[float], seed: int = SEED) -> tuple[float, float] | None:
    """95% percentile bootstrap interval of the median; None for fewer than 6 values."""
    if len(values) < FEWEST_BLOCKS:
        return None
    return interval_of(resampled_medians(values, seed))


def verdict(interval: tuple[float, float] | None) -> str:
    """The verdict on the interval of a ratio to the baseline, by the rules of this module."""
    if interval is None:
        return "ambiguous"
    low, high = interval
    if low >= 1 / SAME_WITHIN and high <= SAME_WITHIN:
        return "same"
    if high < 1:
        return "faster"
    if low > 1:
        return "slower"
    return "ambiguous"


def compare(cell: dict[int, float], baseline: dict[int, float]) -> Comparison:
    """Compares the block medians of a cell with those of its baseline, paired by block number."""
    common = sorted(cell.keys() & baseline.keys())
    if not common:
        return Comparison(None, None, None, 0, UNPAIRED)
    ratios = [cell[block] / baseline[block] for block in common]
    interval = bootstrap_interval(ratios)
    low, high = interval or (None, None)
    return Comparison(float(numpy.median(ratios)), low, high, len(common), verdict(interval))


def compare_cells(cell: dict, baseline: dict) -> Comparison:
    """compare() of two cells; without a ratio unless they were measured in turn, in one group."""
    if cell["group"] != baseline["group"]:
        return Comparison(None, None, None, 0, OTHER_RUN)
    if cell is baseline:
        return Comparison(1.0, None, None, 0, "baseline")
    return compare(block_medians_of(cell), block_medians_of(baseline))


def headline_source(settings: Sequence[dict[str, dict]]) -> str:
    """The source of the baselines of all settings of one context, by the rule of this module. Each setting
    has its measured cells by key."""
    ratios = []
    for cells in settings:
        pairs: dict[str, dict[str, dict]] = {}
        for cell in cells.values():
            if cell["method"] == "blend" and cell["parameters"].get("order", "submission") == "submission":
                pairs.setdefault(cell["group"], {})[source_of(cell)] = cell
        found = [compare_cells(pair[HARDWARE], pair[COMPUTE]).ratio for pair in pairs.values()
                 if {HARDWARE, COMPUTE} <= pair.keys()]
        ratios += [ratio for ratio in found if ratio is not None][:1]
    return COMPUTE if ratios and float(numpy.median(ratios)) > 1 else HARDWARE


def choose_baseline(cells: dict[str, dict], source: str = HARDWARE) -> str:
    """The key of the baseline among the measured cells of one setting, by the rule of this module;
    `source` is the headline source."""
    blends = [key for key, cell in cells.items() if cell["method"] == "blend"]
    blends = [key for key in blends if source_of(cells[key]) == source] or blends
    runs: dict[str, list[dict]] = {}
    for cell in cells.values():
        runs.setdefault(cell["group"], []).append(cell)

    def rank(group: str) -> tuple:
        run = runs[group]
        return len(run), max(cell["provenance"].get("date") or "" for cell in run), group

    candidates = blends or list(cells)
    group = max({cells[key]["group"] for key in candidates}, key=rank)
    return min((key for key in candidates if cells[key]["group"] == group),
               key=lambda key: (cells[key]["parameters"].get("order", "submission") != "submission",
                                cells[key]["statistics"]["frame"]["median"], key))


def compare_setting(cells: dict[str, dict], source: str = HARDWARE) -> dict[str, tuple[str, Comparison]]:
    """For each measured cell of one setting, by key: the key of its baseline, and the comparison.

    All have the same baseline, of the headline source; a cell of another run has no ratio to it.
    """
    base = choose_baseline(cells, source)
    blocks = block_medians_of(cells[base])
    result = {}
    for key, cell in cells.items():
        if key == base:
            result[key] = base, Comparison(1.0, None, None, len(blocks), "baseline")
        elif cell["group"] != cells[base]["group"]:
            result[key] = base, Comparison(None, None, None, 0, OTHER_RUN)
        else:
            result[key] = base, compare(block_medians_of(cell), blocks)
    return result


def is_quantile(value: float, samples: Sequence[float], percent: float) -> bool:
    """Whether a value can be this percentile of the samples, by any of the usual definitions.

    The definitions that Hyndman and Fan list differ by less than one rank to either side; the
    allowance of 1e-5 is for times written with six digits.
    """
    return _is_quantile_of_sorted(value, numpy.sort(numpy.asarray(samples, dtype=float)), percent)


def _is_quantile_of_sorted(value: float, ordered: numpy.ndarray, percent: float) -> bool:
    rank = percent / 100 * len(ordered)
    last = len(ordered) - 1
    low = ordered[min(max(math.floor(rank) - 2, 0), last)]
    high = ordered[min(math.ceil(rank), last)]
    return bool(low * (1 - 1e-5) <= value <= high * (1 + 1e-5))


def disagreements(cell: dict) -> list[str]:
    """Recorded statistics of the frame that its own samples contradict (empty if all is well)."""
    frame, samples = cell["statistics"]["frame"], cell["samples"]["frame_ms"]
    ordered = numpy.sort(numpy.asarray(samples, dtype=float))
    quantiles = {"q1": 25, "median": 50, "q3": 75, "p95": 95, "min": 0, "max": 100}
    found = [
        f"{key} {frame[key]:g} ms against {percentile(ordered, percent):g} ms"
        for key, percent in quantiles.items()
        if not _is_quantile_of_sorted(frame[key], ordered, percent)
    ]
    if frame["count"] != len(samples):
        found.append(f"count {frame['count']} against {len(samples)}")
    return found
