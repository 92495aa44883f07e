"""What is too large to be read is refused in a sentence, before it takes time or memory."""

import copy
import gzip
import json
import time

import numpy
import pytest
from oitlab_analysis.compare.diff import diff
from oitlab_analysis.compare.sections import MOST_SECTIONS
from oitlab_analysis.compare.statistics import MOST_DRAWN, resampled_medians
from oitlab_analysis.paper.measured import MOST_CONTEXTS, MOST_DEVICES, gather
from oitlab_analysis.read import limits
from oitlab_analysis.read.cells import collect
from oitlab_analysis.read.sources import BadResults
from oitlab_analysis.write.diff_text import terminal
from oitlab_analysis.write.report import make_report
from sections import sections_of
from synthetic import make_cell, without_measurement, write_cell

HEAD = b'{"schema":1,"pack":"oitlab cells","cells":['


def bomb(unit, megabytes, tail=b"]}"):
    """A pack of one unit over and over: DEFLATE makes a thousandth of it."""
    return gzip.compress(HEAD + unit * (megabytes * 2**20 // len(unit)) + tail)


def pack_of(folder, cells):
    path = folder / "pack.json.gz"
    path.write_bytes(gzip.compress(json.dumps({"schema": 1, "pack": "oitlab cells", "cells": cells}).encode()))
    return path


def variants(count, change, base=None):
    """Failed cells that `change` makes different."""
    cells = []
    for number in range(count):
        cell = copy.deepcopy(base or without_measurement(make_cell(), "failed", "lost"))
        change(cell, number)
        cells.append(cell | {"id": f"{number}"})
    return cells


@pytest.mark.parametrize("content, said", [
    (bomb(b" ", 40), "holds more than 16 MiB"),
    (bomb(b"{},", 14), "brackets; at most"),
    (bomb(b"[", 2), "brackets; at most"),
    (bomb(b"1,", 15, b"1]}"), "a pack of 7"),
    (gzip.compress(b"[" * 100_000), "nested too deeply"),
    (bomb(b'{"a":' * 900 + b"1" + b"}" * 900 + b",", 1, b"1]}"), "of 2"),
    (gzip.compress(b"\0" * 1000), "not JSON"),
    (b"\x1f\x8b\x08\0", "half-written or not compressed"),
    (HEAD, "not compressed"),
    (gzip.compress(HEAD + b"NaN]}"), "NaN is not a JSON number"),
    (gzip.compress(HEAD + b"9" * 5000 + b"]}"), "more than 64 bits"),
], ids=range(11))
def test_what_unpacks_to_too_much_is_refused(tmp_path, content, said):
    (tmp_path / "pack.json.gz").write_bytes(content)
    start = time.process_time()
    with pytest.raises(BadResults) as caught:
        collect(tmp_path / "pack.json.gz")
    assert "\n" not in str(caught.value)
    assert said in str(caught.value) or "no whole cell" in str(caught.value)
    assert time.process_time() - start < 5


def test_a_pack_of_too_many_cells_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("oitlab_analysis.read.packs.MOST_CELLS", 50)
    with pytest.raises(BadResults, match="a pack of 51 cells, at most 50"):
        collect(pack_of(tmp_path, variants(51, lambda cell, i: None)))


def test_too_many_names_are_left_out_and_said(tmp_path, monkeypatch):
    monkeypatch.setattr(limits, "MOST_NAMES", 40)
    cells = variants(10, lambda cell, i: cell.update(parameters={f"p{i}-{j}": 1 for j in range(10)}))
    found = collect(pack_of(tmp_path, cells))
    assert len(found.cells) == 4 and len(found.problems) == 6
    assert "more than 40 names" in found.problems[0].reason


@pytest.mark.parametrize("change, said", [
    (lambda cell: cell.update(method="x" * 301), "/method"),
    (lambda cell: cell.update(parameters={"x" * 301: 1}), "a name of more than 300"),
    (lambda cell: cell.update(reason="x" * 8193), "a text of 8193 characters"),
    (lambda cell: cell.update(extra=json.loads('{"a":' * 70 + "1" + "}" * 70)), "nested too deeply"),
])
def test_names_and_texts_have_a_length(tmp_path, change, said):
    cell = make_cell()
    change(cell)
    write_cell(tmp_path, make_cell(method="whole"))
    (tmp_path / "cells" / "long.json").write_text(json.dumps(cell | {"id": "long"}))
    found = collect(tmp_path)
    assert len(found.cells) == 1 and said in found.problems[0].reason


def test_sections_and_devices_are_bounded_and_said(tmp_path):
    def apart(cell, number):
        cell["device"] = cell["device"] | {"name": f"d{number}"}

    path = pack_of(tmp_path, variants(80, apart))
    assert len(sections_of(path)) == MOST_SECTIONS
    found = gather([path])
    assert len(found.devices()) == MOST_DEVICES <= len(found.contexts) <= MOST_CONTEXTS
    assert any("devices, commits and builds were left out" in text for text in found.warnings)


def test_a_cell_of_very_many_blocks_has_an_interval_without_much_memory():
    values = numpy.random.default_rng(1).normal(1, 0.1, 10 * MOST_DRAWN)
    draws = resampled_medians(values)
    # The standard error of a median of n normal values is 1.2533 sigma / sqrt(n).
    assert draws.std() == pytest.approx(1.2533 * 0.1 / len(values) ** 0.5, rel=0.1)
    assert draws.mean() == pytest.approx(numpy.median(values), abs=1e-3)


def test_both_ways_of_drawing_ranks_agree(monkeypatch):
    values = numpy.random.default_rng(2).normal(1, 0.1, 999)
    every = resampled_medians(values, seed=5)
    monkeypatch.setattr("oitlab_analysis.compare.statistics.MOST_DRAWN", 10)
    ranks = resampled_medians(values, seed=6)  # another seed: the first is remembered
    for percent in (2.5, 50, 97.5):
        assert numpy.percentile(ranks, percent) == pytest.approx(numpy.percentile(every, percent), abs=8e-4)


def test_thousands_of_measured_cells_in_one_setting_take_seconds(tmp_path):
    """They used to take minutes, with the square of their number; 10,000 now take 16 s."""
    def change(cell, i):  # half of them are methods of their own, half are variants of blend
        cell.update(method=f"m{i}") if i % 2 else cell.update(parameters={"layers": i})

    path = pack_of(tmp_path, variants(2000, change, make_cell(blocks=8, frames=1)))
    start = time.process_time()
    make_report([path], tmp_path / "report")
    diff(path, path)
    gather([path])
    assert time.process_time() - start < 30


def scene_of_its_own(cell, i):
    cell["scene"]["name"] = cell["group"] = f"s{i}"


@pytest.mark.parametrize("change, written", [
    (scene_of_its_own, True),
    (lambda cell, i: cell.update(view=f"v{i}"), True),
    # Without files: each of 18 sections has a chart, which takes a second.
    (lambda cell, i: cell["device"].update(name=f"d{i}"), False),
    (lambda cell, i: cell["provenance"].update(commit=f"c{i}"), False),
], ids=["scenes", "views", "devices", "commits"])
def test_many_settings_and_sections_take_seconds(tmp_path, change, written):
    """One method in 1500 scenes or views took a minute, with the square of their number; now 5 s. 10,000
    take 20 s."""
    path = pack_of(tmp_path, variants(1500, change, make_cell(blocks=8, frames=1)))
    start = time.process_time()
    make_report([path], tmp_path / "report" if written else None)
    terminal(diff(path, path))
    gather([path])
    assert time.process_time() - start < 15
