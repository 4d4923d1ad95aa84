"""Maps back from files."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenImageIO

from skybake.errors import InputError
from skybake.formats.hdr import RADIANCE_EFFICACY, WHITE_LUMINANCE, read_header
from skybake.formats.ktx2_texts import read_texts
from skybake.formats.long_texts import joined
from skybake.formats.targets import is_utf8

Pixels = npt.NDArray[np.float32]

_BAND_ROWS = 256
_FORMATS = {".exr": "openexr", ".hdr": "hdr", ".png": "png"}


class ImageFile:
    """A scene-linear image that is read from top to bottom.

    Parameters
    ----------
    path : Path
        Any image of half or float pixels that OpenImageIO reads.
    takes_integers : bool, optional
        Also read pixels of 8 or 16 bits, which are taken as encoded for sRGB.
    part : str, optional
        Name of a part of an OpenEXR file; by default the first one.

    Attributes
    ----------
    width, height : int
        Its size. [pixel]
    is_integer : bool
        Whether the file holds integers.
    attributes : dict
        By the file's own names, long texts in one; of a Radiance picture also `chromaticities` and
        `whiteLuminance` where its header implies them.

    Raises
    ------
    InputError
        If the file is missing, damaged, of integers, or without R, G, B, or has no such part.
    """

    def __init__(
        self, path: Path, *, takes_integers: bool = False, part: str | None = None
    ) -> None:
        self._path = path
        self._source = open_image(path)
        if part is not None:
            _seek_part(path, self._source, part)
        spec = self._source.spec()
        names = [name.upper() for name in spec.channelnames]
        self.is_integer = spec.format.basetype in {OpenImageIO.UINT8, OpenImageIO.UINT16}
        is_readable = spec.format.basetype in {OpenImageIO.HALF, OpenImageIO.FLOAT}
        if not is_readable and not (takes_integers and self.is_integer):
            raise InputError(f"{path}: pixels must be half or float, got {spec.format}")
        if names[:3] != ["R", "G", "B"]:
            found = _printable(", ".join(spec.channelnames))
            raise InputError(f"{path}: channels must be R, G, B, got {found}")
        self.width: int = spec.width
        self.height: int = spec.height
        self.attributes = attributes_of(path, self._source)

    def bands(self) -> Iterator[Pixels]:
        """Yield R, G and B of some rows after others, shape (row, width, 3), finite.

        Raises
        ------
        InputError
            If the file is damaged or a value is not finite.
        """
        for first in range(0, self.height, _BAND_ROWS):
            last = min(first + _BAND_ROWS, self.height)
            rows = None
            with suppress(RuntimeError):
                rows = self._read(first, last)
            if rows is None:
                raise InputError(f"{self._path}: must be complete, got {reason(self._source)}")
            is_finite = np.isfinite(rows)
            if not is_finite.all():
                row, column, channel = np.argwhere(~is_finite)[0].tolist()
                raise InputError(
                    f"{self._path}: pixels must be finite, got {rows[row, column, channel]} in "
                    f"{'RGB'[channel]} at column {column}, row {first + row}"
                )
            yield _linear(rows) if self.is_integer else rows
        self._source.close()

    def _read(self, first: int, last: int) -> Pixels | None:
        spec = self._source.spec()
        if not spec.tile_width:
            top = spec.y
            rows: Pixels | None = self._source.read_scanlines(
                top + first, top + last, 0, 0, 3, OpenImageIO.FLOAT
            )
            return rows
        return self._read_tiles(spec, first, last)

    def _read_tiles(self, spec: OpenImageIO.ImageSpec, first: int, last: int) -> Pixels | None:
        # Whole rows of tiles, of which the rows are then taken.
        height = spec.tile_height
        top, bottom = first // height * height, min(-(-last // height) * height, spec.height)
        columns, rows = (spec.x, spec.x + spec.width), (spec.y + top, spec.y + bottom)
        tiles = self._source.read_tiles(*columns, *rows, 0, 1, 0, 3, OpenImageIO.FLOAT)
        return None if tiles is None else tiles[first - top : last - top]


def read_image(path: Path) -> tuple[Pixels, dict[str, Any]]:
    """Read all of a scene-linear image.

    Returns
    -------
    pixels : ndarray of float32, shape (row, column, 3)
        As stored, finite.
    attributes : dict
        As of `ImageFile`.

    Raises
    ------
    InputError
        As `ImageFile`.
    """
    image = ImageFile(path)
    return np.concatenate(list(image.bands())), image.attributes


def read_attributes(path: Path) -> dict[str, Any]:
    """Return the attributes of a map or a preview, as of `ImageFile`; of a KTX 2 file its texts.

    Raises
    ------
    InputError
        If the file is missing, damaged in its header, or of another format than its suffix.
    """
    if path.suffix.lower() == ".ktx2":
        return read_texts(path)
    source = open_image(path)
    if source.format_name() != _FORMATS.get(path.suffix.lower()):
        raise InputError(f"{path}: format must match the suffix, got {source.format_name()}")
    source.close()
    return attributes_of(path, source)


def _seek_part(path: Path, source: OpenImageIO.ImageInput, part: str) -> None:
    number = 0
    while source.seek_subimage(number, 0):
        if source.spec().get_string_attribute("oiio:subimagename") == part:
            return
        number += 1
    raise InputError(f"{path}: parts must include {part}, got {number} others")


def _linear(codes: Pixels) -> Pixels:
    """Light by which sRGB shows code values from 0 to 1 (IEC 61966-2-1)."""
    light: Pixels = np.where(
        codes <= np.float32(0.04045),
        codes / np.float32(12.92),
        ((codes + np.float32(0.055)) / np.float32(1.055)) ** np.float32(2.4),
    )
    return light


def open_image(path: Path) -> OpenImageIO.ImageInput:
    """Open an image file.

    Raises
    ------
    InputError
        If it is missing or no image.
    """
    if not path.is_file():
        raise InputError(f"{path}: must be an image file, got {_what_instead(path)}")
    if not is_utf8(path):
        raise InputError(f"{path}: must be UTF-8, got bytes that are not")
    source = OpenImageIO.ImageInput.open(str(path))
    if source is None:
        raise InputError(f"{path}: must be an image, got {reason(OpenImageIO)}")
    return source


def attributes_of(path: Path, source: OpenImageIO.ImageInput) -> dict[str, Any]:
    """Return the attributes of the part that an open file is at, see `ImageFile`."""
    attributes: dict[str, Any] = {a.name: a.value for a in source.spec().extra_attribs}
    attributes = joined(attributes)
    if source.format_name() == "hdr":
        attributes |= _radiance_attributes(path)
    return attributes


def _radiance_attributes(path: Path) -> dict[str, Any]:
    """Return the attributes of a Radiance header, under OpenEXR's names."""
    try:
        header = read_header(path)
        exposure = float(header.get("EXPOSURE", "0"))
        white = float(header.pop(WHITE_LUMINANCE, "0"))
        primaries = tuple(float(v) for v in header.get("PRIMARIES", "").split())
    except ValueError as error:
        raise InputError(f"{path}: EXPOSURE and PRIMARIES must be numbers, got {error}") from error
    if not 0.0 <= exposure < math.inf:
        raise InputError(f"{path}: EXPOSURE must be at least 0 and finite, got {exposure:g}")
    attributes: dict[str, Any] = dict(header)
    # Some programs write EXPOSURE=0 for an unknown exposure.
    if exposure > 0.0:
        attributes[WHITE_LUMINANCE] = RADIANCE_EFFICACY / exposure
    elif 0.0 < white < math.inf:
        attributes[WHITE_LUMINANCE] = white
    if primaries:
        attributes["chromaticities"] = primaries
    return attributes


def _what_instead(path: Path) -> str:
    return "a folder" if path.is_dir() else "nothing" if not path.exists() else "a device or pipe"


def reason(source: Any) -> str:
    """Return the first line of the library's message, which may repeat bytes of a file."""
    try:
        message = source.geterror()
    except UnicodeDecodeError:
        return "a header that is not UTF-8"
    return _printable(message.strip().partition("\n")[0]) or "an unknown error"


def _printable(text: str) -> str:
    return "".join(letter if letter.isprintable() else ascii(letter)[1:-1] for letter in text)
