"""Names in charts: what tells variants apart, and what the caption says once."""

import pytest
from oitlab_analysis.compare.labels import short_labels
from sections import section_of
from synthetic import make_cell, write_cell


def names_of(folder, *variants, method="abuffer"):
    """The short names of variants of a method, and the sentence for the caption."""
    for parameters in variants:
        write_cell(folder, make_cell(method=method, parameters=parameters))
    table = section_of(folder).table
    names, said = short_labels(table)
    assert set(names) == set(table["label"])
    return set(names.values()), said


def test_what_most_variants_share_is_said_once(tmp_path):
    names, said = names_of(tmp_path, {"sort": "auto", "deep": "exact", "size": 512}, {"sort": "merge", "deep": "exact",
                           "size": 512}, {"sort": "shell", "deep": "exact", "size": 512},
                           {"sort": "auto", "deep": "truncate", "size": 512})
    assert names == {"abuffer (sort=auto)", "abuffer (sort=merge)", "abuffer (sort=shell)",
                     "abuffer (deep=truncate, sort=auto)"}
    assert said == "Where a name does not say otherwise, abuffer has deep=exact."


@pytest.mark.parametrize("values, names", [
    ([1, 2], {"abuffer (n=1)", "abuffer (n=2)"}),  # half is not most
    ([1, 2, 2], {"abuffer (m=0, n=1)", "abuffer (m=1)", "abuffer (m=2)"}),
    ([1, 1, 1, 2, 2], {f"abuffer (m={m}, n={n})" for m, n in enumerate([1, 1, 1, 2, 2])}),  # nor is three fifths
    ([7], {"abuffer"})])
def test_only_two_thirds_are_most(tmp_path, values, names):
    variants = [{"n": n, "m": m} for m, n in enumerate(values)] if len(values) > 2 else [{"n": n} for n in values]
    assert names_of(tmp_path, *variants)[0] == names


def test_what_all_rows_of_a_chart_share_is_not_named(tmp_path):
    for source in ("hardware", "compute"):
        for order in ("sorted", "submission"):
            write_cell(tmp_path, make_cell(method="blend", parameters={"source": source, "order": order}))
    table = section_of(tmp_path).table
    names, said = short_labels(table[table["param.source"] == "compute"])
    assert set(names.values()) == {"blend (order=sorted)", "blend (order=submission)"} and said == ""


def test_a_variant_without_a_parameter_keeps_its_name(tmp_path):
    names, _said = names_of(tmp_path, {"n": 1}, {}, {"n": 1, "m": 1})
    assert len(names) == 3, "no two variants have one name"


def test_cells_that_nothing_tells_apart_keep_their_numbers(tmp_path):
    for seed in (1, 2):
        write_cell(tmp_path, make_cell(seed=seed) | {"id": f"seed-{seed}"})
    names, _ = short_labels(section_of(tmp_path).table)
    assert list(names.values()) == ["blend", "blend #2"]
