"""Pictures for the HTML report, which is one file: as data URIs while they fit, else by link.

A picture that many cells share (those of exact methods are equal bit for bit) is kept once.
"""

from __future__ import annotations

import base64
import io
import os
import struct
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from PIL import Image

from ..compare.sections import Section

WIDEST = 1280  # pixels
NARROWEST = 160
JPEG_QUALITY = 88
# Bytes of all pictures of a page before base64, which adds a third: the page stays under 15 MB.
MOST_BYTES = 7_000_000
# Decoding takes about 25 ms a megapixel on one core; more would make the report wait.
MOST_DECODED_PIXELS = 120_000_000
# What a JPEG of such renderings takes at that quality, by experience; the rest is retried smaller.
BYTES_PER_PIXEL = 0.25
PNG_HEAD, PNG_END = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", b"IEND\xaeB`\x82"


def data_uri(content: bytes, kind: str) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(content).decode('ascii')}"


def relative_link(folder: Path, results: Path, file: str) -> str:
    """A link to a file of a results folder from a report in `folder`."""
    return quote(os.path.relpath(results / file, folder))


@dataclass(frozen=True)
class Source:
    """An image file, looked at but not decoded; `problem` says why there is none."""

    content: bytes = b""
    width: int = 0
    height: int = 0
    problem: str = ""


def look_at(results: Path, file: str | None) -> Source:
    """Reads RESULTS/`file` and its size."""
    if not file:
        return Source(problem="no image was written")
    if results.is_file():
        return Source(problem="a pack holds no images")
    path = results / file
    # A cell may come from elsewhere: it must not pull other files of this machine into a report.
    if not path.resolve().is_relative_to(results.resolve()):
        return Source(problem="the image lies outside the results folder")
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        return Source(problem=f"{file} is missing")
    except (OSError, ValueError) as error:
        return Source(problem=f"{file} cannot be read: {error}")
    # A cut-off file should show here, not in the reader's browser.
    if not content.startswith(PNG_HEAD) or not content.endswith(PNG_END):
        return Source(problem=f"{file} cannot be read: not a whole PNG file")
    width, height = struct.unpack(">II", content[16:24])
    return Source(content, width, height)


def smaller(content: bytes, width: int) -> bytes:
    """A JPEG of this width; each pixel is the mean of those it stands for. Raises OSError."""
    with Image.open(io.BytesIO(content)) as picture:
        small = picture.convert("RGB")
    # Only shrinks, keeps the aspect, and averages over all pixels it drops.
    small.thumbnail((width, 100 * width), Image.Resampling.BOX, reducing_gap=None)
    buffer = io.BytesIO()
    small.save(buffer, "JPEG", quality=JPEG_QUALITY, subsampling=0)
    return buffer.getvalue()


class Pictures:
    """The pictures of all cells of a report.

    `embedded` holds, by key, those that are in the page: {"uri", "width", "height", "scale"}, where
    scale is how many pixels of the image one of the copy stands for (1: the image itself).
    """

    def __init__(self, folder: Path, sources: dict[str, Path], sections: list[Section]):
        self._folder, self._results = folder, sources
        self.embedded: dict[str, dict] = {}
        self._problems: dict[str, str] = {}  # by key of the cell, as are the next
        self._pictures: dict[str, str] = {}
        self._decoded = self._bytes = 0
        wanted = self._in_order(sections)
        distinct = len(set(wanted.values()))
        share = MOST_BYTES / max(1, distinct)
        for (cell, file), picture in wanted.items():
            self._add(cell, file, picture, share)

    def _in_order(self, sections: list[Section]) -> dict[tuple[str, str], str]:
        """Key of a cell and its file -> key of its picture: first one cell of each setting, then another, and so on."""
        queue = []
        for section in sections:
            for cells in section.rows.values():
                rows = [row for row in cells if isinstance(row["image"], str)]
                # The reference is what the others are compared with.
                rows.sort(key=lambda row: row["method"] != "reference")
                queue += [(place, row) for place, row in enumerate(rows)]
        queue.sort(key=lambda entry: entry[0])
        # Equal images of one setting have equal hashes; the scene keeps apart what hashes cannot.
        return {(row["key"], row["image"]): f"{row['image_hash'] or row['key']}-{row['scene']}"
                for _, row in queue}

    def _add(self, cell: str, file: str, key: str, share: float) -> None:
        self._pictures[cell] = key
        source = look_at(self._results[cell], file)
        self._problems[cell] = source.problem
        if source.problem or key in self.embedded:
            return
        content, kind, scale = source.content, "png", 1.0
        if len(content) > share:
            if self._decoded + source.width * source.height > MOST_DECODED_PIXELS:
                return
            self._decoded += source.width * source.height
            try:
                content, width = self._fitting(source, share)
            except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
                self._problems[cell] = f"{file} cannot be read: {error}"
                return
            kind, scale = "jpeg", source.width / width
        if self._bytes + len(content) > MOST_BYTES:
            return
        self._bytes += len(content)
        self.embedded[key] = {"uri": data_uri(content, kind), "width": source.width,
                              "height": source.height, "scale": round(scale, 3)}

    @staticmethod
    def _fitting(source: Source, share: float) -> tuple[bytes, int]:
        """A copy of about this many bytes, and its width."""
        pixels = share / BYTES_PER_PIXEL
        width = int(min(WIDEST, source.width, (pixels * source.width / source.height) ** 0.5))
        width = max(width, min(NARROWEST, source.width))
        content = smaller(source.content, width)
        if len(content) > 1.5 * share and width > NARROWEST:
            width = max(NARROWEST, int(width * (share / len(content)) ** 0.5))
            content = smaller(source.content, width)
        return content, width

    def of(self, row: dict) -> dict[str, str]:
        """`picture`: the key of the embedded one, or ""; `link` to the file; `problem`."""
        file = row["image"] if isinstance(row["image"], str) else None
        if file is None:
            return {"picture": "", "link": "", "problem": "no image was written"}
        problem, key = self._problems[row["key"]], self._pictures[row["key"]]
        link = "" if problem else relative_link(self._folder, self._results[row["key"]], file)
        return {"picture": key if key in self.embedded and not problem else "", "link": link,
                "problem": problem}

    def note(self) -> str:
        """What a reader must know of the copies; empty where the page holds the images themselves."""
        whole = sum(picture["scale"] == 1 for picture in self.embedded.values())
        small = len(self.embedded) - whole
        linked = sum(1 for cell, key in self._pictures.items()
                     if key not in self.embedded and not self._problems[cell])
        parts = []
        if small:
            parts.append(f"{small} of {len(self.embedded)} pictures are smaller copies, whose values are "
                         "means of several pixels")
        if linked:
            parts.append(f"{linked} did not fit into the page and are shown from the folder images/, "
                         "without values and error maps")
        return "; ".join(parts)
