"""Adding a method as methods/README.md says: two folders, and nothing else names it.

tests/data/toy holds the two folders of a toy method, with the same names as at the root of the tree.
The build makes a second program from them beside the real methods, with the same CMake function; the
shader folder is copied beside the others, as anybody would.
"""

import json
import os
import re
import shutil
import subprocess

import numpy
import pytest
from exr import read_exr_red
from program import PROGRAM, ROOT

NAME = "sum_of_layers"
TOY = ROOT / "tests" / "data" / "toy"
WITH_TOY = PROGRAM.with_name("oitlab_with_toy")


@pytest.fixture(scope="module")
def with_toy(tmp_path_factory):
    """Runs the program that has the toy, with shaders/ as it is when the folder was copied there."""
    if not WITH_TOY.is_file():
        assert "CI" not in os.environ, f"{WITH_TOY} is not built"
        pytest.skip(f"{WITH_TOY} is not built")
    root = tmp_path_factory.mktemp("root")
    shutil.copytree(ROOT / "shaders", root / "shaders")
    shutil.copytree(TOY / "shaders", root / "shaders", dirs_exist_ok=True)
    shutil.copytree(ROOT / "experiments", root / "experiments")

    def run(*arguments):
        done = subprocess.run([WITH_TOY, *map(str, arguments)], capture_output=True, text=True,
                              cwd=root, env={**os.environ, "OITLAB_ROOT": str(root)}, timeout=120)
        assert done.returncode == 0, done.stderr
        return done

    return run


def test_nothing_outside_its_two_folders_names_it():
    mine = {path.relative_to(TOY).parts[:2] for path in TOY.rglob("*") if path.is_file()}
    assert mine == {("methods", NAME), ("shaders", NAME)}
    elsewhere = [ROOT / "CMakeLists.txt", ROOT / "tests" / "CMakeLists.txt", ROOT / "oitlab"]
    for folder in ("analysis", "cmake", "harness", "methods", "shaders", "experiments"):
        elsewhere += [path for path in (ROOT / folder).rglob("*") if path.is_file()]
    assert len(elsewhere) > 100
    word = re.compile(NAME.encode())
    assert [path for path in elsewhere if word.search(path.read_bytes())] == []


def test_it_is_listed_with_its_parameters(oitlab, with_toy):
    def names(done):
        return {method["name"]: method for method in json.loads(done.stdout)["methods"]}

    with_it = names(with_toy("list", "methods", "--json"))
    without = names(oitlab("list", "methods", "--json"))
    assert with_it.keys() - without.keys() == {NAME}
    assert [p["name"] for p in with_it[NAME]["parameters"]] == ["strength"]


def test_it_renders_what_it_says(with_toy, tmp_path):
    """Twice the strength adds twice as much to the background."""

    def render(*arguments):
        path = tmp_path / "image.exr"
        done = with_toy("render", "--scene", "planes", "--size", "48x27", "--format", "rgba32f",
                        "--validation", "--json", "--out", path, *arguments)
        assert "validation:" not in done.stderr
        return read_exr_red(path), json.loads(done.stdout)

    _, exact = render("--method", "reference")
    background, said = render("--method", NAME, "--set", "strength=0")
    once, _ = render("--method", NAME)
    twice, _ = render("--method", NAME, "--set", "strength=2")
    assert said["counters"]["fragments"] == exact["counters"]["fragments"] > 0
    assert "sum" in said["gpu_ms"]["stages"]
    assert background.min() == background.max() and (once > background).any()
    numpy.testing.assert_allclose(twice - background, 2 * (once - background), rtol=1e-5, atol=1e-5)


def test_it_is_measured_in_experiments(with_toy, tmp_path):
    toml = tmp_path / "toy.toml"
    toml.write_text(f"""
name = "toy"
sizes = ["48x27"]
scenes = ["planes"]
[[methods]]
method = "{NAME}"
strength = [0.5, 1.0]
[[methods]]
method = "blend"
[measure]
time_limit = 0.1
stage_frames = 3
""")
    with_toy("run", toml, "--results", tmp_path / "results")
    cells = [json.loads(p.read_text()) for p in (tmp_path / "results" / "cells").glob("*.json")]
    toys = [cell for cell in cells if cell["method"] == NAME]
    assert len(cells) == 3 and all(cell["status"] == "ok" for cell in cells)
    assert sorted(cell["parameters"]["strength"] for cell in toys) == [0.5, 1.0]
    assert all(f"{NAME}/sum.frag" in cell["provenance"]["shaders"] for cell in toys)
    assert all(cell["quality"]["rmse"] > 0.01 for cell in toys)
