"""How numbers are written."""

import pytest
from oitlab_analysis import formats


@pytest.mark.parametrize("value, text", [
    (12.345, "12.3"), (0.012345, "0.0123"), (1234.5, "1234"), (0, "0"), (0.00012345, "1.23e-04"),
    (None, "–"), (float("nan"), "–"), (float("inf"), "–"), (True, "–"), (999.9, "1000"), (9.996, "10.0")])
def test_number(value, text):
    assert formats.number(value) == text


@pytest.mark.parametrize("values, text", [
    ((12.345, 12.2, 12.4), "12.3 [12.2, 12.4]"),
    ((2.1971, 2.196, 2.201), "2.197 [2.196, 2.201]"),
    ((12.3, 12.3, 12.3), "12.30 [12.30, 12.30]"),
    ((12.3, None, None), "12.3"),
    ((None, 1, 2), "–")])
def test_interval_gets_a_fourth_digit_where_three_would_hide_it(values, text):
    assert formats.with_interval(*values) == text


@pytest.mark.parametrize("value, text", [
    (950, "950"), (12_700, "12.7 K"), (2_900_000, "2.90 M"), (999_950, "1.00 M"),
    (1.3e9, "1.30 G"), (0, "0"), (None, "–")])
def test_count(value, text):
    assert formats.count(value) == text


@pytest.mark.parametrize("value, text", [
    (0, "0 %"), (0.125, "12.5 %"), (1, "100 %"), (1e-7, "<0.001 %"), (None, "–")])
def test_share_never_rounds_an_error_to_zero(value, text):
    assert formats.share(value) == text


@pytest.mark.parametrize("ssim, text", [
    (1, "1.0000"), (0.999999, "0.9999"), (0.96582, "0.9658"), (-0.00372, "-0.0038"), (None, "–")])
def test_similarity_is_1_only_when_equal(ssim, text):
    assert formats.similarity(ssim) == (text if ssim is not None else formats.NOTHING)


@pytest.mark.parametrize("psnr, rmse, text", [
    (None, 0.0, "∞ (equal)"), (None, None, "–"), (33.333, 0.02, "33.3"),
    (None, 0.02, "–")])  # a cell that contradicts itself must not look equal
def test_psnr_is_infinite_only_without_any_error(psnr, rmse, text):
    assert formats.decibels(psnr, rmse) == text


def test_mebibytes_are_binary():
    assert formats.mebibytes(3 * 2**20) == "3.00"


def test_natural_order():
    assert sorted(["t=16", "t=8", "a"], key=formats.natural_key) == ["a", "t=8", "t=16"]
