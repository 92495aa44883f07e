"""Where the fragments of a cell come from: the hardware rasterizer or the one of compute shaders.

Cells say so by the parameter `source`. In older cells, which have none, every method took them from the
hardware, but for those in WITHOUT_SETTING.
"""

from __future__ import annotations

SETTING = "source"
HARDWARE, COMPUTE = "hardware", "compute"
# The last two have no fragments of a GPU's rasterizer at all.
WITHOUT_SETTING = {"lucid": COMPUTE, "cpu_reference": "", "local_memory": ""}


def usual_source(method: str) -> str:
    """The source of a method's cells that have no setting."""
    return WITHOUT_SETTING.get(method, HARDWARE)


def source_of(cell: dict) -> str:
    """"hardware", "compute", or "" for a method without fragments."""
    return str(cell["parameters"].get(SETTING, usual_source(cell["method"])))


def named(cell: dict) -> str:
    """A method with its source, as a baseline is called: `blend source=hardware`."""
    source = source_of(cell)
    return f"{cell['method']} {SETTING}={source}" if source else cell["method"]
