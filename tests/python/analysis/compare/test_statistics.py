"""The comparison of frame times, on data whose answers are known."""

import numpy
import pytest
from oitlab_analysis.compare import statistics
from synthetic import make_cell


def blocks(values):
    return dict(enumerate(values))


def test_percentile_is_the_95th_and_not_the_median():
    values = list(range(1, 102))  # 1..101: the 95th percentile is exactly 96, the median 51
    assert statistics.percentile(values, 95) == 96
    assert statistics.percentile(values, 50) == 51
    assert statistics.percentile(values[::-1], 95) == 96  # order of samples does not matter


def test_block_medians_are_taken_within_blocks():
    medians = statistics.block_medians([1, 2, 9, 5, 4, 100], [0, 0, 0, 7, 7, 7])
    assert medians == {0: 2, 7: 5}


def test_median_of_an_even_count_is_between_the_middle_two():
    assert statistics.block_medians([4, 1, 3, 2], [0, 0, 0, 0]) == {0: 2.5}


def test_ratio_pairs_blocks_and_cancels_a_common_drift():
    drift = numpy.linspace(1, 2, 12)  # the clock falls to half over the run
    result = statistics.compare(blocks(drift * 3), blocks(drift * 2))
    assert result.ratio == pytest.approx(1.5)
    assert (result.low, result.high) == (pytest.approx(1.5), pytest.approx(1.5))
    assert result.verdict == "slower" and result.blocks == 12


def test_ratio_uses_common_blocks_only():
    cell = {0: 2.0, 1: 2.0, 2: 2.0, 9: 50.0}
    baseline = {0: 1.0, 1: 1.0, 2: 1.0, 3: 0.01}
    result = statistics.compare(cell, baseline)
    assert (result.ratio, result.blocks) == (2.0, 3)


def test_without_common_blocks_there_is_no_ratio():
    result = statistics.compare({0: 1.0}, {1: 1.0})
    assert (result.ratio, result.low, result.verdict) == (None, None, "unpaired")


@pytest.mark.parametrize(
    "interval, wanted",
    [
        ((0.995, 1.005), "same"),
        ((1.001, 1.009), "same"),  # surely slower, but by less than matters
        ((0.992, 0.999), "same"),
        ((1 / 1.01, 1.01), "same"),  # the ends belong to it
        ((0.98, 0.999), "faster"),
        ((0.5, 0.6), "faster"),
        ((1.001, 1.02), "slower"),
        ((0.98, 1.005), "ambiguous"),
        ((0.995, 1.02), "ambiguous"),
        ((0.98, 1.0), "ambiguous"),
        (None, "ambiguous"),
    ],
)
def test_verdict(interval, wanted):
    assert statistics.verdict(interval) == wanted


@pytest.mark.parametrize("count, has_interval", [(5, False), (6, True)])
def test_an_interval_needs_six_blocks(count, has_interval):
    assert (statistics.bootstrap_interval([1.0] * count) is not None) == has_interval


def test_interval_is_reproducible_and_holds_the_median():
    values = numpy.random.default_rng(5).normal(1.2, 0.1, 15)
    low, high = statistics.bootstrap_interval(values)
    assert (low, high) == statistics.bootstrap_interval(values)
    assert low < numpy.median(values) < high


@pytest.mark.parametrize("draw", ["normal", "lognormal"])
def test_interval_covers_the_true_median_as_often_as_it_claims(draw):
    """500 runs of 15 blocks: a true coverage of 95% gives 92% to 98% with more than 99% odds.

    The percentile bootstrap of a median of few values is a little off 95%; 91% is let pass.
    """
    random = numpy.random.default_rng(11)
    truth = {"normal": 1.0, "lognormal": numpy.exp(0.2)}[draw]
    sample = {"normal": lambda: random.normal(1.0, 0.05, 15),
              "lognormal": lambda: random.lognormal(0.2, 0.3, 15)}[draw]
    covered = 0
    for trial in range(500):
        low, high = statistics.bootstrap_interval(sample(), seed=trial)
        covered += low <= truth <= high
    assert 0.91 <= covered / 500 <= 0.98


def runs(*cells):
    """Cells of (method, frame ms, run, parameters, date), by the names a, b, c ..."""
    made = {}
    for name, (method, time, run, parameters, date) in zip("abcdefgh", cells):
        cell = make_cell(method=method, frame_ms=time, parameters=parameters, group=run)
        cell["provenance"] = cell["provenance"] | {"date": date}
        made[name] = cell
    return made


SUBMISSION, SORTED = {"order": "submission"}, {"order": "sorted"}


@pytest.mark.parametrize("cells, wanted", [
    # blend although others are faster, submission order although sorted is
    ([("lucid", 1, "1", {}, ""), ("blend", 3, "1", SUBMISSION, ""), ("blend", 2, "1", SORTED, "")], "b"),
    ([("lucid", 1, "1", {}, ""), ("lucid", 3, "1", {"n": 2}, "")], "a"),
    # blend of a small run rather than the fastest of a large one
    ([("lucid", 1, "1", {}, ""), ("wboit", 2, "1", {}, ""), ("blend", 9, "2", SUBMISSION, "")], "c"),
    # of the run with most cells
    ([("blend", 1, "1", SORTED, "2"), ("blend", 2, "2", SUBMISSION, "1"), ("lucid", 9, "2", {}, "1")], "b"),
    # of the newest of two equally large runs
    ([("blend", 1, "2", SORTED, "2026-01"), ("blend", 2, "1", SUBMISSION, "2026-02")], "b"),
])
def test_the_baseline_of_a_setting(cells, wanted):
    assert statistics.choose_baseline(runs(*cells)) == wanted


def test_a_setting_is_compared_with_its_baseline():
    cells = {cell["method"]: cell for cell in (
        make_cell(method="blend", frame_ms=2.0), make_cell(method="lucid", frame_ms=1.0),
        make_cell(method="moment", frame_ms=2.002), make_cell(method="wboit", frame_ms=2.5))}
    found = statistics.compare_setting(cells)
    assert {base for base, _ in found.values()} == {"blend"}
    assert [found[method][1].verdict for method in cells] == ["baseline", "faster", "same", "slower"]
    assert found["wboit"][1].ratio == pytest.approx(1.25, rel=0.01)


def test_cells_of_two_runs_have_one_baseline_and_no_ratio_across():
    found = statistics.compare_setting(runs(
        ("blend", 2, "first", SUBMISSION, ""), ("wboit", 3, "first", {}, ""), ("reference", 6, "first", {}, ""),
        ("blend", 4, "second", SORTED, ""), ("lucid", 8, "second", {}, "")))
    assert [comparison.verdict for _, comparison in found.values()] == [
        "baseline", "slower", "slower", "other run", "other run"]
    assert [comparison.ratio for _, comparison in found.values()][3:] == [None, None]


def test_honest_statistics_do_not_contradict_their_samples():
    assert statistics.disagreements(make_cell()) == []


@pytest.mark.parametrize("method", ["inverted_cdf", "weibull", "hazen", "nearest", "linear",
                                    "median_unbiased", "closest_observation", "lower", "higher"])
def test_every_usual_definition_of_a_quantile_is_accepted(method):
    for count in (1, 2, 7, 20, 60):
        samples = numpy.random.default_rng(count).normal(10, 1, count).tolist()
        for percent in (25, 50, 75, 95):
            value = numpy.percentile(samples, percent, method=method)
            assert statistics.is_quantile(value, samples, percent), (count, percent)


def test_a_p95_that_is_the_median_is_found():
    cell = make_cell()
    cell["statistics"]["frame"]["p95"] = cell["statistics"]["frame"]["median"]
    assert len(statistics.disagreements(cell)) == 1
    assert statistics.disagreements(cell)[0].startswith("p95")


def test_a_wrong_median_and_count_are_found():
    cell = make_cell()
    cell["statistics"]["frame"] |= {"median": 0.1, "count": 3}
    assert [text.split()[0] for text in statistics.disagreements(cell)] == ["median", "count"]
