"""Lets the tests import the analysis package and the helpers in support/."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "analysis"), str(HERE / "support")]


def pytest_configure(config):
    """What pandas and matplotlib will stop to do is an error now: newer ones are already in use."""
    for kind in ("FutureWarning", "DeprecationWarning", "PendingDeprecationWarning"):
        config.addinivalue_line("filterwarnings", f"error::{kind}:oitlab_analysis.*")
