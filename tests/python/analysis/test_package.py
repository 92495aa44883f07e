"""The package keeps its layout: each folder uses those before it; a module's name is its alone."""

import ast
from collections import Counter

from program import ROOT

PACKAGE = ROOT / "analysis/oitlab_analysis"
ORDER = ("formats", "read", "compare", "draw", "write", "paper", "__main__")


def modules():
    return [path for path in PACKAGE.rglob("*.py") if path.name != "__init__.py"]


def test_no_two_modules_have_one_name():
    counts = Counter(path.name for path in modules())
    assert [name for name, count in counts.items() if count > 1] == []


def test_each_folder_uses_those_before_it():
    wrong = []
    for path in modules():
        own = path.relative_to(PACKAGE).with_suffix("").parts[0]
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.level:
                inside = node.level == 1 and path.parent != PACKAGE
                names = [node.module.split(".")[0]] if node.module else [a.name for a in node.names]
                wrong += [f"{path.name} imports {name}" for name in names
                          if not inside and ORDER.index(name) > ORDER.index(own)]
    assert wrong == []
