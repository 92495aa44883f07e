"""Wrong input to `report`, `diff`, `paper` and `pack`: one clear line and exit code 2."""

import pytest
from oitlab_analysis.__main__ import main
from synthetic import LAVAPIPE, make_cell, make_results, without_measurement, write_cell


@pytest.fixture(scope="module")
def there(tmp_path_factory):
    """Folders that a user may name by mistake, and some that are right."""
    folder = tmp_path_factory.mktemp("there")
    write_cell(folder / "one", make_cell())
    write_cell(folder / "failed", without_measurement(make_cell(method="a"), "failed", "device lost"))
    make_results(folder / "cpu", 2, 1, device=LAVAPIPE)
    (folder / "nothing").mkdir()
    (folder / "empty" / "cells").mkdir(parents=True)
    (folder / "junk" / "cells").mkdir(parents=True)
    (folder / "junk" / "cells" / "a.json").write_text("{}")
    (folder / "file").write_text("x")
    (folder / "broken.json.gz").write_text("x")
    return folder


@pytest.fixture
def told(there, monkeypatch, capsys):
    """Runs a verb in the folder; returns its exit code and the lines of standard error."""
    monkeypatch.chdir(there)

    def run(words):
        try:
            code = main(words.split())
        except SystemExit as stop:
            code = stop.code
        output = capsys.readouterr()
        assert output.out == "", "nothing but the error"
        return code, output.err.splitlines()
    return run


NOT_RESULTS = {"nothing": "not a results folder", "none": "no such folder", "empty": "is empty",
               "file": "neither a results folder nor a pack", "broken.json.gz": "not compressed JSON",
               "junk": "no whole cell; a.json"}


@pytest.mark.parametrize("words", ["report {} --out out", "paper {} --out out", "diff {} one", "diff one {}"])
@pytest.mark.parametrize("given, said", NOT_RESULTS.items())
def test_what_holds_no_results_is_named_with_what_to_run(told, there, words, given, said):
    code, lines = told(words.format(given))
    assert code == 2 and len(lines) == 1
    assert lines[0].startswith(f"oitlab {words.split()[0]}: {given}") and said in lines[0]
    assert "oitlab run experiments/quickstart.toml" in lines[0]
    assert not (there / "out").exists(), "no empty folder is left behind"


@pytest.mark.parametrize("words, said", [
    ("pack none p.json.gz", "pack: none: no such folder"),
    ("pack nothing p.json.gz", "nothing: not a results folder"),
    ("pack empty p.json.gz", "no whole cell to pack"),
    ("pack one p.txt", "p.txt: wanted a name that ends with .json.gz"),
    ("pack one file/p.json.gz", "file: a file is there, where a folder is wanted"),
    ("paper one --out file", "file: a file is there, where a folder is wanted"),
    ("report one --out file", "file: a file is there, where a folder is wanted"),
    ("diff one cpu", "no cell in common (devices Example GPU 4000 and llvmpipe"),
    ("diff failed failed", "no measured cell in common: boxes 64×36 a: failed in A, failed in B (device lost)"),
    ("report one --x nothing_like_it", "no cell has a quantity 'nothing_like_it'; there are time, ratio"),
    ("report one --x time", "no two cells differ in time alone"),
    ("report cpu --x order --only none", "no cell is of the method 'none'; there are: blend, reference"),
    ("report one --per scene", "--per, --base and --only are of a chart that --x asks for"),
    ("report one --metric none", "invalid choice: 'none'"),
    ("report one --none", "oitlab report: '--none' is not known here; see `oitlab report --help`"),
    ("report", "required: RESULTS; see `oitlab report --help`"),
    ("diff one", "required: RESULTS_B; see `oitlab diff --help`"),
    ("pack one", "required: FILE.json.gz; see `oitlab pack --help`"),
    ("none", "invalid choice: 'none'"),
])
def test_a_wrong_word_is_told_in_one_line(told, words, said):
    code, lines = told(words)
    assert code == 2 and len(lines) == 1 and said in lines[0]


def test_results_that_say_little_are_reported_all_the_same(there, tmp_path, capsys):
    """One cell; only failed cells; two devices; a diff of a cell with itself."""
    assert main(["report", str(there / "one"), "--out", str(tmp_path / "one")]) == 0
    assert "1 cell: 1 measured" in capsys.readouterr().out
    assert main(["report", str(there / "failed"), "--out", str(tmp_path / "failed")]) == 1
    assert "failed: device lost" in capsys.readouterr().out
    assert main(["report", str(there / "one"), str(there / "cpu"), "--out", str(tmp_path / "both")]) == 0
    assert "2 devices, 2 drivers: kept apart" in capsys.readouterr().out
    assert main(["diff", str(there / "one"), str(there / "one"), "--out", str(tmp_path / "new" / "diff.md")]) == 0
    assert "1 cell in both" in capsys.readouterr().out and (tmp_path / "new" / "diff.md").is_file()
