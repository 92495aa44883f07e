"""The direction of dependence that docs/design.md promises, checked over every #include.

A package is a folder of harness/; a method is a folder of methods/ and the folder of shaders/ with
the same name. A package includes only packages on lower lines of ORDER. A method includes the
packages below `methods` and itself, and never another method.
"""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]

# From the top down. Packages on one line do not include each other.
ORDER = [
    ["cli"],
    ["sweep"],
    ["results"],
    ["experiment"],
    ["methods", "measure", "quality"],
    ["render"],
    ["method"],
    ["source"],
    ["raster"],
    ["frame"],
    ["scene"],
    ["gpu"],
    ["image"],
    ["util"],
]
LEVEL = {package: -line for line, packages in enumerate(ORDER) for package in packages}
METHODS = {folder.name for folder in (ROOT / "methods").iterdir() if folder.is_dir()}
# Shaders that the package uses whose name stands beside them; `common` is for all.
SHADER_OWNER = {"depth": "render"}
GENERATED = {"commit.h"}
DEFINED = {"FRAGMENT_PROGRAM"}  # a definition that names the file (harness/gpu/shader.h)
INCLUDE = re.compile(r'^\s*#include "([^"]+)"', re.MULTILINE)


def sources():
    for top in ("harness", "methods", "shaders"):
        for path in sorted((ROOT / top).glob("*/**/*")):
            if path.is_file() and path.suffix in {".h", ".cpp", ".glsl", ".vert", ".frag", ".comp"}:
                yield path


def resolve(includer, name):
    """The file that an #include means: in the includer's folder, or below one of the three roots."""
    for folder in (includer.parent, ROOT / "harness", ROOT / "methods", ROOT / "shaders"):
        if (folder / name).is_file():
            return (folder / name).resolve()
    return None


def owner(path):
    """("package", name), ("method", name) or ("common", "") of a file."""
    top, name = path.relative_to(ROOT).parts[:2]
    if top == "methods" or (top == "shaders" and name in METHODS):
        return "method", name
    if top == "shaders" and name == "common":
        return "common", ""
    return "package", SHADER_OWNER.get(name, name) if top == "shaders" else name


def wrong(includer, included):
    """Why `includer` must not include `included`; None where it may."""
    (kind, name), (other_kind, other) = owner(includer), owner(included)
    if (kind, name) == (other_kind, other) or other_kind == "common":
        return None
    if kind == "common":
        return "shaders/common includes nothing but itself"
    if kind == "method" and other_kind == "method":
        return f"method {name} includes method {other}"
    if other_kind == "method":
        return f"{name} includes a method"
    level = LEVEL["methods"] if kind == "method" else LEVEL[name]
    return None if LEVEL[other] < level else f"{name} includes {other}, which is not below it"


def problems(paths):
    for path in paths:
        for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
            if name in GENERATED or name in DEFINED:
                continue
            included = resolve(path, name)
            reason = f"{name} is not there" if included is None else wrong(path, included)
            if reason:
                yield f"{path.relative_to(ROOT)}: {reason}"


def test_includes_point_one_way():
    checked = list(sources())
    assert len(checked) > 200, "the sources moved: this test has to follow"
    assert list(problems(checked)) == []


def test_every_package_is_in_the_order_and_in_the_documentation():
    packages = {folder.name for folder in (ROOT / "harness").iterdir() if folder.is_dir()}
    assert packages == set(LEVEL) - {"methods"}
    design = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
    rows = set(re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`.*?) \|", design, re.MULTILINE))))
    assert packages <= rows, f"docs/design.md has no row for {packages - rows}"


@pytest.mark.parametrize(
    ("includer", "included", "part"),
    [
        ("harness/frame/frame.h", "harness/render/renderer.h", "frame includes render"),
        ("harness/raster/front_end.h", "harness/method/method.h", "raster includes method"),
        ("harness/render/renderer.h", "methods/blend/blend.cpp", "render includes a method"),
        ("methods/wboit/wboit.cpp", "shaders/lucid/lucid_types.h", "wboit includes method lucid"),
        ("methods/wboit/wboit.cpp", "harness/measure/measure.h", "wboit includes measure"),
        ("shaders/common/shade.glsl", "shaders/raster/raster_types.h", "shaders/common"),
    ],
)
def test_the_check_finds(includer, included, part):
    reason = wrong(ROOT / includer, ROOT / included)
    assert reason and part in reason
