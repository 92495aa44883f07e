"""The time that `run` and `--dry-run` say is left: right within a factor of 1.5."""

import os
import pty
import re
import subprocess
import time

import pytest

# Cells that end at their time limit, as those of a CPU device do.
EXPERIMENT = """
name = "timed"
sizes = ["48x27", "64x36", "32x18"]
scenes = ["planes"]
methods = ["blend", "reference"]
[measure]
time_limit = 1.5
min_blocks = 1000
max_blocks = 1000
stage_frames = 2
"""
FACTOR = 1.5
# Times are told in whole seconds, rounded up.
ROUNDING = 1.0


def seconds(text):
    total = 0
    for part in text.split(":"):
        total = 60 * total + int(part)
    return total


def run_on_a_terminal(program, arguments, env):
    """What it says on a terminal, as (seconds since the start, text); and how long it took."""
    try:
        terminal, side = pty.openpty()
    except OSError as error:
        # A chroot may be without /dev/pts. CI has it, so that this cannot look like a pass there.
        assert "CI" not in os.environ, error
        pytest.skip(f"no pseudo-terminal to be had (is /dev/pts mounted?): {error}")
    started = time.monotonic()
    run = subprocess.Popen([program, *map(str, arguments)], stderr=side, stdout=subprocess.DEVNULL,
                           env=env)
    os.close(side)
    said = []
    while True:
        try:
            text = os.read(terminal, 4096)
        except OSError:  # the other side is closed
            break
        if not text:
            break
        said.append((time.monotonic() - started, text.decode()))
    os.close(terminal)
    assert run.wait(60) == 0, said[-1]
    return said, time.monotonic() - started


@pytest.fixture
def env(tmp_path):
    """A cache of its own: what is learned of the machine is kept there."""
    return {**os.environ, "OITLAB_CACHE": str(tmp_path / "cache")}


def test_the_time_left_is_right_within_a_factor(oitlab, tmp_path, env):
    toml = tmp_path / "timed.toml"
    toml.write_text(EXPERIMENT)

    # The first run compiles shaders and learns what this machine takes around the blocks.
    first = ("run", toml, "--results", tmp_path / "first")
    assert oitlab(*first, env=env).returncode == 0

    again = ("run", toml, "--results", tmp_path / "again")
    told = oitlab(*again, "--dry-run", env=env).stderr
    forecast = seconds(re.search(r"6 to measure: about ([0-9:]+)", told)[1])
    said, duration = run_on_a_terminal(oitlab.program, again, env)
    assert duration / FACTOR <= forecast <= duration * FACTOR + ROUNDING

    readings = [(at, seconds(left)) for at, text in said
                for left in re.findall(r"block \d+ +([0-9:]+) left", text)]
    assert len(readings) > 30, "it is told after every block"
    judged = [(at, left) for at, left in readings if duration - at > 3]
    assert judged[0][0] < duration / 2 < judged[-1][0]
    wrong = [(at, left, duration - at) for at, left in judged
             if not (duration - at) / FACTOR <= left <= (duration - at) * FACTOR + ROUNDING]
    assert wrong == []
