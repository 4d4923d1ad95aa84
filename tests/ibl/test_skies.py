"""Lighting maps of skies are quadratures of the skies themselves."""

import math

import numpy as np
import pytest

import skybake
from skybake.colour.space import rgb_from_xyz
from skybake.ibl.diffuse import diffuse_cube
from skybake.ibl.harmonics import basis, harmonics_of
from skybake.ibl.surroundings import surroundings_of_scene
from skybake.image.raster import Raster
from skybake.projection import Equirect
from tests.ibl.maps import directions, sizes

EDGE = 512
DIFFUSE_EDGE = 32


def _lit(preset, **settings):
    """Scene, directions and flux of its sky on an equirect map, and the irradiance of its sun."""
    settings = skybake.map_settings(
        "cubemap",
        EDGE,
        sun_elevation=math.radians(30.0),
        sun_azimuth=math.radians(130.0),
        **settings,
    )
    scene = skybake.Scene(skybake.load_preset(preset), settings)
    (canvas,) = Equirect(1024).canvases()
    sky = Raster(scene, canvas).layers(0, canvas.height).plane("sky")
    chart = canvas.parts[0].chart
    zenith, bearing = np.broadcast_arrays(*chart.angles(0, canvas.height))
    toward = np.stack(
        [np.sin(zenith) * np.sin(bearing), np.cos(zenith), -np.sin(zenith) * np.cos(bearing)], -1
    )
    flux = (
        sky.astype(float)
        * np.broadcast_to(chart.solid_angles(0, canvas.height), zenith.shape)[..., None]
    )
    encoding = scene.settings.encoding
    sun = rgb_from_xyz(encoding.space) @ scene.sun_xyz()[0] / encoding.white_luminance
    return scene, toward.reshape(-1, 3), flux.reshape(-1, 3), sun


@pytest.mark.parametrize(
    "world",
    [
        ("earth", {}),
        pytest.param(("earth-fair", {"clouds_quality": "draft"}), marks=pytest.mark.slow),
    ],
    ids=["earth", "earth-fair"],
)
def test_irradiance_and_harmonics_are_those_of_an_equirect_map(world):
    preset, settings = world
    scene, toward, flux, sun = _lit(preset, **settings)
    around = surroundings_of_scene(scene, EDGE)
    place = np.array(
        [
            math.cos(math.pi / 6) * math.sin(math.radians(130.0)),
            0.5,
            -math.cos(math.pi / 6) * math.cos(math.radians(130.0)),
        ]
    )
    shown = math.pi * diffuse_cube(around.smooth, around.points, DIFFUSE_EDGE).reshape(-1, 3)
    normals = directions(DIFFUSE_EDGE)
    # A disc sets over half a degree, which a plane at its edge sees a part of.
    chosen = np.flatnonzero(np.abs(normals @ place) > 0.005)[::37]
    for i in chosen:
        expected = np.maximum(toward @ normals[i], 0.0) @ flux
        expected += max(normals[i] @ place, 0.0) * sun
        assert shown[i] == pytest.approx(expected, rel=5e-3)
    expected = basis(toward).T @ flux + basis(place[None]).T * sun
    found = harmonics_of(around.smooth, around.points)
    assert np.abs(found - expected).max() < 5e-3 * expected[0].max()


def test_the_points_of_a_setting_sun_hold_the_light_that_files_state():
    settings = skybake.map_settings("cubemap", 64, sun_elevation=math.radians(0.1))
    scene = skybake.Scene(skybake.load_preset("earth"), settings)
    around = surroundings_of_scene(scene, 64)
    encoding = scene.settings.encoding
    stated = rgb_from_xyz(encoding.space) @ scene.sun_xyz()[0] / encoding.white_luminance
    assert around.points.flux.sum(axis=0) == pytest.approx(stated, rel=1e-6)
    # The planet hides the lower part, of which nothing shines.
    lit = around.points.flux[:, 0] > 0.0
    assert around.points.directions[lit, 1].min() > -1e-3
    of_texels = (around.cube.astype(float) - around.smooth).reshape(-1, 3)
    assert sizes(64) @ of_texels == pytest.approx(stated, rel=0.01, abs=1e-3 * stated.max())
