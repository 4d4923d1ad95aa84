"""Canvases filled with the light of a scene."""

import math

import numpy as np
import pytest

from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.projection import Angular, Cubemap, Equirect, Fisheye, Octahedral, Perspective

EARTH = load_preset("earth")
PROJECTIONS = [
    Equirect(64),
    Cubemap(16, "cross"),
    Cubemap(16, "exr"),
    Cubemap(16, "vertical-cross"),
    Equirect(64, "poles"),
    Angular(48),
    Octahedral(32),
    Fisheye(48),
    Perspective(64, 36, math.radians(60.0), math.pi, 0.3),
]


def raster(projection, **values):
    values = {"sun_elevation": math.radians(20.0)} | values
    (canvas,) = projection.canvases()
    return Raster(Scene(EARTH, map_settings(projection, **values)), canvas)


def whole(made):
    return made.rows(0, made.canvas.height)


@pytest.mark.parametrize("projection", PROJECTIONS)
def test_layers_add_up_to_the_map(projection):
    made = raster(projection)
    layers = made.layers(0, made.canvas.height)
    assert layers.names() == ("sky", "sun")
    sky, sun = layers.plane("sky").copy(), layers.plane("sun").copy()
    np.testing.assert_array_equal(layers.added(), sky + sun)
    for disc, plane in (("exclude", sky), ("only", sun)):
        np.testing.assert_array_equal(whole(raster(projection, sun_disc=disc)), plane)


@pytest.mark.parametrize("projection", PROJECTIONS)
def test_a_map_is_the_same_in_bands_of_any_height(projection):
    made = raster(projection)
    bands = [
        made.rows(first, min(first + 7, made.canvas.height))
        for first in range(0, made.canvas.height, 7)
    ]
    np.testing.assert_array_equal(np.concatenate(bands), whole(made))


def test_a_band_without_the_sun_has_no_layer_of_it():
    made = raster(Equirect(64))
    assert made.layers(0, 4).names() == ("sky",)
    assert made.layers(0, 4).plane("sun") is None
    assert (whole(raster(Equirect(64), sun_disc="only"))[:4] == 0.0).all()


def test_corners_of_a_fisheye_are_black():
    pixels = whole(raster(Fisheye(48)))
    x, y = np.meshgrid(np.arange(48) - 23.5, np.arange(48) - 23.5)
    outside = np.hypot(x, y) > 24.0
    assert (pixels[outside] == 0.0).all()
    assert (pixels[~outside].sum(axis=1) > 0.0).all()


def reduced(pixels, step):
    rows, columns = pixels.shape[0] // step, pixels.shape[1] // step
    return pixels.reshape(rows, step, columns, step, 3).mean(axis=(1, 3))


@pytest.mark.parametrize("roll", [pytest.param(0.0, marks=pytest.mark.slow), 0.5])
@pytest.mark.parametrize("sun", [-15.0, 20.0])
def test_the_limb_in_a_picture_from_orbit_is_smooth(roll, sun):
    """Each pixel is the mean of the 8 by 8 that a finer picture has in its place.

    Off to the side of the picture the limb is tilted.
    """
    look = {"azimuth": math.pi, "elevation": math.radians(-18.0) + 0.2 * roll}
    values = {"altitude": 400.0, "sun_elevation": math.radians(sun), "sun_disc": "exclude"}
    view = math.radians(40.0 + 60.0 * roll)
    coarse = whole(raster(Perspective(192, 108, view, **look), **values))
    fine = reduced(whole(raster(Perspective(1536, 864, view, **look), **values)), 8)
    brightest = fine.max()
    assert np.abs(coarse - fine).max() < 0.05 * brightest
    assert math.sqrt(np.mean((coarse - fine) ** 2)) < 0.002 * brightest


@pytest.mark.parametrize("altitude", [0.0, 12.0])
def test_a_perspective_shows_what_an_equirect_map_has_there(altitude):
    values = {"altitude": altitude, "sun_disc": "exclude"}
    picture = Perspective(40, 30, math.radians(70.0), 2.0, 0.4)
    shown = whole(raster(picture, **values))
    flat = whole(raster(Equirect(4096), **values))
    (part,) = picture.canvases()[0].parts
    zenith, bearing = part.chart.angles(0, 30)
    rows = (zenith / math.pi * 2048).astype(int)
    columns = (bearing % (2.0 * math.pi) / (2.0 * math.pi) * 4096).astype(int)
    away = np.abs(zenith - math.pi / 2.0) > 0.08
    np.testing.assert_allclose(shown[away], flat[rows, columns][away], rtol=0.01)
