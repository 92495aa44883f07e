"""The main table: what each column says, and its forms for the terminal and for Markdown."""

from __future__ import annotations

import textwrap

from .. import formats
from ..compare.device_notes import NOTED, note_of
from ..compare.fragment_source import HARDWARE
from ..compare.labels import records
from ..compare.sections import Section, has_hardware_ratio
from ..formats import NOTHING

UNSETTLED = ("time_limit", "max_blocks")
TERMINAL_WIDTH = 100


def describe(row: dict) -> dict[str, str]:
    """The figures of one cell as text, by the names that the tables use."""
    if row["status"] != "ok":
        return {"frame": row["status"], "reason": row["reason"].strip() or "no reason given"}
    frame = formats.with_interval(
        row["frame_ms.median"], row["frame_ms.ci_low"], row["frame_ms.ci_high"], row["blocks"]
    )
    ratio = formats.with_interval(row["ratio"], row["ratio.low"], row["ratio.high"], row["ratio.blocks"])
    return {
        "frame": frame + (" †" if row.get("stop.reason") in UNSETTLED else ""),
        "ratio": "1" if row["verdict"] == "baseline" else ratio + (NOTED if row["device_note"] else ""),
        "baseline": row["baseline_name"] or NOTHING,
        "to_hardware": _to_hardware(row),
        "verdict": row["verdict"],
        "rmse": formats.number(row.get("quality.rmse")),
        "psnr": formats.decibels(row.get("quality.psnr"), row.get("quality.rmse")),
        "pixels_off": formats.share(row.get("quality.pixels_off")),
        "ssim": formats.similarity(row.get("quality.ssim")),
        "flip": formats.number(row.get("quality.flip")),
        "fragments": formats.count(row.get("counter.fragments")),
        "memory": formats.mebibytes(row["memory_total_bytes"]),
        "per_pixel": formats.number(row.get("bytes_per_pixel")),
        "per_fragment": formats.number(row.get("bytes_per_fragment")),
        "reason": "",
    }


def _to_hardware(row: dict) -> str:
    """The ratio to hardware blending, where it stands beside that to the baseline."""
    noted = NOTED if note_of(row["device"], "blend", HARDWARE) else ""
    text = formats.with_interval(*(row.get(f"ratio_hardware{suffix}") for suffix in ("", ".low", ".high")))
    return text if text == NOTHING else text + noted


def error_caption(row: dict) -> str:
    """The error of an image in a few words, for its caption."""
    if not formats.is_number(row.get("quality.rmse")):
        return "not compared with a reference"
    texts = describe(row)
    if row["quality.rmse"] == 0:
        return "equal to the reference"
    return f"RMSE {texts['rmse']}, PSNR {texts['psnr']} dB, pixels off: {texts['pixels_off']}"


Columns = tuple[tuple[str, str, int, bool], ...]
# Column head, name in describe(), width in characters, right-aligned. With two spaces between
# columns a line has at most 100 characters.
TERMINAL_COLUMNS: Columns = (
    ("method", "label", 20, False),
    ("frame ms [95%]", "frame", 25, True),
    ("ratio [95%]", "ratio", 23, True),
    ("verdict", "verdict", 9, False),
    ("RMSE", "rmse", 8, True),
    ("MiB", "memory", 5, True),
)
# With the ratio to hardware blending beside, without its interval, which the page has.
COLUMNS_WITH_HARDWARE: Columns = (
    ("method", "label", 15, False),
    ("frame ms [95%]", "frame", 25, True),
    ("ratio [95%]", "ratio", 23, True),
    ("verdict", "verdict", 9, False),
    ("to hardware", "to_hardware_alone", 11, True),
    ("RMSE", "rmse", 7, True),
)


def terminal_table(section: Section) -> str:
    """Aligned text, one block of lines per setting, at most 100 columns wide. Begins with an empty line."""
    lines: list[str] = []
    beside = has_hardware_ratio(section.table)
    columns = COLUMNS_WITH_HARDWARE if beside else TERMINAL_COLUMNS
    head = "  ".join(_align(text, width, right) for text, _, width, right in columns)
    for cells in section.rows.values():
        lines += ["", *textwrap.wrap(setting_heading(cells) + _ratio_text(cells), TERMINAL_WIDTH), head.rstrip()]
        for row in cells:
            lines += _terminal_rows(row, columns)
    return "\n".join(lines)


def terminal_warnings(warnings: list[str], everything: bool = True, hint: str = "") -> str:
    """Warnings as lines of at most 100 characters, or nothing. Unless `everything` is wanted they are one
    line: how many there are, what the first says, as far as it goes, and the hint how to see all."""
    if not warnings:
        return ""
    if everything:
        lines = [textwrap.fill(f"warning: {warning}", TERMINAL_WIDTH, subsequent_indent="  ",
                               break_on_hyphens=False) for warning in warnings]
        return "".join(f"{line}\n" for line in lines)
    line = f"{len(warnings)} warnings: {warnings[0]}" if len(warnings) > 1 else f"1 warning: {warnings[0]}"
    if len(warnings) == 1 and len(line) <= TERMINAL_WIDTH:
        return f"{line}\n"
    return textwrap.shorten(line, TERMINAL_WIDTH - len(hint) - 1, placeholder=" ...", break_on_hyphens=False) \
        + f" {hint}\n"


def setting_heading(cells: list[dict]) -> str:
    """`boxes · default · 640×360 · 12.0 K triangles`."""
    parts = [cells[0]["scene_label"], cells[0]["view"], cells[0]["size_label"]]
    # Failed cells may not know it.
    triangles = [row["triangles"] for row in cells if formats.is_number(row["triangles"])]
    if triangles:
        parts.append(f"{formats.count(max(triangles))} triangles")
    return " · ".join(parts)


def _ratio_text(cells: list[dict]) -> str:
    """What the ratios of a setting are to, for its heading; "" where there are none."""
    baselines = sorted({row["baseline_name"] for row in cells if isinstance(row["baseline_name"], str)})
    if not baselines:
        return ""
    beside = any(formats.is_number(row.get("ratio_hardware")) for row in cells)
    return f" · ratio to {' or '.join(baselines)}" + (", beside it to blend source=hardware" if beside else "")


def _terminal_rows(row: dict, columns: Columns) -> list[str]:
    """One cell; a label that is too long has a line of its own, nothing is cut off."""
    texts = describe(row)
    number, interval, rest = texts.get("to_hardware", NOTHING).partition(" [")
    texts["to_hardware_alone"] = number + rest.partition("]")[2] if interval else number
    width = columns[0][2]
    if row["status"] != "ok":
        names = textwrap.wrap(row["label"], width, subsequent_indent="  ")
        reason = textwrap.wrap(f"{row['status']}: {texts['reason']}", TERMINAL_WIDTH - width - 2)
        height = max(len(names), len(reason))
        names += [""] * (height - len(names))
        reason += [""] * (height - len(reason))
        return [f"{n:<{width}}  {r}".rstrip() for n, r in zip(names, reason)]
    values = "  ".join([" " * width, *(_align(texts[name], w, right) for _, name, w, right in columns[1:])]).rstrip()
    room = len(values) - len(values.lstrip()) - 2
    if len(row["label"]) <= room:
        return [row["label"] + values[len(row["label"]):]]
    return [*textwrap.wrap(row["label"], TERMINAL_WIDTH, subsequent_indent="  "), values]


def _align(text: str, width: int, right: bool) -> str:
    return f"{text:>{width}}" if right else f"{text:<{width}}"


MARKDOWN_COLUMNS = (
    ("scene", "scene_label"),
    ("view", "view"),
    ("size", "size_label"),
    ("method", "label"),
    ("frame ms [95%]", "frame"),
    ("ratio [95%]", "ratio"),
    ("baseline", "baseline"),
    ("ratio to blend source=hardware [95%]", "to_hardware"),
    ("verdict", "verdict"),
    ("RMSE", "rmse"),
    ("PSNR dB", "psnr"),
    ("pixels off", "pixels_off"),
    ("SSIM", "ssim"),
    ("FLIP", "flip"),
    ("fragments", "fragments"),
    ("memory MiB", "memory"),
    ("own bytes a pixel", "per_pixel"),
    ("own bytes a fragment", "per_fragment"),
)


def markdown_text(text: str) -> str:
    """Text that Markdown shows as it is, also inside a table."""
    text = text.replace("&", "&amp;").replace("<", "&lt;")
    for character in "\\`*_[]|#":
        text = text.replace(character, "\\" + character)
    return text


def markdown_table(section: Section) -> str:
    """The main table in Markdown, one row per cell."""
    first_figure = 4
    beside = has_hardware_ratio(section.table)
    columns = [column for column in MARKDOWN_COLUMNS if beside or column[1] != "to_hardware"]
    rules = ["---" if i < first_figure or head in ("verdict", "baseline") else "---:"
             for i, (head, _) in enumerate(columns)]
    lines = [_markdown_row([head for head, _ in columns]), _markdown_row(rules)]
    for row in records(section.table):
        texts = describe(row)
        values = [row[name] for _, name in columns[:first_figure]]
        values += [texts.get(name, NOTHING) for _, name in columns[first_figure:]]
        lines.append(_markdown_row([markdown_text(value) for value in values]))
    return "\n".join(lines)


def _markdown_row(values: list[str]) -> str:
    return f"| {' | '.join(values)} |"
