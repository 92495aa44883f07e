"""The program under test, as a user runs it."""

import json
import os
import subprocess

import pytest
from program import PROGRAM
from runs import EXPERIMENT


@pytest.fixture(scope="session")
def oitlab(tmp_path_factory):
    """Runs the program in an empty folder; returns the completed process."""
    if not PROGRAM.is_file():
        assert "CI" not in os.environ, f"{PROGRAM} is not built"
        pytest.skip(f"{PROGRAM} is not built")
    folder = tmp_path_factory.mktemp("work")

    def run(*arguments, env=None, cwd=None):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                              cwd=cwd or folder, env={**os.environ, **(env or {})}, timeout=300)

    run.folder = folder
    run.program = PROGRAM
    return run


@pytest.fixture(scope="session")
def render_json(oitlab):
    """`oitlab render ... --json` of a small image, parsed."""

    def render(*arguments):
        done = oitlab("render", "--size", "96x54", "--json", *arguments)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return render


@pytest.fixture
def toml(tmp_path):
    path = tmp_path / "resumed.toml"
    path.write_text(EXPERIMENT)
    return path


@pytest.fixture
def results(tmp_path):
    return tmp_path / "results"
