"""`--long` runs each test in full; without it, a part of some seconds (docs/robustness.md)."""

import os

import pytest
from small_sweep import PROGRAM, Sweep


def pytest_addoption(parser):
    parser.addoption("--long", action="store_true", help="every case, not a part of some seconds")


@pytest.fixture(scope="session")
def long(request):
    return request.config.getoption("--long")


@pytest.fixture(scope="session")
def program():
    if not PROGRAM.is_file():
        assert "CI" not in os.environ, f"{PROGRAM} is not built"
        pytest.skip(f"{PROGRAM} is not built")
    return PROGRAM


@pytest.fixture
def sweep(program, tmp_path):
    return Sweep(program, tmp_path)


@pytest.fixture(scope="session")
def undisturbed(program, tmp_path_factory):
    """The cells of a run in which nothing fails, by id."""
    whole = Sweep(program, tmp_path_factory.mktemp("undisturbed"))
    done = whole.run()
    assert done.returncode == 0, done.stderr
    cells = whole.cells()
    assert len(cells) == 20 and all(cell["status"] == "ok" for cell in cells.values())
    return cells
