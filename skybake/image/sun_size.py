"""How large the sun's disc is drawn."""

from __future__ import annotations

import math

from skybake.errors import InputError
from skybake.image.settings import LARGEST_SUN, Lighting
from skybake.sky.drawn_disc import SOFT_PEAK

SOFTENED = 2.0
"""Least diameter of a soft disc, over that of the sun."""

SOFT_LARGEST = 50000.0
"""Largest value of a soft disc, which leaves room in a half for the sky before it."""


def drawn_radius(lighting: Lighting, true_radius: float, flux: float) -> float:
    """Angular radius of a disc that is drawn in another size, or soft. [rad]

    Parameters
    ----------
    lighting : Lighting
        Size and softness as they were asked for.
    true_radius : float
        That of the sun. [rad]
    flux : float
        The largest channel of the pixels' values times solid angles that the disc has in sum
        above the atmosphere. It does not depend on the sun's elevation, nor does the size of
        a soft disc. [sr]

    Raises
    ------
    InputError
        If no soft disc is large enough for half floats.
    """
    if lighting.sun_size is not None:
        return 0.5 * lighting.sun_size
    sine = math.sqrt(SOFT_PEAK * flux / (math.pi * SOFT_LARGEST))
    if sine > math.sin(0.5 * LARGEST_SUN):
        needed = f"{math.degrees(2.0 * math.asin(sine)):.0f}deg" if sine < 1.0 else "more than all"
        raise InputError(
            f"sun disc: a soft one must fit half floats within {math.degrees(LARGEST_SUN):g}deg, "
            f"but would need {needed}; let 1 stand for more light, or give its size"
        )
    return max(SOFTENED * true_radius, math.asin(sine))
