"""Light that forward peaks alone have scattered, on its true path around the sun."""

import math

import numpy as np

from skybake.scattering.aureole import LAST_ANGLE, no_aureole
from skybake.sky.observer import Observer
from skybake.sky.skylight import Skylight
from tests.skies import truth_atmosphere, view_cosines, white_source

GROUND = 0.001


def radiance(atmosphere, elevation, zenith, azimuth):
    source = white_source(elevation)
    sky = Skylight(atmosphere, Observer(GROUND), (source,))
    return sky.radiance_per_irradiance(source, *view_cosines(zenith, azimuth, elevation))


def without(atmosphere):
    return atmosphere._replace(aureole=no_aureole(atmosphere.scaled))


def test_peaks_too_weak_to_matter_have_none():
    assert truth_atmosphere("EARTH_HAZE").aureole.source.shape[2] == 0
    assert truth_atmosphere("MARS_MIE").aureole.source.shape[2] > 0


def test_its_light_ends_without_an_edge():
    """Along the almucantar of a sun at 5 deg, toward the last angle from it and across."""
    dust = truth_atmosphere("MARS_MIE")
    azimuth = np.linspace(0.0, 62.0, 125)
    zenith = np.full(125, 85.0)
    bent = radiance(dust, 5.0, zenith, azimuth) - radiance(without(dust), 5.0, zenith, azimuth)
    angle = np.degrees(np.arccos(view_cosines(zenith, azimuth, 5.0)[1]))
    last = math.degrees(LAST_ANGLE)
    assert (bent[angle > last] == 0.0).all()
    assert np.abs(bent[angle > last - 1.0]).max() < 0.01 * np.abs(bent).max()


def test_it_matters_where_the_sun_is_low():
    dust = truth_atmosphere("MARS_MIE")
    zenith, azimuth = np.linspace(10.0, 89.0, 30), np.full(30, 8.0)
    share = []
    for elevation in (60.0, 2.0):
        light = radiance(dust, elevation, zenith, azimuth)
        share.append(
            np.abs(radiance(without(dust), elevation, zenith, azimuth) / light - 1.0).max()
        )
    assert share[0] < 0.01
    assert share[1] > 0.02
