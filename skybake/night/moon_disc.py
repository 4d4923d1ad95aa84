"""The Moon's disc: its phase, its maria, Earth's light on it, and Earth's shadow."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.angles import direction_from_angles
from skybake.ephemeris.lit_moon import LitMoon
from skybake.night.moon_albedo import mean_albedo, moon_albedo
from skybake.optics.medium import Array

Share = Callable[[Array], Array]
"""Shares of the sunlight that pass Earth, shape (n, wavelength), at unit vectors of places on the
Moon from its centre, shape (n, 3)."""

NODES = 48
"""In each of two angles, for integrals over the lit side."""

SIDE, SIDE_OF_CRESCENT = 2, 4
"""Places along the side of a cell that are looked at, if cells are not many."""

CRESCENT = math.radians(135.0)
"""Phase angle from which on the lit side is a few cells wide."""

SAMPLES = 400_000
"""Most places of the disc that are looked at, but for one to a cell."""


class DiscLight(NamedTuple):
    """Light of places of the disc, before the air.

    Attributes
    ----------
    sunlit : ndarray of float64, shape (n, wavelength) or (n, 1)
        Radiance over the irradiance of the uneclipsed Moon; without an eclipse its integral over
        the disc is 1. [sr⁻¹]
    albedo : ndarray of float64, shape (n,)
        Over the disc's mean, which is that of Earth's light on it too.
    """

    sunlit: Array
    albedo: Array


class MoonDisc:
    """What a place of the Moon's disc looks like.

    The side in the sun reflects by the law of Lommel and Seeliger, so that a full moon is as bright
    at its edge as in its middle.

    Parameters
    ----------
    moon : LitMoon
        The Moon.
    share : callable, optional
        What an eclipse leaves of the sunlight, see `Share`.

    Attributes
    ----------
    eclipsed_share : ndarray of float64, shape (wavelength,) or (1,)
        Share of the whole disc's light that an eclipse leaves.
    """

    def __init__(self, moon: LitMoon, share: Share | None = None) -> None:
        self._moon, self._share = moon, share
        self._centre = np.array(moon.direction)
        self._sun = np.array(moon.sun)
        pole, meridian = np.array(moon.pole), np.array(moon.meridian)
        self._axes = np.stack([meridian, np.cross(pole, meridian), pole])
        self._mean_albedo = mean_albedo(*moon.sub_observer)
        self._whole, self.eclipsed_share = self._integrals()

    def light(self, zenith: Array, azimuth: Array, distance: Array, extent: Array) -> DiscLight:
        """Return the mean light of cells of the disc.

        Parameters
        ----------
        zenith, azimuth : ndarray of float64, shape (n,)
            Compass bearings, and zenith angles of the cells' centres. [rad]
        distance : ndarray of float64, shape (n,)
            Of what the disc covers of them, from its centre. [rad]
        extent : ndarray of float64, shape (n,)
            Their widths. [rad]
        """
        side = SIDE_OF_CRESCENT if self._moon.phase_angle > CRESCENT else SIDE
        count = min(max(int(math.sqrt(SAMPLES / max(zenith.size, 1))), 1), side)
        across = (np.arange(count) + 0.5) / count - 0.5
        down, along = (each.ravel() for each in np.meshgrid(across, across, indexing="ij"))
        x, y = self._in_plane(zenith, azimuth, distance)
        # Offsets from the middle of what is covered; those beyond the edge do not count.
        step = extent / math.sin(self._moon.angular_radius)
        x, y = x[:, None] + step[:, None] * along, y[:, None] + step[:, None] * down
        inside = x**2 + y**2 < 1.0
        centred = np.zeros(count * count, bool)
        centred[count * count // 2] = True
        used = np.where(inside.any(axis=1, keepdims=True), inside, centred)
        weight = used / used.sum(axis=1, keepdims=True)
        normals = self._normals(x[used], y[used])
        sunlit, albedo = self._at(normals)
        rows = np.nonzero(used)[0]
        return DiscLight(
            _sum_by(rows, weight[used][:, None] * sunlit, zenith.size),
            _sum_by(rows, (weight[used] * albedo)[:, None], zenith.size)[:, 0],
        )

    def _in_plane(self, zenith: Array, azimuth: Array, distance: Array) -> tuple[Array, Array]:
        """Places on the disc to the right and up, over its radius."""
        vectors = direction_from_angles(azimuth, math.pi / 2.0 - zenith)
        right, up = self._frame()
        x, y = vectors @ right, vectors @ up
        off = np.hypot(x, y)
        scale = np.sin(distance) / math.sin(self._moon.angular_radius) / np.maximum(off, 1e-300)
        return x * scale, y * scale

    def _frame(self) -> tuple[Array, Array]:
        """Return unit vectors to the right and up as the observer sees the disc."""
        azimuth, elevation = self._moon.azimuth, self._moon.elevation
        right = np.array([math.cos(azimuth), 0.0, math.sin(azimuth)])
        flat = math.sin(elevation)
        up = np.array([-flat * math.sin(azimuth), math.cos(elevation), flat * math.cos(azimuth)])
        return right, up

    def _normals(self, x: Array, y: Array) -> Array:
        right, up = self._frame()
        toward = np.sqrt(np.maximum(1.0 - x**2 - y**2, 0.0))
        normals: Array = x[:, None] * right + y[:, None] * up - toward[:, None] * self._centre
        return normals

    def _at(self, normals: Array) -> tuple[Array, Array]:
        """Light of places by their unit vectors from the Moon's centre, as of `DiscLight`."""
        albedo = self._albedo(normals)
        incident = np.maximum(normals @ self._sun, 0.0)
        leaving = np.maximum(-(normals @ self._centre), 0.0)
        total = incident + leaving
        lit = albedo * np.divide(incident, total, out=np.zeros_like(total), where=total > 0.0)
        sunlit = (lit / self._whole)[:, None]
        if self._share is not None:
            sunlit = sunlit * self._share(normals)
        return sunlit, albedo

    def _albedo(self, normals: Array) -> Array:
        x, y, z = (normals @ self._axes.T).T
        return moon_albedo(np.arctan2(y, x), np.arcsin(np.clip(z, -1.0, 1.0))) / self._mean_albedo

    def _integrals(self) -> tuple[float, Array]:
        """Integral of the unscaled light over the disc [sr], and what an eclipse leaves of it.

        In longitude and latitude from the plane of sun and observer, in which the lit side has no
        edges within.
        """
        phase = self._moon.phase_angle
        toward = -self._centre
        beside = self._sun - (self._sun @ toward) * toward
        length = float(np.linalg.norm(beside))
        beside = self._frame()[0] if length < 1e-9 else beside / length
        node, weight = np.polynomial.legendre.leggauss(NODES)
        half = 0.5 * (math.pi - phase)
        omega, width = phase - 0.5 * math.pi + half * (node + 1.0), half * weight
        latitude, height = 0.5 * math.pi * node, 0.5 * math.pi * weight
        leaving, incident = np.cos(omega), np.cos(omega - phase)
        total = incident + leaving
        # A new moon has no lit side.
        law = leaving * incident / np.where(total > 0.0, total, 1.0)
        light = (law * width)[:, None] * np.cos(latitude) ** 2 * height
        flat = np.cos(latitude)
        normals = (
            (np.cos(omega)[:, None] * flat)[..., None] * toward
            + (np.sin(omega)[:, None] * flat)[..., None] * beside
            + np.broadcast_to(np.sin(latitude), light.shape)[..., None] * np.cross(toward, beside)
        ).reshape(-1, 3)
        flux = light.ravel() * self._albedo(normals)
        whole = max(float(flux.sum()), 1e-12)
        left = np.ones(1)
        if self._share is not None:
            left = flux @ self._share(normals) / whole
        return whole * math.sin(self._moon.angular_radius) ** 2, left


def _sum_by(rows: npt.NDArray[np.int64], values: Array, count: int) -> Array:
    """Add up values by the rows that they belong to, shape (count, column)."""
    columns = [np.bincount(rows, column, minlength=count) for column in values.T]
    return np.stack(columns, axis=1)
