"""The chunks of an OpenEXR file, by its own table of their places.

The library writes the table last, over zeros, and does not notice when that fails; nor
do readers, which look for the chunks themselves.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import BinaryIO

_MAGIC = 20000630
_HEAD = struct.Struct("<ii")
_LONGEST_NAME = 255


def find_chunk_fault(path: Path, height: int) -> str | None:
    """Return what is wrong with the table or the chunks of a scanline file, None if nothing.

    Parameters
    ----------
    path : Path
        A file of one part whose chunks are ordered from top to bottom without gaps.
    height : int
        Rows of the picture.

    References
    ----------
    OpenEXR file layout, openexr.com/en/latest/OpenEXRFileLayout.html.
    """
    with path.open("rb") as file:
        try:
            _skip_header(file)
            places = _read_table(file, height)
            if places is None:
                return "no table of chunks"
            return _chunk_fault(file, places, height)
        except struct.error:
            return "a file that ends early"


def _skip_header(file: BinaryIO) -> None:
    if _HEAD.unpack(file.read(8))[0] != _MAGIC:
        raise struct.error
    while _read_name(file):
        _read_name(file)
        (size,) = struct.unpack("<i", file.read(4))
        if size < 0:
            raise struct.error
        file.seek(size, 1)


def _read_name(file: BinaryIO) -> bytes:
    name = b""
    while (byte := file.read(1)) != b"\0":
        name += byte
        if not byte or len(name) > _LONGEST_NAME:
            raise struct.error
    return name


def _read_table(file: BinaryIO, height: int) -> tuple[int, ...] | None:
    """Read places of chunks, the first of which directly follows the table. [byte]"""
    start = file.tell()
    (first,) = struct.unpack("<Q", file.read(8))
    count, rest = divmod(first - start, 8)
    if not 1 <= count <= height or rest:
        return None
    return (first, *struct.unpack(f"<{count - 1}Q", file.read(8 * (count - 1))))


def _chunk_fault(file: BinaryIO, places: tuple[int, ...], height: int) -> str | None:
    end, rows = places[0], []
    for place in places:
        if place != end:
            return f"a chunk at {place} instead of {end}"
        file.seek(place)
        row, size = _HEAD.unpack(file.read(8))
        rows.append(row)
        end = place + _HEAD.size + size
    step = rows[1] if len(rows) > 1 else height
    if step < 1 or rows != list(range(0, height, step)):
        return "chunks of other rows"
    found = file.seek(0, 2)
    return None if found == end else f"{found} bytes instead of {end}"
