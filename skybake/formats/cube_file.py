"""Formats that hold all six faces of a cubemap, and their levels, in one file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from skybake.errors import InputError
from skybake.formats.spec import Attribute, MapSpec
from skybake.formats.whole_files import WholeFiles
from skybake.jit.workers import ALL_CPUS, Workers

if TYPE_CHECKING:
    from skybake.formats.cube_levels import Level

CUBE_SUFFIXES = (".ktx2", ".dds")

_PIXELS = {".ktx2": ("half", "float", "rgb9e5", "r11g11b10"), ".dds": ("half", "float")}
_COMPRESSIONS = {".ktx2": ("zip", "zstd", "none"), ".dds": ("zip", "none")}


def is_cube_file(path: Path) -> bool:
    """Whether a file of that name holds six faces."""
    return path.suffix.lower() in CUBE_SUFFIXES


def check_cube_encoding(path: Path, pixel: str, compression: str) -> None:
    """Refuse what the format of a file does not know.

    Parameters
    ----------
    path : Path
        One of `CUBE_SUFFIXES`.
    pixel : str
        Stored type, or auto.
    compression : str
        As of `skybake.formats.compression`; zip, the usual one of others, means that of the
        format.

    Raises
    ------
    InputError
        If the format does not have them.
    """
    suffix = path.suffix.lower()
    if pixel not in ("auto", *_PIXELS[suffix]):
        known = ", ".join(_PIXELS[suffix])
        raise InputError(f"{path}: pixel of {suffix} must be one of {known}, got {pixel}")
    if compression not in _COMPRESSIONS[suffix]:
        known = " or ".join(_COMPRESSIONS[suffix][1:])
        raise InputError(f"{path}: compression of {suffix} must be {known}, got {compression}")


def write_cube(
    path: Path,
    levels: Sequence[Level],
    spec: MapSpec,
    files: WholeFiles,
    workers: Workers = ALL_CPUS,
) -> int:
    """Write a cubemap in the format that its name asks for.

    Parameters
    ----------
    path : Path
        One of `CUBE_SUFFIXES`.
    levels : sequence of ndarray of float32, shape (6, n >> k, n >> k, 3)
        See `skybake.formats.ktx2.write_ktx2`.
    spec : MapSpec
        What the file holds besides.
    files : WholeFiles
        The set that it is to appear with.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    int
        Negative values that became 0 since the type has no sign.

    Raises
    ------
    OutputError
        If the file cannot be written, or a value does not fit its type.
    """
    if path.suffix.lower() == ".dds":
        from skybake.formats.dds import write_dds

        write_dds(path, levels, pixel=spec.pixel, files=files, workers=workers)
        return 0
    from skybake.formats.ktx2 import write_ktx2

    tags: dict[str, Attribute] = {
        "colorInteropID": spec.colour_space.interop_id,
        "chromaticities": tuple(spec.colour_space.chromaticities),
    }
    if spec.white_luminance is not None:
        tags["whiteLuminance"] = spec.white_luminance
    return write_ktx2(
        path,
        levels,
        pixel=spec.pixel,
        zstd=spec.compression != "none",
        attributes={**tags, **spec.attributes},
        files=files,
        workers=workers,
    )
