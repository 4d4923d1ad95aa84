"""The shadow of a moon: how much of the sun is uncovered, from place to place."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.eclipse.share import (
    ShareTable,
    build_share_table,
    fill_share,
    powers_from_limb_darkening,
)
from skybake.ephemeris.moon import Moon, reaches
from skybake.jit.kernel import kernel

Array = npt.NDArray[np.float64]

FAR = 1e15
"""Distance that stands for an infinite one: parallax is nanoarcseconds then. [km]"""


class Shadow(NamedTuple):
    """A moon and the sun that it covers, as kernels read them.

    Places are relative to the observer, in km: x toward the sun's bearing, y to the right of
    it, z up.

    Attributes
    ----------
    sun, moon : ndarray of float64, shape (3,)
        Where their centres are. [km]
    sun_radius, moon_radius : float
        [km]
    table : ShareTable
        Uncovered light for all ratios of the radii that are seen.
    powers : ndarray of float64, shape (POWERS, wavelength)
        Light of the sun's disc, see `powers_from_limb_darkening`.
    """

    sun: Array
    moon: Array
    sun_radius: float
    moon_radius: float
    table: ShareTable
    powers: Array


class Phase(NamedTuple):
    """What an observer sees of an eclipse.

    Attributes
    ----------
    name : {"none", "partial", "annular", "total"}
        Of its kind.
    magnitude : float
        Covered share of the sun's diameter along the line of the centres; for an annular or total
        eclipse, as almanacs have it, the moon's diameter over the sun's.
    obscuration : float
        Covered share of the area of the sun's disc.
    """

    name: str
    magnitude: float
    obscuration: float


def cast_shadow(
    moon: Moon,
    sun_azimuth: float,
    sun_elevation: float,
    sun_radius: float,
    sun_distance: float,
    limb_darkening: Array,
    reach: float,
) -> Shadow | None:
    """Return the shadow of a moon, or None where it does not reach.

    Parameters
    ----------
    moon : Moon
        What is in front of the sun.
    sun_azimuth, sun_elevation : float
        Where the observer sees the sun's centre. [rad]
    sun_radius, sun_distance : float
        Angular radius [rad] and distance [km] of the sun at the observer.
    limb_darkening : ndarray of float64, shape (2, wavelength)
        As of `powers_from_limb_darkening`.
    reach : float
        Distance of the farthest place that matters from the observer. [km]
    """
    if not reaches(moon, sun_azimuth, sun_elevation, sun_radius, sun_distance, reach):
        return None
    distance = min(moon.distance, FAR)
    moon_radius = distance * math.sin(0.5 * moon.diameter)
    sun = min(sun_distance, FAR) * _vector(0.0, sun_elevation)
    where = distance * _vector(moon.azimuth - sun_azimuth, moon.elevation)
    ratio = 0.5 * moon.diameter / sun_radius
    least = ratio * distance / (distance + reach)
    greatest = ratio * distance / max(distance - reach, 0.1 * distance)
    return Shadow(
        sun=sun,
        moon=where,
        sun_radius=min(sun_distance, FAR) * math.sin(sun_radius),
        moon_radius=moon_radius,
        table=build_share_table(0.999 * least, 1.001 * greatest),
        powers=np.ascontiguousarray(powers_from_limb_darkening(limb_darkening)),
    )


def phase_at_observer(shadow: Shadow) -> Phase:
    """Return what the observer sees."""
    apart, ratio = _discs.py_func(shadow, 0.0, 0.0, 0.0)
    uniform = np.zeros((shadow.powers.shape[0], 1))
    uniform[0] = 1.0
    share = np.empty(1)
    fill_share(shadow.table, uniform, apart, ratio, share)
    if apart >= 1.0 + ratio:
        return Phase("none", 0.0, 0.0)
    if apart > abs(1.0 - ratio):
        return Phase("partial", 0.5 * (1.0 + ratio - apart), 1.0 - float(share[0]))
    if ratio >= 1.0:
        return Phase("total", ratio, 1.0)
    return Phase("annular", ratio, 1.0 - float(share[0]))


def shares_at(shadow: Shadow, places: Array) -> Array:
    """Uncovered share of the sun's light at places, shape (..., wavelength).

    Parameters
    ----------
    shadow : Shadow
        Of the moon.
    places : ndarray of float64, shape (..., 3)
        Relative to the observer, in the axes of `Shadow`. [km]
    """
    flat = np.ascontiguousarray(places.reshape(-1, 3))
    out = np.empty((len(flat), shadow.powers.shape[1]))
    _fill_shares(shadow, flat, out)
    return out.reshape(*places.shape[:-1], -1)


def axis_on_ground(shadow: Shadow, radius: float, bottom: float) -> Array | None:
    """Where the shadow's axis meets the ground, from the planet's centre, if it does. [km]

    Parameters
    ----------
    shadow : Shadow
        Of the moon.
    radius, bottom : float
        Of the observer and of the ground. [km]
    """
    start = shadow.moon + np.array([0.0, 0.0, radius])
    along = shadow.moon - shadow.sun
    along /= np.linalg.norm(along)
    middle = -float(start @ along)
    squared = middle**2 - float(start @ start) + bottom**2
    if squared < 0.0 or middle < 0.0:
        return None
    centre: Array = start + (middle - math.sqrt(squared)) * along
    return centre


def _vector(bearing: float, elevation: float) -> Array:
    flat = math.cos(elevation)
    return np.array([flat * math.cos(bearing), flat * math.sin(bearing), math.sin(elevation)])


@kernel
def fill_share_at(shadow, x, y, z, out):
    """Write the uncovered share of the sun's light at a place, shape (wavelength,)."""
    apart, ratio = _discs(shadow, x, y, z)
    fill_share(shadow.table, shadow.powers, apart, ratio, out)


@kernel
def _discs(shadow, x, y, z):
    """Separation of the two centres and radius of the moon, over the radius of the sun."""
    sx, sy, sz = shadow.sun[0] - x, shadow.sun[1] - y, shadow.sun[2] - z
    mx, my, mz = shadow.moon[0] - x, shadow.moon[1] - y, shadow.moon[2] - z
    sun_squared = sx * sx + sy * sy + sz * sz
    moon_squared = mx * mx + my * my + mz * mz
    cx, cy, cz = sy * mz - sz * my, sz * mx - sx * mz, sx * my - sy * mx
    across = math.sqrt((cx * cx + cy * cy + cz * cz) / (sun_squared * moon_squared))
    along = sx * mx + sy * my + sz * mz
    apart = math.asin(min(across, 1.0))
    if along < 0.0:
        apart = math.pi - apart
    sun = math.asin(min(shadow.sun_radius / math.sqrt(sun_squared), 1.0))
    moon = math.asin(min(shadow.moon_radius / math.sqrt(moon_squared), 1.0))
    return apart / sun, moon / sun


@kernel
def _fill_shares(shadow, places, out):
    for i in range(places.shape[0]):
        fill_share_at(shadow, places[i, 0], places[i, 1], places[i, 2], out[i])
