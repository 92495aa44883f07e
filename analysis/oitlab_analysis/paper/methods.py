"""LucidRaster's opening table with every method of oitlab in it, and the memory that each takes."""

from __future__ import annotations

import statistics

from .agreement import factor, order
from .common import build, clock_notes, columns, file_name, general_notes, head, pairs_of, published, without_ratios
from .lucidraster import LUCID
from .measured import Context, Measurements, Want, find, ratio
from .paired_table import Column, Number, Table
from .published import STAND_INS, read

HW = Want("blend", {"order": "submission"})
# The rows of the paper that have a method here.
PUBLISHED = {"Hardware alpha blending": HW, "Weighted-blended OIT": Want("wboit", {"weight": "eq7"}),
             "LucidRaster": Want("lucid", LUCID)}
# Methods that the paper's table does not have.
MORE = {
    ("LucidRaster", "repaired: exact order"): Want("lucid", LUCID | {"repair": True}),
    ("Hardware alpha blending", "sorted by centroid"): Want("blend", {"order": "sorted"}),
    ("A-buffer", "BMA: exact"): Want("abuffer", {"sort_memory": "bma"}),
    ("A-buffer", "fixed allocation: exact"): Want("abuffer", {"sort_memory": "max"}),
    ("Depth peeling", "front to back: exact"): Want("depth_peeling", {"mode": "front_to_back", "layers": 0}),
    ("Depth peeling", "dual: exact"): Want("depth_peeling", {"mode": "dual", "layers": 0}),
    ("Linked lists, full sort", "the reference: exact"): Want("reference", {}),
}
SCENES = sorted(set(STAND_INS.values()) - {"smoke"})


def opening(found: Measurements, device: str) -> Table:
    """Time of each method relative to hardware blending, with its error."""
    paper = read("lucidraster_methods")
    wanted = [(line["algorithm"], line["parameters"], line["relative_time"], PUBLISHED.get(line["algorithm"]))
              for line in paper]
    wanted += [(name, parameters, "", want) for (name, parameters), want in MORE.items()]

    def rows_of(context: Context) -> tuple[list[dict], list[dict]]:
        rows, used = [], []
        for name, parameters, time, want in wanted:
            row = {"scene": f"{name} {parameters}".strip(), "algorithm": name, "parameters": parameters,
                   "p.relative": published(time), "want": want, "unknown": want is None}
            if want:
                times, errors, off, cells = [], [], [], []
                for scene in SCENES:
                    pair = find(context, scene, {"it": want, "hw": HW}, (2560, 1330), "it", "methods")
                    compared = ratio(pair, "it", "hw")
                    if compared:
                        cells += pair.values()
                        times.append(compared.ratio)
                        quality = pair["it"].get("quality") or {}
                        if quality.get("rmse") is not None:
                            errors.append(quality["rmse"])
                            off.append(100 * quality["pixels_off"])
                if times:
                    row["m.relative"] = Number(statistics.fmean(times))
                    row["m.scenes"] = str(len(times))
                    if errors:
                        row["m.rmse"] = Number(statistics.fmean(errors))
                        row["m.off"] = Number(statistics.fmean(off))
                used += cells
            rows.append(row)
        return rows, used

    context, rows, used, others = build("methods", rows_of, found, device)
    metrics = [("relative", "relative time"), ("scenes", "scenes"), ("rmse", "RMSE"), ("off", "pixels off, %")]
    agreement, notes = [], []
    if context:
        agreement = [s for s in (order("Relative time", pairs_of(rows, "relative")),
                                 # Hardware blending relative to itself agrees with any paper.
                                 factor("Relative time", pairs_of([row for row in rows if row["want"] is not HW],
                                                                  "relative"))) if s]
        notes = clock_notes(used) + general_notes(context, used, others, "2560x1330")
        counts = {row["m.scenes"] for row in rows if row.get("m.scenes")}
        if len(counts) > 1:
            notes.insert(0, "The means are over different numbers of scenes: compare rows with equal numbers only.")
    unknown = [row["scene"] for row in rows if row["unknown"]]
    notes.append(f"Not a method of oitlab: {'; '.join(unknown)}.")
    return Table(
        name=f"methods-{file_name(device)}", title="Time relative to hardware alpha blending",
        source=f"{paper[0]['source']}, {paper[0]['table']} (of several papers and environments)",
        columns=[Column("algorithm", "algorithm"), Column("parameters", "parameters")]
        + columns(metrics, "paper", device, ("scenes", "rmse", "off")),
        rows=rows, measured_on=head(context, used), agreement=agreement, notes=notes,
        missing=[row["scene"] for row in rows if not row["unknown"] and not row.get("m.relative")],
        command="oitlab run experiments/methods.toml",
    )


MEMORY = {"blend": Want("blend", {"order": "submission"}), "wboit": Want("wboit", {}),
          "lucid": Want("lucid", LUCID | {"repair": True}), "abuffer": Want("abuffer", {"sort_memory": "bma"}),
          "depth_peeling": Want("depth_peeling", {"mode": "front_to_back"}), "reference": Want("reference", {})}


def memory(found: Measurements, device: str) -> Table:
    """Buffers of each method itself, in MiB, per scene: the paper's are of one size for all scenes."""
    paper = read("lucidraster_memory")[0]

    def rows_of(context: Context) -> tuple[list[dict], list[dict]]:
        rows, used = [], []
        for name, scene in STAND_INS.items():
            if name in ("Atrium", "Smoke", "Power Plant"):
                continue
            row = {"scene": name, "p.lucid": Number(float(paper["megabytes"]) * 1e6 / 2**20)}
            cells = find(context, scene, MEMORY, (2560, 1330), "lucid", "memory")
            for method, cell in cells.items():
                own = cell["memory_bytes"].get("method", cell["memory_bytes"]["total"])
                row[f"m.{method}"] = Number(own / 2**20)
            used += cells.values()
            rows.append(row)
        return rows, used

    context, rows, used, others = build("memory", rows_of, found, device)
    metrics = [("lucid", "lucid, MiB")] + [(m, f"{m}, MiB") for m in MEMORY if m != "lucid"]
    agreement, notes = [], []
    if context:
        below = [row for row in rows if row.get("m.lucid") and row["m.lucid"].value < row["p.lucid"].value]
        counted = sum(bool(row.get("m.lucid")) for row in rows)
        agreement = [f"Below the paper's fixed {paper['megabytes']} MB in {len(below)} of {counted} scenes."]
        notes = [n for n in without_ratios(general_notes(context, used, others, "2560x1330"))
                 if "times say" not in n]
    return Table(
        name=f"memory-{file_name(device)}", title="Memory of the methods themselves",
        source=f"{paper['source']}, {paper['table']}",
        columns=[Column("scene", "scene"),
                 *columns(metrics, "paper", device, tuple(m for m in MEMORY if m != "lucid"))],
        rows=rows, measured_on=head(context, used), agreement=agreement, notes=notes,
        missing=[row["scene"] for row in rows if not row.get("m.lucid")],
        command="oitlab run experiments/memory.toml",
    )
