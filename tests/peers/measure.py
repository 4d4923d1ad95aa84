"""What is measured of the views that a program rendered."""

import math
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from tests.peers.scenes import ALBEDO, BALL, POLE, POLE_HEIGHT, POLE_RADIUS, ball_normals, grid

BLOCK = 8
"""Pixels of a sphere's view across a block, over which the noise of a path tracer is averaged."""

RIM = 0.9
SHADOW_SHARE = 1e-3
"""Of the view of the pole, at most as much as surely lies in its shadow."""

SUN_IN_MIRROR = math.cos(math.radians(6.0))


class Check(NamedTuple):
    """One measurement.

    Attributes
    ----------
    what : str
        Of what.
    value, limit : float
        Its error, and how large that may be.
    unit : str
        Of both, ``%`` or ``deg``.
    """

    what: str
    value: float
    limit: float
    unit: str

    @property
    def is_met(self):
        """Whether the error is within the limit; NaN is not."""
        return self.value <= self.limit


def measure(views, sky):
    """Return the checks of all views.

    Parameters
    ----------
    views : Views
        As rendered.
    sky : Sky
        By which they are judged.
    """
    azimuth, elevation = shadow_angles(views.pole)
    whole, block = sphere_errors(views.sphere, sky)
    right, up, back = sky.sun
    true_azimuth = math.degrees(math.atan2(right, -back))
    true_elevation = math.degrees(math.asin(up))
    return [
        Check("level of a plane", plane_error(views.plane, sky), 1.0, "%"),
        Check("level of a sphere", whole, 1.0, "%"),
        Check("worst block of the sphere", block, 3.0, "%"),
        Check(
            "bearing of a shadow",
            abs(math.remainder(azimuth - true_azimuth, 360.0)),
            0.5,
            "deg",
        ),
        Check("elevation by its length", abs(elevation - true_elevation), 0.5, "deg"),
        Check("median of a mirror", mirror_error(views.mirror, sky), 3.0, "%"),
    ]


def plane_error(pixels, sky):
    """Largest error of a channel of the mean. [%]"""
    (irradiance,) = sky.irradiance(np.array([[0.0, 1.0, 0.0]]), above_plane=True)
    level = pixels.mean(axis=(0, 1)) / (irradiance * ALBEDO / math.pi)
    return float(100.0 * np.abs(level - 1.0).max())


def sphere_errors(pixels, sky):
    """Largest error of a channel of the mean, and of the mean of a block. [%]"""
    normals = _blocks(ball_normals())
    inside = np.isfinite(normals).all(axis=(1, 2))
    inside[inside] = np.hypot(normals[inside, :, 0], normals[inside, :, 1]).max(axis=1) < RIM
    facing = normals[inside]
    irradiance = sky.irradiance(facing.reshape(-1, 3)).reshape(facing.shape).mean(axis=1)
    expected = irradiance * ALBEDO / math.pi
    got = _blocks(pixels)[inside].mean(axis=1)
    whole, block = got.mean(axis=0) / expected.mean(axis=0), got / expected
    return tuple(float(100.0 * np.abs(ratio - 1.0).max()) for ratio in (whole, block))


def mirror_error(pixels, sky):
    """Median error of what a mirror shows, apart from the sun. [%]"""
    normals = ball_normals()
    inside = np.hypot(normals[..., 0], normals[..., 1]) < RIM
    facing = normals[inside]
    # A ray to the north, mirrored.
    ray = np.array([0.0, 0.0, -1.0])
    seen = ray - 2.0 * (facing @ ray)[:, None] * facing
    away = seen @ sky.sun < SUN_IN_MIRROR
    expected, got = sky.seen(seen[away]), pixels[inside][away]
    return float(100.0 * np.median(np.abs(got / expected - 1.0).max(axis=-1)))


def shadow_angles(pixels):
    """Bearing and elevation of the light by the shadow of the pole. [deg]"""
    right, up = grid(*POLE)
    brightness = pixels.sum(axis=-1)
    beside = np.hypot(right, up) > 5.0 * POLE_RADIUS
    lit = np.median(brightness[beside])
    darkness = np.where(beside, 1.0 - brightness / lit, 0.0)
    # Half of what is taken from the light where it is darkest, and no speck of noise.
    deep = darkness > 0.5 * np.quantile(darkness, 1.0 - SHADOW_SHARE)
    parts, _ = ndimage.label(deep, structure=np.ones((3, 3)))
    share = (parts == np.argmax(np.bincount(parts.ravel())[1:]) + 1).astype(float)
    x, y = (share * right).sum(), (share * up).sum()
    bearing = math.atan2(-x, -y)
    along = -(right * math.sin(bearing) + up * math.cos(bearing))
    length = 2.0 * (share * along).sum() / share.sum() - 5.0 * POLE_RADIUS
    return math.degrees(bearing) % 360.0, math.degrees(math.atan2(POLE_HEIGHT, length))


def _blocks(pixels):
    """Values by blocks, shape (block, pixel, 3)."""
    count = BALL[1] // BLOCK
    return (
        pixels.reshape(count, BLOCK, count, BLOCK, 3)
        .swapaxes(1, 2)
        .reshape(count * count, BLOCK * BLOCK, 3)
    )
