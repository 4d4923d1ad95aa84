"""Directions and the axes of pictures; +Y up, -Z north, +X east."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.angles import zenith_azimuth
from skybake.errors import InputError
from skybake.projection.cells import Array


class PictureAxes(NamedTuple):
    """Unit vectors of a picture's axes, each of shape (3,).

    Attributes
    ----------
    right, up, forward : ndarray of float64
        Where the picture's right, its top and its middle look.
    """

    right: Array
    up: Array
    forward: Array


def look_frame(azimuth: float, elevation: float) -> PictureAxes:
    """Return the axes of a picture that is held upright.

    Parameters
    ----------
    azimuth, elevation : float
        Compass bearing and height of its middle. [rad] Straight up, the bearing is that of
        the picture's bottom.
    """
    sine, cosine = math.sin(elevation), math.cos(elevation)
    east, south = math.sin(azimuth), -math.cos(azimuth)
    return PictureAxes(
        right=np.array([-south, 0.0, east]),
        up=np.array([-sine * east, cosine, -sine * south]),
        forward=np.array([cosine * east, sine, cosine * south]),
    )


def roll_frame(frame: PictureAxes, roll: float) -> PictureAxes:
    """Turn a picture about its middle.

    Parameters
    ----------
    frame : PictureAxes
        Its axes.
    roll : float
        How far the camera is turned clockwise about where it looks, so that what it shows turns
        counterclockwise. [rad]
    """
    if roll == 0.0:
        return frame
    sine, cosine = math.sin(roll), math.cos(roll)
    return PictureAxes(
        right=cosine * frame.right - sine * frame.up,
        up=cosine * frame.up + sine * frame.right,
        forward=frame.forward,
    )


def check_look(azimuth: float, elevation: float) -> None:
    """Refuse an invalid direction.

    Raises
    ------
    InputError
        If the elevation is beyond the zenith or the nadir, or a value is not finite.
    """
    if not math.isfinite(azimuth):
        raise InputError(f"look: azimuth must be finite, got {azimuth}")
    if not abs(elevation) <= math.pi / 2.0 + 1e-9:
        raise InputError(
            f"look: elevation must be from -90deg to 90deg, got {math.degrees(elevation):g}deg"
        )


def look_label(azimuth: float, elevation: float) -> str:
    """Return how file names denote a direction."""
    bearing = round(math.degrees(azimuth), 2) % 360.0
    return f"az{bearing:g}deg_el{math.degrees(elevation):g}deg"


def zenith_extent(directions: Array, across: Array, along: Array) -> Array:
    """Extent of pixels in zenith angle.

    Parameters
    ----------
    directions : ndarray of float64, shape (..., 3)
        Unit vectors of their centres.
    across, along : ndarray of float64, shape (..., 3)
        Steps to the neighbours in their row and in their column, across the line of sight. [rad]

    Returns
    -------
    ndarray of float64, shape (...)
        Height of the band of zenith angles that has the same variance as the tilted pixel. [rad]
    """
    zenith, azimuth = zenith_azimuth(directions)
    cosine = np.cos(zenith)
    downward = np.stack(
        [cosine * np.sin(azimuth), -np.sin(zenith), -cosine * np.cos(azimuth)], axis=-1
    )
    extent: Array = np.hypot((across * downward).sum(axis=-1), (along * downward).sum(axis=-1))
    return extent
