"""OpenEXR maps: half or float, tagged with space, scale and mapping."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import OpenImageIO

from skybake.errors import OutputError
from skybake.formats.compression import ZIP_LEVEL, largest_value, parse_compression
from skybake.formats.exr_chunks import find_chunk_fault
from skybake.formats.half import half_rows
from skybake.formats.long_texts import pieces
from skybake.formats.scanlines import Rows, ScanlineWriter
from skybake.formats.spec import UNDATED, Attribute, MapSpec
from skybake.formats.targets import write_error
from skybake.jit.workers import ALL_CPUS, Workers

# Only this name becomes OpenEXR's `envmap`; under the name `envmap` OpenImageIO would
# write an integer that no reader takes for it.
_TEXTURE_FORMAT = {"latlong": "LatLong Environment", "cube": "CubeFace Environment"}


class ExrWriter(ScanlineWriter):
    """Writes an OpenEXR file row by row.

    Parameters
    ----------
    path, temporary : Path
        The target, for messages, and the file to write.
    spec : MapSpec
        What it holds.

    Raises
    ------
    InputError
        If the compression is unknown.
    OutputError
        If the file cannot be written, or a value does not fit its type.
    """

    def __init__(self, path: Path, temporary: Path, spec: MapSpec) -> None:
        super().__init__(path, temporary, image_spec(spec))
        self._spec = spec

    def ready(self, rows: Rows, workers: Workers = ALL_CPUS) -> Rows:
        """Check that rows fit their type, and convert them to it."""
        return stored_rows(rows, self._spec, self._path, workers)

    def check_whole(self) -> None:
        """Check the table of chunks, which readers do not, and read the last row back."""
        fault = find_chunk_fault(self._temporary, self._height)
        if fault is not None:
            raise write_error(self._path, self._temporary, fault)
        super().check_whole()


def stored_rows(rows: Rows, spec: MapSpec, path: Path, workers: Workers = ALL_CPUS) -> Rows:
    """Check that rows fit the type of a file, and convert them to it.

    Raises
    ------
    OutputError
        If a value would come back as infinity; OpenImageIO stores it silently.
    """
    ready, largest = rows, math.nan
    if spec.pixel == "half" and rows.dtype == np.float32:
        ready, largest = half_rows(np.asarray(rows, np.float32), workers)
    limit = largest_value(spec.pixel, spec.compression)
    if not largest <= limit:
        _check_range(rows, limit, spec, path)
    return ready


def _check_range(rows: Rows, limit: float, spec: MapSpec, path: Path) -> None:
    low, high = float(rows.min()), float(rows.max())
    if max(-low, high) <= limit:
        return
    got = low if -low > high else high
    if not np.isfinite(got):
        raise OutputError(f"{path}: radiance must be finite, got {got}")
    raise OutputError(
        f"{path}: radiance in {spec.pixel} with {spec.compression} must be at most {limit:g}, "
        f"got {got:g}; use a larger unit, float with a lossless compression, or leave the sun's "
        "disc out"
    )


def image_spec(spec: MapSpec) -> OpenImageIO.ImageSpec:
    """Header of an OpenEXR file."""
    name, level = parse_compression(spec.compression)
    if name == "zip" and level is None:
        level = ZIP_LEVEL
    header = OpenImageIO.ImageSpec(spec.width, spec.height, len(spec.channels), spec.pixel)
    header.channelnames = spec.channels
    header["compression"] = name if level is None else f"{name}:{level:g}"
    if spec.envmap is not None:
        header["textureformat"] = _TEXTURE_FORMAT[spec.envmap]
        # One level: otherwise OpenImageIO expects mip levels, and closing does not finish the file.
        header["openexr:levelmode"] = 0
    # What OpenImageIO derives from `oiio:ColorSpace`, for which it would read a configuration
    # of colours in 30 ms.
    header["colorInteropID"] = spec.colour_space.interop_id
    if spec.colour_space.chromaticities:
        header.attribute("chromaticities", "float[8]", tuple(spec.colour_space.chromaticities))
        header.attribute("adoptedNeutral", "float[2]", tuple(spec.colour_space.neutral))
    if spec.white_luminance is not None:
        header.attribute("whiteLuminance", "float", spec.white_luminance)
    for key, value in {"DateTime": UNDATED, "Software": "skybake", **spec.attributes}.items():
        _set_attribute(header, key, value)
    return header


def _set_attribute(header: OpenImageIO.ImageSpec, key: str, value: Attribute) -> None:
    if isinstance(value, tuple):
        kind = "vector" if len(value) == 3 else f"float[{len(value)}]"
        header.attribute(key, kind, tuple(float(v) for v in value))
    elif isinstance(value, float):
        header.attribute(key, "float", value)
    elif isinstance(value, str):
        for name, piece in pieces(key, value):
            header.attribute(name, piece)
    else:
        header.attribute(key, value)
