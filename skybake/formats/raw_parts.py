"""Images as they are stored, whatever is wrong with their values."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenImageIO

from skybake.errors import InputError
from skybake.formats.reader import attributes_of, open_image, reason


@dataclass(frozen=True, eq=False)
class RawPart:
    """A part of an image file; most have one.

    Attributes
    ----------
    name : str
        Of the part, empty where the file names none.
    channels : tuple of str
        In the order of the last axis of `pixels`.
    pixel : str
        Stored type, such as half, or rgbe of a Radiance picture.
    compression : str
        As the format names it, with a level after a colon if it has one; empty if there is none.
    pixels : ndarray of float32, shape (row, column, channel)
        As stored.
    attributes : dict
        As of `skybake.formats.reader.ImageFile`.
    """

    name: str
    channels: tuple[str, ...]
    pixel: str
    compression: str
    pixels: npt.NDArray[np.float32]
    attributes: dict[str, Any]


def read_parts(path: Path) -> list[RawPart]:
    """Read all parts of an image of half or float pixels, the largest level of each.

    Raises
    ------
    InputError
        If the file is missing, damaged, or of integers.
    """
    source = open_image(path)
    parts: list[RawPart] = []
    try:
        while source.seek_subimage(len(parts), 0):
            parts.append(_read_part(path, source, len(parts)))
    finally:
        source.close()
    return parts


def _read_part(path: Path, source: OpenImageIO.ImageInput, number: int) -> RawPart:
    spec = source.spec()
    if spec.format.basetype not in {OpenImageIO.HALF, OpenImageIO.FLOAT}:
        raise InputError(f"{path}: pixels must be half or float, got {spec.format}")
    pixels = None
    with suppress(RuntimeError):
        pixels = source.read_image(number, 0, 0, spec.nchannels, OpenImageIO.FLOAT)
    if pixels is None:
        raise InputError(f"{path}: must be complete, got {reason(source)}")
    is_radiance = source.format_name() == "hdr"
    compression = "" if is_radiance else str(spec.getattribute("compression") or "")
    level = spec.getattribute("openexr:dwaCompressionLevel")
    if level is not None and compression.startswith("dwa"):
        compression = f"{compression}:{level:g}"
    return RawPart(
        name=str(spec.getattribute("oiio:subimagename") or ""),
        channels=tuple(spec.channelnames),
        pixel="rgbe" if is_radiance else str(spec.format),
        compression=compression,
        pixels=np.asarray(pixels, np.float32).reshape(spec.height, spec.width, spec.nchannels),
        attributes=attributes_of(path, source),
    )
