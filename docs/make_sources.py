#!/usr/bin/env python3
"""Draws docs/images/sources.png: how the two fragment sources feed one fragment program.

    docs/make_sources.py [--out docs/images/sources.png]
"""

import argparse
import itertools

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import FancyBboxPatch

GREY, BLUE, ORANGE, GREEN = "#f2f2f2", "#dbe9f6", "#fde5cf", "#dff0d8"
COLUMNS = {"hardware": 1.6, "compute": 6.4}
WIDTH = 4.2


def box(axes, x, y, text, color, width=WIDTH, height=0.62):
    axes.add_patch(FancyBboxPatch((x - width / 2, y - height / 2), width, height, boxstyle="round,pad=0.05",
                                  facecolor=color, edgecolor="#444444", linewidth=0.8))
    axes.text(x, y, text, ha="center", va="center", fontsize=8.5)


def arrow(axes, start, end):
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": "#444444", "linewidth": 0.9,
                                              "shrinkA": 0, "shrinkB": 0})


def chain(axes, x, color, steps):
    for (y, text), (below, _) in itertools.pairwise(steps):
        box(axes, x, y, text, color)
        arrow(axes, (x, y - 0.37), (x, below + 0.37))
    box(axes, x, steps[-1][0], steps[-1][1], color)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", default="docs/images/sources.png")
    figure, axes = plt.subplots(figsize=(8.2, 5.4))
    axes.set_xlim(-0.8, 8.8)
    axes.set_ylim(-0.6, 6.4)
    axes.axis("off")
    middle = (COLUMNS["hardware"] + COLUMNS["compute"]) / 2
    box(axes, middle, 6.0, "transparent triangles, opaque depth", GREY, width=5)
    for name, color, steps in (
            ("hardware", BLUE, [(4.9, "vertex shader, rasterizer"), (3.9, "depth test"),
                                (2.9, "one fragment shader per fragment")]),
            ("compute", ORANGE, [(4.9, "setup, bins of 32 x 32 pixels"),
                                 (3.9, "lists of half-blocks, in order if it matters"),
                                 (2.9, "one subgroup per half-block, one lane per pixel")])):
        x = COLUMNS[name]
        chain(axes, x, color, steps)
        arrow(axes, (middle + (x - middle) * 0.45, 5.63), (x, 5.27))
        arrow(axes, (x, 2.53), (middle + (x - middle) * 0.45, 2.22))
        axes.text(x - WIDTH / 2 if x < middle else x + WIDTH / 2, 5.42, f"source={name}",
                  ha="left" if x < middle else "right", fontsize=9, fontweight="bold")
    box(axes, middle, 1.85, "the method's fragment program\nFragment: pixel, depth, id, shadeFragment()", GREEN, 5, 0.7)
    box(axes, middle, 0.85, "own buffers and atomics  |  sums  |  a state of the pixel", GREY, width=5)
    arrow(axes, (middle, 1.45), (middle, 1.22))
    box(axes, COLUMNS["hardware"], -0.2, "sums: images, blending units", BLUE)
    box(axes, COLUMNS["compute"], -0.2, "sums and states: registers of the pixel's lane", ORANGE)
    for x in COLUMNS.values():
        arrow(axes, (middle + (x - middle) * 0.45, 0.48), (x, 0.17))
    figure.savefig(parser.parse_args().out, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    main()
