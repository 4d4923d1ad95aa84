"""Lengths of a tile that computers hold exactly, and noise whose periods fit into it."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

_PARTS = 2.0**-14

_TURNS = (0.0, 0.64, 1.21)
"""Angles by which the lattices of noises are turned against each other. [rad]"""


def dyadic(length: float) -> float:
    """Return the nearest multiple of 2⁻¹⁴ km, at least one: sums of such are exact."""
    return max(round(length / _PARTS), 1) * _PARTS


def displacements(
    period: tuple[float, float], scales: list[tuple[float, float]], seed: int
) -> npt.NDArray[np.float64]:
    """Return the rows of `CloudField.displacement`.

    Parameters
    ----------
    period : tuple of float
        Of the tile along x and y. [km]
    scales : list of tuple of float
        Amplitude and period of each noise, from coarse to fine, of which as many periods as are
        whole fit into the tile. [km]
    seed : int
        Another one, other shifts.
    """
    rng = np.random.default_rng([seed, 5])
    width, height = period
    rows = np.empty((len(scales), 9))
    for row, turn, (amplitude, length) in zip(rows, _TURNS, scales, strict=False):
        cos, sin = math.cos(turn) / length, math.sin(turn) / length
        along = max(1, round(width * cos)) / width, round(height * sin) / height
        across = -round(width * sin) / width, max(1, round(height * cos)) / height
        row[:] = amplitude, *along, *across, 1.0 / length, *rng.random(3)
    return rows
