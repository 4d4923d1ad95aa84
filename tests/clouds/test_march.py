"""Rays through drawn clouds: what they must not depend on, and what they must not miss."""

import math
from dataclasses import replace

import numpy as np
import pytest

from skybake.clouds.build import build_cloudscape
from skybake.clouds.cloudscape import unit_vectors
from skybake.jit.workers import Workers
from skybake.preset import load_preset
from skybake.sky.sky import Sky

PIXEL = 3e-3


@pytest.fixture(scope="module")
def clouds(tmp_path_factory):
    path = tmp_path_factory.mktemp("march") / "world.toml"
    path.write_text(
        'extends = "earth-hillaire2020"\n[clouds.low]\nkind = "cumulus"\ncover = 0.4\n'
        'phase = { kind = "henyey-greenstein", asymmetry = 0.85 }\n'
    )
    planet = load_preset(path)
    sky = Sky(planet, math.radians(40.0), 0.0, method="hillaire")
    weights = np.eye(sky.wavelengths.size)[:, :1]
    return build_cloudscape(planet.clouds, sky, weights, quality="draft", workers=Workers(2))


def rays(low, high, rows, columns, around=360.0):
    """Directions between two elevations [deg], row by row."""
    elevation = low + (high - low) * (np.arange(rows) + 0.5) / rows
    bearing = around * (np.arange(columns) + 0.5) / columns
    angle, turn = np.meshgrid(np.radians(90.0 - elevation), np.radians(bearing), indexing="ij")
    return unit_vectors(angle.ravel(), turn.ravel())


def test_a_ray_is_the_same_whichever_are_followed_with_it(clouds):
    directions = rays(1.0, 89.0, 24, 64)
    seen, passing = clouds.see(directions, PIXEL)
    assert 0.2 < passing[0, :, 0].mean() < 0.8
    order = np.random.default_rng(1).permutation(len(directions))
    for part in np.array_split(order, 3):
        alone, passes = clouds.see(np.ascontiguousarray(directions[part]), PIXEL)
        np.testing.assert_array_equal(alone, seen[:, part])
        np.testing.assert_array_equal(passes, passing[:, part])


@pytest.mark.parametrize(("low", "high", "pixel"), [(5.0, 85.0, 1e-3), (1.0, 4.0, PIXEL)])
def test_leaps_over_empty_space_miss_no_cloud(clouds, low, high, pixel, monkeypatch):
    directions = rays(low, high, 24, 80)
    seen, passing = clouds.see(directions, pixel)
    layer = clouds.layers[0]
    blind = layer.field._replace(
        near_clearance=np.zeros_like(layer.field.near_clearance),
        clearance=np.zeros_like(layer.field.clearance),
    )
    monkeypatch.setattr(clouds, "layers", [replace(layer, field=blind)])
    all_seen, all_passing = clouds.see(directions, pixel)
    assert passing[..., 0].mean() == pytest.approx(all_passing[..., 0].mean(), abs=0.004)
    assert seen.mean() == pytest.approx(all_seen.mean(), rel=0.01)


def test_far_clouds_below_the_size_of_a_pixel_keep_their_mean(clouds):
    fine, coarse = rays(2.0, 5.0, 40, 240, 60.0), rays(2.0, 5.0, 8, 48, 60.0)
    few, many = clouds.see(coarse, 5.0 * PIXEL)[1], clouds.see(fine, PIXEL)[1]
    assert few[..., 0].mean() == pytest.approx(many[..., 0].mean(), abs=0.02)
