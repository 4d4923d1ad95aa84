"""Whether the numbers of a map are such that programs can use them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from skybake.colour.space import ColourSpace, luminance_weights
from skybake.errors import InputError
from skybake.formats.compression import largest_value
from skybake.formats.raw_parts import RawPart
from skybake.formats.spec import HALF_MAX
from skybake.inspect.finding import Finding

NEGATIVE = 1e-5
"""Luminance below 0, as a share of the mean, that is rounding."""

_CLIPPED = 4
"""Values at exactly the largest half, in a part, that a clipped sun leaves."""


def value_findings(part: RawPart, space: ColourSpace | None) -> Iterator[Finding]:
    """Yield what is wrong with the values of a part.

    Parameters
    ----------
    part : RawPart
        Its first three channels are RGB.
    space : ColourSpace or None
        Of these, if it is known; what is no light, as a transmittance, may be negative without it.
    """
    pixels = part.pixels
    for check, text, bad in (
        ("nan", "NaN", np.asarray(np.isnan(pixels))),
        ("infinity", "infinite", np.asarray(np.isinf(pixels))),
    ):
        if bad.any():
            row, column = _first(np.asarray(bad.any(axis=2)))
            count = int(np.count_nonzero(bad))
            yield Finding(
                check, True, f"{_values(count)} {text}, the first in row {row}, column {column}"
            )
    finite = np.where(np.isfinite(pixels), pixels, np.float32(0.0))
    yield from _range_findings(part, finite)
    if space is not None:
        yield from _negative_findings(finite[..., :3], space)


def _range_findings(part: RawPart, pixels: npt.NDArray[np.float32]) -> Iterator[Finding]:
    most = float(np.abs(pixels).max(initial=0.0))
    if not most:
        yield Finding("black", False, "all values are 0")
    clipped = int(np.count_nonzero(np.abs(pixels) == HALF_MAX))
    if clipped >= _CLIPPED:
        yield Finding(
            "half", True, f"{_values(clipped)} at {HALF_MAX:g}, as of a sun that was cut off"
        )
    elif most > HALF_MAX:
        yield Finding(
            "half",
            False,
            f"the largest value is {most:.6g}, beyond {HALF_MAX:g}, the largest of programs that "
            "hold textures in half floats",
        )
    if part.compression.startswith("dwa"):
        try:
            limit = largest_value(part.pixel, part.compression)
        except InputError:
            return
        if most > limit:
            yield Finding(
                "dwa",
                True,
                f"the largest value is {most:.6g}, above {limit:g}, up to which "
                f"{part.compression} is safe from infinity",
            )


def _negative_findings(rgb: npt.NDArray[np.float32], space: ColourSpace) -> Iterator[Finding]:
    negative = rgb < 0.0
    if not negative.any():
        return
    count, least = int(np.count_nonzero(negative)), float(rgb.min())
    yield Finding(
        "negative", False, f"{_values(count)} negative, the least {least:.4g}: colours out of gamut"
    )
    luminance = rgb @ luminance_weights(space).astype(np.float32)
    dark = luminance < -NEGATIVE * max(float(luminance.mean()), 0.0)
    if dark.any():
        row, column = _first(dark)
        yield Finding(
            "luminance",
            True,
            f"{int(np.count_nonzero(dark))} pixels of negative luminance, the first in row {row}, "
            f"column {column}",
        )


def _values(count: int) -> str:
    return "1 value" if count == 1 else f"{count} values"


def _first(mask: npt.NDArray[np.bool_]) -> tuple[int, int]:
    row, column = np.unravel_index(int(mask.argmax()), mask.shape)
    return int(row), int(column)
