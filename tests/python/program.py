"""The oitlab program, for the tests that run it."""

import os
from pathlib import Path

import pytest
from conftest import ROOT

PROGRAM = Path(os.environ.get("OITLAB_PROGRAM")
               or ROOT / "build" / os.environ.get("OITLAB_PRESET", "release") / "oitlab")
needs_program = pytest.mark.skipif(not PROGRAM.is_file(), reason=f"{PROGRAM} is not built")
