"""What the launcher promises by itself, before anything is built: in copies of the source tree without a
build folder, and with a PATH that has no compiler."""

import os
import re
import shutil
import subprocess

import pytest
from program import ROOT

PACKAGE_TOOLS = ("apt-get", "dpkg-query", "sudo")
PYTHON = os.environ.get("OITLAB_PYTHON", "/usr/bin/python3")


@pytest.fixture(scope="module")
def tree(tmp_path_factory):
    """A copy of the tracked files, in a folder whose path has a space."""
    copy = tmp_path_factory.mktemp("a tree") / "my projects" / "oitlab"
    for name in ("oitlab", "CMakeLists.txt", "CMakePresets.json"):
        copy.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, copy / name)
    for folder in ("analysis", "cmake", "experiments"):
        shutil.copytree(ROOT / folder, copy / folder, ignore=shutil.ignore_patterns("__pycache__"))
    return copy


@pytest.fixture
def tools(tmp_path):
    """A folder of stand-ins for programs: `tools(name, script)` adds one."""
    folder = tmp_path / "tools"
    folder.mkdir()

    def add(name, script):
        (folder / name).write_text(f"#!/bin/sh\n{script}\n")
        (folder / name).chmod(0o755)

    add.folder = folder
    return add


def launch(tree, *arguments, path="/usr/bin:/bin", **environment):
    kept = {"PATH": path, "HOME": str(tree.parent), "OITLAB_PYTHON": PYTHON}
    given = {name: value for name, value in (kept | environment).items() if value is not None}
    return subprocess.run([tree / "oitlab", *map(str, arguments)], capture_output=True, text=True,
                          env=given, cwd=tree.parent, timeout=120)


def no_compiler(tools):
    for name in ("cmake", "ninja", *PACKAGE_TOOLS):
        tools(name, f"echo {name} was called >&2; exit 9")
    return f"{tools.folder}:/usr/bin:/bin"


@pytest.mark.parametrize("arguments", [[], ["help"], ["--help"], ["-h"]])
def test_help_needs_no_build(tree, tools, arguments):
    done = launch(tree, *arguments, path=no_compiler(tools))
    assert done.returncode == 0 and done.stderr == ""
    assert "quickstart" in done.stdout and "report" in done.stdout
    assert not (tree / "build").exists()


def test_help_has_the_verbs_of_the_program_and_their_summaries(tree, oitlab):
    def verbs(text):
        return dict(re.findall(r"^  ([a-z]+) {2,}(\S.*)$", text, re.MULTILINE))

    program = verbs(oitlab("--help").stdout.split("Subcommands:")[1])
    assert len(program) > 8
    launcher = verbs(launch(tree, "--help").stdout)
    assert {name: launcher.get(name) for name in program} == program


def test_version_needs_no_build_and_is_that_of_the_program(tree, tools, oitlab):
    done = launch(tree, "--version", path=no_compiler(tools))
    assert re.fullmatch(r"oitlab \d+\.\d+\.\d+, commit \S+, release \(not built\)\n", done.stdout)
    own = oitlab("--version")
    assert own.returncode == 0
    pattern = r"oitlab (\d+\.\d+\.\d+), commit (unknown|[0-9a-f]{12})(-dirty)?, \w+\n"
    assert re.fullmatch(pattern, own.stdout), own.stdout
    assert own.stdout.split(",")[0] == done.stdout.split(",")[0]


@pytest.mark.parametrize("verb", ["report", "diff", "paper", "pack"])
def test_python_verbs_need_no_build(tree, tools, verb):
    done = launch(tree, verb, "--help", path=no_compiler(tools))
    assert done.returncode == 0 and f"usage: oitlab {verb}" in done.stdout, done.stderr
    done = launch(tree, verb, "nowhere", "nothing", path=no_compiler(tools))
    assert done.returncode == 2 and "nowhere" in done.stderr
    assert "was called" not in done.stderr
    assert not (tree / "build").exists()


def test_an_unknown_verb_is_told_before_anything_is_installed(tree, tools):
    done = launch(tree, "rendre", path=no_compiler(tools))
    assert done.returncode == 2 and "'rendre' is not a verb" in done.stderr
    assert "was called" not in done.stderr


def test_packages_are_listed_by_purpose(tree):
    def packages(*purposes):
        done = launch(tree, "packages", *purposes)
        assert done.returncode == 0, done.stderr
        return set(done.stdout.split())

    use, build, test, benchmark = map(packages, ("use", "build", "test", "benchmark"))
    assert packages() == use | build
    assert {"libgtest-dev", "libgmock-dev", "python3-pytest"} <= test
    assert "libbenchmark-dev" in benchmark
    assert not (use | build) & (test | benchmark), "what is needed to test is not needed to measure"
    assert not any("-dev" in name for name in use)
    done = launch(tree, "packages", "play")
    assert done.returncode == 2 and "use build test benchmark fuzz develop" in done.stderr


def test_setup_installs_what_is_missing_and_nothing_else(tree, tools):
    tools("dpkg-query", 'for name; do case $name in lib*) echo "installed $name";; esac; done; exit 1')
    tools("sudo", 'exec "$@"')
    tools("apt-get", 'echo "apt-get $*" >&2')
    done = launch(tree, "setup", "test", path=f"{tools.folder}:/usr/bin:/bin")
    assert done.returncode == 0, done.stderr
    install = re.search(r"apt-get install .*--no-install-recommends (.*)", done.stderr)
    assert install and install[1].split() == ["python3-pytest", "python3-scipy", "vulkan-validationlayers"]

    tools("dpkg-query", 'for name; do echo "installed $name"; done')
    done = launch(tree, "setup", "test", path=f"{tools.folder}:/usr/bin:/bin")
    assert done.returncode == 0 and "apt-get" not in done.stderr and "are installed" in done.stderr


def fake_build(tools):
    """A CMake that records its options and leaves the files that the launcher looks at; a Python that
    has every module."""
    tools("python", "exit 0")
    tools("dpkg-query", 'for name; do echo "installed $name"; done')
    tools("cmake", """
case $1 in
  --preset)
    echo "configure $*" >>"$RECORD"
    folder=$4
    shift 4
    touch "$folder/build.ninja" "$folder/CMakeCache.txt"
    for option; do
      name=${option#-D}; name=${name%%=*}
      sed -i "/^$name:/d" "$folder/CMakeCache.txt"
      echo "$name:BOOL=${option##*=}" >>"$folder/CMakeCache.txt"
    done ;;
  --build)
    echo "build $4 $5" >>"$RECORD"
    printf '[1/2] Building CXX object a.o\\n[2/2] Linking CXX executable oitlab\\n'
    printf '#!/bin/sh\\nexit 0\\n' >"$2/oitlab"
    chmod +x "$2/oitlab" ;;
esac""")
    tools("ctest", 'echo "100% tests passed"')
    return f"{tools.folder}:/usr/bin:/bin"


def test_quickstart_and_test_share_a_build_folder_in_both_orders(tree, tools, tmp_path):
    path = fake_build(tools)

    def run(verb, build):
        record = tmp_path / "record"
        record.write_text("")
        launch(tree, verb, path=path, RECORD=str(record), OITLAB_BUILD=str(build), CI=None,
               OITLAB_PYTHON=str(tools.folder / "python"))
        return record.read_text().splitlines()

    def configured(lines):
        return [line for line in lines if line.startswith("configure")]

    first = tmp_path / "first quickstart"
    lines = run("quickstart", first)
    assert len(configured(lines)) == 1 and "-DOITLAB_TESTS=OFF" in lines[0] and "build oitlab" in lines[1]
    lines = run("test", first)
    assert len(configured(lines)) == 1 and lines[0].endswith("-DOITLAB_TESTS=ON") and "build all" in lines[1]
    assert configured(run("quickstart", first)) == configured(run("test", first)) == []

    second = tmp_path / "first test"
    assert len(configured(run("test", second))) == 1
    assert configured(run("quickstart", second)) == configured(run("test", second)) == []


def test_progress_is_sparse_where_there_is_no_terminal(tree, tools, tmp_path):
    path = fake_build(tools)
    edges = "".join(f"[{n}/200] Building CXX object {n}.o\\n" for n in range(1, 201))
    text = (tools.folder / "cmake").read_text()
    (tools.folder / "cmake").write_text(text.replace("[1/2] Building CXX object a.o\\n", edges))
    done = launch(tree, "info", path=path, RECORD=str(tmp_path / "record"), OITLAB_BUILD=str(tmp_path / "b"))
    assert done.returncode == 0, done.stderr
    told = re.findall(r"^\[\d+/\d+\]$", done.stderr, re.MULTILINE)
    assert 5 <= len(told) <= 12 and told[-1] != told[0]
    assert "[199/200] Building" in (tmp_path / "b" / "build.log").read_text(), "the log has every line"


def test_a_read_only_tree(tree, tools, tmp_path):
    """Reading verbs work there, and building says where else to build. (Root may write anywhere, so a
    file stands where the folder would be made.)"""
    path = fake_build(tools)
    (tmp_path / "file").write_text("")
    done = launch(tree, "info", path=path, RECORD="/dev/null", OITLAB_BUILD=str(tmp_path / "file" / "b"))
    assert done.returncode == 2 and "OITLAB_BUILD" in done.stderr
    before = {item: item.stat().st_mtime_ns for item in tree.iterdir()}
    for arguments in (["--help"], ["--version"], ["report", "--help"]):
        assert launch(tree, *arguments).returncode == 0
    assert {item: item.stat().st_mtime_ns for item in tree.iterdir()} == before


def test_without_home(tree, tools, tmp_path):
    path = fake_build(tools)
    for arguments in (["--help"], ["report", "--help"], ["info"]):
        done = launch(tree, *arguments, path=path, HOME=None, RECORD=str(tmp_path / "record"),
                      OITLAB_BUILD=str(tmp_path / "b"))
        assert done.returncode == 0, done.stderr
