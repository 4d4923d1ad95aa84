"""Sunlight that passes Earth to the Moon: through its air, bent and reddened, and beside it.

A ring of Earth's limb shows the Moon an image of the sun, where the air bends light toward the axis
of the shadow. Radiance does not change on the way but for what the air takes, so that the light at
a place of the Moon is the integral over the image: focusing needs no rule of its own.
"""

from __future__ import annotations

import math

import numpy as np

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.lit_moon import LitMoon
from skybake.ephemeris.moon import MEAN_RADIUS
from skybake.ephemeris.refraction import REFRACTIVITY, SCALE_HEIGHT
from skybake.optics.medium import Array
from skybake.optics.spectrum import limb_darkening
from skybake.sky.disc import fill_sight_columns
from skybake.sky.sky import Sky

EARTH_RADIUS = 6371.0
"""Mean; Earth's flattening is left out. [km]"""

CLOUD_TOP = 14.0
"""Above which clouds leave all of the limb open; below it the share falls to 0 on the ground as the
cube of the height. With this rule eclipses are as bright as most are. [km]"""

HEIGHTS = 400
ARCS = 32
SEPARATIONS = 160


class EarthShadow:
    """Shares of sunlight at places of the Moon.

    Parameters
    ----------
    sky : Sky
        Whose air is that of the limb, and whose star shines past it.
    moon : LitMoon
        Which knows where Earth is.
    """

    def __init__(self, sky: Sky, moon: LitMoon) -> None:
        if moon.earth is None or moon.sun_distance is None:
            raise ValueError("moon: must know where Earth and sun are")
        self._earth = np.array(moon.earth)
        self._sun = np.array(moon.sun) * moon.sun_distance * ASTRONOMICAL_UNIT
        self._sun_radius = math.asin(sky.star.radius / (moon.sun_distance * ASTRONOMICAL_UNIT))
        distance = float(np.linalg.norm(self._earth))
        # No air is so high that it would dim the sun farther out.
        reach = 1.02 * EARTH_RADIUS / distance + self._sun_radius
        self._separation = np.linspace(0.0, reach, SEPARATIONS)
        self._share = _shares(sky, distance, self._sun_radius, self._separation)

    def __call__(self, normals: Array) -> Array:
        """Return shares, shape (n, wavelength), at unit vectors from the Moon's centre, (n, 3)."""
        places = MEAN_RADIUS * normals
        apart = _angle(self._sun - places, self._earth - places)
        out = np.empty((apart.size, self._share.shape[1]))
        for w, column in enumerate(self._share.T):
            out[:, w] = np.exp(np.interp(apart, self._separation, np.log(column), right=0.0))
        return out


def is_reached(moon: LitMoon, sun_radius: float) -> bool:
    """Whether a part of Earth's shadow may fall on the Moon.

    Parameters
    ----------
    moon : LitMoon
        The Moon.
    sun_radius : float
        Angular radius of the sun. [rad]
    """
    if moon.earth is None or moon.sun_distance is None:
        return False
    earth = np.array(moon.earth)
    distance = float(np.linalg.norm(earth))
    apart = float(_angle(np.array(moon.sun)[None], earth[None])[0])
    return apart < (1.02 * EARTH_RADIUS + MEAN_RADIUS) / distance + sun_radius


def _shares(sky: Sky, distance: float, sun_radius: float, separation: Array) -> Array:
    """Shares where Earth's centre is so far from the sun's, shape (separation, wavelength)."""
    height, width = _heights()
    radius = (EARTH_RADIUS + height) / distance
    source = radius - _bending(height)
    passing = _passing(sky, height)
    u, v = limb_darkening(sky.star, sky.wavelengths)
    # The image in each ring: of the circle on which its light comes from, the arc on the sun.
    out = np.empty((separation.size, passing.shape[1]))
    node, weight = np.polynomial.legendre.leggauss(ARCS)
    node, weight = 0.5 * (node + 1.0), 0.5 * weight
    mean = 1.0 - u / 3.0 - v / 2.0
    scale = 2.0 * radius * width / distance / (math.pi * sun_radius**2)
    for i, apart in enumerate(separation):
        cosine = (source**2 + apart**2 - sun_radius**2) / np.where(
            np.abs(source) * apart > 0.0, 2.0 * np.abs(source) * apart, 1e-300
        )
        # Light that is bent across the axis comes from the other side.
        arc = np.arccos(np.clip(cosine, -1.0, 1.0))
        angle = arc[:, None] * node
        squared = (
            source[:, None] ** 2 + apart**2 - 2.0 * np.abs(source)[:, None] * apart * np.cos(angle)
        )
        mu = np.sqrt(np.clip(1.0 - squared / sun_radius**2, 0.0, 1.0))
        on_sun = arc * scale
        moments = [on_sun * (weight * mu**n).sum(axis=1) for n in range(3)]
        light = np.stack(moments) @ passing
        out[i] = ((1.0 - u - v) * light[0] + u * light[1] + v * light[2]) / mean
    return np.clip(out, 1e-12, 1.0)


def _heights() -> tuple[Array, Array]:
    """Heights of rings above the ground, from where little light passes to beyond the sun. [km]"""
    edge = 100.0 * np.linspace(0.0, 1.0, HEIGHTS // 2 + 1) ** 1.5
    outer = np.geomspace(100.0, 8000.0, HEIGHTS // 2 + 1)
    edge = np.concatenate([edge, outer[1:]])
    return 0.5 * (edge[1:] + edge[:-1]), np.diff(edge)


def _bending(height: Array) -> Array:
    """By how much the whole way through the air bends light. [rad]"""
    impact = EARTH_RADIUS + height
    refractivity = REFRACTIVITY * np.exp(-height / SCALE_HEIGHT)
    bending: Array = refractivity * np.sqrt(2.0 * math.pi * impact / SCALE_HEIGHT)
    return bending


def _passing(sky: Sky, height: Array) -> Array:
    """Transmittance of rays that graze at heights, shape (ring, wavelength)."""
    atmosphere = sky.skylight.atmosphere
    medium = atmosphere.medium
    out = np.ones((height.size, medium.extinction.shape[1]))
    for i, each in enumerate(height.tolist()):
        r = medium.r_bottom + each
        if r >= medium.r_top:
            break
        columns, visible = np.empty((1, medium.extinction.shape[0])), np.empty(1, np.bool_)
        fill_sight_columns(medium, atmosphere.columns, r, np.zeros(1), columns, visible)
        out[i] = np.exp(-2.0 * columns[0] @ medium.extinction)
    passing: Array = out * np.minimum(height / CLOUD_TOP, 1.0)[:, None] ** 3
    return passing


def _angle(one: Array, other: Array) -> Array:
    across = np.linalg.norm(np.cross(one, other), axis=-1)
    angle: Array = np.arctan2(across, (one * other).sum(axis=-1))
    return angle
