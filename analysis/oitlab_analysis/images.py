"""Pictures as data URIs, so that the HTML report is one file."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from PIL import Image

WIDEST = 800  # pixels
LARGEST_COPY = 160 * 1024  # bytes; larger PNGs are shown as JPEG to keep the page small
JPEG_QUALITY = 90


@dataclass(frozen=True)
class Preview:
    """An image of a cell as the page shows it; `problem` says why there is none."""

    uri: str = ""
    link: str = ""
    width: int = 0
    height: int = 0
    problem: str = ""


def data_uri(content: bytes, kind: str) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(content).decode('ascii')}"


def relative_link(file: str) -> str:
    """A link to a file of the results folder, from a report in that folder."""
    return quote(file)


def preview(results: Path, file: str | None) -> Preview:
    """A copy of RESULTS/`file` at most 800 pixels wide; the file itself if it is small."""
    if not file:
        return Preview(problem="no image was written")
    path = results / file
    # A cell may come from elsewhere: it must not pull other files of this machine into a report.
    if not path.resolve().is_relative_to(results.resolve()):
        return Preview(problem="the image lies outside the results folder")
    try:
        content = path.read_bytes()
        with Image.open(io.BytesIO(content)) as picture:
            width, height = picture.size
            if width > WIDEST or len(content) > LARGEST_COPY or picture.format != "PNG":
                return _copy(picture, relative_link(file))
            picture.load()  # a cut-off file shows here, not in the reader's browser
            return Preview(data_uri(content, "png"), relative_link(file), width, height)
    except FileNotFoundError:
        return Preview(problem=f"{file} is missing")
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        return Preview(problem=f"{file} cannot be read: {error}")


def _copy(picture: Image.Image, link: str) -> Preview:
    small = picture.convert("RGB")
    # Only shrinks, keeps the aspect, and averages over all pixels it drops.
    small.thumbnail((WIDEST, 100 * WIDEST), Image.Resampling.BOX, reducing_gap=None)
    buffer = io.BytesIO()
    small.save(buffer, "JPEG", quality=JPEG_QUALITY, subsampling=0)
    return Preview(data_uri(buffer.getvalue(), "jpeg"), link, *small.size)
