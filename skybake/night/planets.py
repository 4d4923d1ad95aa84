"""The light of planets and small moons: points, or discs that consist of points."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.place import GROUND_RADII
from skybake.ephemeris.planets import Body, bodies_over
from skybake.optics.medium import Array

_TABLE = Path(__file__).parents[1] / "data" / "night" / "planets.csv"
_FIRST_ROW = 4

DISC_POINTS = 400
"""Points of which the disc of a moon consists; those of Phobos are 0.6 arcmin apart."""

POLE_OF_SATURN = math.radians(40.589), math.radians(83.537)
"""Right ascension and declination (Archinal et al. 2018). [rad]"""

SUN_RADIUS = 695700.0
"""[km]"""

MARS_FROM_50 = (-0.367, -0.02573, 3.445e-4)
VENUS_FROM_163_7 = (236.05828, -2.81914, 8.39034e-3)
"""Polynomials of Mallama & Hilton (2018) beyond these phase angles."""


class Points(NamedTuple):
    """Light from directions.

    Attributes
    ----------
    vectors : ndarray of float64, shape (n, 3)
        Unit vectors in the axes of maps, without refraction.
    v, b_v : ndarray of float64, shape (n,)
        Magnitude and colour of each point. [mag]
    """

    vectors: Array
    v: Array
    b_v: Array


def planet_points(frame: CelestialFrame, altitude: float, faintest: float) -> Points:
    """Return the planets and small moons over an observer.

    Parameters
    ----------
    frame : CelestialFrame
        How the sky stands.
    altitude : float
        Of the observer. [km]
    faintest : float
        Magnitude V up to which they are shown. [mag]
    """
    found = [
        _points_of(body, frame)
        for body in bodies_over(frame, altitude)
        if magnitude(body) <= faintest
    ]
    empty = Points(np.zeros((0, 3)), np.zeros(0), np.zeros(0))
    return Points(*(np.concatenate(parts) for parts in zip(empty, *found, strict=True)))


def magnitude(body: Body) -> float:
    """V of a body, outside the shadow of others. [mag]"""
    away, from_sun = float(np.linalg.norm(body.vector)), float(np.linalg.norm(body.sun))
    phase = phase_angle(body)
    coefficients, _ = _light(body.name)
    if body.name == "mars" and phase > 50.0:
        coefficients = MARS_FROM_50
    if body.name == "venus" and phase > 163.7:
        coefficients = VENUS_FROM_163_7
    v = math.fsum(each * phase**power for power, each in enumerate(coefficients))
    if body.name == "saturn":
        tilt = _ring_tilt(body.vector)
        v -= 1.825 * tilt + 0.378 * tilt * math.exp(-2.25 * phase)
    return v + 5.0 * math.log10(away * from_sun / ASTRONOMICAL_UNIT**2)


def phase_angle(body: Body) -> float:
    """Angle at a body between the sun and the observer. [deg]"""
    cosine = -float(body.vector @ body.sun)
    cosine /= float(np.linalg.norm(body.vector) * np.linalg.norm(body.sun))
    return math.degrees(math.acos(min(max(cosine, -1.0), 1.0)))


def sunlit_share(place: Array, to_sun: Array, radius: float) -> Array:
    """Share of the sun that a planet leaves uncovered at places behind it.

    Parameters
    ----------
    place, to_sun : ndarray of float64, shapes (n, 3) and (3,)
        From the planet's centre. [km]
    radius : float
        Of the planet. [km]
    """
    distance = float(np.linalg.norm(to_sun))
    sunward = to_sun / distance
    along = place @ sunward
    beside = np.linalg.norm(place - along[:, None] * sunward, axis=1)
    # The sun's disc makes the shadow's edge as wide as this, to either side.
    half = np.maximum(np.abs(along) * SUN_RADIUS / distance, 1e-9)
    share = np.clip((beside - radius + half) / (2.0 * half), 0.0, 1.0)
    return np.where(along < 0.0, share, 1.0)


def _points_of(body: Body, frame: CelestialFrame) -> Points:
    v, (_, b_v) = magnitude(body), _light(body.name)
    if body.radius == 0.0:
        return Points(frame.seen(body.vector[None]), np.array([v]), np.array([b_v]))
    offsets, share = _disc(body)
    lit = share * sunlit_share(body.centre + offsets, body.sun, GROUND_RADII[frame.planet])
    is_lit = lit > 0.0
    vectors = frame.seen(body.vector + offsets[is_lit])
    return Points(vectors, v - 2.5 * np.log10(lit[is_lit]), np.full(len(vectors), b_v))


def _disc(body: Body) -> tuple[Array, Array]:
    """Points of a disc from its centre [km], and their shares of its light.

    Notes
    -----
    Of a ball whose surface scatters as Lommel and Seeliger have it, as that of the Moon does.
    """
    toward = -body.vector / np.linalg.norm(body.vector)
    sun = body.sun / np.linalg.norm(body.sun)
    across = np.cross(toward, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    up = np.cross(across, toward)
    # Evenly over the disc, as seeds of a sunflower.
    step = np.arange(DISC_POINTS) + 0.5
    radius, turn = np.sqrt(step / DISC_POINTS), step * math.pi * (3.0 - math.sqrt(5.0))
    x, y = radius * np.cos(turn), radius * np.sin(turn)
    height = np.sqrt(1.0 - radius**2)
    normal = x[:, None] * across + y[:, None] * up + height[:, None] * toward
    of_sun = np.maximum(normal @ sun, 0.0)
    share = of_sun / (of_sun + height)
    total = float(share.sum())
    return body.radius * normal, share / total if total > 0.0 else share


def _ring_tilt(vector: Array) -> float:
    """Sine of the angle between the rings of Saturn and the direction to the observer."""
    right, up = POLE_OF_SATURN
    pole = np.array([math.cos(up) * math.cos(right), math.cos(up) * math.sin(right), math.sin(up)])
    return abs(float(pole @ vector)) / float(np.linalg.norm(vector))


@cache
def _light(name: str) -> tuple[tuple[float, ...], float]:
    """Coefficients of V by the phase angle in degrees, and B-V. [mag]"""
    for line in _TABLE.read_text(encoding="utf-8").splitlines()[_FIRST_ROW:]:
        body, *numbers = line.split(",")
        if body == name:
            *coefficients, b_v = map(float, numbers)
            return tuple(coefficients), b_v
    raise KeyError(name)
