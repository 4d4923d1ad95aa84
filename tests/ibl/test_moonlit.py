"""The Moon in lighting maps."""

import math

import numpy as np
import pytest

from skybake.ephemeris.lit_moon import moon_by_hand
from skybake.ibl.surroundings import moon_points, surroundings_of_scene
from skybake.image.moonlight import Moonlight
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset


def scene(**options):
    moon = moon_by_hand(2.0, 0.7, math.radians(60.0), 5.0, -0.6)
    settings = map_settings(
        "cubemap",
        16,
        sun_elevation=-0.6,
        units="nits",
        method="hillaire",
        moonlight=Moonlight(moon),
        **options,
    )
    return Scene(load_preset("earth"), settings)


def test_the_disc_of_the_moon_is_points_of_its_stated_light():
    lit = scene()
    around = surroundings_of_scene(lit, 16)
    stated = float(lit.moonlit.xyz()[0][1])
    flux = around.points.flux @ lit.luminance
    assert flux.sum() == pytest.approx(stated, rel=1e-6)
    middle = flux @ around.points.directions
    cosine = middle @ np.array(lit.moonlit.moon.direction) / np.linalg.norm(middle)
    assert math.degrees(math.acos(min(cosine, 1.0))) < 0.3
    assert (around.smooth @ lit.luminance).max() < 1.0 < (around.cube @ lit.luminance).max()


def test_without_discs_its_light_in_the_air_stays():
    lit = scene(sun_disc="exclude")
    assert len(moon_points(lit)) == 0
    around = surroundings_of_scene(lit, 16)
    assert (around.cube == around.smooth).all()
    assert (around.cube @ lit.luminance).max() > 1e-3
