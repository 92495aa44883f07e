"""Where the program runs must not matter: locale, home folder, folder names, rights, a full /tmp."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest
from program import ROOT
from small_sweep import LAYERS, Sweep, assert_right

# One small group, and what else reads and writes numbers.
ONE_GROUP = """
name = "faults"
sizes = ["24x16"]
scenes = ["planes"]
methods = ["blend", "reference"]
[measure]
time_limit = 0.1
"""


@pytest.fixture
def one_group(program, tmp_path):
    return Sweep(program, tmp_path, ONE_GROUP)


def environment(**changes):
    """This process's, with the changes; None removes a variable."""
    changed = {**os.environ, **changes}
    return {name: value for name, value in changed.items() if value is not None}


def run(command, **more):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True,
                          timeout=300, check=False, **more)


def assert_whole(sweep, undisturbed):
    """All cells are there, as in every other environment."""
    cells = sweep.cells()
    assert len(cells) == 2
    for cell in cells.values():
        assert_right(cell, undisturbed[cell["id"]])


@pytest.fixture(scope="module")
def locales(tmp_path_factory):
    """A folder with locales whose decimal point is a comma, and whose i has no dot in capitals."""
    folder = tmp_path_factory.mktemp("locales")
    for name in ("de_DE", "tr_TR"):
        try:
            made = run(["localedef", "-i", name, "-f", "UTF-8", folder / f"{name}.UTF-8"])
        except FileNotFoundError:
            pytest.skip("no localedef here")
        if not (folder / f"{name}.UTF-8" / "LC_NUMERIC").is_file():
            pytest.skip(f"{name} cannot be made here (package locales): {made.stderr[-200:]}")
    return folder


@pytest.mark.parametrize("name", ["de_DE.UTF-8", "tr_TR.UTF-8"])
def test_a_locale_changes_nothing(one_group, undisturbed, locales, name):
    where = environment(LOCPATH=str(locales), LC_ALL=name, LANGUAGE=name)
    told = run(["locale", "decimal_point"], env=where)
    assert told.stdout == ",\n", "the locale is not in force: nothing would be tested"
    done = run(one_group.command, env=where, cwd=one_group.folder)
    assert done.returncode == 0, done.stderr
    assert_whole(one_group, undisturbed)
    done = run([one_group.program, "report", one_group.results], env=where)
    assert done.returncode == 0, done.stderr
    done = run([one_group.program, "render", "--scene", "planes", "--method", "BLEND"], env=where)
    assert done.returncode == 2 and "'blend'" in done.stderr, "the suggestion ignores capitals"


def test_no_home(one_group, undisturbed):
    where = environment(HOME=None, XDG_CACHE_HOME=None, OITLAB_CACHE=None,
                        TMPDIR=str(one_group.folder))
    for command in (one_group.command, [one_group.program, "report", one_group.results]):
        done = run(command, env=where, cwd=one_group.folder)
        assert done.returncode == 0, done.stderr
    assert_whole(one_group, undisturbed)


@pytest.fixture
def open_folder():
    """A folder that other users can reach; pytest's own is for its user alone."""
    with tempfile.TemporaryDirectory(prefix="oitlab-faults-") as name:
        folder = Path(name)
        folder.chmod(0o755)
        yield folder


def tree_copy(to):
    """What the program reads of the source tree, in another place."""
    for part in ("shaders", "experiments", "analysis"):
        shutil.copytree(ROOT / part, to / part, ignore=shutil.ignore_patterns("__pycache__"))
    return to


def test_a_read_only_tree_and_another_user(program, undisturbed, open_folder):
    if os.geteuid() != 0 or shutil.which("setpriv") is None:
        pytest.skip("another user's name takes root and setpriv (package util-linux)")
    tree = tree_copy(open_folder / "tree")
    for path in (tree, *tree.rglob("*")):
        path.chmod(0o555 if path.is_dir() else 0o444)
    shutil.copy2(program, open_folder / "oitlab")
    own = open_folder / "own"
    own.mkdir()
    sweep = Sweep(open_folder / "oitlab", own, ONE_GROUP)
    nobody = 65534
    os.chown(own, nobody, nobody)
    done = run(["setpriv", f"--reuid={nobody}", f"--regid={nobody}", "--clear-groups",
                *sweep.command], cwd=own,
               env=environment(OITLAB_ROOT=str(tree), HOME="/nonexistent", TMPDIR=str(own),
                               XDG_CACHE_HOME=None, OITLAB_CACHE=None))
    assert done.returncode == 0, done.stderr
    assert_whole(sweep, undisturbed)
    assert all(path.stat().st_uid == nobody for path in sweep.results.rglob("*"))


def test_a_tree_whose_name_has_spaces_and_umlauts(program, undisturbed, tmp_path):
    tree = tree_copy(tmp_path / "Äpfel und Öl" / "oit lab")
    shutil.copy2(program, tree / "oitlab")
    sweep = Sweep(tree / "oitlab", tree, ONE_GROUP)
    where = environment(OITLAB_ROOT=str(tree), OITLAB_CACHE=str(tree / "Zwischen lager"))
    for command in (sweep.command, [sweep.program, "report", sweep.results]):
        done = run(command, env=where, cwd=tree)
        assert done.returncode == 0, done.stderr
    assert_whole(sweep, undisturbed)
    assert (sweep.results / "report.html").is_file()


def test_a_clone_whose_name_has_spaces_and_umlauts_builds(tmp_path, long):
    """The build itself, of a part that takes no minutes."""
    if not long:
        pytest.skip("a build in another folder takes a minute: pytest --long")
    if not (ROOT / ".git").exists() or shutil.which("git") is None:
        pytest.skip("not a clone: there is nothing to clone")
    clone = tmp_path / "Äpfel und Öl" / "oit lab"
    done = run(["git", "clone", "-q", ROOT, clone])
    assert done.returncode == 0, done.stderr
    for command in (["cmake", "--preset", "release", "-DOITLAB_TESTS=ON"],
                    ["cmake", "--build", "build/release", "--target", "oitlab_layer_fail_calls",
                     "oitlab_commit"]):
        done = run(command, cwd=clone)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    assert (clone / "build" / "release" / "layers" / "fail_calls.json").is_file()


def test_a_full_folder_for_temporary_files(one_group, undisturbed):
    if os.geteuid() != 0:
        pytest.skip("a small file system takes root to mount")
    full = one_group.folder / "tmp"
    full.mkdir()
    done = run(["mount", "-t", "tmpfs", "-o", "size=4k", "tmpfs", full])
    if done.returncode != 0:
        pytest.skip(f"a small file system cannot be mounted here: {done.stderr.strip()}")
    try:
        (full / "rest").write_bytes(bytes(4096))
        # The shaders' cache is in the full folder too, where there is no home.
        where = environment(TMPDIR=str(full), HOME=None, XDG_CACHE_HOME=None, OITLAB_CACHE=None)
        for command in (one_group.command, [one_group.program, "report", one_group.results]):
            done = run(command, env=where, cwd=one_group.folder)
            assert done.returncode == 0, done.stderr
        assert_whole(one_group, undisturbed)
    finally:
        run(["umount", full])


def test_layers_lie_beside_the_program():
    """The tests of failing calls skip where there are none: that must not pass unseen."""
    if "CI" in os.environ:
        assert (LAYERS / "fail_calls.json").is_file() and (LAYERS / "reorder.json").is_file()
