"""The page: what it holds, that it loads nothing, and that nothing in it can run but its own scripts."""

import base64
import hashlib
import html
import json
import re

import pytest
from reports import embedded_pictures, html_of
from synthetic import make_cell, write_cell

pytestmark = pytest.mark.usefixtures("without_charts")


def test_page_is_self_contained_and_well_formed(results, page):
    assert len(re.findall(r'<figure class="chart lead">\s*<svg ', page.text)) == 1
    assert len(page.sources) == 4  # the other charts: per scene, times, stages, memory
    assert all(source.startswith("data:image/svg+xml") for source in page.sources)
    pictures = embedded_pictures(page.text)
    # Those of the two exact methods are the same, bit for bit, in each of the two scenes.
    assert len(pictures) == 2 * 3
    assert all(p["uri"].startswith("data:image/png") and p["scale"] == 1 for p in pictures.values())
    assert not [link for link in page.links if ":" in link]
    for link in page.links:
        assert link.startswith("#") or (results / link).is_file()


def test_the_policy_allows_the_scripts_of_the_page_and_no_others(page):
    policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', page.text)[1]
    policy = html.unescape(policy)
    assert policy.startswith("default-src 'none'; ") and "http" not in policy
    script_src, = [part for part in policy.split("; ") if part.startswith("script-src")]
    scripts = re.findall(r"<script>(.*?)</script>", page.text, re.S)
    hashes = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in scripts]
    assert script_src.split()[1:] == [f"'sha256-{digest}'" for digest in hashes] and len(hashes) == 2


def test_the_pointer_over_a_point_shows_its_variant(page):
    chart = page.text[page.text.index("<svg "):page.text.index("</svg>")]
    assert re.search(r'<g id="chart1-hint[0-9]+"><title>lucid: 1.70, RMSE 0</title>', chart)


def test_the_first_screen_has_title_plot_and_table_in_this_order(page):
    marks = [page.text.index(mark) for mark in ("<h1>", "<svg ", 'class="table"', 'class="viewer"', "<img ")]
    assert marks == sorted(marks)


def test_page_table_holds_the_figures_of_the_cells(results, page):
    table, = page.tables()
    rows = {(row["scene"], row["label"]): row for row in table["rows"]}
    assert len(rows) == 10
    for path in (results / "cells").glob("*.json"):
        cell = json.loads(path.read_text())
        row = rows[cell["scene"]["name"], cell["method"]]
        if cell["status"] != "ok":
            assert row["frame"] == f"{cell['status']}: {cell['reason']}"
            continue
        shown = [float(x) for x in re.findall(r"[\d.]+", row["frame"])]
        frame = cell["statistics"]["frame"]
        assert shown == pytest.approx([frame["median"], *frame["ci95"]], rel=0.006)
        assert row["sort"]["frame"] == frame["median"]
        equal = cell["quality"]["psnr"] is None
        assert row["psnr"] == "∞ (equal)" if equal else float(row["psnr"]) > 20
        assert float(row["memory"]) == pytest.approx(cell["memory_bytes"]["total"] / 2**20, rel=0.006)
        # The generator makes every method a known multiple of blend.
        factor = {"blend": 1, "reference": 3.1, "wboit": 1.003, "lucid": 1.7}[cell["method"]]
        assert float(row["ratio"].split()[0]) == pytest.approx(factor, rel=0.01)
        assert row["verdict"] == {"blend": "baseline", "wboit": "same"}.get(cell["method"], "slower")
        assert all(f"{name}=" in row["hints"]["label"] for name in cell["parameters"])


def test_text_from_cells_is_escaped(results):
    text = (results / "report.html").read_text(encoding="utf-8")
    assert "3 | frames &lt;b&gt;" in text and "3 | frames \\u003cb>" in text and "<b>" not in text
    markdown = (results / "report.md").read_text(encoding="utf-8")
    assert "3 \\| frames &lt;b>" in markdown


def test_an_unscored_image_is_not_called_equal(tmp_path):
    write_cell(tmp_path, make_cell(rmse=None))
    text = html_of(tmp_path)
    assert "not compared with a reference" in text
    assert "(equal)" not in text and "equal to the reference</figcaption>" not in text
