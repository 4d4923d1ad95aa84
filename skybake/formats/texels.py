"""Texels as graphics processors read them: which formats there are, and what each can hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError, OutputError
from skybake.formats.half import half_rows
from skybake.formats.packed_floats import (
    RGB9E5_MAX,
    UFLOAT10_MAX,
    UFLOAT11_MAX,
    r11g11b10,
    rgb9e5,
)
from skybake.formats.spec import HALF_MAX
from skybake.jit.workers import ALL_CPUS, Workers

Pixels = npt.NDArray[np.float32]
Texels = npt.NDArray[np.generic]

_FLOAT_MAX = float(np.finfo(np.float32).max)


@dataclass(frozen=True)
class TexelFormat:
    """How texels are stored.

    Attributes
    ----------
    name : str
        As typed.
    vulkan : int
        Number of the format as Vulkan has it, VkFormat.
    unit, size : int
        Bytes of what a program reads at once, and of a whole texel.
    is_signed : bool
        Whether it holds negative values.
    largest : tuple of float
        Of red, green and blue.
    """

    name: str
    vulkan: int
    unit: int
    size: int
    is_signed: bool
    largest: tuple[float, float, float]


TEXEL_FORMATS = {
    one.name: one
    for one in (
        TexelFormat("half", 97, 2, 8, True, (HALF_MAX,) * 3),
        TexelFormat("float", 109, 4, 16, True, (_FLOAT_MAX,) * 3),
        TexelFormat("rgb9e5", 123, 4, 4, False, (RGB9E5_MAX,) * 3),
        TexelFormat("r11g11b10", 122, 4, 4, False, (UFLOAT11_MAX, UFLOAT11_MAX, UFLOAT10_MAX)),
    )
}
"""Formats by name: R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT, E5B9G9R9_UFLOAT and
B10G11R11_UFLOAT of Vulkan."""


def find_texel_format(name: str) -> TexelFormat:
    """Return the format of a name.

    Raises
    ------
    InputError
        If there is none; the message lists the known names.
    """
    if name not in TEXEL_FORMATS:
        raise InputError(f"pixel: must be one of {', '.join(TEXEL_FORMATS)}, got {name!r}")
    return TEXEL_FORMATS[name]


def encode_texels(
    pixels: Pixels, form: TexelFormat, path: Path, workers: Workers = ALL_CPUS
) -> tuple[Texels, int]:
    """Convert pixels to texels.

    Parameters
    ----------
    pixels : ndarray of float32, shape (row, column, 3)
        Linear.
    form : TexelFormat
        What they become; an alpha that it has is 1.
    path : Path
        The file, for messages.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    ndarray
        Little-endian.
    int
        Negative values that became 0 since the format has no sign.

    Raises
    ------
    OutputError
        If a value is not finite or larger than the format holds.
    """
    _check_range(pixels, form, path)
    negative = 0
    if not form.is_signed and pixels.min(initial=0.0) < 0.0:
        negative = int(np.count_nonzero(pixels < 0.0))
        pixels = np.maximum(pixels, np.float32(0.0))
    return _ENCODERS[form.name](pixels, workers), negative


def _check_range(pixels: Pixels, form: TexelFormat, path: Path) -> None:
    for channel, largest in enumerate(form.largest):
        values = pixels[..., channel]
        low, high = float(values.min()), float(values.max())
        got = high if not high <= largest or not form.is_signed else low
        if not np.isfinite(low + high):
            got = low if not np.isfinite(low) else high
            raise OutputError(f"{path}: radiance must be finite, got {got}")
        if abs(got) > largest:
            raise OutputError(
                f"{path}: radiance in {form.name} must be at most {largest:g}, got {got:g}; use a "
                "larger unit, float, or leave the sun's disc out"
            )


def _with_alpha(colours: npt.NDArray[np.floating]) -> Texels:
    texels = np.ones((*colours.shape[:-1], 4), colours.dtype.newbyteorder("<"))
    texels[..., :3] = colours
    return texels


def _encode_half(pixels: Pixels, workers: Workers) -> Texels:
    return _with_alpha(half_rows(pixels, workers)[0])


def _encode_float(pixels: Pixels, _workers: Workers) -> Texels:
    return _with_alpha(pixels)


def _encode_rgb9e5(pixels: Pixels, _workers: Workers) -> Texels:
    return rgb9e5(pixels).astype("<u4", copy=False)


def _encode_r11g11b10(pixels: Pixels, _workers: Workers) -> Texels:
    return r11g11b10(pixels).astype("<u4", copy=False)


_ENCODERS: dict[str, Callable[[Pixels, Workers], Texels]] = {
    "half": _encode_half,
    "float": _encode_float,
    "rgb9e5": _encode_rgb9e5,
    "r11g11b10": _encode_r11g11b10,
}
