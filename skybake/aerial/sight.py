"""Where the pixels of a camera look, and how far each ray is in the air."""

from __future__ import annotations

import math
from typing import NamedTuple

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array
from skybake.projection.camera import Camera
from skybake.scattering.segments import SHORTEST
from skybake.sky.skylight import Skylight
from skybake.sky.source import Source
from skybake.sky.table import EDGE, horizon_angles

ABOVE, BELOW = 0, 1
"""Sides of the horizon."""

OUTSIDE = -1
"""Side of a ray that meets no air."""


class Lens(NamedTuple):
    """Pixels of a camera.

    Attributes
    ----------
    frame : ndarray of float64, shape (3, 3)
        As of `Camera`.
    left, top : float
        Of the first pixel's edges on the plane at distance 1, to the right and upward.
    width, height : float
        Of a pixel on this plane.
    """

    frame: Array
    left: float
    top: float
    width: float
    height: float


class Eye(NamedTuple):
    """An observer under a sun, as kernels take them.

    Attributes
    ----------
    radius, r_bottom, r_top : float
        Distances from the planet's centre of the observer, the ground, and the top of the air. [km]
    zenith_horizon : float
        Zenith angle of the ground's edge. [rad]
    sun_mu, sun_sine : float
        Cosine and sine of the sun's zenith angle.
    sun_x, sun_z : float
        Unit vector of its bearing on the ground.
    """

    radius: float
    r_bottom: float
    r_top: float
    zenith_horizon: float
    sun_mu: float
    sun_sine: float
    sun_x: float
    sun_z: float


def lens_of(camera: Camera, size: tuple[int, int], origin: tuple[int, int] = (0, 0)) -> Lens:
    """Return the pixels of a picture.

    Parameters
    ----------
    camera : Camera
        What it is of.
    size : tuple of int
        Width and height of what the camera shows. [pixel]
    origin : tuple of int, optional
        Column and row of the first pixel in it.
    """
    width, height = (
        2.0 * half / pixels
        for half, pixels in zip((camera.half_width, camera.half_height), size, strict=True)
    )
    left = camera.shift[0] - camera.half_width + origin[0] * width
    top = camera.shift[1] + camera.half_height - origin[1] * height
    frame = camera.frame.astype(float).copy()
    return Lens(frame, left, top, width, height)


def eye_of(skylight: Skylight, source: Source) -> Eye:
    """Return where light is looked at from, and the sun."""
    medium = skylight.atmosphere.medium
    _, horizon = horizon_angles(skylight.radius, medium.r_bottom, medium.r_top)
    return Eye(
        radius=skylight.radius,
        r_bottom=medium.r_bottom,
        r_top=medium.r_top,
        zenith_horizon=horizon,
        sun_mu=source.mu,
        sun_sine=math.cos(source.elevation),
        sun_x=math.sin(source.azimuth),
        sun_z=-math.cos(source.azimuth),
    )


@kernel
def look_through(lens, row, column, out):
    """Write the unit vector of a pixel to `out`; return how much longer rays are than depths."""
    u = lens.left + (column + 0.5) * lens.width
    v = lens.top - (row + 0.5) * lens.height
    length = math.sqrt(1.0 + u * u + v * v)
    for k in range(3):
        out[k] = (u * lens.frame[0, k] + v * lens.frame[1, k] + lens.frame[2, k]) / length
    return length


@kernel
def reach(eye, mu, is_below):
    """Distances at which a ray enters the air and leaves it or meets the ground. [km]"""
    r, along = eye.radius, -eye.radius * mu
    squared = along * along
    above_top = (r - eye.r_top) * (r + eye.r_top)
    root = math.sqrt(max(squared - above_top, 0.0))
    begin = max(along - root, 0.0) if r > eye.r_top else 0.0
    if not is_below:
        return begin, along + root
    height = (r - eye.r_bottom) * (r + eye.r_bottom)
    return begin, height / (along + math.sqrt(max(squared - height, 0.0)))


@kernel
def find_place(eye, direction, distance, out):
    """Find where the end of a ray is among all ends.

    Parameters
    ----------
    eye : Eye
        From where.
    direction : ndarray of float64, shape (3,)
        Unit vector.
    distance : float
        Of the end. [km]
    out : ndarray of float64, shape (6,)
        Receives the root of the angle from the horizon [rad^½], the azimuth from the sun [rad],
        the share of the way in the air, the way itself [km], and the cosine of the angle to
        the sun.

    Returns
    -------
    int
        `ABOVE`, `BELOW` or `OUTSIDE`.

    Notes
    -----
    An end that is below the ground of a round planet, as in a deep valley, is seen through the
    air over the lowest ground at its distance.
    """
    mu = min(max(direction[1], -1.0), 1.0)
    theta = math.acos(mu)
    sine = math.sqrt(max(1.0 - mu * mu, 0.0))
    cosine = 1.0
    if sine > 0.0:
        cosine = (direction[0] * eye.sun_x + direction[2] * eye.sun_z) / sine
    cosine = min(max(cosine, -1.0), 1.0)
    is_below = theta > eye.zenith_horizon
    r = eye.radius
    if r > eye.r_top:
        closest = r * r * (1.0 - mu * mu)
        if mu >= 0.0 or closest >= eye.r_top * eye.r_top:
            return OUTSIDE
    elif is_below:
        _, end = reach(eye, mu, True)
        if distance > end:
            height = (r - eye.r_bottom) * (r + eye.r_bottom)
            is_below = distance * distance < height
            theta = eye.zenith_horizon - EDGE
            if is_below:
                theta = math.acos(max(-(height + distance * distance) / (2.0 * r * distance), -1.0))
                theta = max(theta, eye.zenith_horizon + EDGE)
            mu, sine = math.cos(theta), math.sin(theta)
    begin, end = reach(eye, mu, is_below)
    if distance <= begin:
        return OUTSIDE
    way = max(min(distance, end) - begin, SHORTEST)
    out[0] = math.sqrt(abs(theta - eye.zenith_horizon))
    out[1] = math.acos(cosine)
    out[2] = min(way / max(end - begin, SHORTEST), 1.0)
    out[3] = way
    out[4] = min(max(mu * eye.sun_mu + sine * eye.sun_sine * cosine, -1.0), 1.0)
    return BELOW if is_below else ABOVE


@kernel
def survey(eye, lens, depth, factor, is_planar, first, last, scratch, out):
    """Find what part of directions and ways the rays of some rows take.

    Parameters
    ----------
    eye, lens : Eye, Lens
        The camera.
    depth : ndarray of float32, shape (row, column)
        Of what is seen; 0 and infinity count for nothing.
    factor : float
        Length of 1 in it. [km]
    is_planar : bool
        Whether depths are along the camera's axis rather than along rays.
    first, last : int
        Rows to look at.
    scratch : ndarray of float64, shape (9,)
        Work space.
    out : ndarray of float64, shape (row, 2, 4)
        Receives, of either side, the least and the greatest of both `find_place` values.
    """
    place, direction = scratch[:6], scratch[6:9]
    for i in range(first, last):
        for side in range(2):
            for k in range(2):
                out[i, side, 2 * k], out[i, side, 2 * k + 1] = math.inf, -math.inf
        for j in range(depth.shape[1]):
            length = look_through(lens, i, j, direction)
            distance = depth[i, j] * factor
            if is_planar:
                distance *= length
            if not 0.0 < distance < math.inf:
                continue
            side = find_place(eye, direction, distance, place)
            if side == OUTSIDE:
                continue
            out[i, side, 0] = min(out[i, side, 0], place[0])
            out[i, side, 1] = max(out[i, side, 1], place[0])
            out[i, side, 2] = min(out[i, side, 2], place[2])
            out[i, side, 3] = max(out[i, side, 3], place[2])
