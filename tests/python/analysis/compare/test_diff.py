"""`oitlab diff`: changes of known size are found, and nothing else is."""

import json
import re

import pytest
from oitlab_analysis.__main__ import main
from oitlab_analysis.compare.diff import diff
from oitlab_analysis.read.packs import without_folders
from oitlab_analysis.read.sources import BadResults
from oitlab_analysis.write.diff_text import markdown, terminal
from synthetic import DEVICE, LAVAPIPE, make_cell, without_measurement, write_cell


def write(folder, factors, date="2026-11-21T22:40:00Z", shader="11", blend=2.0, **changes):
    """A group of blend and methods that take `factors` times as long."""
    cells = [make_cell(method="blend", frame_ms=blend, rmse=0.1, **changes)]
    cells += [make_cell(method=m, frame_ms=blend * f, rmse=0.0, **changes) for m, f in factors.items()]
    for cell in cells:
        shaders = {"common/shade.glsl": "aa"} | ({"lucid/raster.comp": shader}
                                                 if cell["method"] == "lucid" else {})
        cell["provenance"] = cell["provenance"] | {"date": date, "shaders": shaders}
        write_cell(folder, cell, image=False)
    return folder


def by_method(result):
    return {change.cell["method"]: change for change in result.changes}


def test_a_change_of_known_size_has_its_ratio_and_verdict(tmp_path):
    a = write(tmp_path / "a", {"lucid": 3.0, "wboit": 1.2})
    b = write(tmp_path / "b", {"lucid": 2.4, "wboit": 1.2}, shader="22")
    changes = by_method(diff(a, b))
    assert changes["lucid"].ratio == pytest.approx(0.8, rel=0.01)
    assert changes["lucid"].verdict == changes["lucid"].blend_verdict == "faster"
    assert changes["lucid"].shaders.changed == ["lucid/raster.comp"]
    assert changes["wboit"].blend_verdict == "same" and changes["wboit"].shaders.line() == ""
    assert changes["blend"].against_blend is None


def test_a_device_note_stands_beside_what_is_compared_through_blend(tmp_path):
    h200 = DEVICE | {"name": "NVIDIA H200"}
    a = write(tmp_path / "a", {"lucid": 3.0}, device=h200)
    b = write(tmp_path / "b", {"lucid": 2.4}, device=h200)
    result = diff(a, b)
    for text in (terminal(result), markdown(result, (a, b))):
        assert "2 of its 66 TPCs" in " ".join(text.split())
        assert re.search(r"\] ‡", text), "beside the ratio"
    other = diff(write(tmp_path / "c", {"lucid": 3.0}), write(tmp_path / "d", {"lucid": 2.4}))
    assert "‡" not in terminal(other)


def test_a_slower_device_is_told_from_a_slower_method(tmp_path):
    a = write(tmp_path / "a", {"lucid": 3.0})
    b = write(tmp_path / "b", {"lucid": 3.0}, blend=2.6)  # all 1.3 times slower
    result = diff(a, b)
    lucid = by_method(result)["lucid"]
    assert lucid.verdict == "slower" and lucid.ratio == pytest.approx(1.3, rel=0.02)
    assert lucid.blend_verdict == "same"
    assert any("the device was in another state" in w for w in result.warnings)


def test_equal_runs_have_no_change(tmp_path):
    a, b = (write(tmp_path / name, {"lucid": 3.0}) for name in "ab")
    result = diff(a, b)
    assert {change.ratio for change in result.changes} == {1.0}
    assert {change.verdict for change in result.changes} <= {"same", "ambiguous"}
    assert result.warnings == []
    assert "all images are the same" in terminal(result)


def test_images_that_differ_are_said_with_their_error(tmp_path):
    a, b = (write(tmp_path / name, {"lucid": 3.0}) for name in "ab")
    path = next((b / "cells").glob("*lucid*"))
    cell = json.loads(path.read_text())
    cell["image_hash"], cell["quality"]["rmse"] = "other", 0.5
    path.write_text(json.dumps(cell))
    result = diff(a, b)
    assert [c.cell["method"] for c in result.changes if c.image_changed] == ["lucid"]
    assert "image differs, RMSE 0 to 0.500" in terminal(result)


def with_shaders(folder, shaders):
    """The cells of lucid with these shaders."""
    for path in (folder / "cells").glob("*lucid*"):
        cell = json.loads(path.read_text())
        cell["provenance"]["shaders"] = shaders
        path.write_text(json.dumps(cell))


def test_shaders_of_other_methods_of_the_process_are_no_change(tmp_path):
    """Older cells hold what the whole process had compiled: run alone, a method has fewer."""
    a, b = (write(tmp_path / name, {"lucid": 3.0}) for name in "ab")
    with_shaders(a, {"lucid/raster.comp": "1", "common/scene.vert": "2", "common/scene.vert WEIGHT=7": "3"})
    with_shaders(b, {"lucid/raster.comp": "1", "common/scene.vert": "2"})
    assert by_method(diff(a, b))["lucid"].shaders.line() == ""
    assert "shaders" not in terminal(diff(a, b))


def test_changed_shaders_are_one_line_and_named_on_request(tmp_path):
    a, b = (write(tmp_path / name, {"lucid": 3.0}) for name in "ab")
    with_shaders(a, {"lucid/raster.comp A=1": "1", "lucid/sort.comp": "1", "old.comp": "1"})
    with_shaders(b, {"lucid/raster.comp A=1": "2", "lucid/sort.comp": "1", "new.comp": "1"})
    result = diff(a, b)
    assert "shaders: 1 of 2 changed" in terminal(result) and "raster.comp" not in terminal(result)
    told = terminal(result, details=True)
    for text in ("changed: lucid/raster.comp A=1", "only in A: old.comp", "only in B: new.comp"):
        assert text in told
    with_shaders(b, {"lucid/other.comp": "2"})
    assert "shaders: none in common" in terminal(diff(a, b))


def test_what_is_only_in_one_or_failed_is_named(tmp_path):
    a = write(tmp_path / "a", {"lucid": 3.0, "old": 1.0, "bad": 1.0})
    b = write(tmp_path / "b", {"lucid": 3.0, "new": 1.0})
    write_cell(b, without_measurement(make_cell(method="bad"), "failed", "device lost"))
    (b / "cells" / "half.json").write_text('{"schema": 1')
    text = " ".join(terminal(diff(a, b)).split())
    assert "1 cells are only in A: boxes 64×36 old." in text
    assert "1 cells are only in B: boxes 64×36 new." in text
    assert "bad: ok in A, failed in B (device lost)" in text
    assert "half.json: half-written" in text


def test_devices_are_never_compared_with_each_other(tmp_path):
    a = write(tmp_path / "a", {"lucid": 3.0}, device=DEVICE)
    b = write(tmp_path / "b", {"lucid": 3.0}, device=LAVAPIPE)
    with pytest.raises(BadResults, match=r"no cell in common.*Example GPU 4000.*llvmpipe"):
        diff(a, b)


def test_of_several_versions_the_newest_is_compared_and_said(tmp_path):
    a = write(tmp_path / "a", {"lucid": 3.0})
    write(tmp_path / "b", {"lucid": 9.0}, date="2026-01-01T00:00:00Z")
    for path in (tmp_path / "b" / "cells").iterdir():
        cell = json.loads(path.read_text())
        cell["id"] += "-old"
        path.rename(path.with_name("old-" + path.name))
        (path.parent / ("old-" + path.name)).write_text(json.dumps(cell))
    b = write(tmp_path / "b", {"lucid": 3.0})
    result = diff(a, b)
    assert {change.ratio for change in result.changes} == {1.0}
    assert "B holds 2 cells in several versions" in result.warnings[0]


def test_the_command_and_its_markdown(tmp_path, capsys):
    a = write(tmp_path / "a", {"lucid": 3.0})
    b = write(tmp_path / "b", {"lucid": 2.0})
    assert main(["diff", str(a), str(b), "--out", str(tmp_path / "diff.md")]) == 0
    shown = capsys.readouterr().out
    assert "2 cells in both: 1 faster" in shown and max(map(len, shown.splitlines())) <= 100
    table = [x for x in (tmp_path / "diff.md").read_text().splitlines() if x.startswith("|")]
    assert len(table) == 2 + 2 and len({line.count("|") for line in table}) == 1
    assert markdown(diff(a, b), (a, b)) == (tmp_path / "diff.md").read_text()
    assert main(["diff", str(a), str(tmp_path / "no")]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_packs_hold_the_cells_as_they_are(tmp_path, capsys, monkeypatch):
    a = write(tmp_path / "a", {"lucid": 3.0})
    (a / "cells" / "half.json").write_text("{")
    pack = tmp_path / "data" / "gpu" / "a.json.gz"
    assert main(["pack", str(a), str(pack)]) == 0
    assert "left out: half.json" in capsys.readouterr().out
    first = pack.read_bytes()
    monkeypatch.setattr("time.time", lambda: 4e9)
    main(["pack", str(a), str(pack)])
    assert pack.read_bytes() == first, "the same cells give the same file"
    for source in (pack, pack.parent):  # the file, and a folder of packs
        result = diff(a, source)
        assert {change.ratio for change in result.changes} == {1.0} and len(result.changes) == 2
    pack.write_bytes(first[:200])
    with pytest.raises(BadResults, match="half-written or not compressed"):
        diff(a, pack)


def test_packs_do_not_say_where_files_lay():
    command = "oitlab run /volume/oit/experiments/bma.toml --size 64x32 --results /data/job/42/results/bma"
    assert without_folders(command) == (
        "oitlab run experiments/bma.toml --size 64x32 --results results/bma")
    assert without_folders("oitlab run experiments/bma.toml") == "oitlab run experiments/bma.toml"


@pytest.mark.parametrize("source, target", [("no", "x.json.gz"), ("empty", "x.json.gz"), ("a", "x.zip")])
def test_what_cannot_be_packed_is_one_line(tmp_path, capsys, source, target):
    write(tmp_path / "a", {})
    (tmp_path / "empty" / "cells").mkdir(parents=True)
    assert main(["pack", str(tmp_path / source), str(tmp_path / target)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / target).exists()
