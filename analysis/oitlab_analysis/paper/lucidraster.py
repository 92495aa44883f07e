"""The tables of "LucidRaster: GPU Software Rasterizer for Exact OIT" (Jakubowski 2024)."""

from __future__ import annotations

from .agreement import factor, order
from .common import (
    build,
    clock_notes,
    columns,
    file_name,
    frame_us,
    general_notes,
    head,
    is_full_size,
    mean_row,
    not_in_turn,
    pairs_of,
    published,
    short,
    size_of,
    stages_us,
    without_ratios,
)
from .measured import Context, Measurements, Want, find, ratio
from .paired_table import Column, Number, Table
from .published import STAND_INS, read

# What the paper measured: it leaves wrong pixels as they are.
LUCID = {"depth_filter": 3, "alpha_threshold": 0, "repair": False, "visualize_errors": False,
         "backface_culling": False}
SW, HW = Want("lucid", LUCID), Want("blend", {"order": "submission"})
REPAIRED = Want("lucid", LUCID | {"repair": True})
STAGES = ("setup", "binning", "low_raster", "high_raster")
# Timed here by themselves, and part of both rasters in the paper.
OWN_STAGES = ("blocks", "sort")
RASTER = ("low_raster", "high_raster")
WITHIN = ("The paper's low and high raster hold what is timed here as blocks (the lists of tri-half-blocks) and "
          "sort (the order by depth of all but short lists, which low raster sorts itself): compare its low + high "
          "with blocks + sort + low + high. There low and high part the bins, here the lists of half-blocks.")


def performance(found: Measurements, device: str, table: str) -> Table:
    """Both performance tables: `table` is "first" or "second"."""
    paper = [row for row in read("lucidraster_performance") if table in row["table"]]
    size, paper_device = paper[0]["size"], paper[0]["device"]

    def rows_of(context: Context) -> tuple[list[dict], list[dict]]:
        rows, used = [], []
        for line in paper:
            row = {"scene": line["scene"], "p.samples": published(line["samples_m"]),
                   "p.s_hb": published(line["s_hb"]), "p.sw": published(line["sw_us"]),
                   "p.hw": published(line["hw_us"]), "p.sw_hw": published(line["sw_hw"])}
            row |= {f"p.{stage}": published(line[f"{stage}_us"]) for stage in STAGES}
            cells = find(context, STAND_INS[line["scene"]], {"sw": SW, "hw": HW, "repaired": REPAIRED},
                         size_of(size), "sw", "performance")
            if cells:
                row |= _performance_cells(cells)
                used += cells.values()
            rows.append(row)
        return rows, used

    context, rows, used, others = build("performance", rows_of, found, device)
    metrics = [("samples", "samples, M"), ("s_hb", "S/HB"), ("sw", "SW, µs"), ("hw", "HW, µs"),
               ("sw_hw", "SW/HW"), ("setup", "setup, µs"), ("binning", "binning, µs"),
               ("blocks", "blocks, µs"), ("sort", "sort, µs"), ("low_raster", "low, µs"),
               ("high_raster", "high, µs"), ("repaired", "SW/HW, repaired")]
    keys = [f"{side}.{key}" for side in "pm" for key in ("sw_hw", "repaired")]
    notes = not_in_turn(rows, "m.sw_hw", ("m.sw", "m.hw"))
    agreement = []
    if context:
        agreement = _performance_agreement(rows, context, used, size)
        software = [cell for cell in used if SW.fits(cell)]
        notes = [WITHIN, *clock_notes(used, software), *notes, *general_notes(context, used, others, size)]
    missing = [row["scene"] for row in rows if not row.get("m.sw")]
    return Table(
        name=f"performance-{size}-{file_name(device)}",
        title=f"LucidRaster (SW) against hardware blending (HW), {size.replace('x', '×')}",
        source=f"{paper[0]['source']}, {paper[0]['table']}, {paper_device}",
        columns=[Column("scene", "scene")] + columns(metrics, short(paper_device), device,
                                                         ("repaired", *OWN_STAGES)),
        rows=[*rows, mean_row(rows, keys, "mean")],
        measured_on=head(context, used), agreement=agreement, notes=notes, missing=missing,
        command="oitlab run experiments/performance.toml",
    )


def _performance_cells(cells: dict[str, dict]) -> dict:
    sw, counters = cells["sw"], cells["sw"]["counters"]
    row = {"m.sw": frame_us(sw)}
    if "fragments" in counters:
        row["m.samples"] = Number(counters["fragments"] / 1e6)
        if counters.get("half_blocks"):
            row["m.s_hb"] = Number(counters["fragments"] / counters["half_blocks"])
    if "hw" in cells:
        row["m.hw"] = frame_us(cells["hw"])
    for key, role in (("m.sw_hw", "sw"), ("m.repaired", "repaired")):
        if compared := ratio(cells, role, "hw"):
            row[key] = Number(compared.ratio, compared.low, compared.high)
    row |= {f"m.{stage}": time for stage, time in stages_us(sw, STAGES + OWN_STAGES).items()}
    return row


def _performance_agreement(rows: list[dict], context: Context, used: list[dict], size: str) -> list[str]:
    said = []
    full = is_full_size(used, size)
    for what, key in (("Samples", "samples"), ("S/HB", "s_hb")):
        said.append(factor(what, pairs_of(rows, key)) if full else order(what, pairs_of(rows, key)))
    said.append(order("SW/HW", pairs_of(rows, "sw_hw")))
    if full and context.device_type != "cpu":
        said.append(factor("SW/HW", pairs_of(rows, "sw_hw")))
    said.append(order("SW", pairs_of(rows, "sw")))
    said.append(_dearest_stage(rows))
    return [sentence for sentence in said if sentence]


def _dearest_stage(rows: list[dict]) -> str:
    """In how many scenes the same of setup, binning and all of raster takes most, and raster's share."""
    same, shares = 0, []
    for row in rows:
        sides = [_three_stages(row, "p", RASTER), _three_stages(row, "m", RASTER + OWN_STAGES)]
        if all(sides):
            same += max(sides[0], key=sides[0].get) == max(sides[1], key=sides[1].get)
            shares.append([100 * side["raster"] / sum(side.values()) for side in sides])
    if not shares:
        return ""
    published_share, measured_share = (sum(column) / len(shares) for column in zip(*shares))
    return (f"Of setup, binning and raster (low + high; here with blocks and sort) the dearest is the same in {same} "
            f"of {len(shares)} scenes; raster takes {measured_share:.0f} % of the three here in the mean, "
            f"{published_share:.0f} % as published.")


def _three_stages(row: dict, side: str, raster: tuple[str, ...]) -> dict[str, float]:
    """setup, binning and all of raster; empty where one is missing or of a lower clock."""
    wanted = ("setup", "binning", *raster)
    times = {stage: row.get(f"{side}.{stage}") for stage in wanted}
    if not all(isinstance(time, Number) for time in times.values()):
        return {}
    return {"setup": times["setup"].value, "binning": times["binning"].value,
            "raster": sum(times[stage].value for stage in raster)}


def scenes(found: Measurements, device: str) -> Table:
    """Triangles and quads, visible and degenerate, of each scene."""
    paper = read("lucidraster_scenes")

    def rows_of(context: Context) -> tuple[list[dict], list[dict]]:
        rows, used = [], []
        for line in paper:
            culled = line["backface_culling"] == "yes"
            row = {"scene": line["scene"] + (" (BC)" if culled else ""),
                   "p.triangles": published(line["triangles_k"]), "p.quads": published(line["quads_k"]),
                   "p.visible": published(line["visible_percent"]),
                   "p.degenerate": published(line["degenerate_percent"])}
            want = Want("lucid", {"backface_culling": culled})
            cells = find(context, STAND_INS[line["scene"]], {"sw": want}, (2560, 1330), "sw",
                         "scenes")
            quads = cells["sw"]["counters"].get("input_quads") if cells else None
            if quads:
                counters = cells["sw"]["counters"]
                row["m.triangles"] = Number(cells["sw"]["scene"]["triangles"] / 1e3)
                row["m.quads"] = Number(quads / 1e3)
                for key, counter in (("visible", "visible_quads"), ("degenerate", "degenerate_quads")):
                    if counter in counters:
                        row[f"m.{key}"] = Number(100 * counters[counter] / quads)
                used += cells.values()
            rows.append(row)
        return rows, used

    context, rows, used, others = build("scenes", rows_of, found, device)
    metrics = [("triangles", "triangles, K"), ("quads", "quads, K"), ("visible", "visible, %"),
               ("degenerate", "degenerate, %")]
    agreement, notes = [], []
    if context:
        rules = factor if is_full_size(used, "2560x1330") else order
        agreement = [s for s in (rules("Triangles", pairs_of(rows, "triangles")),
                                 rules("Quads", pairs_of(rows, "quads")),
                                 factor("Visible share", pairs_of(rows, "visible")),
                                 factor("Degenerate share", pairs_of(rows, "degenerate"))) if s]
        notes = without_ratios(general_notes(context, used, others, "2560x1330"))
    return Table(
        name=f"scenes-{file_name(device)}", title="Test scenes", source=f"{paper[0]['source']}, {paper[0]['table']}",
        columns=[Column("scene", "scene (BC: back faces culled)")] + columns(metrics, "paper", device),
        rows=rows, measured_on=head(context, used), agreement=agreement, notes=notes,
        missing=[row["scene"] for row in rows if not row.get("m.quads")],
        command="oitlab run experiments/scenes.toml",
    )


def depth_filter(found: Measurements, device: str) -> Table:
    """Invalid pixels and time for filters of 3, 8 and 12."""
    paper = read("lucidraster_depth_filter")
    sizes = (3, 8, 12)
    wants = {f"df{n}": Want("lucid", LUCID | {"depth_filter": n}) for n in sizes}

    def rows_of(context: Context) -> tuple[list[dict], list[dict]]:
        rows, used = [], []
        for line in paper:
            row = {"scene": line["scene"]}
            for n in sizes:
                row[f"p.n{n}"] = published(line[f"invalid_df{n}"])
                row[f"p.share{n}"] = published(line[f"percent_df{n}"])
            row |= {f"p.time{n}": published(line[f"time_df{n}_percent"]) for n in (8, 12)}
            cells = find(context, STAND_INS[line["scene"]], wants, (2560, 1330), "df3",
                         "depth_filter")
            for n in sizes:
                cell = cells.get(f"df{n}")
                if cell and "invalid_pixels" in cell["counters"]:
                    invalid = cell["counters"]["invalid_pixels"]
                    row[f"m.n{n}"] = Number(invalid, printed=str(invalid))
                    row[f"m.share{n}"] = Number(100 * invalid / (cell["size"][0] * cell["size"][1]), digits=2)
                compared = ratio(cells, f"df{n}", "df3")
                if n > 3 and compared:
                    low, high = (100 * end if end is not None else None for end in (compared.low, compared.high))
                    row[f"m.time{n}"] = Number(100 * compared.ratio, low, high)
            used += cells.values()
            rows.append(row)
        return rows, used

    context, rows, used, others = build("depth_filter", rows_of, found, device)
    metrics = [(f"n{n}", f"invalid, DF={n}") for n in sizes]
    metrics += [(f"share{n}", f"%, DF={n}") for n in sizes]
    metrics += [(f"time{n}", f"time, % of DF=3, DF={n}") for n in (8, 12)]
    agreement, notes = [], not_in_turn(rows, "m.time8", ("m.n8", "m.n3"))
    if context:
        agreement = [s for s in (order("Invalid pixels at DF=3", pairs_of(rows, "n3")),
                                 _falling(rows), factor("Time at DF=8", pairs_of(rows, "time8")),
                                 factor("Time at DF=12", pairs_of(rows, "time12"))) if s]
        timed = any(row.get(f"m.time{n}") for row in rows for n in (8, 12))
        notes += clock_notes(used if timed else []) + without_ratios(
            general_notes(context, used, others, "2560x1330"))
    keys = [f"{side}.{key}" for side in "pm" for key in ("share3", "share8", "share12", "time8", "time12")]
    return Table(
        name=f"depth-filter-{file_name(device)}", title="Fragment sorting errors by depth filter (repair off)",
        source=f"{paper[0]['source']}, {paper[0]['table']} (device not named)",
        columns=[Column("scene", "scene")] + columns(metrics, "paper", device),
        rows=[*rows, mean_row(rows, [k for k in keys if not k.startswith("p.share")], "mean")],
        measured_on=head(context, used), agreement=agreement, notes=notes,
        missing=[row["scene"] for row in rows if not all(
            row.get(f"m.{key}") for key in ("n3", "n8", "n12", "time8", "time12"))],
        command="oitlab run experiments/depth_filter.toml",
    )


def _falling(rows: list[dict]) -> str:
    complete = [[row[f"m.n{n}"].value for n in (3, 8, 12)] for row in rows
                if all(row.get(f"m.n{n}") for n in (3, 8, 12))]
    falling = sum(a >= b >= c for a, b, c in complete)
    return (f"As published, invalid pixels fall or stay as the filter grows in {falling} of {len(complete)} scenes."
            if complete else "")


def alpha_threshold(found: Measurements, device: str) -> Table:
    """HW and SW with the threshold off and on."""
    paper = read("lucidraster_alpha_threshold")
    wants = {"off": SW, "on": Want("lucid", LUCID | {"alpha_threshold": 1 - 1 / 128}), "hw": HW}

    def rows_of(context: Context) -> tuple[list[dict], list[dict]]:
        rows, used = [], []
        for line in paper:
            opacity = float(line["opacity"])
            row = {"scene": f"{line['scene']} {opacity:g}", "p.hw": published(line["hw_us"]),
                   "p.off": published(line["sw_off_us"]), "p.off_hw": published(line["sw_hw_off"]),
                   "p.on": published(line["sw_on_us"]), "p.on_hw": published(line["sw_hw_on"]),
                   "p.speedup": Number(float(line["sw_off_us"]) / float(line["sw_on_us"]))}
            cells = find(context, STAND_INS[line["scene"]], wants, size_of(line["size"]), "off",
                         "alpha_threshold", _stored(context, opacity), any_opacity=False)
            row |= {f"m.{role}": frame_us(cell) for role, cell in cells.items()}
            for key, role, base in (("off_hw", "off", "hw"), ("on_hw", "on", "hw"), ("speedup", "off", "on")):
                if compared := ratio(cells, role, base):
                    row[f"m.{key}"] = Number(compared.ratio, compared.low, compared.high)
            used += cells.values()
            rows.append(row)
        return rows, used

    context, rows, used, others = build("alpha_threshold", rows_of, found, device)
    metrics = [("hw", "HW, µs"), ("off", "SW off, µs"), ("off_hw", "SW/HW off"), ("on", "SW on, µs"),
               ("on_hw", "SW/HW on"), ("speedup", "speed-up")]
    agreement, notes = [], not_in_turn(rows, "m.speedup", ("m.off", "m.on"))
    if context:
        agreement = [s for s in (order("Speed-up", pairs_of(rows, "speedup")),
                                 factor("Speed-up", pairs_of(rows, "speedup"))) if s]
        notes += clock_notes(used) + general_notes(context, used, others, paper[0]["size"])
    return Table(
        name=f"alpha-threshold-{file_name(device)}", title="Alpha threshold off and on (1 - 1/128)",
        source=f"{paper[0]['source']}, {paper[0]['table']}, {paper[0]['device']}",
        columns=[Column("scene", "scene, opacity")] + columns(metrics, short(paper[0]["device"]), device),
        rows=rows, measured_on=head(context, used), agreement=agreement, notes=notes,
        missing=[row["scene"] for row in rows if not row.get("m.off") or not row.get("m.on")],
        command="oitlab run experiments/alpha_threshold.toml",
    )


def _stored(context: Context, opacity: float) -> float:
    """The opacity as the cells hold it: a 32-bit float written in full."""
    held = {c["scene"].get("opacity") for c in context.cells} - {None}
    return min(held, key=lambda value: abs(value - opacity), default=opacity) \
        if any(abs(value - opacity) < 1e-6 for value in held) else opacity
