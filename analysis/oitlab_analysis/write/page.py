"""The report as one HTML page that opens from the disk: tables, charts, and pictures to compare."""

from __future__ import annotations

import json
from pathlib import Path

import jinja2

from .. import formats
from . import images
from ..compare.labels import parameter_text, parameters_of, records
from ..compare.sections import Section
from .contents import Report, all_parameters, commands, summary, unmeasured
from .table import describe, error_caption, setting_heading

TEMPLATES = Path(__file__).parent / "templates"

# Column head, name in describe(), column to sort by, what it means.
FIGURES = (
    ("Frame, ms", "frame", "frame_ms.median", "median time of a whole frame, with its 95% interval"),
    ("Ratio", "ratio", "ratio", "frame time over that of the baseline, with its 95% interval"),
    ("Verdict", "verdict", "verdict", "against the baseline"),
    ("RMSE", "rmse", "quality.rmse", "root mean square error against the reference image"),
    ("PSNR, dB", "psnr", "quality.psnr", "∞ means equal to the reference"),
    ("Pixels off", "pixels_off", "quality.pixels_off", "share of pixels off by more than 1/255"),
    ("SSIM", "ssim", "quality.ssim", "structural similarity of display values; 1 means equal"),
    ("FLIP", "flip", "quality.flip", "visible difference of display values, from 0 to 1"),
    ("Fragments", "fragments", "counter.fragments", "transparent fragments of a frame"),
    ("Memory, MiB", "memory", "memory_total_bytes", "all buffers and images of the method"),
)


def html_page(report: Report) -> str:
    """The page."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=True, undefined=jinja2.StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )
    pictures = images.Pictures(report.folder, report.sources, report.sections)
    return environment.get_template("report.html.jinja").render(
        title=report.title,
        summary=summary(report.table),
        clock=report.clock,
        warnings=report.notes,
        figures=FIGURES,
        pictures=_json(pictures.embedded),
        pictures_note=pictures.note(),
        style=(TEMPLATES / "report.css").read_text(encoding="utf-8"),
        script=(TEMPLATES / "report.js").read_text(encoding="utf-8")
        + (TEMPLATES / "viewer.js").read_text(encoding="utf-8"),
        sections=[
            {
                "title": section.title,
                "context": section.context,
                "warnings": section.warnings,
                "rows": [_row(row) for row in records(section.table)],
                "charts": [_chart(report.folder, chart) for chart in charts],
                "settings": _settings(section, pictures),
                "parameters": all_parameters(section),
                "unmeasured": unmeasured(section),
                "commands": commands(report, section),
            }
            for section, charts in zip(report.sections, report.charts)
        ],
    )


def _json(value: object) -> str:
    """JSON that is safe inside a script element."""
    return json.dumps(value, separators=(",", ":"), ensure_ascii=False).replace("<", "\\u003c")


def _row(row: dict) -> dict[str, object]:
    texts = describe(row)
    return {
        "status": row["status"],
        "reason": texts["reason"],
        "baseline": row["baseline"] or "",
        "note": row["device_note"],
        "clock": row["clock_note"],
        "keys": [
            (row["scene_label"], row["scene_label"], parameter_text(scene_facts(row))),
            (row["view"], row["view"], ""),
            (row["size_label"], row["width"] * row["height"], ""),
            (row["label"], row["label"], ""),
        ],
        "figures": [
            (name, texts.get(name, formats.NOTHING), _sort_value(row, column))
            for _, name, column, _ in FIGURES
        ],
    }


def scene_facts(row: dict) -> dict[str, object]:
    facts = {key: row[key] for key in ("source", "triangles", "opacity", "detail")}
    return {key: value for key, value in facts.items() if formats.is_number(value) or
            (isinstance(value, str) and value)}


def _sort_value(row: dict, column: str) -> object:
    """What the column sorts by; empty goes last. An infinite PSNR is the greatest."""
    value = row.get(column)
    if column == "quality.psnr" and not formats.is_number(value) and row.get("quality.rmse") == 0:
        return "Infinity"
    return value if formats.is_number(value) or isinstance(value, str) else ""


def _chart(folder: Path, chart) -> dict[str, str]:
    content = (folder / "plots" / f"{chart.name}.svg").read_bytes()
    return {"uri": images.data_uri(content, "svg+xml"), "caption": chart.caption,
            "link": f"plots/{chart.name}"}


def _settings(section: Section, pictures: images.Pictures) -> list[dict]:
    """What the viewer offers: the pictures of each setting, the reference first to compare with."""
    result = []
    for _, cells in section.settings():
        measured = cells[cells["status"] == "ok"]
        if measured.empty:
            continue
        result.append({
            "heading": setting_heading(cells),
            "pictures": [
                {
                    "label": row["label"],
                    "parameters": parameter_text(parameters_of(row)),
                    "error": error_caption(row),
                    "exact": row.get("quality.rmse") == 0,
                } | pictures.of(row)
                for row in records(measured)
            ],
        })
    return result
