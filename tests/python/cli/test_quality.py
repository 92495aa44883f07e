"""The program's metrics against independent ones: FLIP against float64 numpy, SSIM and PSNR against
scikit-image where that is installed."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy
import pytest
from exr import read_exr_red, write_exr
from PIL import Image
from program import PROGRAM, needs_program

pytestmark = needs_program
SIZE = (48, 61)  # smaller than the filters reach, and of odd width


def pattern(name: str, size: tuple[int, int] = SIZE) -> numpy.ndarray:
    """An image in [0, 1] with what a metric may trip over."""
    height, width = size
    y, x = numpy.mgrid[0:height, 0:width]
    random = numpy.random.default_rng(7)
    noise = random.random((height, width, 3))
    waves = numpy.stack([0.5 + 0.5 * numpy.sin(x / f + y / 9) for f in (2, 5, 11)], axis=-1)
    colours = numpy.eye(3)[(x // 9 + y // 7) % 3]
    return {"noise": noise, "waves": waves, "colours": colours,
            "shifted": numpy.roll(waves, 2, axis=1),
            "near": (waves + 0.02 * (noise - 0.5)).clip(0, 1),
            "dark": 0.01 * noise, "black": numpy.zeros_like(noise), "white": numpy.ones_like(noise),
            "blue": numpy.zeros_like(noise) + (0, 0, 1), "grey": 0.5 + 0 * noise,
            "green": numpy.zeros_like(noise) + (0, 1, 0)}[name]


PAIRS = [("waves", "shifted"), ("waves", "near"), ("noise", "waves"), ("colours", "noise"),
         ("black", "white"), ("green", "blue"), ("dark", "black"), ("grey", "noise"),
         ("waves", "waves")]


def compare(*arguments: object) -> dict:
    done = subprocess.run([PROGRAM, "compare", *map(str, arguments), "--json"],
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def save_png(path: Path, image: numpy.ndarray) -> numpy.ndarray:
    """Returns what the file holds, in [0, 1]."""
    stored = (image * 255).round().astype(numpy.uint8)
    Image.fromarray(stored).save(path)
    return stored / 255


@pytest.mark.parametrize("first, second", PAIRS)
def test_flip_of_display_values_is_that_of_the_paper(tmp_path, first, second):
    reference = pytest.importorskip("flip_reference")
    a = save_png(tmp_path / "a.png", pattern(first))
    b = save_png(tmp_path / "b.png", pattern(second))
    wanted = reference.flip(reference.srgb_to_linear(a), reference.srgb_to_linear(b))
    found = compare(tmp_path / "a.png", tmp_path / "b.png", "--metric", "flip", "--map",
                    tmp_path / "map.exr")
    assert found["flip"] == pytest.approx(wanted.mean(), abs=2e-5)
    assert found["flip_hdr"] is None
    assert numpy.abs(read_exr_red(tmp_path / "map.exr") - wanted).max() < 1e-3
    assert wanted.min() >= 0 and wanted.max() <= 1


@pytest.mark.parametrize("first, second, brightness", [
    ("waves", "shifted", 1), ("waves", "near", 40), ("noise", "waves", 0.001), ("colours", "noise", 3),
    ("waves", "dark", 1), ("waves", "waves", 5)])
def test_hdr_flip_is_that_of_the_paper(tmp_path, first, second, brightness):
    reference = pytest.importorskip("flip_reference")
    a = (brightness * pattern(first)).astype(numpy.float32)
    b = (brightness * pattern(second)).astype(numpy.float32)
    b[3, 5] = 50 * brightness  # a light: several exposures
    write_exr(tmp_path / "a.exr", a)
    write_exr(tmp_path / "b.exr", b)
    wanted = reference.hdr_flip(a.astype(float), b.astype(float))
    found = compare(tmp_path / "a.exr", tmp_path / "b.exr", "--metric", "flip_hdr", "--map",
                    tmp_path / "map.exr")
    assert found["flip_hdr"] == pytest.approx(wanted.mean(), abs=5e-5)
    assert numpy.abs(read_exr_red(tmp_path / "map.exr") - wanted).max() < 2e-3
    shown = reference.flip(a.clip(0, 1).astype(float), b.clip(0, 1).astype(float))
    assert found["flip"] == pytest.approx(shown.mean(), abs=2e-5)


@pytest.mark.parametrize("first, second", PAIRS)
def test_ssim_and_psnr_are_those_of_scikit_image(tmp_path, first, second):
    metrics = pytest.importorskip("skimage.metrics")
    a = save_png(tmp_path / "a.png", pattern(first))
    b = save_png(tmp_path / "b.png", pattern(second))
    wanted, wanted_map = metrics.structural_similarity(
        a, b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, channel_axis=-1,
        data_range=1, full=True)
    found = compare(tmp_path / "a.png", tmp_path / "b.png", "--metric", "ssim", "--map",
                    tmp_path / "map.exr")
    assert found["ssim"] == pytest.approx(wanted, abs=1e-6)
    inside = (slice(5, -5), slice(5, -5))
    errors = 1 - read_exr_red(tmp_path / "map.exr") - wanted_map.mean(axis=-1)
    assert numpy.abs(errors[inside]).max() < 1e-5
    if first != second:
        psnr = metrics.peak_signal_noise_ratio(b, a, data_range=1)
        assert found["psnr"] == pytest.approx(psnr, abs=1e-5)


def test_ssim_of_linear_images_is_that_of_their_encoded_clamped_values(tmp_path):
    metrics = pytest.importorskip("skimage.metrics")
    reference = pytest.importorskip("flip_reference")
    a, b = (2 * pattern(name) - 0.1 for name in ("waves", "noise"))
    write_exr(tmp_path / "a.exr", a)
    write_exr(tmp_path / "b.exr", b)
    wanted = metrics.structural_similarity(
        *(reference.linear_to_srgb(image.clip(0, 1)) for image in (a, b)), gaussian_weights=True,
        sigma=1.5, use_sample_covariance=False, channel_axis=-1, data_range=1)
    assert compare(tmp_path / "a.exr", tmp_path / "b.exr")["ssim"] == pytest.approx(wanted, abs=1e-6)


def test_what_cannot_be_measured_is_null(tmp_path):
    broken = pattern("waves")
    broken[20, 20, 1] = numpy.nan
    write_exr(tmp_path / "a.exr", broken)
    write_exr(tmp_path / "b.exr", pattern("waves"))
    found = compare(tmp_path / "a.exr", tmp_path / "b.exr")
    assert [found[key] for key in ("rmse", "psnr", "ssim", "flip", "flip_hdr")] == [None] * 5
    assert found["pixels_off_count"] == 1
    save_png(tmp_path / "small.png", pattern("waves", (10, 40)))
    found = compare(tmp_path / "small.png", tmp_path / "small.png")
    assert found["ssim"] is None and found["flip"] == 0
