"""The report as one HTML page that opens from the disk: table, charts, and pictures to compare."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
from pathlib import Path

import jinja2

from .. import formats
from ..compare.labels import parameter_text, parameters_of, records
from ..compare.sections import Section
from ..draw.style import Chart
from . import images
from .contents import Report, all_parameters, commands, summary, unmeasured
from .table import describe, error_caption, setting_heading

HERE = Path(__file__).parent
TEMPLATES, TABULATOR = HERE / "templates", HERE / "vendor" / "tabulator"

# Column head, name in describe(), column to sort by, what it means.
FIGURES = (
    ("Frame, ms", "frame", "frame_ms.median", "median time of a whole frame, with its 95% interval; (n = 2): of "
     "2 blocks, too few for an interval"),
    ("Ratio", "ratio", "ratio", "frame time over that of the baseline, with its 95% interval"),
    ("Baseline", "baseline", "baseline_name", "what the ratio is to, and where its fragments come from"),
    ("Ratio to blend source=hardware", "to_hardware", "ratio_hardware", "frame time over that of hardware blending, "
     "where the headline is the ratio to blending by compute shaders"),
    ("Verdict", "verdict", "verdict", "against the baseline"),
    ("RMSE", "rmse", "quality.rmse", "root mean square error against the reference image"),
    ("PSNR, dB", "psnr", "quality.psnr", "∞ means equal to the reference"),
    ("Pixels off", "pixels_off", "quality.pixels_off", "share of pixels off by more than 1/255"),
    ("SSIM", "ssim", "quality.ssim", "structural similarity of display values; 1 means equal"),
    ("FLIP", "flip", "quality.flip", "visible difference of display values, from 0 to 1"),
    ("Fragments", "fragments", "counter.fragments", "transparent fragments of a frame"),
    ("Memory, MiB", "memory", "memory_total_bytes", "all buffers and images of the method"),
)
TEXTS = ("verdict", "baseline")
# Nothing but what the page itself holds, and pictures beside it.
POLICY = ("default-src 'none'; img-src data: 'self' file:; style-src 'unsafe-inline'; script-src {scripts}; "
          "base-uri 'none'; form-action 'none'")


def html_page(report: Report) -> str:
    """The page. It loads nothing over a network, and a content security policy holds it to that."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=True, undefined=jinja2.StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )
    pictures = images.Pictures(report.folder, report.sources, report.sections)
    read = [path.read_text(encoding="utf-8") for path in
            (TABULATOR / "tabulator.js", TEMPLATES / "report.js", TEMPLATES / "viewer.js")]
    scripts = [read[0], read[1] + read[2]]
    alone = len(report.sections) == 1
    return environment.get_template("report.html.jinja").render(
        title=report.sections[0].title if alone else report.title,
        summary=summary(report.table),
        clock=report.clock,
        warnings=[] if alone else report.notes,
        more=report.more,
        figures=FIGURES,
        policy=POLICY.format(scripts=" ".join(map(_hash, scripts))),
        scripts=scripts,
        style="".join((folder / name).read_text(encoding="utf-8") for folder, name in
                      ((TABULATOR, "tabulator.css"), (TEMPLATES, "report.css"))),
        pictures=_json(pictures.embedded),
        pictures_note=pictures.note(),
        sections=[_section(report, index, pictures) for index in range(len(report.sections))],
    )


def _section(report: Report, index: int, pictures: images.Pictures) -> dict[str, object]:
    section, charts = report.sections[index], report.charts[index]
    settings = _settings(section, pictures)
    return {
        "title": section.title,
        "context": section.context,
        "warnings": section.warnings if len(report.sections) > 1 else report.notes + section.warnings,
        "table": _json(_table(section, settings)),
        "lead": _lead(report.folder, charts[0], index + 1) if charts else None,
        "charts": [_chart(report.folder, chart) for chart in charts[1:]],
        "settings": _json(settings),
        "pictured": bool(settings),
        "parameters": all_parameters(section),
        "unmeasured": unmeasured(section),
        "commands": commands(report, section),
    }


def _hash(script: str) -> str:
    digest = hashlib.sha256(script.encode("utf-8")).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"


def _json(value: object) -> str:
    """JSON that is safe inside a script element."""
    return json.dumps(value, separators=(",", ":"), ensure_ascii=False).replace("<", "\\u003c")


def _table(section: Section, settings: list[dict]) -> dict[str, object]:
    """The columns, and the rows with their texts and, by `sort`, what each figure sorts by."""
    rows = records(section.table)
    places = {(setting["name"], picture["key"]): (i, j) for i, setting in enumerate(settings)
              for j, picture in enumerate(setting["pictures"])}
    columns = [{"field": "scene", "title": "Scene", "hint": ""}, {"field": "label", "title": "Method", "hint": ""}]
    for field, title in (("view", "View"), ("size", "Size")):
        columns.append({"field": field, "title": title, "hint": "",
                        "hidden": len({row["view" if field == "view" else "size_label"] for row in rows}) == 1})
    described = [describe(row) for row in rows]
    baselines = section.table["baseline_name"].dropna().unique()
    alone = baselines[0] if len(baselines) == 1 else ""  # then the head of the ratios names it
    for title, name, _, meaning in FIGURES:
        empty = all(texts.get(name, formats.NOTHING) in (formats.NOTHING, "") for texts in described)
        if name == "ratio" and alone:
            title = f"Ratio to {alone}"
        columns.append({"field": name, "title": title, "hint": meaning, "hidden": empty or (name == "baseline" and
                        bool(alone)), "number": name not in TEXTS})
    return {"columns": columns,
            "rows": [_row(row, texts, places.get((row["setting"], row["key"])))
                     for row, texts in zip(rows, described)]}


def _row(row: dict, texts: dict[str, str], place: tuple[int, int] | None) -> dict[str, object]:
    """One cell; `place` says which picture of which setting is its."""
    found = {"scene": row["scene_label"], "label": row["label"], "view": row["view"], "size": row["size_label"],
             "hints": {"scene": parameter_text(scene_facts(row)), "label": parameter_text(parameters_of(row))},
             "sort": {"size": row["width"] * row["height"]}}
    if place:
        found["place"] = place
    if row["status"] != "ok":
        text = f"{row['status']}: {texts['reason']}"
        return found | {"status": row["status"], "frame": text, "hints": found["hints"] | {"frame": text}}
    found |= {name: texts[name] for _, name, _, _ in FIGURES if texts.get(name, formats.NOTHING) != formats.NOTHING}
    found["sort"] |= {name: key for _, name, column, _ in FIGURES
                      if name not in TEXTS and (key := _sort_value(row, column)) is not None}
    if row["baseline"]:
        found["hints"]["ratio"] = " · ".join(filter(None, [f"baseline: {row['baseline']}", row["device_note"]]))
    if row["clock_note"]:
        found["frame"] += " §"
        found["hints"]["frame"] = row["clock_note"]
    return found


def scene_facts(row: dict) -> dict[str, object]:
    facts = {key: row[key] for key in ("source", "triangles", "opacity", "detail")}
    return {key: value for key, value in facts.items() if formats.is_number(value) or
            (isinstance(value, str) and value)}


def _sort_value(row: dict, column: str) -> float | None:
    """What the column sorts by; None goes last. An infinite PSNR is the greatest."""
    value = row.get(column)
    if column == "quality.psnr" and not formats.is_number(value) and row.get("quality.rmse") == 0:
        return 1e9
    return float(value) if formats.is_number(value) else None


def _lead(folder: Path, chart: Chart, number: int) -> dict[str, str]:
    """The chart above the table, as SVG within the page: the pointer over a point says what it is."""
    text = (folder / "plots" / f"{chart.name}.svg").read_text(encoding="utf-8")
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg"):], flags=re.DOTALL)
    text = re.sub(r'<g id="(hint[0-9]+)">', lambda m: f"{m[0]}<title>{html.escape(chart.hints.get(m[1], ''))}</title>",
                  text)
    # Ids must differ between the charts of one page.
    text = re.sub(r'(\bid="|url\(#|href="#)', rf"\g<1>chart{number}-", text)
    # The size is that of the page, not of the paper.
    text = re.sub(r'<svg ([^>]*?)width="[^"]*" height="[^"]*"|<svg ([^>]*?)height="[^"]*" ([^>]*?)width="[^"]*"',
                  lambda m: "<svg " + (m[1] or f"{m[2] or ''}{m[3] or ''}"), text, count=1)
    return {"svg": text, "caption": chart.caption, "link": f"plots/{chart.name}"}


def _chart(folder: Path, chart: Chart) -> dict[str, str]:
    content = (folder / "plots" / f"{chart.name}.svg").read_bytes()
    return {"uri": images.data_uri(content, "svg+xml"), "caption": chart.caption, "link": f"plots/{chart.name}"}


def _settings(section: Section, pictures: images.Pictures) -> list[dict]:
    """What the viewer offers: the pictures of each setting, by the labels of the table."""
    result = []
    for name, cells in section.rows.items():
        measured = [row for row in cells if row["status"] == "ok"]
        if not measured:
            continue
        result.append({
            "name": name,
            "heading": setting_heading(cells),
            "pictures": [
                {
                    "key": row["key"],
                    "label": row["label"],
                    "parameters": parameter_text(parameters_of(row)),
                    "error": error_caption(row),
                    "exact": row.get("quality.rmse") == 0,
                } | pictures.of(row)
                for row in measured
            ],
        })
    return result
