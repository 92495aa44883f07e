"""Just enough OpenEXR to hand exact floats to the program and back: scan lines of 32-bit floats,
written without compression, read without or with zip."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy


def write_exr(path: Path, rgb: numpy.ndarray) -> None:
    height, width, _ = rgb.shape
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for name in (b"B", b"G", b"R"))
    attributes = (
        (b"channels", b"chlist", channels + b"\0"), (b"compression", b"compression", b"\0"),
        (b"dataWindow", b"box2i", box), (b"displayWindow", b"box2i", box),
        (b"lineOrder", b"lineOrder", b"\0"), (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        (b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
        (b"screenWindowWidth", b"float", struct.pack("<f", 1)))
    head = struct.pack("<ii", 20000630, 2) + b"".join(
        name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
        for name, kind, value in attributes) + b"\0"
    line_bytes = 3 * width * 4
    first = len(head) + 8 * height
    offsets = struct.pack(f"<{height}Q", *(first + y * (line_bytes + 8) for y in range(height)))
    lines = b"".join(struct.pack("<ii", y, line_bytes)
                     + numpy.ascontiguousarray(rgb[y].T[::-1], "<f4").tobytes()
                     for y in range(height))
    path.write_bytes(head + offsets + lines)


def read_exr_red(path: Path) -> numpy.ndarray:
    """Channel R of a float file of channels A, B, G, R, as the program writes it."""
    data = path.read_bytes()
    at, compression, box = 8, None, None
    while data[at]:
        name, _, rest = data[at:at + 256].partition(b"\0")
        kind, _, _ = rest.partition(b"\0")
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        value = data[at + 4:at + 4 + size]
        at += 4 + size
        compression = value[0] if name == b"compression" else compression
        box = struct.unpack("<4i", value) if name == b"dataWindow" else box
    width, height = box[2] - box[0] + 1, box[3] - box[1] + 1
    lines_per_block = {0: 1, 2: 1, 3: 16}[compression]
    blocks = -(-height // lines_per_block)
    red = numpy.empty((height, width), numpy.float32)
    for offset in struct.unpack_from(f"<{blocks}Q", data, at + 1):
        y, size = struct.unpack_from("<ii", data, offset)
        block = data[offset + 8:offset + 8 + size]
        rows = min(lines_per_block, height - y)
        if size < rows * width * 16:
            block = _unzip(block)
        red[y:y + rows] = numpy.frombuffer(block, "<f4").reshape(rows, 4, width)[:, 3]
    return red


def _unzip(block: bytes) -> bytes:
    """Undoes zip's predictor and the split into even and odd bytes."""
    deltas = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
    deltas[1:] -= 128
    split = (numpy.cumsum(deltas) % 256).astype(numpy.uint8)
    half = (len(split) + 1) // 2
    joined = numpy.empty_like(split)
    joined[0::2], joined[1::2] = split[:half], split[half:]
    return joined.tobytes()
