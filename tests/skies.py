"""Skies of the atmospheres that the reference tables were computed for."""

import functools
import math

import numpy as np

from skybake.sky.sky import Sky
from tests.truth import truth_medium


def truth_sky(name, elevation, altitude, method="full"):
    """Sky of a `truth_medium`; sun elevation in degrees, altitude in km.

    It has no planet and so no star: only what is per unit irradiance can be asked.
    """
    sky = bare_sky(truth_medium(name), elevation, altitude, method)
    sky.__dict__["atmosphere"] = _atmosphere(name, method)
    return sky


def bare_sky(medium, elevation, altitude, method="full"):
    """Sky of any medium without a planet."""
    sky = Sky.__new__(Sky)
    sky.medium = medium
    sky.method = method
    sky.altitude = altitude
    sky.r = medium.r_bottom + max(altitude, 1e-8)
    sky.sun_elevation = math.radians(elevation)
    sky.sun_azimuth = math.pi
    return sky


def without_diffuse_light(sky):
    """Leave only light that is scattered or reflected once; changes the sky."""
    field = sky.atmosphere.field
    dark = field._replace(
        radiance=np.zeros_like(field.radiance), ground=np.zeros_like(field.ground)
    )
    sky.__dict__["atmosphere"] = sky.atmosphere._replace(field=dark)
    return sky


@functools.cache
def _atmosphere(name, method):
    return bare_sky(truth_medium(name), 0.0, 0.0, method).atmosphere


def view_cosines(view_zenith, azimuth, elevation):
    """Cosines mu and nu of views, from angles in degrees."""
    theta, phi = np.radians(view_zenith), np.radians(azimuth)
    sun = math.radians(90.0 - elevation)
    mu = np.cos(theta)
    nu = mu * math.cos(sun) + np.sin(theta) * math.sin(sun) * np.cos(phi)
    return mu, np.clip(nu, -1.0, 1.0)
