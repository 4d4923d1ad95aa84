"""The sky around one observer as a table.

The table holds, for directions around the observer, the RGB that each curve of a
basis of phase functions multiplies. What it interpolates is therefore smooth even
where a phase function has a peak; the peak is applied per pixel. Directions
are split at the planet's horizon and, seen from space, at the top of the
atmosphere, and nothing is interpolated across these edges.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array
from skybake.scattering.grid import ORDER

Table = npt.NDArray[np.float32]

LATITUDES = 120
LATITUDES_FROM_SPACE = 180
AZIMUTHS = 97
AZIMUTHS_FROM_SPACE = 121
AZIMUTHS_FROM_SPACE_AUREOLE = 201
"""Around the terminator, where they crowd, fewer would do; the aureole is elsewhere."""

RAY_AZIMUTHS = ORDER + 3
"""Azimuths of rays where the observer sees no twilight: the diffuse field has orders m up to
`ORDER`, and what the sun alone lights is smoother."""

RAY_AZIMUTHS_AUREOLE = 65
"""Of a medium with an aureole, which has more orders than the diffuse field."""
RAY_AZIMUTHS_TWILIGHT = 49
TWILIGHT_ELEVATION = math.radians(2.0)
HIGH_DIP = math.radians(4.0)
"""Dip of the horizon beyond which the planet's shadow shows an edge too sharp for few azimuths."""

DUSK = -0.03
"""Cosine of the sun's zenith angle, where a ray from space ends, at which nodes are densest:
just behind the terminator."""

DUSK_WIDTH = 0.04
LEAST_RANGE = 1e-6
"""Half range of the sun's cosine below which all azimuths see the same sun."""

EDGE = 1e-7
"""Angle by which the tables stay away from the horizon itself. [rad]"""


class FoldedTable(NamedTuple):
    """The light of one source around one observer, folded into a colour space.

    Attributes
    ----------
    zenith_first : float
        Zenith angle at which the atmosphere begins: 0 inside it, beyond 0 from space. [rad]
    zenith_horizon : float
        Zenith angle of the planet's horizon. [rad]
    source_zenith : float
        Zenith angle of the source. [rad]
    values : ndarray of float32, shape (2, latitude, azimuth * 3 * curve)
        Above the horizon and below it; azimuths of `table_directions`, from the source's
        to the opposite one; R, G and B, each with a value for every curve.
    curves : ndarray of float32, shape (SCATTERING_ANGLES, curve)
        The basis of phase functions over the scattering angle.
    is_linear : bool
        Whether pixels are linear between nodes, which adds no swing to a sharp edge, or cubic.
    """

    zenith_first: float
    zenith_horizon: float
    source_zenith: float
    values: Table
    curves: Table
    is_linear: bool


def horizon_angles(r: float, r_bottom: float, r_top: float) -> tuple[float, float]:
    """Zenith angles at which the atmosphere begins and at which the ground begins. [rad]"""
    first = math.pi - math.asin(r_top / r) if r > r_top else 0.0
    return first, math.pi - math.asin(min(1.0, r_bottom / r))


def ray_azimuths(sun_elevation: float, zenith_horizon: float, *, has_aureole: bool = False) -> int:
    """How many azimuths of rays determine those of a table inside the atmosphere."""
    dip = zenith_horizon - math.pi / 2.0
    least = RAY_AZIMUTHS_AUREOLE if has_aureole else RAY_AZIMUTHS
    if sun_elevation > TWILIGHT_ELEVATION + dip:
        return least
    return max(least, RAY_AZIMUTHS_TWILIGHT if dip < HIGH_DIP else AZIMUTHS)


def table_directions(
    sun_zenith: float, zenith_first: float, zenith_horizon: float, azimuths: int
) -> tuple[Array, Array]:
    """Zenith angles and azimuths of the nodes, (2, latitude) and (2, latitude, azimuths). [rad]

    Notes
    -----
    Latitudes crowd quadratically toward the horizon from both sides. Azimuths are
    equally far apart, but from space, where the terminator runs across them: there
    they are equally far apart in `dusk_coordinate`.
    """
    latitudes = LATITUDES_FROM_SPACE if zenith_first > 0.0 else LATITUDES
    x = np.linspace(0.0, 1.0, latitudes)
    above = zenith_horizon - (zenith_horizon - zenith_first) * (1.0 - x) ** 2
    below = zenith_horizon + (math.pi - zenith_horizon) * x**2
    above = np.minimum(above, zenith_horizon - EDGE)
    below = np.maximum(below, zenith_horizon + EDGE)
    zenith = np.stack([above, below])
    azimuth = np.broadcast_to(np.linspace(0.0, math.pi, azimuths), (*zenith.shape, azimuths))
    if zenith_first > 0.0:
        azimuth = _dusk_azimuths(sun_zenith, zenith_horizon, zenith, azimuths)
    return zenith, azimuth


def _dusk_azimuths(sun_zenith: float, zenith_horizon: float, zenith: Array, azimuths: int) -> Array:
    """Azimuths that are equally far apart in `dusk_coordinate` at each zenith angle."""
    x = np.linspace(0.0, 1.0, azimuths)
    azimuth = np.empty((*zenith.shape, azimuths))
    for node in np.ndindex(zenith.shape):
        middle, half = sun_range.py_func(sun_zenith, zenith_horizon, zenith[node])
        if half < LEAST_RANGE:
            cosine = 1.0 - 2.0 * x
        else:
            first, last = (math.asinh((middle + s * half - DUSK) / DUSK_WIDTH) for s in (1.0, -1.0))
            mu_s = DUSK + DUSK_WIDTH * np.sinh(first + (last - first) * x)
            cosine = (mu_s - middle) / half
        azimuth[node] = np.arccos(np.clip(cosine, -1.0, 1.0))
    return azimuth


@kernel
def sun_range(sun_zenith, zenith_horizon, zenith):
    """Cosine of the sun's zenith angle where rays of a zenith angle end: middle and half range.

    At the azimuth phi from the sun it is middle + half * cos(phi). A ray ends on
    the ground, or at its point closest to the planet.
    """
    sine, cosine = math.sin(zenith), math.cos(zenith)
    planet = math.sin(zenith_horizon)
    along, across = sine, -cosine
    if zenith > zenith_horizon:
        # In units of the planet's radius: the distance to the ground and where it is.
        t = -cosine / planet - math.sqrt(max(1.0 - (sine / planet) ** 2, 0.0))
        along, across = 1.0 / planet + t * cosine, t * sine
    return math.cos(sun_zenith) * along, math.sin(sun_zenith) * across


@kernel
def dusk_coordinate(middle, half, cosine):
    """Share of the way from the sun's azimuth to the opposite one, stretched at the terminator."""
    if half < LEAST_RANGE:
        return 0.5 * (1.0 - cosine)
    first = math.asinh((middle + half - DUSK) / DUSK_WIDTH)
    last = math.asinh((middle - half - DUSK) / DUSK_WIDTH)
    here = math.asinh((middle + half * cosine - DUSK) / DUSK_WIDTH)
    return (first - here) / (first - last)
