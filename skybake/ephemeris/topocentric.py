"""From a planet's equator to the axes of an observer on it."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def east_north_up(
    body: Array, sidereal_angle: float, latitude: float, observer: tuple[float, float]
) -> Array:
    """Return where a body is from an observer, shape (3,): toward east, north and up.

    Parameters
    ----------
    body : ndarray of float64, shape (3,)
        From the planet's centre, the third axis along the planet's. [km]
    sidereal_angle : float
        From the first axis to the observer's meridian, along the equator. [rad]
    latitude : float
        Of the observer's vertical. [rad]
    observer : tuple of 2 float
        Distances of the observer from the axis and from the plane of the equator. [km]
    """
    sine, cosine = math.sin(sidereal_angle), math.cos(sidereal_angle)
    outward = body[0] * cosine + body[1] * sine - observer[0]
    east = body[1] * cosine - body[0] * sine
    northward = body[2] - observer[1]
    return np.array(
        [
            east,
            northward * math.cos(latitude) - outward * math.sin(latitude),
            northward * math.sin(latitude) + outward * math.cos(latitude),
        ]
    )


def turn(start: Array, end: Array, vector: Array) -> Array:
    """Turn a vector by the rotation that takes one direction the shortest way to another.

    Parameters
    ----------
    start : ndarray of float64, shape (3,)
        Of any length.
    end : ndarray of float64, shape (3,)
        Unit vector, not opposite to `start`.
    vector : ndarray of float64, shape (3,)
        Keeps its length.
    """
    start = start / np.linalg.norm(start)
    axis = np.cross(start, end)
    turned: Array = (
        vector * (start @ end)
        + np.cross(axis, vector)
        + axis * (axis @ vector) / (1.0 + start @ end)
    )
    return turned
