"""Pictures of a page: how large they are, and what is said of those that are not there."""

import io

import numpy
import pytest
from oitlab_analysis.write.images import smaller
from PIL import Image
from reports import embedded_pictures, html_of
from synthetic import make_cell, write_cell, write_image

pytestmark = pytest.mark.usefixtures("without_charts")


def test_wide_images_become_smaller_copies(tmp_path, monkeypatch):
    monkeypatch.setattr("oitlab_analysis.write.images.MOST_BYTES", 1_000_000)
    write_cell(tmp_path, make_cell(size=(2000, 1000)), image=False)
    write_image(tmp_path / make_cell(size=(2000, 1000))["image"]["file"], 2000, 1000, detail=8)
    picture, = embedded_pictures(html_of(tmp_path)).values()
    assert (picture["width"], picture["height"]) == (2000, 1000)
    assert picture["scale"] == pytest.approx(2000 / 1280, rel=1e-3)
    assert picture["uri"].startswith("data:image/jpeg")


def test_pictures_of_a_big_report_share_the_room_there_is(tmp_path, monkeypatch):
    monkeypatch.setattr("oitlab_analysis.write.images.MOST_BYTES", 60_000)
    for number in range(6):
        cell = make_cell(method=f"m{number}", size=(400, 300), rmse=0.1)
        write_cell(tmp_path, cell, image=False)
        write_image(tmp_path / cell["image"]["file"], 400, 300, cell["image_hash"], detail=60)
    text = html_of(tmp_path)
    pictures = embedded_pictures(text)
    assert len(pictures) == 6 and all(p["scale"] > 1.5 for p in pictures.values())
    assert sum(len(p["uri"]) for p in pictures.values()) < 60_000 * 1.4
    assert "6 of 6 pictures are smaller copies" in text


@pytest.mark.parametrize("kind, said", [("missing", "is missing"), ("cut", "cannot be read"),
                                        ("outside", "outside the results folder"),
                                        ("none", "no image was written")])
def test_images_that_cannot_be_shown_are_said_so(tmp_path, kind, said):
    results = tmp_path / "results"
    cell = make_cell()
    if kind == "outside":
        write_image(tmp_path / "secret.png", 8, 8)
        cell["image"] = {"file": "../secret.png"}
    if kind == "none":
        cell["image"] = None
    write_cell(results, cell, image=False)
    if kind == "cut":
        path = results / cell["image"]["file"]
        write_image(path, 64, 36)
        path.write_bytes(path.read_bytes()[:90])
    text = html_of(results)
    assert said in text and "data:image/png" not in text


def test_pictures_never_take_more_than_their_room(tmp_path, monkeypatch):
    monkeypatch.setattr("oitlab_analysis.write.images.MOST_BYTES", 12_000)  # for two of the smallest copies
    for number in range(6):
        cell = make_cell(method=f"m{number}", size=(400, 300), rmse=0.1)
        write_cell(tmp_path, cell, image=False)
        write_image(tmp_path / cell["image"]["file"], 400, 300, cell["image_hash"], detail=60)
    text = html_of(tmp_path)
    pictures = embedded_pictures(text)
    assert 0 < len(pictures) < 6
    assert sum(len(p["uri"]) for p in pictures.values()) < 12_000 * 1.4
    assert f"{6 - len(pictures)} did not fit into the page" in text


def test_a_picture_that_cells_share_takes_its_room_once(tmp_path, monkeypatch):
    for number in range(5):
        write_cell(tmp_path, make_cell(method=f"exact{number}", rmse=0.0))
    size = next((tmp_path / "images").iterdir()).stat().st_size
    write_cell(tmp_path, make_cell(method="other", rmse=0.1))
    monkeypatch.setattr("oitlab_analysis.write.images.MOST_BYTES", 2 * size + 20)
    text = html_of(tmp_path)
    assert len(embedded_pictures(text)) == 2 and "did not fit" not in text


def test_a_copy_averages_the_pixels_that_it_drops():
    y, x = numpy.mgrid[0:900, 0:1600]
    board = ((x + y) % 2 * 255).astype(numpy.uint8)  # a fine chequer: grey from afar
    board[:, 800:] = 0
    file = io.BytesIO()
    Image.fromarray(board).save(file, "PNG")
    shown = numpy.asarray(Image.open(io.BytesIO(smaller(file.getvalue(), 800))), int)
    assert shown.shape == (450, 800, 3)
    assert numpy.abs(shown[:, :390] - 127.5).max() < 3 and shown[:, 410:].max() < 3
