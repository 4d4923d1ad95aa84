"""The sunlight that the Moon reflects, and the Earth's light that it gives back."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

_TABLE = Path(__file__).parents[1] / "data" / "night" / "moon_reflectance.csv"
_FIRST_ROW = 4

SOLID_ANGLE = 6.4177e-5
"""Of the disc that reflectances belong to. [sr]"""

DISTANCE = 384_400.0
"""From which that is seen. [km]"""

LEVEL = 1.04
"""Of the Moon over the model, 3 to 5 % in the visible (Toledano et al. 2024, ACP 24, 3649)."""

LEAST_PHASE, GREATEST_PHASE = 1.55, 120.0
"""Phase angles between which the model is used. It was fitted up to 97; nearer to opposition it is
constant, and farther from it the Moon fades as a Lommel-Seeliger sphere does. [deg]"""

EARTH_ALBEDO = 0.367
"""Geometric, of Earth."""

EARTH_RADIUS = 6371.0
"""[km]"""

EARTH_BLUENESS = 0.8
"""Power of the wavelength with which Earth's albedo falls."""

REFERENCE = 550.0
"""[nm]"""

_LONGEST = 800.0
_SURGES = 4.06054, 12.8802
_WAVE = -30.5858, 16.7498
_LIBRATION = 0.00034115, -0.0013425, 0.00095906, 0.00066229


def disc_reflectance(
    phase_angle: float,
    wavelengths: Array,
    *,
    sun_longitude: float = 0.0,
    latitude: float = 0.0,
    longitude: float = 0.0,
) -> Array:
    """Reflectance of the Moon's disc: its mean radiance over that of a white one in the sun.

    Parameters
    ----------
    phase_angle : float
        Between sun and observer, from 0 to pi. [rad]
    wavelengths : ndarray of float64, shape (wavelength,)
        [nm]
    sun_longitude : float, optional
        Selenographic, positive before the Moon is full. [rad]
    latitude, longitude : float, optional
        Of the middle of the disc, which libration moves. [rad]

    Returns
    -------
    ndarray of float64, shape (wavelength,)

    Notes
    -----
    The model of Kieffer and Stone (2005), without `LEVEL`. Its bands scatter by 4 %, so that the
    logarithm is fitted by a parabola in the logarithm of the wavelength.
    """
    degrees = math.degrees(phase_angle)
    used = min(max(degrees, LEAST_PHASE), GREATEST_PHASE)
    turn = math.radians(GREATEST_PHASE)
    logarithms = _bands(
        used, max(-turn, min(turn, sun_longitude)), math.degrees(latitude), math.degrees(longitude)
    )
    nodes, _ = _model()
    parabola = np.polyfit(np.log(nodes / REFERENCE), logarithms, 2)
    reflectance: Array = np.exp(np.polyval(parabola, np.log(wavelengths / REFERENCE)))
    if degrees > GREATEST_PHASE:
        reflectance *= sphere_phase(phase_angle) / sphere_phase(turn)
    return reflectance


def moon_share(
    phase_angle: float,
    wavelengths: Array,
    distance: float,
    *,
    sun_longitude: float = 0.0,
    latitude: float = 0.0,
    longitude: float = 0.0,
) -> Array:
    """Moonlight above the atmosphere over the sunlight at the Moon, shape (wavelength,).

    Parameters
    ----------
    distance : float
        Of the Moon from the observer. [km]
    phase_angle, wavelengths, sun_longitude, latitude, longitude
        As of `disc_reflectance`.
    """
    reflectance = disc_reflectance(
        phase_angle,
        wavelengths,
        sun_longitude=sun_longitude,
        latitude=latitude,
        longitude=longitude,
    )
    share: Array = LEVEL * reflectance * SOLID_ANGLE / math.pi * (DISTANCE / distance) ** 2
    return share


def earthshine(phase_angle: float, wavelengths: Array, distance: float) -> Array:
    """Radiance of the Moon in the light of Earth, over the irradiance of sunlight.

    Parameters
    ----------
    phase_angle : float
        Of the Moon; Earth's is the rest of half a turn. [rad]
    wavelengths : ndarray of float64, shape (wavelength,)
        [nm]
    distance : float
        Between them. [km]

    Returns
    -------
    ndarray of float64, shape (wavelength,)
        At the mean albedo of the disc. [sr⁻¹]
    """
    earth = EARTH_ALBEDO * (EARTH_RADIUS / distance) ** 2 * sphere_phase(math.pi - phase_angle)
    colour = (REFERENCE / wavelengths) ** EARTH_BLUENESS
    light: Array = earth * colour * LEVEL * disc_reflectance(0.0, wavelengths) / math.pi
    return light


def sphere_phase(angle: float) -> float:
    """Light of a Lommel-Seeliger sphere at a phase angle [rad] over that at 0."""
    if angle <= 0.0:
        return 1.0
    if angle >= math.pi:
        return 0.0
    half = 0.5 * angle
    return 1.0 + math.sin(half) * math.tan(half) * math.log(math.tan(0.5 * half))


def _bands(phase: float, sun: float, latitude: float, longitude: float) -> Array:
    """Logarithms of the reflectance in the model's bands, angles but the sun's in degrees."""
    _, (a0, a1, a2, a3, b1, b2, b3, d1, d2, d3) = _model()
    g = math.radians(phase)
    c1, c2, c3, c4 = _LIBRATION
    logarithms: Array = (
        a0
        + g * (a1 + g * (a2 + g * a3))
        + sun * (b1 + sun**2 * (b2 + sun**2 * b3))
        + c1 * latitude
        + c2 * longitude
        + sun * (c3 * latitude + c4 * longitude)
        + d1 * math.exp(-phase / _SURGES[0])
        + d2 * math.exp(-phase / _SURGES[1])
        + d3 * math.cos((phase - _WAVE[0]) / _WAVE[1])
    )
    return logarithms


@cache
def _model() -> tuple[Array, Array]:
    """Wavelengths of the bands [nm] and their coefficients, shape (10, band)."""
    lines = _TABLE.read_text(encoding="utf-8").splitlines()
    table = np.array([line.split(",") for line in lines[_FIRST_ROW:]], dtype=np.float64)
    table = table[table[:, 0] < _LONGEST]
    table.flags.writeable = False
    return table[:, 0], table[:, 1:].T
