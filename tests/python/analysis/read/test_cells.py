"""Reading a results folder: what is a cell, what is not, and what the columns say."""

import copy
import json
import random

import pytest
from oitlab_analysis.compare.tidy import as_table
from oitlab_analysis.read.cells import collect
from oitlab_analysis.read.sources import BadResults
from oitlab_analysis.write.report import make_report
from synthetic import make_cell, make_results, without_measurement, write_cell


def write(folder, name, text):
    (folder / "cells").mkdir(parents=True, exist_ok=True)
    (folder / "cells" / name).write_bytes(text if isinstance(text, bytes) else text.encode())


def test_one_row_per_cell_with_its_figures(tmp_path):
    cell = make_cell(method="lucid", parameters={"tile": 8}, rmse=0.01)
    write_cell(tmp_path, cell)
    write_cell(tmp_path, make_cell(method="blend"))
    table = as_table(collect(tmp_path).cells).set_index("id")
    row = table.loc[cell["id"]]
    frame = cell["statistics"]["frame"]
    assert len(table) == 2
    assert row["param.tile"] == 8
    assert row["frame_ms.median"] == frame["median"] and row["frame_ms.p95"] == frame["p95"]
    assert [row["frame_ms.ci_low"], row["frame_ms.ci_high"]] == frame["ci95"]
    assert row["stage.capture_ms"] == cell["gpu_ms"]["stages"]["capture"]
    assert row["counter.fragments"] == cell["counters"]["fragments"]
    assert row["memory_total_bytes"] == cell["memory_bytes"]["total"]
    assert row["memory.fragment pool"] == cell["memory_bytes"]["buffers"]["fragment pool"]
    assert row["quality.rmse"] == 0.01
    assert (row["width"], row["height"], row["commit"]) == (64, 36, "abc1234")
    assert row["stop.reason"] == "spread" and row["image_hash"] == cell["image_hash"]


def test_stages_keep_the_order_in_which_they_run(tmp_path):
    make_results(tmp_path, methods=2, scenes=1)
    columns = [c for c in as_table(collect(tmp_path).cells).columns if c.startswith("stage.")]
    assert columns == ["stage.opaque_ms", "stage.accumulate_ms", "stage.capture_ms",
                       "stage.resolve_ms"]


def test_failed_and_skipped_cells_are_rows_with_their_reasons(tmp_path):
    write_cell(tmp_path, without_measurement(make_cell(), "failed", "device lost"))
    row = as_table(collect(tmp_path).cells).iloc[0]
    assert (row["status"], row["reason"], row["scene"]) == ("failed", "device lost", "boxes")
    assert row["frame_ms.median"] != row["frame_ms.median"] or row["frame_ms.median"] is None


@pytest.mark.parametrize(
    "name, text, reason",
    [
        ("half.json", json.dumps(make_cell())[:700], "half-written"),
        ("empty.json", "", "half-written"),
        ("list.json", "[1, 2]", "foreign"),
        ("package.json", '{"name": "x", "id": "y"}', "foreign"),
        ("new.json", json.dumps(make_cell() | {"schema": 2}), "/schema: found 2, wanted 1"),
        ("bytes.json", b'{"schema": 1, "id": "\xff\xfe"}', "not JSON"),
        ("deep.json", "[" * 100_000, "nested"),
        ("nan.json", '{"schema": 1, "id": NaN}', "NaN"),
        (".boxes.json.tmp4711", "{", "temporary"),
        ("boxes.json.tmp", json.dumps(make_cell()), "temporary"),
        ("state.json", json.dumps(make_cell() | {"status": "fine"}), '/status: found "fine"'),
        ("size.json", json.dumps(make_cell() | {"size": [64]}), "/size"),
        ("copy.json", json.dumps(make_cell(method="blend")), "that of another file"),
        ("time.json", json.dumps(make_cell() | {"samples": {"frame_ms": [1, 0], "block": [0, 0]}}),
         "/samples/frame_ms"),
        ("gap.json", json.dumps(make_cell() | {"samples": {"frame_ms": [1, 2], "block": [0]}}),
         "/samples/block"),
    ],
)
def test_what_is_no_cell_is_named_and_left_out(tmp_path, name, text, reason):
    write_cell(tmp_path, make_cell(method="blend"))
    write(tmp_path, name, text)
    collection = collect(tmp_path)
    assert len(as_table(collection.cells)) == 1
    assert [problem.file for problem in collection.problems] == [name]
    assert reason in collection.problems[0].reason
    assert "\n" not in collection.problems[0].reason


def test_a_folder_named_like_a_cell_is_left_out(tmp_path):
    write_cell(tmp_path, make_cell())
    (tmp_path / "cells" / "zz.json").mkdir()
    assert [p.file for p in collect(tmp_path).problems] == ["zz.json"]


@pytest.mark.parametrize("kind", ["missing", "no cells folder", "empty", "only foreign"])
def test_without_any_cell_one_line_says_what_to_run(tmp_path, kind):
    folder = tmp_path / "missing" if kind == "missing" else tmp_path
    if kind in ("empty", "only foreign"):
        (tmp_path / "cells").mkdir()
    if kind == "only foreign":
        write(tmp_path, "a.json", "{")
    with pytest.raises(BadResults) as caught:
        collect(folder)
    assert "oitlab run" in str(caught.value) and "\n" not in str(caught.value)
    assert ("a.json" in str(caught.value)) == (kind == "only foreign")


def paths(value, at=()):
    """The path of every value in a JSON document."""
    if at:
        yield at
    children = value.items() if isinstance(value, dict) else enumerate(value) \
        if isinstance(value, list) else ()
    for key, child in children:
        yield from paths(child, (*at, key))


JUNK = (None, True, -1, 0, 1e300, 10**400, "", "text", "|<b>\n\x1b[31m", [], {}, [1, 2], {"a": 1},
        {"a": {"b": 1}}, [None])


@pytest.mark.parametrize("seed", range(4))
def test_junk_anywhere_in_a_cell_never_breaks_the_report(tmp_path, seed, monkeypatch):
    """Each cell of a folder gets one value replaced or removed; all of them must be survived."""
    monkeypatch.setattr("oitlab_analysis.write.report.save_charts", lambda sections, *_: ([[]] * len(sections), 0))
    choose = random.Random(seed)
    write_cell(tmp_path, make_cell(scene="whole"))
    whole = make_cell(blocks=7, frames=1)
    every = [p for p in paths(whole) if not (p[0] == "samples" and len(p) > 2)]
    for number in range(150):
        cell = copy.deepcopy(whole) | {"id": f"cell-{number}"}
        path = choose.choice(every)
        parent = cell
        for key in path[:-1]:
            parent = parent[key]
        if choose.random() < 0.2 and isinstance(parent, dict):
            del parent[path[-1]]
        else:
            parent[path[-1]] = choose.choice(JUNK)
        write(tmp_path, f"{number}.json", json.dumps(cell))
    result = make_report([tmp_path])
    assert "whole" in result.text
    assert "\x1b" not in result.text
    assert "<b>" not in (tmp_path / "report.html").read_text(encoding="utf-8")
