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
    period: float, scales: list[tuple[float, float]], seed: int
) -> npt.NDArray[np.float64]:
    """Return the rows of `CloudField.displacement`.

    Parameters
    ----------
    period : float
        Of the square tile. [km]
    scales : list of tuple of float
        Amplitude and period of each noise, from coarse to fine. [km]
    seed : int
        Another one, other shifts.
    """
    rng = np.random.default_rng([seed, 5])
    rows = []
    for turn, (amplitude, length) in zip(_TURNS, scales, strict=False):
        along = max(1, round(period / length * math.cos(turn)))
        across = round(period / length * math.sin(turn))
        rows.append([amplitude, along, across, period / math.hypot(along, across), *rng.random(3)])
    return np.array(rows).reshape(-1, 7)
