"""What the eye sees of light at which it is adapted to the dark: less colour, and a bluer one."""

from __future__ import annotations

import numpy as np

from skybake.colour.space import ColourSpace, rgb_from_xyz
from skybake.errors import InputError
from skybake.image.layers import Pixels

VISIONS = ("camera", "eye")

_RODS, _CONES = -2.0, 0.6
"""Logarithms of the luminances [cd m⁻²] below which only rods see, and above which only cones."""

_NIGHT_WHITE = 0.25, 0.25
"""Chromaticity of what rods see."""

_SCOTOPIC = 0.4468
"""Luminance that a scotopic one seems to be; white light stays as bright."""


def check_vision(vision: str) -> None:
    """Raise an `InputError` if there is no such vision."""
    if vision not in VISIONS:
        raise InputError(f"vision: must be one of {', '.join(VISIONS)}, got {vision!r}")


def as_seen(pixels: Pixels, space: ColourSpace, white_luminance: float, vision: str) -> Pixels:
    """Return pixels as a camera or the eye sees them.

    Parameters
    ----------
    pixels : ndarray of float32, shape (row, column, 3)
        Scene-linear.
    space : ColourSpace
        Theirs.
    white_luminance : float
        Luminance that RGB (1, 1, 1) stands for. [cd m⁻²]
    vision : {"camera", "eye"}
        A camera takes them as they are.

    Notes
    -----
    For the eye chromaticity and luminance go over into those of night vision between 0.01 and
    4 cd/m2, as in Jensen et al. (2001), "A Physically-Based Night Sky Model". Scotopic luminance
    follows from XYZ (Larson, Rushmeier & Piatko 1997, eq. 14), see docs/night.md.
    """
    if vision == "camera":
        return pixels
    to_rgb = rgb_from_xyz(space)
    xyz = white_luminance * (pixels.astype(np.float64) @ np.linalg.inv(to_rgb).T)
    x, y, z = np.moveaxis(xyz, -1, 0)
    luminance = np.maximum(y, 0.0)
    cones = np.clip((np.log10(np.maximum(luminance, 1e-30)) - _RODS) / (_CONES - _RODS), 0.0, 1.0)
    cones = cones * cones * (3.0 - 2.0 * cones)
    total = np.maximum(x + y + z, 1e-30)
    chroma_x = (1.0 - cones) * _NIGHT_WHITE[0] + cones * x / total
    chroma_y = (1.0 - cones) * _NIGHT_WHITE[1] + cones * y / total
    seen = (1.0 - cones) * _SCOTOPIC * scotopic_luminance(xyz) + cones * luminance
    scale = seen / np.maximum(chroma_y, 1e-6)
    looks = np.stack([chroma_x * scale, seen, (1.0 - chroma_x - chroma_y) * scale], axis=-1)
    shown: Pixels = (looks @ to_rgb.T / white_luminance).astype(np.float32)
    return shown


def scotopic_luminance(xyz: np.ndarray) -> np.ndarray:
    """Scotopic luminance of light by its XYZ, shape (...,). [cd m⁻²]"""
    x, y, z = np.moveaxis(xyz, -1, 0)
    ratio = np.clip((y + z) / np.maximum(x, 1e-30), 0.0, 10.0)
    scotopic: np.ndarray = np.maximum(y, 0.0) * np.maximum(1.33 * (1.0 + ratio) - 1.68, 0.0)
    return scotopic
