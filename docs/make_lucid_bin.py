#!/usr/bin/env python3
"""Draws docs/lucid-bin.svg: how `lucid` turns a bin's triangles into the pixels of a half-block.

    docs/make_lucid_bin.py [--out docs/lucid-bin.svg]

Nothing is drawn by hand: coverage, depths, the order of the list, what the depth filter does to it
and the blended greys are worked out from the triangles below, as the shaders do it.
"""

import argparse

BIN, WIDTH, HEIGHT = 32, 8, 4  # BIN_SIZE, HALF_BLOCK_WIDTH, HALF_BLOCK_HEIGHT
COLUMN, ROW = 1, 3             # of the half-block that is followed
PIXEL = (5, 2)                 # of it, whose fragments are followed
FILTER = 3                     # the default depth_filter
ALPHA = 0.5

# Corners (x, y in pixels, 1 / w: larger is nearer) and a grey. B and C cut through each other.
TRIANGLES = {
    "A": (((1, 2, .30), (31, 9, .30), (5, 31, .34)), 0.85),
    "B": (((11, 7, .72), (29, 5, .75), (14, 27, .80)), 0.68),
    "C": (((3, 10.5, 1.25), (17, 15, .47), (4, 24, 1.2)), 0.15),
    "D": (((21, 21, .5), (30, 17, .5), (28, 29, .5)), 0.40),
}


def plane(corners):
    """1 / w as a function of the place on the screen, on which it is linear."""
    (ax, ay, a), (bx, by, b), (cx, cy, c) = corners
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    dx = ((b - a) * (cy - ay) - (c - a) * (by - ay)) / area
    dy = ((c - a) * (bx - ax) - (b - a) * (cx - ax)) / area
    return lambda x, y: a + dx * (x - ax) + dy * (y - ay)


def covers(corners, x, y):
    sides = [(bx - ax) * (y - ay) - (by - ay) * (x - ax)
             for (ax, ay, _), (bx, by, _) in zip(corners, corners[1:] + corners[:1])]
    return min(sides) >= 0 or max(sides) <= 0


def mask_of(corners):
    """Bit y * 8 + x: the pixel (x, y) of the half-block."""
    return sum(1 << (y * WIDTH + x) for y in range(HEIGHT) for x in range(WIDTH)
               if covers(corners, COLUMN * WIDTH + x + .5, ROW * HEIGHT + y + .5))


def depth_at(name, bit):
    return plane(TRIANGLES[name][0])(COLUMN * WIDTH + bit % WIDTH + .5, ROW * HEIGHT + bit // WIDTH + .5)


def sort_depth(name, mask):
    """At the centroid of the covered samples; linear, so the mean of the depths there."""
    bits = [b for b in range(WIDTH * HEIGHT) if mask >> b & 1]
    return sum(depth_at(name, b) for b in bits) / len(bits)


def blend(order):
    """Front to back over white."""
    grey, left = 0.0, 1.0
    for name in order:
        grey += left * ALPHA * TRIANGLES[name][1]
        left *= 1 - ALPHA
    return grey + left


def tone(value):
    return "#" + f"{round(255 * value):02x}" * 3


class Svg:
    def __init__(self, width, height):
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
            f'font-family="Helvetica, Arial, sans-serif" font-size="13" fill="#111">',
            "<title>How lucid processes a bin</title>",
            '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" '
            'markerHeight="8" orient="auto"><path d="M0 0 L8 4 L0 8 z"/></marker></defs>',
            f'<rect width="{width}" height="{height}" fill="#fff"/>']

    def rect(self, x, y, w, h, fill="none", stroke="#111", width=1):
        self.parts.append(f'<rect x="{x:g}" y="{y:g}" width="{w:g}" height="{h:g}" fill="{fill}" '
                          f'stroke="{stroke}" stroke-width="{width}"/>')

    def text(self, x, y, words, anchor="start", size=13, bold=False, fill="#111"):
        weight = ' font-weight="bold"' if bold else ""
        self.parts.append(f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}" font-size="{size}"'
                          f'{weight} fill="{fill}">{words}</text>')

    def lines(self, x, y, words, size=13):
        for i, line in enumerate(words):
            self.text(x, y + 17 * i, line, size=size)

    def head(self, x, y, number, words):
        self.parts.append(f'<circle cx="{x + 10}" cy="{y - 5}" r="10" fill="#111"/>')
        self.text(x + 10, y, str(number), "middle", 13, True, "#fff")
        self.text(x + 27, y, words, size=15, bold=True)

    def arrow(self, *points):
        path = " L".join(f"{x:g} {y:g}" for x, y in points)
        self.parts.append(f'<path d="M{path}" fill="none" stroke="#111" stroke-width="1.6" '
                          'marker-end="url(#tip)"/>')

    def line(self, x0, y0, x1, y1, stroke="#999", width=.6):
        self.parts.append(f'<path d="M{x0:g} {y0:g} L{x1:g} {y1:g}" stroke="{stroke}" '
                          f'stroke-width="{width}"/>')

    def polygon(self, points, fill):
        at = " ".join(f"{x:g},{y:g}" for x, y in points)
        self.parts.append(f'<polygon points="{at}" fill="{fill}" fill-opacity=".45" stroke="#111"/>')

    def letter(self, x, y, name):
        """A triangle's letter in its grey."""
        grey = TRIANGLES[name][1]
        self.rect(x, y, 22, 22, tone(grey))
        self.text(x + 11, y + 16, name, "middle", 14, True, "#fff" if grey < .5 else "#111")

    def cells(self, x, y, size, fills, columns):
        for i, fill in enumerate(fills):
            self.rect(x + i % columns * size, y + i // columns * size, size, size, fill, "#777", .6)


def draw():
    masks = {name: mask_of(corners) for name, (corners, _) in TRIANGLES.items()}
    found = [name for name in TRIANGLES if masks[name]]
    order = sorted(found, key=lambda name: -sort_depth(name, masks[name]))
    pixel = PIXEL[1] * WIDTH + PIXEL[0]
    arrive = [name for name in order if masks[name] >> pixel & 1]
    leave = sorted(arrive, key=lambda name: -depth_at(name, pixel))
    assert arrive != leave and len(arrive) <= FILTER, "the picture wants disorder that the filter mends"

    svg = Svg(960, 700)
    # 1: the bin
    svg.head(20, 30, 1, "A bin and its triangles")
    left, top, unit = 20, 46, 10
    for corners, grey in TRIANGLES.values():
        svg.polygon([(left + unit * x, top + unit * y) for x, y, _ in corners], tone(grey))
    for i in range(BIN + 1):
        strong = i % WIDTH == 0
        svg.line(left + unit * i, top, left + unit * i, top + 320, "#555" if strong else "#ddd",
                 1 if strong else .4)
        strong = i % HEIGHT == 0
        svg.line(left, top + unit * i, left + 320, top + unit * i, "#555" if strong else "#ddd",
                 1 if strong else .4)
    for name, (x, y) in {"A": (2.2, 3.6), "B": (22.5, 6.2), "C": (5.6, 17.0), "D": (26, 22)}.items():
        svg.letter(left + unit * x, top + unit * y, name)
    block = (left + unit * COLUMN * WIDTH, top + unit * ROW * HEIGHT)
    svg.rect(*block, unit * WIDTH, unit * HEIGHT, stroke="#000", width=4)
    svg.lines(20, 386, ["32 x 32 pixels, 32 half-blocks of 8 x 4.", "B and C cut through each other."])

    # 2: masks
    svg.head(400, 30, 2, "Tri-half-blocks")
    svg.arrow((block[0] + unit * WIDTH + 2, block[1] + 20), (360, block[1] + 20), (360, 128), (394, 128))
    for i, name in enumerate(found):
        y = 46 + 66 * i
        svg.letter(402, y + 13, name)
        svg.cells(436, y, 12, [tone(TRIANGLES[name][1]) if masks[name] >> b & 1 else "#fff"
                               for b in range(WIDTH * HEIGHT)], WIDTH)
        svg.text(546, y + 20, f"{masks[name]:08x}", size=13)
        svg.text(546, y + 38, f"1/w = {sort_depth(name, masks[name]):.2f}", size=13)
    svg.lines(402, 258, ["A bit a pixel, and 1/w (larger is", "nearer) at the centroid of the bits.",
                         "D misses the half-block."])

    # 3: the list
    svg.head(680, 30, 3, "The list, sorted")
    svg.arrow((632, 128), (676, 128))
    for i, name in enumerate(order):
        y = 58 + 46 * i
        svg.letter(686, y + 4, name)
        svg.rect(720, y, 130, 30)
        svg.rect(850, y, 50, 30, "#e4e4e4")
        svg.text(785, y + 20, "depth", "middle")
        svg.text(875, y + 20, f"place {found.index(name)}", "middle", 12)
    svg.lines(686, 212, ["By a subgroup, front first: right but", "for tri-half-blocks whose depths",
                         "overlap, as those of B and C."])

    # 4: prepared triangles
    svg.head(400, 352, 4, "Prepared triangles, in shared memory")
    svg.arrow((790, 258), (790, 310), (470, 310), (470, 330))
    for i, name in enumerate(order):
        y = 366 + 30 * i
        svg.letter(402, y, name)
        x = 430
        for words, w in (("1/w", 42), ("weights", 66), ("normals", 66), ("colours, uv", 88), ("material", 68)):
            svg.rect(x, y, w, 22)
            svg.text(x + w / 2, y + 16, words, "middle", 12)
            x += w
    svg.lines(776, 376, ["By one lane each, as", "planes that start at the", "half-block's corner,",
                         "then read by all lanes."])

    # 5: fragments
    svg.head(20, 500, 5, "Fragments: a lane a pixel")
    svg.arrow((560, 458), (560, 476), (300, 476), (300, 494))
    size = 12
    for i, name in enumerate(order):
        y = 520 + 30 * i
        svg.letter(20, y, name)
        svg.cells(50, y + 4, size, [tone(TRIANGLES[name][1]) if masks[name] >> b & 1 else "#fff"
                                    for b in range(32)], 32)
    svg.rect(50 + size * pixel - 1.5, 516, size + 3, 92, stroke="#000", width=3)
    svg.lines(20, 632, ["Where triangles are small, lanes shade samples as they", "come "
                        "and hand them to the lanes that own the pixels."])

    # 6: depth filter
    svg.head(480, 500, 6, "Depth filter of one pixel")
    svg.arrow((50 + size * pixel + 14, 512), (50 + size * pixel + 40, 506), (470, 506), (470, 556), (482, 556))
    svg.text(488, 532, "arrive", size=13)
    svg.text(640, 532, "leave", size=13)
    for i, name in enumerate(arrive):
        svg.letter(490, 542 + 28 * i, name)
    svg.rect(536, 540, 76, 80, "#f2f2f2")
    svg.text(574, 574, "queue of", "middle", 12)
    svg.text(574, 590, "depth_filter", "middle", 12)
    svg.arrow((516, 580), (534, 580))
    svg.arrow((612, 580), (636, 580))
    for i, name in enumerate(leave):
        svg.letter(642, 542 + 28 * i, name)
        svg.text(670, 558 + 28 * i, f"{depth_at(name, pixel):.2f}", size=12)
    svg.lines(480, 646, ["A fragment that leaves in front of", "the one blended last marks the pixel:",
                         "it goes to the repair."])

    # 7: pixels
    svg.head(740, 500, 7, "Pixels")
    svg.arrow((702, 580), (744, 580))
    svg.cells(752, 528, 22, [tone(blend(sorted((n for n in found if masks[n] >> b & 1),
                                               key=lambda n: -depth_at(n, b))))
                             for b in range(32)], WIDTH)
    svg.rect(752 + 22 * PIXEL[0], 528 + 22 * PIXEL[1], 22, 22, stroke="#000", width=3)
    svg.lines(752, 646, ["Blended front to back,", "written once."])
    return "\n".join(svg.parts + ["</svg>", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", default="docs/lucid-bin.svg")
    options = parser.parse_args()
    with open(options.out, "w", encoding="utf-8") as file:
        file.write(draw())


if __name__ == "__main__":
    main()
