"""The chunks of an OpenEXR file, by its own table of their places.

The library writes the table last, over zeros, and does not notice when that fails; nor
do readers, which look for the chunks themselves.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import BinaryIO

_MAGIC = 20000630
_HEAD = struct.Struct("<ii")
_MULTIPART = 0x1000
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
            _read_headers(file)
            places = _read_table(file, height)
            if places is None:
                return "no table of chunks"
            return _chunk_fault(file, places, height)
        except struct.error:
            return "a file that ends early"


def find_fault(path: Path) -> str | None:
    """Return what is wrong with the tables or the chunks of a file, None if nothing.

    Parameters
    ----------
    path : Path
        A file of tiles or of several parts, whose chunks are there once each and without gaps.
    """
    with path.open("rb") as file:
        try:
            parts, is_multipart = _read_headers(file)
            if is_multipart:
                counts = [_whole_number(part["chunkCount"]) for part in parts]
                places = [struct.unpack(f"<{n}Q", file.read(8 * n)) for n in counts]
            else:
                places = [_read_table(file, None) or ()]
            return _gap_fault(file, parts, places, is_multipart)
        except KeyError:
            return "a part without a number of chunks"
        except struct.error:
            return "a file that ends early"


def _gap_fault(
    file: BinaryIO,
    parts: Sequence[Mapping[str, bytes]],
    tables: Sequence[tuple[int, ...]],
    is_multipart: bool,
) -> str | None:
    """Return which chunk does not follow another, or is not the part's that names it."""
    end, seen = file.tell(), set()
    for place, part in sorted(
        (place, part) for part, table in enumerate(tables) for place in table
    ):
        if place != end:
            return f"a chunk at {place} instead of {end}"
        file.seek(place)
        number = _whole_number(file.read(4)) if is_multipart else part
        is_tiled = parts[part].get("type", b"").startswith(b"tiled") or "tiles" in parts[part]
        where = (part, file.read(16 if is_tiled else 4))
        if number != part or where in seen:
            return f"a chunk of another part or twice, at {place}"
        seen.add(where)
        end = file.tell() + 4 + _whole_number(file.read(4))
    found = file.seek(0, 2)
    if not seen:
        return "no table of chunks"
    return None if found == end else f"{found} bytes instead of {end}"


def _read_headers(file: BinaryIO) -> tuple[list[dict[str, bytes]], bool]:
    """Read the attributes of each part, as bytes by their names, and whether there may be more."""
    magic, version = _HEAD.unpack(file.read(8))
    if magic != _MAGIC:
        raise struct.error
    is_multipart = bool(version & _MULTIPART)
    parts: list[dict[str, bytes]] = []
    while header := _read_header(file):
        parts.append(header)
        if not is_multipart:
            break
    return parts, is_multipart


def _read_header(file: BinaryIO) -> dict[str, bytes]:
    found: dict[str, bytes] = {}
    while name := _read_name(file):
        _read_name(file)
        size = _whole_number(file.read(4))
        found[name.decode("utf-8", "replace")] = file.read(size)
    return found


def _whole_number(data: bytes) -> int:
    (number,) = struct.unpack("<i", data)
    if number < 0:
        raise struct.error
    return int(number)


def _read_name(file: BinaryIO) -> bytes:
    name = b""
    while (byte := file.read(1)) != b"\0":
        name += byte
        if not byte or len(name) > _LONGEST_NAME:
            raise struct.error
    return name


def _read_table(file: BinaryIO, most: int | None) -> tuple[int, ...] | None:
    """Read places of chunks, the first of which directly follows the table. [byte]"""
    start = file.tell()
    (first,) = struct.unpack("<Q", file.read(8))
    count, rest = divmod(first - start, 8)
    if count < 1 or rest or (most is not None and count > most):
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
