"""What is below the true horizon: the ground, its light extended, or nothing."""

import math

import numpy as np
import pytest

from skybake.errors import InputError
from skybake.image.below_horizon import light_from_below
from skybake.image.image import image_of_scene
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset

EARTH = load_preset("earth")


def scene(below, size=128, **options):
    options = {"sun_elevation": 0.3, "sun_disc": "exclude", **options}
    return Scene(
        EARTH,
        map_settings(options.pop("projection", "equirect"), size, below_horizon=below, **options),
    )


def pixels(below, size=128, **options):
    return image_of_scene(scene(below, size, **options)).pixels


@pytest.mark.parametrize("altitude", [0.0, 10.0])
def test_the_sky_above_the_true_horizon_stays(altitude):
    dip = scene("ground", altitude=altitude).table.zenith_horizon
    above = int(dip / math.pi * 64)
    assert above >= 32
    ground = pixels("ground", altitude=altitude)
    for below in ("extend", "black"):
        seen = pixels(below, altitude=altitude)
        np.testing.assert_array_equal(seen[:above], ground[:above])
        assert (seen[above + 1 :] != ground[above + 1 :]).all()


def test_black_is_nothing():
    assert (pixels("black")[32:] == 0.0).all()


def test_extended_light_joins_the_horizon_and_is_within_its_range():
    seen = pixels("extend", 512)
    horizon, below = seen[127], seen[128:]
    ring = scene("ground").evaluate(
        np.full((1, 1), math.pi / 2 - 1e-3), np.linspace(0, 2 * math.pi, 512)[None], 1e-4
    )[0]
    assert (below >= 0.99 * ring.min(axis=0)).all()
    assert (below <= 1.01 * ring.max(axis=0)).all()
    # Across the horizon the light changes no more than from row to row above it.
    step = np.abs(seen[128] / horizon - 1.0).max()
    assert step < 1.5 * np.abs(horizon / seen[126] - 1.0).max()
    np.testing.assert_allclose(
        seen[-1], np.broadcast_to(ring[:-1].mean(axis=0), (512, 3)), rtol=0.05
    )


def test_extended_light_is_softer_with_depth():
    seen = pixels("extend", 256)
    contrast = [np.ptp(row[:, 0]) / row[:, 0].mean() for row in seen[65::8]]
    assert np.all(np.diff(contrast) < 0.0)


@pytest.mark.parametrize(
    ("projection", "size"), [("cubemap", 32), ("octahedral", 64), ("angular", 64)]
)
@pytest.mark.parametrize("below", ["extend", "black"])
def test_all_projections_show_the_same(projection, size, below):
    from skybake.environment.environment import Environment
    from skybake.environment.resample import resample
    from skybake.projection import Equirect

    seen = pixels(below, size, projection=projection)
    pictures = tuple(seen) if seen.ndim == 4 else (seen,)
    shown = scene(below, size, projection=projection).settings.view.projection
    laid_out = resample(Environment(pictures, shown), Equirect(64)).pixels[0]
    expected = pixels(below, 64)
    np.testing.assert_allclose(laid_out[36:], expected[36:], rtol=0.06, atol=1e-6)
    np.testing.assert_allclose(laid_out[24:28], expected[24:28], rtol=0.1)


def test_the_light_from_below_is_that_of_the_map():
    for below in ("extend", "black"):
        here = scene(below, 256)
        by_map, by_ground = light_from_below(here)
        for name, told in ((below, by_map), ("ground", by_ground)):
            luminance = pixels(name, 256)[64:].astype(float) @ here.luminance
            zenith = math.pi * (np.arange(64, 128) + 0.5) / 128
            size = 2.0 * math.pi / 256 * math.pi / 128 * np.sin(zenith)
            summed = float((luminance.sum(axis=1) * size * -np.cos(zenith)).sum())
            assert told == pytest.approx(summed, rel=0.01, abs=1e-6)


def test_a_planet_from_space_has_no_horizon_to_extend():
    with pytest.raises(InputError, match="extend needs an observer in the atmosphere, below 100"):
        scene("extend", altitude=400.0)
    assert pixels("black", 64, altitude=400.0).shape == (32, 64, 3)


def test_an_unknown_word_is_refused():
    with pytest.raises(InputError, match="below horizon: must be one of ground, extend, black"):
        map_settings(below_horizon="sea")
