"""Radiances beside the tables of data/reference: what counts, and how far it is off."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from skybake.angles import cosine_between
from skybake.sky.skylight import Skylight
from tests.skies import truth_skylight, view_cosines
from tests.truth import TRUTH_WAVELENGTHS, load_truth, truth_medium

FAINTEST = 1e-3
"""Share of the brightest row of an altitude and sun below which rows do not count."""
NOISIEST = 0.05
"""Relative standard error of the tables beyond which rows do not count."""


class Comparison(NamedTuple):
    """Rows of one table, and the relative errors of a method at them.

    Attributes
    ----------
    rows : structured ndarray, shape (row,)
        As of `tests.truth.load_truth`, those that count.
    error : ndarray of float64, shape (row,)
        Radiance over the table's, less 1.
    noise : ndarray of float64, shape (row,)
        Standard error of the table over its radiance.
    """

    rows: np.ndarray
    error: np.ndarray
    noise: np.ndarray

    @property
    def rms(self) -> float:
        """Root mean square error, less what the table's own noise adds to it."""
        return math.sqrt(max(0.0, np.mean(self.error**2 - self.noise**2)))

    def where(self, mask: np.ndarray) -> Comparison:
        """Only the rows that a mask of shape (row,) selects."""
        return Comparison(self.rows[mask], self.error[mask], self.noise[mask])


def join(parts: Sequence[Comparison]) -> Comparison:
    """All rows of several comparisons."""
    return Comparison(*map(np.concatenate, zip(*parts, strict=True)))


def counted(rows: np.ndarray, column: str = "radiance") -> np.ndarray:
    """Rows of one altitude and sun that are bright and certain enough to count."""
    bright = rows[column] > FAINTEST * rows[column].max()
    return rows[bright & (rows["stderr"] < NOISIEST * rows["radiance"])]


def horizon_distance(name: str, rows: np.ndarray) -> np.ndarray:
    """Angle between views and the horizon. [deg]"""
    radius = truth_medium(name).r_bottom
    horizon = 180.0 - np.degrees(np.arcsin(radius / (radius + rows["altitude_km"])))
    return np.abs(rows["view_zenith_deg"] - horizon)


def sun_distance(rows: np.ndarray) -> np.ndarray:
    """Angle between views and the sun. [deg]"""
    sun, view = np.radians(rows["sun_elevation_deg"]), np.radians(rows["view_zenith_deg"])
    azimuth = np.radians(rows["relative_azimuth_deg"])
    cosine = cosine_between(np.cos(view), np.sin(view), np.sin(sun), np.cos(sun), azimuth)
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))


def rows_at(table: np.ndarray, altitude: float, elevation: float) -> np.ndarray:
    """Rows of one altitude [km] and sun elevation [deg]."""
    return table[(table["altitude_km"] == altitude) & (table["sun_elevation_deg"] == elevation)]


def places(table: np.ndarray) -> list[tuple[float, float]]:
    """Altitudes [km] and sun elevations [deg] of a table, the highest sun first."""
    pairs = {(row["altitude_km"], row["sun_elevation_deg"]) for row in table}
    return sorted(pairs, key=lambda pair: (pair[0], -pair[1]))


def radiance_at(sky: Skylight, rows: np.ndarray) -> np.ndarray:
    """Radiance by a sky's only source at rows of its altitude and sun, per irradiance. [sr^-1]"""
    (source,) = sky.sources
    mu, nu = view_cosines(
        rows["view_zenith_deg"], rows["relative_azimuth_deg"], math.degrees(source.elevation)
    )
    directions, which = np.unique(np.stack([mu, nu], axis=1), axis=0, return_inverse=True)
    band = np.abs(TRUTH_WAVELENGTHS - rows["wavelength_nm"][:, None]).argmin(axis=1)
    return sky.radiance_per_irradiance(source, *directions.T)[which.ravel(), band]


def compare(
    name: str, method: str, altitudes: tuple[float, ...], suns: tuple[float, ...]
) -> Comparison:
    """Compare a method with the table of an atmosphere at those of its altitudes and suns."""
    return join(
        [
            compare_place(name, method, altitude, elevation)
            for altitude, elevation in places(load_truth(name))
            if altitude in altitudes and elevation in suns
        ]
    )


def compare_place(name: str, method: str, altitude: float, elevation: float) -> Comparison:
    """Compare a method with the table of an atmosphere at one altitude and sun."""
    rows = counted(rows_at(load_truth(name), altitude, elevation))
    radiance = radiance_at(truth_skylight(name, elevation, altitude, method), rows)
    return Comparison(rows, radiance / rows["radiance"] - 1.0, rows["stderr"] / rows["radiance"])
