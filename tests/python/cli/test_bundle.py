"""`oitlab bundle`: a folder that runs elsewhere. Made once from the build under test, moved, and used
with an environment that knows nothing of the source tree."""

import os
import re
import subprocess

import pytest
from program import PROGRAM, ROOT

MAKE = ROOT / "bundle" / "make"
LIMIT = 40 * 2**20  # as in bundle/make


@pytest.fixture(scope="module")
def bundle(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bundles")
    if not PROGRAM.is_file():
        assert "CI" not in os.environ, f"{PROGRAM} is not built"
        pytest.skip(f"{PROGRAM} is not built")
    done = subprocess.run([MAKE, PROGRAM.parent, folder / "made"], capture_output=True, text=True,
                          timeout=300)
    assert done.returncode == 0, done.stderr
    (folder / "said").write_text(done.stderr)
    return (folder / "made").rename(folder / "moved here")


@pytest.fixture
def run(bundle, tmp_path):
    def run(*arguments, path="/usr/bin:/bin", **environment):
        home = {"HOME": str(tmp_path), "PATH": path}
        kept = {name: value for name, value in os.environ.items() if name.startswith(("VK_", "LP_"))}
        return subprocess.run([bundle / "oitlab", *map(str, arguments)], capture_output=True,
                              text=True, cwd=tmp_path, env=kept | home | environment, timeout=300)

    return run


def test_it_is_small_and_brings_its_libraries(bundle):
    files = [path for path in bundle.rglob("*") if path.is_file()]
    said = (bundle.parent / "said").read_text()  # names the largest files of one that is too large
    assert sum(path.stat().st_size for path in files) < LIMIT and "more than" not in said, said
    assert not any(path.is_symlink() for path in files), "a link may lead out of the folder"
    found = subprocess.run(["ldd", bundle / "bin" / "oitlab"], capture_output=True, text=True).stdout
    ours = str(bundle / "bin" / ".." / "lib")
    shared = ("libstdc++", "libgcc_s", "libz", "libc", "libm")
    for line in found.splitlines():
        name, arrow, rest = line.strip().partition(" => ")
        if arrow and not name.startswith(tuple(f"{n}.so" for n in shared)):
            assert rest.startswith(ours), line


def test_it_measures_and_reports_away_from_the_source_tree(bundle, run, tmp_path):
    (tmp_path / "tiny.toml").write_text("""
name = "tiny"
sizes = ["32x18"]
scenes = ["planes"]
methods = ["blend"]
[measure]
time_limit = 0.1
stage_frames = 3
""")
    done = run("run", "tiny.toml")
    assert done.returncode == 0, done.stderr
    assert len(list((tmp_path / "results" / "tiny" / "cells").glob("*.json"))) == 1
    python = os.environ.get("OITLAB_PYTHON", "/usr/bin/python3")
    done = run("report", "results/tiny", OITLAB_PYTHON=python)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "results" / "tiny" / "report.html").is_file()
    listed = run("run", bundle / "experiments" / "quickstart.toml", "--dry-run")
    assert listed.returncode == 0 and "boxes" in listed.stdout

    # Its own shaders are what it reads.
    shader = bundle / "shaders" / "blend" / "blend.glsl"
    text = shader.read_text()
    shader.write_text(text + "\nbroken")
    try:
        done = run("render", "--scene", "planes", "--method", "blend", "--size", "32x18")
        assert done.returncode != 0 and "does not compile" in done.stderr
    finally:
        shader.write_text(text)


def test_its_other_verbs_need_no_source_tree(bundle, run, tmp_path):
    """The papers' figures, the experiments that have them, and the documents that tell of both."""
    (tmp_path / "tiny.toml").write_text("""
name = "performance"
sizes = ["32x18"]
scenes = ["boxes"]
methods = ["blend", { method = "lucid", repair = false }]
[measure]
time_limit = 0.1
stage_frames = 3
""")
    assert run("run", "tiny.toml", "--detail", "0.01").returncode == 0
    python = os.environ.get("OITLAB_PYTHON", "/usr/bin/python3")
    packed = tmp_path / "data" / "performance.json.gz"
    done = run("pack", "results/performance", packed, OITLAB_PYTHON=python)
    assert done.returncode == 0 and "2 cells" in done.stdout, done.stderr
    done = run("paper", packed, "--out", tmp_path / "paper", OITLAB_PYTHON=python)
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "paper" / "paper.md").read_text(encoding="utf-8")
    assert "LucidRaster (SW) against hardware blending" in text and "| Boxes |" in text
    assert {"published", "main.tex", "README.md"} <= {p.name for p in (bundle / "paper").iterdir()}
    assert not (bundle / "paper" / "generated").exists()
    for name in ("performance", "bma", "views"):
        assert (bundle / "experiments" / f"{name}.toml").is_file()
    for document in (bundle / "docs").glob("*.md"):
        for link in re.findall(r"\]\((?!http)([^)#]+)", document.read_text(encoding="utf-8")):
            assert (document.parent / link).exists(), f"{document.name} leads to {link}"


def test_selftest_runs_the_tests_under_its_own_layer(run):
    done = run("selftest", "--gtest_filter=Methods.TwoLayers*:Image*:*EveryExperimentOfTheProject*",
               VK_LOADER_DEBUG="layer")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "[  PASSED  ]" in done.stdout and "SKIPPED" not in done.stdout
    layer = [line for line in done.stderr.splitlines() if "libVkLayer_khronos_validation.so" in line]
    assert layer and not any("/usr/" in line for line in layer)
    failing = run("selftest", "--gtest_filter=Methods.TwoLayers*", VK_DRIVER_FILES="/none.json",
                  VK_ICD_FILENAMES="/none.json")
    assert failing.returncode != 0 and "FAILED" in failing.stdout, "no device is no pass"


def test_libraries_of_the_driver_come_from_the_system_unless_they_are_older(run, bundle, tmp_path):
    def loaded(**environment):
        done = run("list", "methods", LD_DEBUG="libs", **environment)
        assert done.returncode == 0, done.stderr[-2000:]
        return [line for line in done.stderr.splitlines()
                if "calling init" in line and "libstdc++" in line and f"{bundle}/lib/fallback" in line]

    assert not loaded()
    (tmp_path / "ldconfig").write_text("#!/bin/sh\n")  # a system that has none of them
    (tmp_path / "ldconfig").chmod(0o755)
    assert loaded(path=f"{tmp_path}:/usr/bin:/bin")


def test_an_older_c_library_is_told(run, bundle):
    needs = bundle / "lib" / "glibc"
    version = needs.read_text()
    assert tuple(map(int, version.split("."))) >= (2, 17)
    needs.write_text("2.99\n")
    try:
        done = run("info")
        assert done.returncode == 2 and "needs 2.99 or newer" in done.stderr
    finally:
        needs.write_text(version)


def test_what_is_there_is_not_overwritten(tmp_path):
    (tmp_path / "mine").write_text("kept")
    done = subprocess.run([MAKE, PROGRAM.parent, tmp_path], capture_output=True, text=True)
    assert done.returncode == 2 and "not an empty folder" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["mine"]


def test_make_needs_to_be_told_where(tmp_path):
    done = subprocess.run([MAKE, PROGRAM.parent, ""], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 2 and "Usage" in done.stderr
    assert not list(tmp_path.iterdir())
