"""What the papers print: every row names its source, and the figures agree with each other."""


import pytest
from oitlab_analysis.paper import published


@pytest.mark.parametrize("path", sorted(published.PUBLISHED.glob("*.csv")), ids=lambda p: p.stem)
def test_every_published_row_names_its_source(path):
    rows = published.read(path.stem)
    assert rows
    for row in rows:
        assert row["source"] and (row.get("table") or row.get("figure"))
        assert None not in row.values(), "as many fields as the head"


def test_published_performance_is_consistent_with_itself():
    rows = published.read("lucidraster_performance")
    assert len(rows) == 24
    for row in rows:
        sw, hw = float(row["sw_us"]), float(row["hw_us"])
        assert sw / hw == pytest.approx(float(row["sw_hw"]), abs=0.006)
        stages = [row[f"{stage}_us"] for stage in ("setup", "binning", "low_raster", "high_raster")]
        if all(stages):  # the rest is between the stages: about 20 us in one table, 6 in the other
            assert 4 < sw - sum(map(float, stages)) < 22
    # "The score for LucidRaster is an average ... for all scenes and all tested GPUs": 3.30.
    assert sum(float(row["sw_hw"]) for row in rows) / 24 == pytest.approx(3.30, abs=0.01)


def test_published_error_rates_are_consistent_with_themselves():
    shares = {3: [], 8: [], 12: []}
    for row in published.read("lucidraster_depth_filter"):
        for n in shares:
            share = 100 * float(row[f"invalid_df{n}"]) / (2560 * 1330)
            shares[n].append(share)
            printed = row[f"percent_df{n}"]
            assert share < 0.01 if printed in ("", "<0.01") else share == pytest.approx(float(printed), abs=0.0051)
    averages = [round(sum(values) / 12, 2) for values in shares.values()]
    assert averages == [0.17, 0.02, 0.01], "as printed under the table"


def test_published_tables_of_bma_are_consistent_with_themselves():
    for row in published.read("bma_table2"):
        assert float(row["oit_ms"]) / float(row["bma_oit_ms"]) == pytest.approx(float(row["speedup"]), abs=0.01)


def test_every_published_scene_has_a_stand_in():
    for name in ("lucidraster_performance", "lucidraster_scenes", "lucidraster_depth_filter",
                 "lucidraster_alpha_threshold", "bma_table1", "bma_table2"):
        assert {row["scene"] for row in published.read(name)} <= published.STAND_INS.keys()
