#!/usr/bin/env python3
"""Renders the scenes of the LucidRaster paper with `oitlab` into one picture, docs/images/scenes.png.

    docs/make_contact_sheet.py build/release/oitlab [--size 480x250] [--out docs/images/scenes.png]

The largest scenes are drawn at a lower detail, which shows the same in a picture of this size.
"""

import argparse
import pathlib
import subprocess
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.image
import matplotlib.pyplot as plt

SCENES = {  # name: detail
    "boxes": 1, "bunny": 1, "conference": 1, "dragon": 1, "gallery": 1, "hairball": 0.3,
    "powerplant": 0.15, "sanmiguel": 0.3, "scrubpine": 1, "sponza_like": 1, "teapot": 1,
    "whiteoak": 1,
}


def render(program, scene, detail, size, folder):
    out = pathlib.Path(folder) / f"{scene}.png"
    subprocess.run(
        [program, "render", "--scene", scene, "--detail", str(detail), "--size", size,
         "--method", "reference", "--out", str(out)],
        check=True, stderr=subprocess.DEVNULL)
    return matplotlib.image.imread(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--size", default="480x250")
    parser.add_argument("--out", default="docs/images/scenes.png")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    columns, rows = 3, 4
    dpi = 100
    title = 22  # pixels
    figure = plt.figure(figsize=(columns * width / dpi, rows * (height + title) / dpi), dpi=dpi)
    with tempfile.TemporaryDirectory() as folder:
        for i, (scene, detail) in enumerate(SCENES.items()):
            image = render(options.program, scene, detail, options.size, folder)
            row, column = divmod(i, columns)
            total = rows * (height + title)
            axes = figure.add_axes([column / columns, 1 - (row + 1) * (height + title) / total,
                                    1 / columns, height / total])
            axes.imshow(image, interpolation="nearest", aspect="auto")
            axes.set_axis_off()
            axes.set_title(scene, fontsize=10, pad=4)
    figure.savefig(options.out, dpi=dpi)


if __name__ == "__main__":
    main()
