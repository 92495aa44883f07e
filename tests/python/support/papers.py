"""Cells for the tables of the papers, and their tables read back."""

import csv

from synthetic import (
    PAPER_SCENES,
    lucid_cell,
    make_cell,
    write_cell,
)

SIZE = (2560, 1330)

SMALL = {"blocks": 7, "frames": 1}


def write_performance(folder, scenes=tuple(PAPER_SCENES), factor=3.0, commit="abc1234", **changes):
    """blend, and lucid that takes `factor` times as long, 1.1 times that when it repairs."""
    provenance = make_cell()["provenance"] | {"commit": commit}
    changes = {"size": SIZE, "experiment": "performance", "provenance": provenance} | SMALL | changes
    for scene in scenes:
        time = PAPER_SCENES[scene]
        for cell in (make_cell(scene, "blend", {"order": "submission"}, time, 0.1, **changes),
                     lucid_cell(scene, time, factor, 100, {"repair": False}, **changes),
                     lucid_cell(scene, time, factor * 1.1, 100, **changes)):
            write_cell(folder, cell | {"id": f"{cell['id']}-{commit}"}, image=False)
    return folder


def table_of(out, name):
    with open(out / f"{name}.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {row[next(iter(row))]: row for row in rows}
