"""What of a results folder counts as there: whole groups of one run, measured as they would be now."""

import json
import subprocess

import pytest
from program import ROOT
from runs import EXPERIMENT, baselines, cells, measured


def test_cells_of_a_newer_version_are_left_alone(oitlab, toml, results):
    """They used to be measured again, and so lost."""
    assert oitlab("run", toml, "--results", results).returncode == 0
    name, cell = sorted(cells(results).items())[0]
    newer = json.dumps({**cell, "schema": 2})
    (results / "cells" / name).write_text(newer)
    done = oitlab("run", toml, "--results", results)
    assert done.returncode == 2 and f"{name}: its schema is 2, which a newer version wrote" in done.stderr
    assert len(done.stderr.splitlines()) <= 2
    assert (results / "cells" / name).read_text() == newer


def test_half_a_group_is_measured_again_as_a_whole(oitlab, toml, results):
    """Two of three methods were measured again alone: their ratios had another baseline."""
    assert oitlab("run", toml, "--results", results).returncode == 0
    first = cells(results)
    for name, cell in first.items():
        if cell["size"] == [48, 27] and cell["method"] == "blend":
            (results / "cells" / name).unlink()
    done = oitlab("run", toml, "--results", results)
    assert done.returncode == 0 and measured(done) == (3, 3)
    assert "measured again, with all 3 cells of its group: 2 of 3 cells are missing" in done.stderr
    second = cells(results)
    assert second.keys() == first.keys()
    assert baselines(results) == {(48, 27): (1, 3), (32, 18): (1, 3)}
    for name, cell in second.items():
        assert (cell == first[name]) == (cell["size"] == [32, 18])
        assert cell["image_hash"] == first[name]["image_hash"]


def test_a_method_that_is_added_is_measured_with_its_group(oitlab, toml, results):
    toml.write_text(EXPERIMENT.replace('order = ["submission", "sorted"]', ""))
    assert measured(oitlab("run", toml, "--results", results)) == (4, 0)
    toml.write_text(EXPERIMENT)
    assert measured(oitlab("run", toml, "--results", results)) == (6, 0)
    assert baselines(results) == {(48, 27): (1, 3), (32, 18): (1, 3)}
    # One that is left out changes nothing in the others.
    toml.write_text(EXPERIMENT.replace('order = ["submission", "sorted"]', ""))
    assert measured(oitlab("run", toml, "--results", results)) == (0, 4)


def damage_text(cell, _):
    return json.dumps(cell)[:100]


def damage_empty(_, __):
    return "{}"


def damage_status_only(_, __):
    return '{"status": "ok"}'


def damage_id(cell, other):
    return json.dumps({**cell, "id": other["id"]})


def damage_status(cell, _):
    return json.dumps({**cell, "status": "fine"})


def damage_samples(cell, _):
    return json.dumps({**cell, "samples": {"frame_ms": [], "block": []}})


def damage_quality(cell, _):
    return json.dumps({**cell, "quality": None})


@pytest.mark.parametrize("damage", [damage_text, damage_empty, damage_status_only, damage_id,
                                    damage_status, damage_samples, damage_quality])
def test_a_broken_cell_is_not_there(oitlab, toml, results, damage):
    """`{}` and `{"status": "ok"}` used to count as measured."""
    run = ("run", toml, "--results", results, "--size", "32x18")
    assert oitlab(*run).returncode == 0
    (name, cell), (_, other), _ = sorted(cells(results).items())
    (results / "cells" / name).write_text(damage(cell, other))
    dry = oitlab(*run, "--dry-run")
    assert "0 there already, 3 to measure" in dry.stderr and "is no whole cell" in dry.stdout
    done = oitlab(*run)
    assert done.returncode == 0 and measured(done) == (3, 0)
    assert f"{name} is no whole cell" in done.stderr
    assert cells(results)[name]["status"] == "ok"
    assert baselines(results) == {(32, 18): (1, 3)}


def test_a_cell_whose_image_is_gone_is_not_there(oitlab, toml, results):
    run = ("run", toml, "--results", results, "--size", "32x18")
    oitlab(*run)
    sorted((results / "images").iterdir())[0].unlink()
    done = oitlab(*run)
    assert measured(done) == (3, 0) and "is not there" in done.stderr
    assert len(list((results / "images").iterdir())) == 3


def change_limit(text):
    return text.replace("time_limit = 0.1", "time_limit = 0.12")


def change_seed(text):
    return text.replace('name = "resumed"', 'name = "resumed"\nseed = 7')


def change_reference(text):
    return text.replace('name = "resumed"', 'name = "resumed"\nreference = "blend"')


@pytest.mark.parametrize(("change", "said"), [
    (change_limit, "measure.time_limit is 0.1, now 0.12"),
    (change_seed, "measure.seed is 1, now 7"),
    (change_reference, "the reference is reference, now blend")])
def test_what_was_measured_otherwise_is_measured_again(oitlab, toml, results, change, said):
    """Or kept and named: cells of other settings used to satisfy a run without a word."""
    assert oitlab("run", toml, "--results", results).returncode == 0
    first = cells(results)
    toml.write_text(change(EXPERIMENT))
    kept = oitlab("run", toml, "--results", results, "--keep")
    assert measured(kept) == (0, 6) and kept.stderr.count(said) == 6
    assert cells(results) == first
    done = oitlab("run", toml, "--results", results)
    assert measured(done) == (6, 0) and said in done.stderr
    assert measured(oitlab("run", toml, "--results", results)) == (0, 6)


def test_brief_cells_do_not_count_for_a_full_run(oitlab, toml, results):
    toml.write_text(EXPERIMENT + "[profile.brief.measure]\ntime_limit = 0.05\n")
    run = ("run", toml, "--results", results, "--size", "32x18")
    assert measured(oitlab(*run, "--profile", "brief")) == (3, 0)
    done = oitlab(*run, "--profile", "full")
    assert measured(done) == (3, 0) and "the profile is brief, now full" in done.stderr
    assert {cell["profile"] for cell in cells(results).values()} == {"full"}


def test_an_edited_shader_makes_its_groups_old(oitlab, toml, results, tmp_path):
    root = tmp_path / "root"
    root.mkdir()
    for folder in ("shaders", "experiments"):
        subprocess.run(["cp", "-r", ROOT / folder, root], check=True)
    env = {"OITLAB_ROOT": str(root), "OITLAB_CACHE": str(tmp_path / "cache")}
    run = ("run", toml, "--results", results, "--size", "32x18")
    assert measured(oitlab(*run, env=env)) == (3, 0)
    assert measured(oitlab(*run, env=env)) == (0, 3)
    unused = root / "shaders" / "wboit" / "wboit.glsl"
    unused.write_text(unused.read_text() + "\n// edited\n")
    assert measured(oitlab(*run, env=env)) == (0, 3)
    edited = root / "shaders" / "blend" / "blend.glsl"
    edited.write_text(edited.read_text() + "\n// edited\n")
    done = oitlab(*run, env=env)
    assert measured(done) == (3, 0)
    assert "shader source/hardware.frag" in done.stderr and "blend/blend.glsl" in done.stderr
