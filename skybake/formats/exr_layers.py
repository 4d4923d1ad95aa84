"""OpenEXR files of any program with all of their parts and channels, read, changed and written."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import OpenImageIO

from skybake.errors import InputError
from skybake.formats.compression import ZIP_LEVEL
from skybake.formats.exr_chunks import find_fault
from skybake.formats.long_texts import joined
from skybake.formats.reader import open_image, reason
from skybake.formats.spec import HALF_MAX, Attribute
from skybake.formats.targets import faults_of, write_error

Plane = npt.NDArray[np.floating[Any]]

LARGEST_NUMBER = 1 << 22
"""Whole number that the library keeps beside channels of other types."""

_LOSSY = ("pxr24", "b44", "b44a", "dwaa", "dwab")
_TYPES = {"half": np.float16, "float": np.float32}


class ExrPart(NamedTuple):
    """A part of a file.

    Attributes
    ----------
    name : str
        Empty if it has none.
    channels : tuple of str
        In the order of `pixels`.
    window : tuple of int
        Column and row of its first pixel in the displayed picture, and the width and height of
        that picture. [pixel]
    attributes : dict
        By the file's own names.
    pixels : ndarray, shape (row, column, channel)
        Of a type that holds all channels without loss; whole numbers of 32 bits as shares of
        their greatest.
    spec : object
        OpenImageIO's own header.
    """

    name: str
    channels: tuple[str, ...]
    window: tuple[int, int, int, int]
    attributes: dict[str, Any]
    pixels: Plane
    spec: Any

    @property
    def size(self) -> tuple[int, int]:
        """Width and height. [pixel]"""
        return self.pixels.shape[1], self.pixels.shape[0]

    def plane(self, channel: str) -> npt.NDArray[np.float32]:
        """Return a channel in single precision, shape (row, column)."""
        plane: npt.NDArray[np.float32] = np.ascontiguousarray(
            self.pixels[..., self.channels.index(channel)], np.float32
        )
        return plane


def read_exr(path: Path) -> list[ExrPart]:
    """Read all parts of an OpenEXR file.

    Raises
    ------
    InputError
        If it is missing, damaged, of another format, or deep.
    """
    source = open_image(path)
    if source.format_name() != "openexr":
        raise InputError(f"{path}: must be an OpenEXR file, got {source.format_name()}")
    parts: list[ExrPart] = []
    while source.seek_subimage(len(parts), 0):
        spec = source.spec()
        if spec.deep:
            raise InputError(f"{path}: must be flat, got deep pixels in part {len(parts)}")
        _check_numbers(path, source, spec, len(parts))
        pixels = source.read_image(len(parts), 0, 0, spec.nchannels, _common_type(spec))
        if pixels is None:
            raise InputError(f"{path}: must be complete, got {reason(source)}")
        window = (spec.x - spec.full_x, spec.y - spec.full_y, spec.full_width, spec.full_height)
        attributes = joined({each.name: each.value for each in spec.extra_attribs})
        name = spec.get_string_attribute("oiio:subimagename")
        shape = (spec.height, spec.width, spec.nchannels)
        parts.append(
            ExrPart(
                name,
                tuple(spec.channelnames),
                window,
                attributes,
                np.asarray(pixels).reshape(shape),
                OpenImageIO.ImageSpec(spec),
            )
        )
    source.close()
    return parts


def write_exr(
    path: Path, temporary: Path, parts: list[ExrPart], attributes: Mapping[str, Attribute]
) -> int:
    """Write parts as they were read.

    Parameters
    ----------
    path, temporary : Path
        The target, for messages, and the file to write.
    parts : list of ExrPart
        Of `read_exr`, perhaps with other pixels.
    attributes : mapping of str to Attribute
        What the first part states besides.

    Returns
    -------
    int
        Values beyond the range of half floats, which became its largest.

    Raises
    ------
    OutputError
        If the file cannot be written.

    Notes
    -----
    Channels keep their types, and parts their windows and attributes. What is compressed with
    loss is compressed without, since a second loss would change what is to stay.
    """
    specs = [_written_spec(part) for part in parts]
    for name, value in attributes.items():
        specs[0].attribute(name, value)
    output = OpenImageIO.ImageOutput.create(str(temporary))
    if output is None:
        raise write_error(path, temporary, OpenImageIO.geterror())
    clamped = 0
    is_fine = output.open(str(temporary), specs)
    for number, part in enumerate(parts):
        if number > 0:
            is_fine = is_fine and output.open(str(temporary), specs[number], "AppendSubimage")
        pixels, beyond = _fitting(part)
        clamped += beyond
        is_fine = is_fine and output.write_image(pixels)
    message = output.geterror()
    output.close()
    if not is_fine or message or output.has_error:
        raise write_error(path, temporary, message or output.geterror())
    if len(parts) > 1:
        with faults_of(path):
            fault = find_fault(temporary)
        if fault is not None:
            raise write_error(path, temporary, fault)
    return clamped


def channel_types(part: ExrPart) -> list[str]:
    """Return the stored types of a part's channels: half, float or uint."""
    formats = part.spec.channelformats or [part.spec.format] * len(part.channels)
    return [str(each) for each in formats]


def _common_type(spec: OpenImageIO.ImageSpec) -> Any:
    formats = {each.basetype for each in (*spec.channelformats, spec.format)}
    if OpenImageIO.UINT32 in formats:
        return OpenImageIO.DOUBLE
    return OpenImageIO.FLOAT if OpenImageIO.FLOAT in formats else OpenImageIO.HALF


def _check_numbers(path: Path, source: Any, spec: OpenImageIO.ImageSpec, part: int) -> None:
    """Refuse whole numbers that would be changed."""
    for k, kind in enumerate(spec.channelformats):
        if kind.basetype == OpenImageIO.UINT32:
            numbers = source.read_image(part, 0, k, k + 1, OpenImageIO.UINT32)
            if numbers is not None and numbers.max(initial=0) > LARGEST_NUMBER:
                raise InputError(
                    f"{path}: channel {spec.channelnames[k]}: whole numbers must be at most "
                    f"{LARGEST_NUMBER}, got {numbers.max()}"
                )


def _written_spec(part: ExrPart) -> OpenImageIO.ImageSpec:
    spec = OpenImageIO.ImageSpec(part.spec)
    name = spec.get_string_attribute("compression").partition(":")[0]
    if name in _LOSSY:
        spec["compression"] = f"zip:{ZIP_LEVEL}"
    return spec


def _fitting(part: ExrPart) -> tuple[Plane, int]:
    """Pixels of which none would become infinite in its type, and how many would have."""
    pixels, clamped = part.pixels, 0
    if pixels.dtype == np.float16:
        return np.ascontiguousarray(pixels), 0
    for k, kind in enumerate(channel_types(part)):
        if kind != "half":
            continue
        plane = pixels[..., k]
        beyond = np.isfinite(plane) & (np.abs(plane) > HALF_MAX)
        if beyond.any():
            clamped += int(beyond.sum())
            plane[beyond] = np.copysign(HALF_MAX, plane[beyond])
    return np.ascontiguousarray(pixels), clamped
