"""Whether what a map states about itself goes together."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from skybake.colour.space import COLOUR_SPACES, ColourSpace, colour_space_from_tags
from skybake.errors import InputError
from skybake.formats.raw_parts import RawPart
from skybake.formats.spec import CAMERA
from skybake.inspect.finding import Finding

_SAME = 2e-3
_SHAPES = {"LatLong Environment": ("latlong", 2, 1), "CubeFace Environment": ("cube", 1, 6)}


def tag_findings(part: RawPart) -> Iterator[Finding]:
    """Yield what is wrong with the attributes of a part."""
    attributes = part.attributes
    yield from _space_findings(attributes)
    yield from _shape_findings(part)
    white = attributes.get("whiteLuminance")
    if white is None:
        yield Finding("whiteLuminance", False, "absent: the luminance of 1.0 is not known")
    elif not (_is_number(white) and 0.0 < white < math.inf):
        yield Finding("whiteLuminance", True, f"not a positive number: {white!r}")
    direction = numbers(attributes.get("skybake:sunDirection"))
    if direction is not None and abs(float(np.linalg.norm(direction)) - 1.0) > _SAME:
        length = float(np.linalg.norm(direction))
        yield Finding("sunDirection", True, f"not a unit vector: its length is {length:.4g}")


def part_space(part: RawPart) -> ColourSpace | None:
    """Return the colour space that a part states, or None if it is not one of ours."""
    if CAMERA in part.attributes:
        return None
    try:
        return colour_space_from_tags("", *_tags(part.attributes))
    except InputError:
        return None


def numbers(value: Any) -> np.ndarray | None:
    """Return the numbers of an attribute, which a Radiance picture holds as text; None if none."""
    try:
        found = np.array(value.split() if isinstance(value, str) else value, float)
    except (TypeError, ValueError):
        return None
    is_fine = value is not None and found.size and np.isfinite(found).all()
    return found if is_fine else None


def _tags(attributes: dict[str, Any]) -> tuple[str | None, tuple[float, ...] | None]:
    name, primaries = attributes.get("colorInteropID"), numbers(attributes.get("chromaticities"))
    is_whole = primaries is not None and primaries.size == 8
    return (
        None if name is None else str(name),
        tuple(primaries.tolist()) if primaries is not None and is_whole else None,
    )


def _space_findings(attributes: dict[str, Any]) -> Iterator[Finding]:
    name, primaries = _tags(attributes)
    if name is None and primaries is None:
        yield Finding(
            "colour", False, "neither colorInteropID nor chromaticities: programs take Rec. 709"
        )
        return
    named = next((space for space in COLOUR_SPACES.values() if space.interop_id == name), None)
    if name is not None and named is None and name != "unknown":
        yield Finding(
            "colour", False, f"colorInteropID {name!r} is not a scene-linear space known here"
        )
    if named is None or primaries is None:
        return
    error = float(np.abs(np.subtract(primaries, named.chromaticities)).max())
    if error > _SAME:
        yield Finding(
            "colour",
            True,
            f"colorInteropID is {name}, but chromaticities are others, by up to {error:.3g}",
        )


def _shape_findings(part: RawPart) -> Iterator[Finding]:
    height, width = part.pixels.shape[:2]
    envmap = part.attributes.get("textureformat")
    if envmap in _SHAPES:
        name, across, down = _SHAPES[envmap]
        if width * down != height * across:
            yield Finding(
                "envmap",
                True,
                f"{name}, which is {across}:{down}, but the size is {width}x{height}",
            )
    elif part.pixel != "rgbe" and width == 2 * height and "skybake:recipe" not in part.attributes:
        yield Finding("envmap", False, "absent: programs tell an equirect map by it")


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float)
