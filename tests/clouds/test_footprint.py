"""Clouds that are smaller than the pixels that they are seen in."""

import math

import numpy as np
import pytest

from skybake.clouds.footprint import rays_per_side, see_pixels
from skybake.clouds.light import LayerLight, half_words
from skybake.clouds.march import Marching
from skybake.clouds.particles import TERMS
from skybake.clouds.sight import Eye
from skybake.jit.workers import Workers
from tests.cloud_fields.layers import field
from tests.cloud_fields.sampling import plane_depths

ASIDE = 0.5
RADIUS = 6360.0


def light_of(clouds):
    """Light of no matter: one voxel that is the same everywhere."""
    return LayerLight(
        beam=np.full((1, 1, 1, 1), 0.1, np.float32),
        moments=half_words(np.full((1, 1, 1, 1, 1), 0.1, np.float32)),
        spacing=np.array([clouds.top - clouds.base, *clouds.period[::-1]]),
        base=float(clouds.base),
        sun_mu=np.array([0.5]),
        irradiance=np.ones((1, 1, 1)),
        brightness=np.ones((1, 1)),
        order=0,
        fraction=ASIDE,
        scatter=np.ones(1),
        truncated=np.ones((9, 1)),
        peak=np.zeros((9, 1, TERMS)),
    )


def transmittances(clouds, altitude, pixel, directions, count):
    out = tuple(np.empty((len(directions), channels), np.float32) for channels in (1, 3))
    marching = Marching(0.4, 0.012, 0.1, 0, 0.1, pixel)
    eye = Eye(RADIUS, altitude, np.array([0.0, 0.8, 0.6]))
    see_pixels(clouds, light_of(clouds), eye, directions, marching, out, Workers(1), count)
    return out[1]


def downward(widest, count):
    """Directions around the nadir, the same number for equal solid angles."""
    rng = np.random.default_rng(1)
    cosine, bearing = rng.uniform(math.cos(widest), 1.0, count), rng.uniform(0.0, 2 * np.pi, count)
    sine = np.sqrt(1.0 - cosine**2)
    return np.stack([sine * np.sin(bearing), sine * np.cos(bearing), -cosine], 1)


@pytest.mark.parametrize("altitude", [400.0, 36_000.0])
def test_from_orbit_as_many_clouds_are_seen_as_there_are(altitude):
    clouds = field("cumulus")
    directions = downward(0.05, 1500)
    pixel = 0.002
    count = rays_per_side(clouds, altitude, pixel)
    passing = transmittances(clouds, altitude, pixel, directions, count)
    places = np.random.default_rng(2).uniform(-700.0, 700.0, (6000, 2))
    depths = plane_depths(clouds, places, levels=24)
    wanted = np.exp(-(1.0 - ASIDE) * depths).mean()
    assert passing[:, 0].mean() == pytest.approx(wanted, abs=0.05)
    # Clouds are between their base and their top, in pixels that have any.
    distance = passing[passing[:, 0] < 0.9, 2]
    near, far = altitude - clouds.top, (altitude - clouds.base) / math.cos(0.07)
    assert ((distance > near) & (distance < far * 1.01)).all()


def test_coarse_pixels_are_means_of_several_rays_and_fine_ones_are_one():
    clouds = field("cumulus")
    assert rays_per_side(clouds, 0.0, 0.001) == rays_per_side(clouds, 11.0, 0.001) == 1
    assert 1 < rays_per_side(clouds, 1000.0, 0.001) <= rays_per_side(clouds, 36_000.0, 0.001) <= 8
    directions = downward(0.05, 800)
    noise = [transmittances(clouds, 2000.0, 0.002, directions, n)[:, 0].std() for n in (1, 4)]
    assert noise[1] < 0.5 * noise[0]


def test_the_number_of_rays_changes_from_pixel_to_pixel_and_not_at_an_edge():
    clouds = field("cumulus")
    directions = downward(0.05, 400)
    few, more, mixed = (
        transmittances(clouds, 2000.0, 0.002, directions, n)[:, 0] for n in (1, 2, 1.25)
    )
    is_different = few != more
    has_more = (mixed == more)[is_different]
    assert ((mixed == more) | (mixed == few)).all()
    assert 0.15 < has_more.mean() < 0.35
    changes = np.count_nonzero(np.diff(has_more.astype(int)))
    assert changes > 0.25 * has_more.size
