import json

import pytest
from oitlab_analysis.__main__ import main
from oitlab_analysis.draw.histogram import describe_depth, join_counts
from PIL import Image


def test_counts_are_joined_only_when_there_are_too_many():
    assert join_counts([9, 5, 0, 7]) == (1, [5, 0, 7])
    assert join_counts([0] + [1] * 1000, most=400) == (3, [3] * 333 + [1])
    assert join_counts([5]) == (1, [])


def test_the_figures_are_those_worked_out_by_hand():
    # 2 * 1 + 2 * 4 = 10 fragments on 4 of 8 pixels.
    text = describe_depth([4, 2, 0, 0, 2])
    assert text == ("10 fragments, at most 4 a pixel; mean 2.50 over covered pixels (50.0 %), "
                    "1.25 over all")
    assert describe_depth([7]) == "no fragments"


@pytest.mark.parametrize("pixels", [[4, 100000, 20, 0, 1], [12], [0] + [3] * 2000])
def test_a_chart_is_written(tmp_path, pixels):
    source, target = tmp_path / "depth.json", tmp_path / "chart.png"
    source.write_text(json.dumps({"histogram": pixels, "scene": {"name": "a $cene"}}))
    assert main(["histogram", str(source), str(target)]) == 0
    assert Image.open(target).size == (960, 510)


@pytest.mark.parametrize("text, wanted", [
    ("{", "not JSON"), ("[]", "/histogram"), ('{"histogram": []}', "/histogram"),
    ('{"histogram": [1, "2"]}', "/histogram"), ('{"histogram": [1, -2]}', "/histogram")])
def test_what_is_no_depth_file_is_named(tmp_path, capsys, text, wanted):
    source = tmp_path / "depth.json"
    source.write_text(text)
    assert main(["histogram", str(source), str(tmp_path / "x.png")]) == 2
    said = capsys.readouterr().err
    assert wanted in said and "depth.json" in said and said.count("\n") == 1


def test_a_missing_file_is_named(tmp_path, capsys):
    assert main(["histogram", str(tmp_path / "no.json"), str(tmp_path / "x.png")]) == 2
    assert "no.json" in capsys.readouterr().err
