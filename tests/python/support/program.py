"""The tree under test, and the program built from it: OITLAB_PROGRAM names it (CTest sets it)."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
PROGRAM = Path(os.environ.get("OITLAB_PROGRAM")
               or ROOT / "build" / os.environ.get("OITLAB_PRESET", "release") / "oitlab")
needs_program = pytest.mark.skipif(not PROGRAM.is_file(), reason=f"{PROGRAM} is not built")
