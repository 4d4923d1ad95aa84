"""Compressions of OpenEXR: which there are, and what each of them can hold."""

from __future__ import annotations

import math

import numpy as np

from skybake.errors import InputError
from skybake.formats.spec import HALF_MAX

COMPRESSIONS = (
    *("none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"),
    *("htj2k256", "htj2k32", "zstd"),
)
"""Names that OpenEXR's writer knows; it silently takes any other for zip."""

ZIP_LEVEL = 2.0
"""Level of zip unless another is asked for: of a sky it makes files 1 to 4 % larger than level 4
in a quarter less time."""

_ZIP_LEVELS = (1.0, 9.0)
_DWA_LEVELS = (0.0, 45.0, 90.0, 135.0)
_DWA_MAXIMA = (63456.0, 62016.0, 56760.0, 51000.0)
_DWA_DEFAULT = 45.0


def parse_compression(text: str) -> tuple[str, float | None]:
    """Split ``name[:level]`` and check both.

    Parameters
    ----------
    text : str
        As typed, for instance ``zip``, ``zip:9`` or ``dwaa:45``.

    Returns
    -------
    name : str
        One of `COMPRESSIONS`.
    level : float or None
        None where none is given.

    Raises
    ------
    InputError
        For an unknown name, or a level that the compression does not take.
    """
    name, colon, level_text = text.partition(":")
    if name not in COMPRESSIONS:
        raise InputError(f"compression: must be one of {', '.join(COMPRESSIONS)}, got {name!r}")
    if not colon:
        return name, None
    if name.startswith("dwa"):
        low, high = _DWA_LEVELS[0], _DWA_LEVELS[-1]
    elif name == "zip":
        low, high = _ZIP_LEVELS
    else:
        raise InputError(f"compression: only zip, dwaa and dwab take a level, got {text!r}")
    try:
        level = float(level_text)
    except ValueError:
        level = math.nan
    if not low <= level <= high or (name == "zip" and level % 1):
        kind = "a whole number" if name == "zip" else "a number"
        raise InputError(
            f"compression: level of {name} must be {kind} within {low:g} to {high:g}, got {text!r}"
        )
    return name, level


def largest_value(pixel: str, compression: str) -> float:
    """Largest magnitude that a file returns as a finite number.

    Notes
    -----
    DWA quantises in the frequency domain of half floats, so that a bright pixel's
    neighbourhood can overshoot the largest half and come back as infinity: a sun disc
    does. The limits are those of github.com/AcademySoftwareFoundation/openexr/issues/2606,
    linear between its levels, which is on the safe side of a concave table. DWA stores
    halves even where floats are asked for.
    """
    name, level = parse_compression(compression)
    if name.startswith("dwa"):
        return float(np.interp(_DWA_DEFAULT if level is None else level, _DWA_LEVELS, _DWA_MAXIMA))
    return HALF_MAX if pixel == "half" else float(np.finfo(np.float32).max)
