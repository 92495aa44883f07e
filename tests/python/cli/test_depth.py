"""`oitlab depth` from end to end: the numbers, the heat map, the histogram."""

import json
import os
import subprocess
import sys

import numpy
import pytest
from exr import read_exr_red
from PIL import Image
from program import PROGRAM, needs_program

pytestmark = needs_program
NO_DEVICE = 3


def depth(*arguments, python=sys.executable):
    done = subprocess.run([PROGRAM, "depth", "--size", "97x53", *map(str, arguments)],
                          capture_output=True, text=True, env=os.environ | {"OITLAB_PYTHON": python})
    if done.returncode == NO_DEVICE:
        pytest.skip(done.stderr)
    return done


def test_numbers_counts_and_pictures_agree(tmp_path):
    heat, chart = tmp_path / "heat.exr", tmp_path / "chart.png"
    found = json.loads(depth("--scene", "planes", "--json", "--out", heat, "--histogram", chart).stdout)
    counts = read_exr_red(heat)
    assert counts.shape == (53, 97)
    assert found["fragments"] == counts.sum()
    assert found["covered_pixels"] == (counts > 0).sum()
    assert found["max_fragments_per_pixel"] == counts.max()
    assert found["mean_fragments_per_pixel"] == pytest.approx(counts.mean(dtype=float))
    assert found["mean_fragments_per_covered_pixel"] == pytest.approx(
        counts[counts > 0].mean(dtype=float))
    assert found["histogram"] == numpy.bincount(counts.astype(int).ravel()).tolist()
    assert Image.open(chart).format == "PNG"
    assert sorted(tmp_path.iterdir()) == [chart, heat]  # no temporary file stays


def test_the_heat_map_has_a_legend_below(tmp_path):
    done = depth("--scene", "planes", "--out", tmp_path / "heat.png", "--heat-scale", 8)
    assert "fragments" in done.stderr and done.returncode == 0
    width, height = Image.open(tmp_path / "heat.png").size
    assert width == 97 and height > 53


def test_without_python_the_histogram_is_a_table(tmp_path):
    done = depth("--scene", "planes", "--json", "--histogram", tmp_path / "chart.png",
                 python="/nonexistent/python")
    pixels = json.loads(done.stdout)["histogram"]
    rows = (tmp_path / "chart.txt").read_text().splitlines()[1:]
    assert [tuple(map(int, row.split())) for row in rows] == [
        (n, count) for n, count in enumerate(pixels) if count]
    assert "chart.txt" in done.stderr


@pytest.mark.parametrize("arguments, wanted", [
    (("--scene", "planes", "--size", "0x5x"), "WxH"),
    (("--scene", "planes", "--histogram", "x.svg"), ".png"),
    (("--scene", "planes", "--out", "x.gif"), ".exr"),
    (("--scene", "plains"), "planes")])
def test_bad_input_is_named(arguments, wanted):
    done = subprocess.run([PROGRAM, "depth", *arguments], capture_output=True, text=True)
    assert done.returncode == 2
    assert wanted in done.stderr
