"""A report of four methods on two scenes, for the tests of all that is written of it."""

import pytest
from oitlab_analysis.write.report import make_report
from reports import Page
from synthetic import make_cell, make_results, without_measurement, write_cell


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    """Four methods on two scenes; one cell failed, one was skipped."""
    folder = make_results(tmp_path_factory.mktemp("results"), methods=4, scenes=2)
    for method, status, reason in (("adaptive|2", "failed", "device lost after 3 | frames <b>"),
                                   ("interlock", "skipped", "needs fragment interlock")):
        write_cell(folder, without_measurement(make_cell("boxes", method), status, reason))
    make_report([folder])
    return folder


@pytest.fixture
def without_charts(monkeypatch):
    """Charts take most of the time of a report; `results` and `run` make them all the same."""
    monkeypatch.setattr("oitlab_analysis.write.report.save_charts", lambda sections, *_: ([[]] * len(sections), 0))


@pytest.fixture
def page(results):
    return Page((results / "report.html").read_text(encoding="utf-8"))
