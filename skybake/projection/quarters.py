"""Discs on square maps that have folds or seams: the square is quartered where the disc is."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from skybake.projection.cells import Array

COARSEST = 0.5
"""Largest side of a part. [pixel]"""


def quarters(
    edge: int,
    directions: Callable[[Array, Array], Array],
    centre: Array,
    radius: float,
    *,
    steepest: float,
    finest: float,
) -> tuple[Array, Array, float]:
    """Parts of a square map that may hold some of a disc, each within one pixel.

    A disc on a seam is in two places of such a map, or in many. So the square is divided in
    four, and again, wherever the disc can be.

    Parameters
    ----------
    edge : int
        Width and height of the map. [pixel]
    directions : callable
        Takes columns and rows of places, in pixels, and returns unit vectors; to the right of
        the map or below it they may be those of the nearest places of the map.
    centre, radius : ndarray of float64, shape (3,), float
        Unit vector of the disc's centre, and its angular radius. [rad]
    steepest : float
        Largest change of direction with the place. [rad/pixel]
    finest : float
        Change of direction across a part below which it is not divided. [rad]

    Returns
    -------
    column, row : ndarray of float64, shape (part,)
        Centres of the parts. [pixel]
    side : float
        Their width and height. [pixel]
    """
    side = 2.0 ** math.ceil(math.log2(edge))
    column, row = np.array([0.5 * side]), np.array([0.5 * side])
    while True:
        chord = np.linalg.norm(directions(column, row) - centre, axis=-1)
        distance = 2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))
        near = distance <= radius + steepest * side * math.sqrt(0.5)
        near &= (column - 0.5 * side < edge) & (row - 0.5 * side < edge)
        column, row = column[near], row[near]
        if side <= COARSEST and steepest * side <= finest:
            return column, row, side
        side *= 0.5
        left, right = column - 0.5 * side, column + 0.5 * side
        top, bottom = row - 0.5 * side, row + 0.5 * side
        column = np.concatenate([left, right, left, right])
        row = np.concatenate([top, top, bottom, bottom])
