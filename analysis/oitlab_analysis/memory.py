"""What a method's own buffers cost, in units that do not depend on the size of the image."""

from __future__ import annotations

from .formats import is_number


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
