"""A moon in front of the sun, which each vertex of a path sees from where it is."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel

RINGS = 400
"""Rings of equal area that the sun's disc is cut into."""


class Occultation(NamedTuple):
    """A sun and a moon, as kernels read them.

    Attributes
    ----------
    sun, moon : ndarray of float64, shape (3,)
        Where their centres are from the observer, +Z up and the sun's azimuth along +X. [km]
    sun_radius, moon_radius : float
        A moon of radius 0 covers nothing. [km]
    u, v : float
        Limb darkening I(mu)/I(1) = 1 - u (1 - mu) - v (1 - mu²).
    """

    sun: npt.NDArray[np.float64]
    moon: npt.NDArray[np.float64]
    sun_radius: float
    moon_radius: float
    u: float
    v: float


def no_occultation() -> Occultation:
    """Return a sun with nothing in front."""
    return Occultation(np.array([1e9, 0.0, 0.0]), np.array([1e6, 0.0, 0.0]), 1.0, 0.0, 0.0, 0.0)


@kernel
def uncovered_share(occultation, x, y, z):
    """Share of the sun's light that passes the moon to a place, relative to the observer.

    By the midpoint rule over rings of the sun's disc, of each of which the moon covers an arc.
    """
    if occultation.moon_radius == 0.0:
        return 1.0
    sx, sy, sz = occultation.sun[0] - x, occultation.sun[1] - y, occultation.sun[2] - z
    mx, my, mz = occultation.moon[0] - x, occultation.moon[1] - y, occultation.moon[2] - z
    far, near = math.sqrt(sx * sx + sy * sy + sz * sz), math.sqrt(mx * mx + my * my + mz * mz)
    # Half of the chord between the two directions is the sine of half their angle.
    dx, dy, dz = sx / far - mx / near, sy / far - my / near, sz / far - mz / near
    apart = 2.0 * math.asin(min(0.5 * math.sqrt(dx * dx + dy * dy + dz * dz), 1.0))
    sun = math.asin(occultation.sun_radius / far)
    apart /= sun
    moon = math.asin(min(occultation.moon_radius / near, 1.0)) / sun
    if apart >= 1.0 + moon:
        return 1.0
    if apart + 1.0 <= moon:
        return 0.0
    light = total = 0.0
    for i in range(RINGS):
        squared = (i + 0.5) / RINGS
        radius = math.sqrt(squared)
        mu = math.sqrt(1.0 - squared)
        radiance = 1.0 - occultation.u * (1.0 - mu) - occultation.v * (1.0 - mu * mu)
        covered = 0.0
        if apart <= 0.0 or radius <= 0.0:
            covered = 1.0 if moon > radius else 0.0
        else:
            cosine = (squared + apart * apart - moon * moon) / (2.0 * radius * apart)
            covered = math.acos(min(max(cosine, -1.0), 1.0)) / math.pi
        light += radiance * (1.0 - covered)
        total += radiance
    return light / total
