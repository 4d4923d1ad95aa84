"""Clouds before things, and the air in their shadow."""

import math

import numpy as np
import pytest

from skybake.aerial.air import air_before
from skybake.aerial.bake import bake_aerial
from skybake.aerial.clouded import with_clouds
from skybake.aerial.depth import Depths
from skybake.aerial.sight import lens_of
from skybake.aerial.source import Reading, read_source
from skybake.formats.exr_layers import read_exr
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.projection.camera import Camera
from skybake.projection.frame import look_frame
from tests.aerial.pictures import beauty, write_exr

OVERCAST = load_preset("earth-overcast")
FIELD = math.radians(30.0)
WIDTH, HEIGHT = 12, 8


def scene(altitude):
    settings = map_settings(
        None,
        sun_elevation=math.radians(40.0),
        altitude=altitude,
        method="hillaire",
        clouds_quality="draft",
    )
    return Scene(OVERCAST, settings)


def lens(elevation):
    frame = look_frame(math.pi, math.radians(elevation))
    half = math.tan(0.5 * FIELD)
    return lens_of(Camera(np.array(frame), half, half * HEIGHT / WIDTH), (WIDTH, HEIGHT))


def seen(one, look, distance):
    """Clear air and air with clouds, up to a distance along all rays. [km]"""
    depths = Depths(np.full((HEIGHT, WIDTH), distance, np.float32), 1.0, is_planar=False)
    clear = air_before(one, look, depths)
    return clear, with_clouds(one, one.cloudscape, look, depths, clear)


@pytest.fixture(scope="module")
def below():
    return scene(0.002)


@pytest.fixture(scope="module")
def above():
    return scene(8.0)


def test_under_a_deck_nothing_is_hidden_and_the_air_is_dimmer(below):
    clear, clouded = seen(below, lens(15.0), 1.0)
    np.testing.assert_array_equal(clouded.passing, clear.passing)
    ratio = clouded.light / clear.light
    assert 0.05 < ratio.min() < ratio.max() < 0.8


def test_from_above_a_deck_hides_the_ground(above):
    clear, clouded = seen(above, lens(-80.0), 7.9)
    assert (clouded.passing < 0.2 * clear.passing).all()
    # What is seen instead is bright.
    assert (clouded.light > 3.0 * clear.light).all()


def test_before_a_deck_the_air_is_almost_clear(above):
    clear, clouded = seen(above, lens(-60.0), 3.0)
    np.testing.assert_array_equal(clouded.passing, clear.passing)
    # The deck below lights it, as bright a ground as snow.
    ratio = clouded.light / clear.light
    assert 1.0 < ratio.min() < ratio.max() < 3.0


@pytest.mark.parametrize("elevation", [25.0, 60.0])
def test_far_away_all_clouds_of_the_sky_are_before_a_thing(below, elevation):
    look = lens(elevation)
    _, clouded = seen(below, look, 5e3)
    u = look.left + (np.arange(WIDTH) + 0.5) * look.width
    v = look.top - (np.arange(HEIGHT) + 0.5) * look.height
    vectors = u[None, :, None] * look.frame[0] + v[:, None, None] * look.frame[1] + look.frame[2]
    zenith = np.arctan2(np.hypot(vectors[..., 0], vectors[..., 2]), vectors[..., 1])
    azimuth = np.arctan2(vectors[..., 0], -vectors[..., 2]) - math.pi
    sky = below.evaluate(zenith, azimuth, look.width)
    np.testing.assert_allclose(clouded.light, sky, rtol=0.03)


def test_a_thing_at_the_camera_or_nowhere_keeps_clear_air(below):
    depths = Depths(np.full((HEIGHT, WIDTH), np.inf, np.float32), 1.0, is_planar=False)
    depths.values[:, ::2] = 0.0
    look = lens(20.0)
    clear = air_before(below, look, depths)
    clouded = with_clouds(below, below.cloudscape, look, depths, clear)
    np.testing.assert_array_equal(clouded.light, clear.light)


def test_a_thing_sinks_into_a_deck_by_and_by(above):
    """By its distance, not when it is behind the middle of what is seen of the deck."""
    look, columns = lens(-80.0), np.linspace(7.1, 7.9, WIDTH)
    depths = Depths(np.tile(columns, (HEIGHT, 1)).astype(np.float32), 1.0, is_planar=False)
    clear = air_before(above, look, depths)
    clouded = with_clouds(above, above.cloudscape, look, depths, clear)
    share = (clouded.passing / clear.passing).mean(axis=-1)
    assert share[:, 0].min() > 0.9
    assert share[:, -1].max() < 0.2
    assert ((share > 0.15) & (share < 0.85)).any(axis=1).sum() > HEIGHT // 3
    mean = share.mean(axis=0)
    assert (np.diff(mean) < 0.02).all()
    # The deck gets brighter as more of it is before the thing.
    assert clouded.light[:, -1].mean() > 3.0 * clouded.light[:, 0].mean()


@pytest.mark.slow
def test_clouds_hide_light_that_comes_from_infinity(below, tmp_path):
    """As stars, which a renderer has drawn where nothing else is."""
    camera = Camera(np.array(look_frame(math.pi, 1.0)), 0.3, 0.2)
    nothing = np.full((HEIGHT, WIDTH), np.inf)
    seen = []
    for light in (0.0, 1.0):
        path = tmp_path / f"{light}.exr"
        write_exr(path, beauty(nothing, light), kinds=dict.fromkeys("RGBZ", "float"))
        out = tmp_path / "out.exr"
        bake_aerial(below, read_source(path, None, Reading()), camera, out)
        (part,) = read_exr(out)
        seen.append(part.plane("G"))
    dark, bright = seen
    assert dark.min() > 0.0
    assert (bright - dark).max() < 0.05
