"""The program under test, as a user runs it: OITLAB_PROGRAM names it (CTest sets it)."""

import json
import os
import subprocess

import pytest


@pytest.fixture(scope="session")
def oitlab(tmp_path_factory):
    """Runs the program in an empty folder; returns the completed process."""
    program = os.environ.get("OITLAB_PROGRAM")
    if not program:
        assert "CI" not in os.environ, "OITLAB_PROGRAM is not set"
        pytest.skip("OITLAB_PROGRAM is not set")
    folder = tmp_path_factory.mktemp("work")

    def run(*arguments, env=None, cwd=None):
        return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True,
                              cwd=cwd or folder, env={**os.environ, **(env or {})}, timeout=300)

    run.folder = folder
    run.program = program
    return run


@pytest.fixture(scope="session")
def render_json(oitlab):
    """`oitlab render ... --json` of a small image, parsed."""

    def render(*arguments):
        done = oitlab("render", "--size", "96x54", "--json", *arguments)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return render
