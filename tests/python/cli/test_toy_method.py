"""Adding a method as methods/README.md says: two folders, and nothing else names it.

tests/data/toy holds the folders of toy methods, with the same names as at the root of the tree. The
build makes a second program from them beside the real methods, with the same CMake function.
"""

import json
import re

import numpy
import pytest
from exr import read_exr_red
from program import ROOT
from toys import SKELETONS, TOY, Toys

PARAMETERS = {"sum_of_layers": "strength", "nearest_layers": "k"}


@pytest.fixture(scope="module")
def toys(tmp_path_factory):
    return Toys(tmp_path_factory.mktemp("root"))


@pytest.mark.parametrize("name", PARAMETERS)
def test_nothing_outside_its_two_folders_names_it(name):
    folders = {path.relative_to(TOY).parts[:2] for path in TOY.rglob("*") if path.is_file()}
    assert folders == {(top, toy) for top in ("methods", "shaders") for toy in PARAMETERS}
    elsewhere = [ROOT / "CMakeLists.txt", ROOT / "tests" / "CMakeLists.txt", ROOT / "oitlab"]
    for folder in ("analysis", "cmake", "harness", "methods", "shaders", "experiments"):
        elsewhere += [path for path in (ROOT / folder).rglob("*")
                      if path.is_file() and path != ROOT / "methods" / "README.md"]
    assert len(elsewhere) > 100
    word = re.compile(name.encode())
    assert [path for path in elsewhere if word.search(path.read_bytes())] == []


def test_they_are_listed_with_their_parameters(oitlab, toys):
    def names(done):
        return {method["name"]: method for method in json.loads(done.stdout)["methods"]}

    with_them = names(toys.run("list", "methods", "--json"))
    without = names(oitlab("list", "methods", "--json"))
    skeletons = {folder.name for folder in (SKELETONS / "methods").iterdir()}
    assert with_them.keys() - without.keys() - skeletons == PARAMETERS.keys()
    of_sources = {"source", "deliver", "deliver_seed"}
    for name, own in PARAMETERS.items():
        assert {p["name"] for p in with_them[name]["parameters"]} == {own} | of_sources


@pytest.mark.parametrize("source", ["hardware", "compute"])
def test_light_adds_up(toys, tmp_path, source):
    """Twice the strength adds twice as much to the background."""

    def render(strength):
        path = tmp_path / "image.exr"
        said = toys.render("sum_of_layers", "planes", f"source={source}", f"strength={strength}", out=path)
        return read_exr_red(path), said

    background, said = render(0)
    once, _ = render(1)
    twice, _ = render(2)
    exact = toys.render("reference", "planes", f"source={source}")
    assert said["counters"]["fragments"] == exact["counters"]["fragments"] > 0
    assert "sum" in said["gpu_ms"]["stages"]
    assert background.min() == background.max() and (once > background).any()
    # Float32 rounds each sum, of at most 32 layers, and the subtraction of the background.
    numpy.testing.assert_allclose(twice - background, 2 * (once - background), rtol=1e-5, atol=1e-5)


def test_the_sum_is_the_same_from_both_sources(toys, tmp_path):
    images = []
    for source in ("hardware", "compute"):
        path = tmp_path / f"{source}.exr"
        toys.render("sum_of_layers", "planes", f"source={source}", out=path)
        images.append(read_exr_red(path))
    # Edges of triangles may fall on the other side of a sample (docs/sources.md): few pixels. Elsewhere, the
    # order of the up to 32 terms of a sum differs, each with a rounding of 6e-8 of the sum.
    near = numpy.isclose(*images, rtol=1e-5)
    assert (~near).mean() < 0.001


def test_all_of_at_most_8_layers_are_the_exact_image(toys):
    exact = toys.render("reference", "teapot", "source=compute")
    assert 4 < exact["counters"]["max_fragments_per_pixel"] <= 8
    all_layers = toys.render("nearest_layers", "teapot", "source=compute", "k=8")
    assert all_layers["image_hash"] == exact["image_hash"]
    assert all_layers["counters"]["fragments"] == exact["counters"]["fragments"]
    assert toys.render("nearest_layers", "teapot", "source=compute", "k=1")["image_hash"] != exact["image_hash"]


def test_the_nearest_layers_are_the_same_in_any_order(toys):
    """Planes have up to 32 layers, so most are dropped."""
    hashes = {toys.render("nearest_layers", "planes", "source=compute", *order)["image_hash"]
              for order in (["deliver=near_to_far"], ["deliver=far_to_near"],
                            *(["deliver=shuffled", f"deliver_seed={seed}"] for seed in (1, 2, 3)))}
    assert len(hashes) == 1


def test_exclusive_access_says_that_hardware_lacks_it(toys):
    device = next(d for d in json.loads(toys.run("info", "--json").stdout)["devices"] if d["best"])
    if device["features"]["fragmentShaderPixelInterlock"]:
        pytest.skip("it does not")
    done = toys.try_run("render", "--scene", "planes", "--size", "48x27", "--method", "nearest_layers",
                        "--set", "source=hardware")
    assert done.returncode == 3
    assert re.fullmatch(
        r"oitlab: source=hardware needs fragmentShaderPixelInterlock, which .* lacks, to give a pixel to one "
        r"fragment at a time; source=compute does without\n", done.stderr)


def test_they_are_measured_in_experiments(toys, tmp_path):
    toml = tmp_path / "toy.toml"
    toml.write_text("""
name = "toy"
sizes = ["48x27"]
scenes = ["planes"]
[[methods]]
method = "sum_of_layers"
strength = [0.5, 1.0]
[[methods]]
method = "nearest_layers"
source = "compute"
k = 2
[[methods]]
method = "blend"
[measure]
time_limit = 0.1
stage_frames = 3
""")
    toys.run("run", toml, "--results", tmp_path / "results")
    cells = [json.loads(p.read_text()) for p in (tmp_path / "results" / "cells").glob("*.json")]
    assert len(cells) == 4 and all(cell["status"] == "ok" for cell in cells)
    sums = [cell for cell in cells if cell["method"] == "sum_of_layers"]
    assert sorted(cell["parameters"]["strength"] for cell in sums) == [0.5, 1.0]
    for cell in cells:
        if cell["method"] in PARAMETERS:
            shaders = " ".join(cell["provenance"]["shaders"])
            assert f"FRAGMENT_PROGRAM={cell['method']}/" in shaders
            assert cell["quality"]["rmse"] > 0.01
