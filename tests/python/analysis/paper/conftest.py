"""The papers' tables of one experiment, for the tests of all that is written of them."""


import pytest
from oitlab_analysis.paper.make import make_paper
from papers import write_performance


@pytest.fixture(scope="session")
def out(tmp_path_factory):
    folder = tmp_path_factory.mktemp("paper")
    write_performance(folder / "results")
    make_paper([folder / "results"], folder / "out")
    return folder / "out"
