"""What a picture's tags say of its numbers: their colour space and their scale."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from skybake.colour.space import ColourSpace, colour_space_from_tags
from skybake.errors import InputError

_CHROMATICITIES = 8

# From darker than any sensor sees to brighter than the surface of any star.
_DARKEST_WHITE = 1e-9
_BRIGHTEST_WHITE = 1e15


def file_space(path: Path, attributes: Mapping[str, Any]) -> ColourSpace:
    """Return the space of a file's pixels, which is Rec. 709 if it has no tag.

    Parameters
    ----------
    path : Path
        For messages.
    attributes : mapping
        Of the file.

    Raises
    ------
    InputError
        If a tag is none, or names a space that is not known.
    """
    chromaticities = attributes.get("chromaticities")
    if chromaticities is not None:
        chromaticities = _numbers(f"{path}: chromaticities", chromaticities, _CHROMATICITIES)
    name = attributes.get("colorInteropID")
    return colour_space_from_tags(str(path), None if name is None else str(name), chromaticities)


def file_white(path: Path, attributes: Mapping[str, Any]) -> float | None:
    """Return the luminance that RGB (1, 1, 1) stands for in a file, None if it has no tag. [cd m⁻²]

    Raises
    ------
    InputError
        If the tag is no luminance.
    """
    if "whiteLuminance" not in attributes:
        return None
    where = f"{path}: whiteLuminance"
    (white,) = _numbers(where, attributes["whiteLuminance"], 1)
    if not _DARKEST_WHITE <= white <= _BRIGHTEST_WHITE:
        raise InputError(
            f"{where}: must be from {_DARKEST_WHITE:g} to {_BRIGHTEST_WHITE:g} cd/m2, got {white:g}"
        )
    return white


def has_space(attributes: Mapping[str, Any]) -> bool:
    """Whether a file has a tag of its space."""
    return "chromaticities" in attributes or attributes.get("colorInteropID") not in {
        None,
        "unknown",
    }


def _numbers(where: str, value: Any, count: int) -> tuple[float, ...]:
    values = value if isinstance(value, tuple) else (value,)
    is_right = len(values) == count and all(isinstance(one, int | float) for one in values)
    if not is_right or not all(math.isfinite(one) for one in values):
        kind = "a number" if count == 1 else f"{count} numbers"
        raise InputError(f"{where}: must be {kind}, got {' '.join(repr(value).split())}")
    return tuple(map(float, values))
