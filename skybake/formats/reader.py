"""Maps back from files."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenImageIO

from skybake.errors import InputError
from skybake.formats.hdr import RADIANCE_EFFICACY, read_header
from skybake.formats.targets import is_utf8

_BAND_ROWS = 256
_FORMATS = {".exr": "openexr", ".hdr": "hdr", ".png": "png"}


def read_image(path: Path) -> tuple[npt.NDArray[np.float32], dict[str, Any]]:
    """Read the R, G and B of a scene-linear image.

    Parameters
    ----------
    path : Path
        Any image of half or float pixels that OpenImageIO reads.

    Returns
    -------
    pixels : ndarray of float32, shape (row, column, 3)
        As stored, finite.
    attributes : dict
        By the file's own names; of a Radiance picture also `chromaticities` and
        `whiteLuminance` where its header implies them.

    Raises
    ------
    InputError
        If the file is missing, damaged, of integers, without R, G, B, or not finite.
    """
    source = _open(path)
    spec = source.spec()
    names = [name.upper() for name in spec.channelnames]
    if spec.format.basetype not in {OpenImageIO.HALF, OpenImageIO.FLOAT}:
        raise InputError(f"{path}: pixels must be half or float, got {spec.format}")
    if names[:3] != ["R", "G", "B"]:
        raise InputError(f"{path}: channels must be R, G, B, got {', '.join(spec.channelnames)}")
    pixels = None
    with suppress(RuntimeError):
        pixels = source.read_image(0, 0, 0, 3, OpenImageIO.FLOAT)
    if pixels is None:
        raise InputError(f"{path}: must be whole, got {_first_line(source.geterror())}")
    source.close()
    if not np.isfinite(pixels).all():
        raise InputError(f"{path}: pixels must be finite, got NaN or infinity")
    return pixels, _attributes(path, source)


def read_whole_attributes(path: Path) -> dict[str, Any]:
    """Return the attributes of a map or a preview, after reading all of its rows.

    They are as of `read_image`.

    Raises
    ------
    InputError
        If the file is missing, damaged, or not what its suffix says.
    """
    source = _open(path)
    if source.format_name() != _FORMATS.get(path.suffix.lower()):
        raise InputError(f"{path}: must be what its suffix says, got {source.format_name()}")
    if not _can_read_rows(source):
        raise InputError(f"{path}: must be whole, got {_first_line(source.geterror())}")
    source.close()
    return _attributes(path, source)


def _can_read_rows(source: OpenImageIO.ImageInput) -> bool:
    spec = source.spec()
    with suppress(RuntimeError):
        return all(
            source.read_scanlines(first, min(first + _BAND_ROWS, spec.height), 0, 0, spec.nchannels)
            is not None
            for first in range(0, spec.height, _BAND_ROWS)
        )
    return False


def _open(path: Path) -> OpenImageIO.ImageInput:
    if not path.is_file():
        raise InputError(f"{path}: must be an image file, got {_what_instead(path)}")
    if not is_utf8(path):
        raise InputError(f"{path}: must be UTF-8, got bytes that are not")
    source = OpenImageIO.ImageInput.open(str(path))
    if source is None:
        raise InputError(f"{path}: must be an image, got {_first_line(OpenImageIO.geterror())}")
    return source


def _attributes(path: Path, source: OpenImageIO.ImageInput) -> dict[str, Any]:
    attributes: dict[str, Any] = {a.name: a.value for a in source.spec().extra_attribs}
    if source.format_name() == "hdr":
        attributes |= _radiance_attributes(path)
    return attributes


def _radiance_attributes(path: Path) -> dict[str, Any]:
    """Return what a Radiance header says, under OpenEXR's names."""
    try:
        header = read_header(path)
        exposure = float(header.get("EXPOSURE", "0"))
        primaries = tuple(float(v) for v in header.get("PRIMARIES", "").split())
    except ValueError as error:
        raise InputError(f"{path}: EXPOSURE and PRIMARIES must be numbers, got {error}") from error
    attributes: dict[str, Any] = dict(header)
    # Some programs write EXPOSURE=0 where they mean that they do not know it.
    if exposure > 0.0:
        attributes["whiteLuminance"] = RADIANCE_EFFICACY / exposure
    if primaries:
        attributes["chromaticities"] = primaries
    return attributes


def _what_instead(path: Path) -> str:
    return "a folder" if path.is_dir() else "nothing" if not path.exists() else "a device or pipe"


def _first_line(message: str) -> str:
    return message.strip().partition("\n")[0] or "an unknown error"
