"""The program with more methods than the tree has: toys of tests/data/toy, and skeletons that the build made
with `./oitlab new-method`. Shader folders are copied beside the others, as anybody would add them."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
from program import PROGRAM, ROOT

TOY = ROOT / "tests" / "data" / "toy"
WITH_TOY = PROGRAM.with_name("oitlab_with_toy")
SKELETONS = PROGRAM.parent / "tests" / "skeletons"


class Toys:
    """Runs the program with a copy of shaders/ below `root`, which a test may edit."""

    def __init__(self, root: Path):
        if not WITH_TOY.is_file():
            assert "CI" not in os.environ, f"{WITH_TOY} is not built"
            pytest.skip(f"{WITH_TOY} is not built")
        self.root = root
        for folder in (ROOT, TOY, SKELETONS):
            shutil.copytree(folder / "shaders", root / "shaders", dirs_exist_ok=True)
        shutil.copytree(ROOT / "experiments", root / "experiments")

    def try_run(self, *arguments):
        return subprocess.run([WITH_TOY, *map(str, arguments)], capture_output=True, text=True,
                              cwd=self.root, env={**os.environ, "OITLAB_ROOT": str(self.root)},
                              timeout=120)

    def run(self, *arguments):
        done = self.try_run(*arguments)
        assert done.returncode == 0, done.stderr
        return done

    def render(self, method, scene, *settings, out=None):
        """What `render --json` says of a small image of float32."""
        done = self.run("render", "--scene", scene, "--size", "96x54", "--format", "rgba32f",
                        "--validation", "--json", "--method", method,
                        *(word for setting in settings for word in ("--set", setting)),
                        *(("--out", out) if out else ()))
        assert "validation:" not in done.stderr
        return json.loads(done.stdout)
