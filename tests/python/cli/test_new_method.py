"""`./oitlab new-method` writes methods that compile and draw. The build adds one for each access to
oitlab_with_toy, as tests/CMakeLists.txt says."""

import shutil
import subprocess

import numpy
import pytest
from exr import read_exr_red
from program import ROOT
from toys import Toys


@pytest.fixture(scope="module")
def toys(tmp_path_factory):
    return Toys(tmp_path_factory.mktemp("root"))


@pytest.fixture
def tree(tmp_path):
    """What the verb needs of a tree, in a folder whose path has a space."""
    root = tmp_path / "a tree"
    (root / "methods").mkdir(parents=True)
    shutil.copytree(ROOT / "methods" / "templates", root / "methods" / "templates")
    shutil.copy2(ROOT / "oitlab", root / "oitlab")
    (root / "methods" / "wboit").mkdir()
    (root / "shaders" / "common").mkdir(parents=True)
    (root / "harness" / "frame").mkdir(parents=True)
    shutil.copy2(ROOT / "harness" / "frame" / "frame.h", root / "harness" / "frame" / "frame.h")
    return root


def new_method(tree, *arguments):
    return subprocess.run([tree / "oitlab", "new-method", *arguments], capture_output=True, text=True,
                          cwd=tree.parent, timeout=60)


def files(tree):
    return {str(path.relative_to(tree)) for path in tree.rglob("*")}


@pytest.mark.parametrize("access, written", [
    ("none", {"methods/my_idea/my_idea.cpp", "shaders/my_idea/my_idea.glsl",
              "shaders/my_idea/my_idea_types.h", "shaders/my_idea/resolve.comp"}),
    ("blended", {"methods/my_idea/my_idea.cpp", "shaders/my_idea/my_idea.glsl"}),
    ("exclusive", {"methods/my_idea/my_idea.cpp", "shaders/my_idea/my_idea.glsl"})])
def test_it_writes_two_folders_and_says_what_to_do_next(tree, access, written):
    before = files(tree)
    done = new_method(tree, "my_idea", "--access", access)
    assert done.returncode == 0 and done.stderr == ""
    assert files(tree) - before == written | {"methods/my_idea", "shaders/my_idea"}
    for name in written:
        assert name in done.stdout
        text = (tree / name).read_text()
        assert "@" not in text and ("my_idea" in text or name.endswith(".glsl"))
    render = "./oitlab render --scene planes --method my_idea"
    assert (f"{render} --set source=compute --out" if access == "exclusive" else f"{render} --out") in done.stdout


@pytest.mark.parametrize("arguments, problem", [
    ([], "new-method needs a name"),
    (["x"], "new-method needs --access none, blended or exclusive"),
    (["x", "--access"], "--access needs a value"),
    (["x", "--access", "interlock"], "--access interlock: wanted none, blended or exclusive"),
    (["x", "y", "--access", "none"], "takes one name, and got 'x' and 'y'"),
    (["x", "--acess", "none"], "'--acess' is not an option"),
    *((["--access", "none", name], f"'{name}' is not a name for a method: wanted a lowercase identifier")
      for name in ("", "Mine", "my-idea", "1st", "a__b", "_a", "../x", "a b", "ä")),
    (["class", "--access", "none"], "'class' is not a name for a method: it is a word of C++"),
    (["frame", "--access", "none"], "'frame' is not a name for a method: harness/ has a type Frame"),
    (["wboit", "--access", "none"], "'wboit' exists already: "),
    (["common", "--access", "none"], "'common' exists already: ")])
def test_it_refuses_in_one_line_and_writes_nothing(tree, arguments, problem):
    before = files(tree)
    done = new_method(tree, *arguments)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("oitlab: ") and problem in done.stderr
    assert done.stderr.count("\n") == 1
    assert files(tree) == before


def test_it_never_overwrites(tree):
    assert new_method(tree, "mine", "--access", "blended").returncode == 0
    again = new_method(tree, "mine", "--access", "none")
    assert again.returncode == 2 and "'mine' exists already" in again.stderr


def red(toys, tmp_path, method, scene, *settings):
    path = tmp_path / "image.exr"
    said = toys.render(method, scene, *settings, out=path)
    return read_exr_red(path), said["counters"].get("fragments")


@pytest.mark.parametrize("source", ["hardware", "compute"])
def test_the_skeleton_with_its_own_buffers_shows_how_many_layers_there_are(toys, tmp_path, source):
    grey, _ = red(toys, tmp_path, "my_none", "planes", f"source={source}")
    background, _ = red(toys, tmp_path, "sum_of_layers", "planes", "strength=0")
    layers = -4 * numpy.log2(1 - grey[grey != background])
    # Float32 near 1 resolves 1 - grey = 2^-8, which 32 layers leave, to 1.5e-5 of it.
    assert numpy.abs(layers - layers.round()).max() < 1e-3
    exact = toys.render("reference", "planes", f"source={source}")["counters"]
    assert layers.round().sum() == exact["fragments"]
    assert layers.round().max() == exact["max_fragments_per_pixel"]


@pytest.mark.parametrize("source", ["hardware", "compute"])
def test_the_blended_skeleton_shows_the_mean_color(toys, tmp_path, source):
    """As wboit without weights does."""
    mean, fragments = red(toys, tmp_path, "my_blended", "planes", f"source={source}")
    wboit, count = red(toys, tmp_path, "wboit", "planes", "weight=none", f"source={source}")
    assert fragments == count > 0
    # With compute the order of the up to 32 float32 terms of a sum differs from frame to frame.
    numpy.testing.assert_allclose(mean, wboit, rtol=1e-5)


def test_the_exclusive_skeleton_shows_the_nearest_layer(toys):
    nearest = toys.render("my_exclusive", "planes", "source=compute")
    toy = toys.render("nearest_layers", "planes", "source=compute", "k=1")
    assert nearest["image_hash"] == toy["image_hash"]
    assert nearest["counters"]["fragments"] == toy["counters"]["fragments"] > 0
