"""How much device memory a method takes, by buffer: in bytes, bytes a pixel and bytes a fragment."""

from __future__ import annotations

import pandas

from ..formats import is_number

PREFIX = "memory.method: "


def memory_table(table: pandas.DataFrame) -> pandas.DataFrame | None:
    """One row for each buffer of each measured cell of the tidy table, largest first within a cell,
    and one, `all`, for their sum. Bytes a fragment are of the fragments in front of the opaque depth
    (counter `fragments`), and missing where a method does not count them. None without such cells."""
    buffers = [column for column in table.columns if column.startswith(PREFIX)]
    rows = []
    for _, cell in table[table["status"] == "ok"].iterrows() if buffers else ():
        pixels, fragments = cell["width"] * cell["height"], cell.get("counter.fragments")
        held = {name[len(PREFIX):]: cell[name] for name in buffers if cell[name] > 0}
        if not held:
            continue
        held = {"all": sum(held.values())} | dict(sorted(held.items(), key=lambda item: -item[1]))
        for buffer, count in held.items():
            rows.append({
                "id": cell["id"], "scene": cell["scene"], "view": cell["view"],
                "width": cell["width"], "height": cell["height"],
                "method": cell.get("label", cell["method"]), "buffer": buffer, "bytes": int(count),
                "bytes_per_pixel": count / pixels,
                "bytes_per_fragment": count / fragments if fragments and fragments > 0 else None,
            })
    return pandas.DataFrame(rows) if rows else None


def own_memory(cell: dict) -> dict[str, float | None]:
    """The method's own buffers, without scene and target: bytes, bytes a pixel, bytes a fragment."""
    own = cell.get("memory_bytes", {}).get("method")
    pixels = cell["size"][0] * cell["size"][1]
    fragments = cell.get("counters", {}).get("fragments")
    return {
        "memory_method_bytes": own,
        "bytes_per_pixel": own / pixels if is_number(own) and pixels else None,
        "bytes_per_fragment": own / fragments if is_number(own) and fragments else None,
    }
