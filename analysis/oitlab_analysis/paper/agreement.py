"""Says in words where measured and published agree, by fixed rules.

order    Of all pairs of rows that differ in print, how many are in the same order in both
         (Kendall's tau is twice that share less 1). From 90 % on: "the same order"; from 70 % on:
         "mostly the same order"; from 30 % on: "no common order"; below: "the opposite order".
factor   Measured over published, row by row: how many lie within 1.25, and the row that is
         furthest off.
"""

from __future__ import annotations

import itertools
import math

from ..formats import number

CLOSE = 1.25
WORDS = ((0.9, "the same order"), (0.7, "mostly the same order"), (0.3, "no common order"),
         (-1, "the opposite order"))

Pairs = dict[str, tuple[float | None, float | None]]  # row -> published, measured


def complete(pairs: Pairs) -> dict[str, tuple[float, float]]:
    """The rows that have both."""
    return {row: (p, m) for row, (p, m) in pairs.items() if p is not None and m is not None}


def order(what: str, pairs: Pairs) -> str:
    """Whether the rows are in the same order; empty for fewer than 3 rows with both."""
    rows = complete(pairs)
    if len(rows) < 3:
        return ""
    agreeing = counted = 0
    for (p1, m1), (p2, m2) in itertools.combinations(rows.values(), 2):
        if p1 != p2:
            counted += 1
            agreeing += (p1 - p2) * (m1 - m2) > 0
    if counted == 0:
        return ""
    share = agreeing / counted
    words = next(words for least, words in WORDS if share >= least)
    return (f"{what}: {words} of rows ({agreeing} of {counted} pairs agree, "
            f"Kendall's τ = {2 * share - 1:.2f}).")


def factor(what: str, pairs: Pairs) -> str:
    """How far measured is from published; empty where no row has both.

    Rows where one of the two is 0 have no factor: they count as close when both are 0.
    """
    rows = complete(pairs)
    if not rows:
        return ""
    factors = {row: (1.0 if p == m else math.inf if p * m == 0 else m / p) for row, (p, m) in rows.items()}
    close = sum(1 / CLOSE <= f <= CLOSE for f in factors.values())
    text = f"{what}: within {CLOSE} times the published figure in {close} of {len(rows)} rows"
    if close == len(rows):
        return text + "."
    # An endless factor says less than the figures themselves.
    row = max(factors, key=lambda r: abs(math.log(factors[r])) if factors[r] not in (0, math.inf) else 1e9)
    published, measured = rows[row]
    return f"{text}; furthest off: {row}, {number(measured)} measured, {number(published)} published."
