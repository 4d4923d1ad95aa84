"""Skies of the atmospheres that the reference tables were computed for."""

import math

import numpy as np

from skybake.angles import cosine_between
from skybake.scattering.atmosphere import load_atmosphere
from skybake.scattering.aureole import no_aureole
from skybake.sky.observer import Observer
from skybake.sky.single import SingleSkylight
from skybake.sky.skylight import Skylight
from skybake.sky.source import Source
from tests.truth import truth_medium


def white_source(elevation, azimuth=180.0, *, irradiance=1.0, wavelengths=3, **options):
    """Source of even irradiance, the size of the sun and without limb; angles in degrees."""
    return Source(
        azimuth=math.radians(azimuth),
        elevation=math.radians(elevation),
        irradiance=np.full(wavelengths, irradiance),
        angular_radius=math.radians(0.2667),
        limb_darkening=np.zeros((2, wavelengths)),
        **options,
    )


def truth_skylight(name, elevation, altitude, method="full"):
    """Light of one white source in a `truth_medium`; elevation in degrees, altitude in km."""
    kind = SingleSkylight if method == "march" else Skylight
    solved = truth_atmosphere(name, "full" if method == "full" else "hillaire")
    return kind(solved, Observer(altitude), (white_source(elevation),))


def first_order(skylight):
    """The same skylight with only what is scattered or reflected once."""
    field = skylight.atmosphere.field
    dark = field._replace(
        radiance=np.zeros_like(field.radiance), ground=np.zeros_like(field.ground)
    )
    atmosphere = skylight.atmosphere._replace(
        field=dark, aureole=no_aureole(skylight.atmosphere.scaled)
    )
    return Skylight(atmosphere, skylight.observer, skylight.sources)


def truth_atmosphere(name, method="full"):
    """Tables of a `truth_medium`, which modules of tests share on disk."""
    return load_atmosphere(truth_medium(name), method)


def view_cosines(view_zenith, azimuth, elevation):
    """Cosines mu and nu of views, from angles in degrees."""
    theta, phi = np.radians(view_zenith), np.radians(azimuth)
    sun = math.radians(90.0 - elevation)
    mu = np.cos(theta)
    nu = cosine_between(mu, np.sin(theta), math.cos(sun), math.sin(sun), phi)
    return mu, np.clip(nu, -1.0, 1.0)
