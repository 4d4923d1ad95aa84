"""Voxels of clouds in a file of the user's, as far as a preset has to know them.

What is in the file is read without numpy, which showing and checking presets does not wait for.
"""

from __future__ import annotations

import ast
import math
import struct
import zipfile
from pathlib import Path
from typing import IO, NamedTuple

from skybake import input_files
from skybake.errors import InputError, PresetError
from skybake.preset.clouds_model import TILE
from skybake.preset.message import shown
from skybake.preset.section import Section

EXTINCTION, SPACING = "extinction_per_km", "spacing_km"
"""Arrays in a tile's file: extinction by z, y and x; and the spacing of these."""

SUFFIX = ".npz"

_MAGIC = b"\x93NUMPY"
_LONGEST_HEADER = 10_000
_FLOATS = {"<f8": "<3d", "<f4": "<3f", ">f8": ">3d", ">f4": ">3f", "<i8": "<3q", "<i4": "<3i"}


class TileFile(NamedTuple):
    """A file that holds a tile: where it is, and the SHA-256 of its content."""

    path: Path
    digest: str


class TileSize(NamedTuple):
    """Height of a tile, and the shorter of its horizontal periods. [km]"""

    depth: float
    period: float


def tile_file(section: Section) -> TileFile:
    """Find the file that a layer's key ``tile`` names.

    Raises
    ------
    PresetError
        If it is no file that can be read.
    """
    name = section.text(TILE)
    if not name.endswith(SUFFIX):
        section.fail(TILE, f"must be a file that ends in {SUFFIX}, got {shown(name)}")
    path = section.user_file(TILE)
    where = f"{section.where(TILE)}: {shown(name)}"
    try:
        digest = input_files.digest(path, where, input_files.LARGEST_TILE)
    except InputError as error:
        raise PresetError(str(error)) from error
    return TileFile(path, digest)


def tile_size(section: Section, file: TileFile) -> TileSize:
    """Return how large a tile is, as its file states it.

    Raises
    ------
    PresetError
        If the file does not state it.
    """
    name = shown(section.text(TILE))
    try:
        with zipfile.ZipFile(file.path) as archive:
            arrays = sorted(one.removesuffix(".npy") for one in archive.namelist())
            if not {EXTINCTION, SPACING} <= set(arrays):
                section.fail(
                    TILE,
                    f"{name} must hold the arrays {EXTINCTION} and {SPACING}, "
                    f"got {', '.join(arrays) or 'none'}",
                )
            with archive.open(f"{EXTINCTION}.npy") as array:
                shape, _ = _header(array)
            with archive.open(f"{SPACING}.npy") as array:
                spacing = _three_numbers(array)
    except (OSError, zipfile.BadZipFile, NotImplementedError, struct.error, RuntimeError) as error:
        section.fail(TILE, f"{name} must be an archive of numpy's, as numpy.savez writes: {error}")
    if len(shape) != 3 or min(shape) < 1:
        section.fail(TILE, f"{name}: {EXTINCTION} must run along z, y and x, got shape {shape}")
    if spacing is None or not all(math.isfinite(step) and step > 0.0 for step in spacing):
        section.fail(TILE, f"{name}: {SPACING} must be three numbers greater than 0 for z, y and x")
    depth, *periods = (count * step for count, step in zip(shape, spacing, strict=True))
    return TileSize(depth, min(periods))


def _header(array: IO[bytes]) -> tuple[tuple[int, ...], str]:
    """Shape and type of an array, by the first bytes of its file, see numpy.lib.format."""
    start = array.read(8)
    if start[:6] != _MAGIC or len(start) < 8:
        raise struct.error("an array has no header")
    length = "<H" if start[6] == 1 else "<I"
    (size,) = struct.unpack(length, array.read(struct.calcsize(length)))
    if size > _LONGEST_HEADER:
        raise struct.error(f"an array's header has {size} bytes")
    try:
        header = ast.literal_eval(array.read(size).decode("utf-8"))
        return tuple(int(count) for count in header["shape"]), str(header["descr"])
    except (ValueError, SyntaxError, KeyError, TypeError) as error:
        raise struct.error("an array's header cannot be read") from error


def _three_numbers(array: IO[bytes]) -> tuple[float, ...] | None:
    shape, kind = _header(array)
    if shape != (3,) or kind not in _FLOATS:
        return None
    layout = _FLOATS[kind]
    return struct.unpack(layout, array.read(struct.calcsize(layout)))
