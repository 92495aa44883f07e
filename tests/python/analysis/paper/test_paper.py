"""`oitlab paper`: published beside measured, gaps with the command that fills them, words by rules."""

import csv
import itertools
import re
import shutil

import pytest
from oitlab_analysis.__main__ import main
from oitlab_analysis.paper import agreement
from oitlab_analysis.paper.make import make_paper
from oitlab_analysis.paper.paired_table import LATEX, Column, Number, Table, latex, latex_text, markdown, write_csv
from papers import SIZE, SMALL, table_of, write_performance
from synthetic import (
    DEVICE,
    PAPER_SCENES,
    lucid_cell,
    make_cell,
    write_cell,
)


def test_published_and_measured_stand_side_by_side(out):
    rows = table_of(out, "performance-2560x1330-example-gpu-4000")
    assert len(rows) == 12 + 1
    boxes = rows["Boxes"]
    assert boxes["SW/HW (GTX 3050 TI)"] == "4.26"
    assert float(boxes["SW/HW (Example GPU 4000 (measured))"]) == pytest.approx(3.0, rel=0.01)
    assert float(boxes["SW/HW, repaired (Example GPU 4000 (measured))"]) == pytest.approx(3.3, rel=0.01)
    assert float(boxes["HW, µs (Example GPU 4000 (measured))"]) == pytest.approx(400, rel=0.05)
    assert float(boxes["S/HB (Example GPU 4000 (measured))"]) == pytest.approx(9, rel=0.01)
    assert float(rows["mean"]["SW/HW (GTX 3050 TI)"]) == pytest.approx(3.32, abs=0.01), "as printed"
    text = (out / "performance-2560x1330-example-gpu-4000.md").read_text(encoding="utf-8")
    assert "GTX 3050 TI" in text and "Example GPU 4000" in text and "commit abc1234" in text
    assert "| 12.11 |" in text and "| 24 |" in text, "published figures stay as printed"


def test_every_table_exists_in_three_formats_and_main_tex_includes_it(out):
    tables = {p.stem for p in out.glob("*.csv")}
    wanted = {"methods", "scenes", "performance-2560x1330", "performance-1920x1031", "alpha-threshold",
              "depth-filter", "memory", "bma-table1", "bma-table2"}
    assert tables == {f"{name}-example-gpu-4000" for name in wanted}
    included = re.findall(r"\\input\{\\generated/([^}]*)\}", (out / "all.tex").read_text())
    assert set(included) == tables
    whole = (out / "paper.md").read_text(encoding="utf-8")
    for name in tables:
        tex = (out / f"{name}.tex").read_text(encoding="utf-8")
        assert tex.count("{") == tex.count("}") and r"\toprule" in tex and r"\bottomrule" in tex
        assert (out / f"{name}.md").read_text(encoding="utf-8") in whole


def test_every_markdown_table_is_regular(out):
    for path in out.glob("*-gpu-4000.md"):
        lines = [x for x in path.read_text(encoding="utf-8").splitlines() if x.startswith("|")]
        assert len({len(re.findall(r"(?<!\\)\|", line)) for line in lines}) == 1, path


def test_a_gap_is_shown_with_the_command_that_fills_it(tmp_path):
    write_performance(tmp_path / "results", [s for s in PAPER_SCENES if s != "teapot"])
    said = make_paper([tmp_path / "results"], tmp_path / "out")
    rows = table_of(tmp_path / "out", "performance-2560x1330-example-gpu-4000")
    assert rows["Teapot"]["SW, µs (GTX 3050 TI)"] == "373.0"
    assert rows["Teapot"]["SW, µs (Example GPU 4000 (measured))"] == ""
    text = (tmp_path / "out" / "performance-2560x1330-example-gpu-4000.md").read_text()
    assert "Not measured: Teapot. Run: oitlab run experiments/performance.toml\n" in text
    assert "not measured: Teapot; run: oitlab run experiments/performance.toml" in said
    assert "bma-table2-example-gpu-4000: not measured: any row; run: oitlab run experiments/bma.toml" in said


def test_the_depth_filter_table(tmp_path):
    group = [lucid_cell("hairball", 3.5, 3.3 * f, n, {"depth_filter": size, "repair": False}, size=SIZE,
                        experiment="depth_filter", **SMALL)
             for size, n, f in ((3, 34048, 1), (8, 3405, 1.03), (12, 0, 1.1))]
    for cell in group:
        write_cell(tmp_path, cell, image=False)
    make_paper([tmp_path], tmp_path / "out")
    row = table_of(tmp_path / "out", "depth-filter-example-gpu-4000")["Hairball"]
    measured = {k: v for k, v in row.items() if "measured" in k and v}
    assert float(measured["invalid, DF=3 (Example GPU 4000 (measured))"]) == 34048
    assert float(measured["%, DF=3 (Example GPU 4000 (measured))"]) == pytest.approx(1.0, rel=1e-3)
    assert float(measured["time, % of DF=3, DF=12 (Example GPU 4000 (measured))"]) == pytest.approx(110, rel=0.01)
    text = (tmp_path / "out/depth-filter-example-gpu-4000.md").read_text()
    assert "fall or stay as the filter grows in 1 of 1 scenes" in text
    assert (tmp_path / "out" / "depth-filter-curve-example-gpu-4000.pdf").is_file()


def test_the_alpha_threshold_table_takes_the_opacity(tmp_path):
    for opacity, gain in ((0.5, 1.25), (0.800000011920929, 2.0)):
        cells = [make_cell("boxes", "blend", {"order": "submission"}, 0.4, 0.1, SIZE, **SMALL),
                 lucid_cell("boxes", 0.4, 4, 0, {"repair": False}, size=SIZE, **SMALL),
                 lucid_cell("boxes", 0.4, 4 / gain, 0, {"repair": False, "alpha_threshold": 0.9921875},
                            size=SIZE, **SMALL)]
        for cell in cells:
            cell["scene"]["opacity"] = opacity
            write_cell(tmp_path, cell | {"id": f"{cell['id']}-{opacity}", "group": str(opacity)}, image=False)
    make_paper([tmp_path], tmp_path / "out")
    rows = table_of(tmp_path / "out", "alpha-threshold-example-gpu-4000")
    key = "speed-up (Example GPU 4000 (measured))"
    assert [float(rows[f"Boxes {o}"][key]) for o in ("0.5", "0.8")] == pytest.approx([1.25, 2.0], rel=0.01)


def test_a_device_note_marks_the_ratios_to_blend(tmp_path):
    write_performance(tmp_path, ["boxes"], device=DEVICE | {"name": "NVIDIA H200"})
    make_paper([tmp_path], tmp_path / "out")
    text = (tmp_path / "out" / "performance-2560x1330-h200.md").read_text()
    assert "SW/HW ‡, H200 (measured)" in text and "2 of its 66 TPCs" in text
    assert "HW, µs, H200 (measured)" in text


def test_the_note_stands_beside_every_ratio_to_blend_in_every_format(tmp_path):
    h200 = DEVICE | {"name": "NVIDIA H200"}
    for scene in ("boxes", "teapot"):
        write_performance(tmp_path, [scene], device=h200)
        write_performance(tmp_path, [scene], device=h200, experiment="methods", format="rgba16f")
        for opacity in (0.5, 0.800000011920929):
            cells = [make_cell(scene, "blend", {"order": "submission"}, 2, 0.1, **SMALL)]
            cells += [lucid_cell(scene, 1, 3, 0, {"repair": False, "alpha_threshold": t}, **SMALL)
                      for t in (0, 1 - 1 / 128)]
            for cell in cells:
                cell |= {"size": list(SIZE), "experiment": "alpha_threshold", "device": h200,
                         "group": f"{scene}{opacity}", "id": f"alpha-{cell['id']}-{opacity}"}
                cell["scene"] = cell["scene"] | {"opacity": opacity}
                write_cell(tmp_path, cell, image=False)
    make_paper([tmp_path], tmp_path / "out")
    ratios = {"performance-2560x1330": ["SW/HW", "SW/HW, repaired"],
              "alpha-threshold": ["SW/HW off", "SW/HW on"], "methods": ["relative time"]}
    for table, names in ratios.items():
        path = tmp_path / "out" / f"{table}-h200"
        csv_head, text, tex = (path.with_suffix(s).read_text(encoding="utf-8") for s in (".csv", ".md", ".tex"))
        assert "2 of its 66 TPCs" in text and "2 of its 66 TPCs" in tex, table
        for name in names:
            assert f"{name} ‡ (H200 (measured))" in csv_head.splitlines()[0]
            assert f"| {name} ‡, H200 (measured) |" in text
            assert re.search(rf"[{{ ]{re.escape(name)} \\ddag{{}}", tex), (table, name)
    for unmarked in ("depth-filter", "scenes", "memory"):
        assert "‡" not in (tmp_path / "out" / f"{unmarked}-h200.md").read_text(encoding="utf-8"), "no ratio to blend"


def test_hardware_blending_relative_to_itself_agrees_with_nothing(tmp_path):
    write_performance(tmp_path, ["boxes"], experiment="methods")
    make_paper([tmp_path], tmp_path / "out")
    text = (tmp_path / "out/methods-example-gpu-4000.md").read_text(encoding="utf-8")
    assert "Relative time: within 1.25 times the published figure in 1 of 1 rows." in text


def test_the_depth_filter_table_names_rows_with_gaps(tmp_path):
    write_performance(tmp_path, ["boxes"])  # with a filter of 3 only
    make_paper([tmp_path], tmp_path / "out")
    text = (tmp_path / "out/depth-filter-example-gpu-4000.md").read_text(encoding="utf-8")
    assert "Not measured: Boxes; " in text and "Run: oitlab run experiments/depth\\_filter.toml" in text
    assert "| Boxes | 3 | 100 | 0 | – |" in text, "counts are whole numbers"


def pairs(published_values, measured_values):
    return dict(zip("abcdefghij", zip(published_values, measured_values)))


def test_order_counts_pairs():
    assert "the same order of rows (3 of 3 pairs agree, Kendall's τ = 1.00)" in agreement.order(
        "x", pairs((1, 2, 3), (10, 20, 30)))
    assert "the opposite order of rows (0 of 3" in agreement.order("x", pairs((1, 2, 3), (3, 2, 1)))
    # One swap of neighbours among five: 9 of 10 pairs.
    assert "the same order of rows (9 of 10 pairs agree, Kendall's τ = 0.80)" in agreement.order(
        "x", pairs((1, 2, 3, 4, 5), (1, 2, 3, 5, 4)))
    assert "mostly the same order" in agreement.order("x", pairs((1, 2, 3, 4, 5), (1, 2, 4, 5, 3)))
    assert agreement.order("x", pairs((1, 2, 3), (1, None, 3))) == "", "two rows have no order to speak of"


def test_factor_names_what_is_furthest_off():
    assert agreement.factor("x", pairs((100, 100), (125, 80))) == (
        "x: within 1.25 times the published figure in 2 of 2 rows.")
    text = agreement.factor("x", pairs((100, 100, 0, 0), (126, 300, 0, None)))
    assert "in 1 of 3 rows; furthest off: b, 300 measured, 100 published" in text
    assert "furthest off: b, 5.00 measured, 0 published" in agreement.factor("x", pairs((100, 0), (300, 5)))
    assert "in 1 of 2 rows; furthest off: b, 79.0 measured" in agreement.factor("x", pairs((100, 100), (80, 79)))
    assert agreement.factor("x", pairs((1,), (None,))) == ""


def test_texts_are_escaped_in_each_format(tmp_path):
    table = Table("t", "50% of a_b & $c", "x|y", [Column("n", "a|b"), Column("v", "µs", "GPU_1")],
                  [{"n": "a_b|c", "v": Number(1.5, 1.4, 1.6)}, {"n": "gap", "v": None}], "here <b>")
    text = markdown(table)
    assert "a\\_b\\|c" in text and "&lt;b>" in text and "| gap | – |" in text
    tex = latex(table)
    assert r"50\% of a\_b \& \$c" in tex and r"GPU\_1" in tex and "µ" not in tex
    write_csv(table, tmp_path / "t.csv")
    with open(tmp_path / "t.csv", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[1] == ["a_b|c", "1.5", "1.4", "1.6"] and rows[2] == ["gap", "", "", ""]
    assert latex_text("".join(LATEX)).isascii()


def test_all_texts_for_latex_are_ascii(out):
    for path in itertools.chain(out.glob("*.tex")):
        assert path.read_text(encoding="utf-8").isascii(), path


@pytest.mark.skipif(not shutil.which("latexmk") or not shutil.which("pdflatex"), reason="no LaTeX here")
def test_the_pdf_is_built(out):
    assert (out / "main.pdf").stat().st_size > 10_000


def test_wrong_input_is_one_line(tmp_path, capsys):
    (tmp_path / "empty").mkdir()
    (tmp_path / "bad" / "cells").mkdir(parents=True)
    (tmp_path / "bad" / "cells" / "x.json").write_text('{"schema": 1')
    for name in ("missing", "empty", "bad"):
        assert main(["paper", str(tmp_path / name), "--out", str(tmp_path / "out")]) == 2
        said = capsys.readouterr().err
        assert said.count("\n") == 1 and "Traceback" not in said
    assert not (tmp_path / "out").exists()


def test_what_cannot_be_read_is_named_and_the_rest_goes_on(tmp_path):
    write_performance(tmp_path / "good", ["boxes"])
    (tmp_path / "good" / "cells" / "half.json").write_text("{")
    (tmp_path / "gone" / "cells").mkdir(parents=True)
    said = " ".join(make_paper([tmp_path / "good", tmp_path / "gone", tmp_path / "good"], tmp_path / "out").split())
    assert "half.json: half-written" in said and "gone/cells is empty" in said
    assert "3 cells were given twice, and count once" in said
    assert "half.json" in (tmp_path / "out" / "paper.md").read_text()
