"""Clouds in patches: no lattice from orbit, nothing cut, and what is asked for everywhere."""

import numpy as np
import pytest

from skybake.cloud_fields.chart import chart_stretch, plane_place
from skybake.cloud_fields.fit import LEAST_DEPTH
from skybake.jit.kernel import kernel
from tests.cloud_fields.layers import KINDS, field
from tests.cloud_fields.sampling import extinction, on_plane, plane_depths, random_points

RADIUS = 6360.0


def places(count, low, high, seed=1):
    """Places of the plane whose distance from the observer is between two. [km]"""
    rng = np.random.default_rng(seed)
    distance = np.sqrt(rng.uniform(low**2, high**2, count))
    bearing = rng.uniform(0.0, 2.0 * np.pi, count)
    return distance[:, None] * np.stack([np.sin(bearing), np.cos(bearing)], 1)


def alike(first, second):
    return np.corrcoef(np.minimum(first, 5.0), np.minimum(second, 5.0))[0, 1]


@pytest.mark.parametrize("kind", ["cumulus", "stratocumulus", "cirrus"])
def test_far_away_places_a_tile_apart_are_no_more_alike_than_any(kind):
    clouds = field(kind)
    here = places(8_000, 100.0, 900.0)
    depths = plane_depths(clouds, here)
    for tiles in ((1.0, 0.0), (0.0, 1.0), (1.0, 1.0)):
        assert abs(alike(depths, plane_depths(clouds, here + tiles * clouds.period))) < 0.05
    # The measure finds a lattice where there is one.
    still = clouds._replace(shifts=np.zeros_like(clouds.shifts), erosion=0.0)
    there = here + clouds.period
    assert alike(plane_depths(still, here), plane_depths(still, there)) > 0.8


@pytest.mark.parametrize("kind", KINDS)
def test_patches_keep_cover_and_optical_depth(kind):
    clouds = field(kind)
    depths = plane_depths(clouds, places(25_000, 50.0, 900.0))
    alone = clouds._replace(shifts=np.zeros_like(clouds.shifts), erosion=0.0)
    tile = plane_depths(alone, np.random.default_rng(2).random((25_000, 2)) * clouds.period)
    least = LEAST_DEPTH * min(float(tile.mean()), 1.0)
    assert (depths > least).mean() == pytest.approx((tile > least).mean(), abs=0.02)
    assert depths.mean() == pytest.approx(tile.mean(), rel=0.03)


def test_over_the_observer_clouds_are_those_of_the_tile():
    clouds = field("cumulus")
    points = random_points(clouds, 20_000)
    points[:, :2] = places(20_000, 0.0, 0.25 * clouds.period[0])
    np.testing.assert_allclose(on_plane(clouds, points)[0], extinction(clouds, points), atol=2e-4)


@pytest.mark.parametrize("kind", KINDS)
def test_no_cloud_is_cut_where_patches_meet(kind):
    clouds = field(kind)
    points = random_points(clouds, 100_000)
    points[:, :2] = places(100_000, 100.0, 300.0)
    step = np.array([2e-3, 0.0, 0.0])

    def change(like):
        difference = np.abs(on_plane(like, points)[0] - on_plane(like, points + step)[0])
        return np.sort(difference)[::-1]

    # A cut would be a change at once of all the extinction there is.
    cut, alone = change(clouds), change(clouds._replace(shifts=0.0 * clouds.shifts, erosion=0.0))
    assert cut.mean() < 1.1 * alone.mean()
    abrupt = 0.5 * clouds.extinction.max()
    assert (cut > abrupt).mean() <= (alone > abrupt).mean() + 3e-5


@pytest.mark.parametrize(("kind", "blur"), [("cumulus", 0.0), ("stratocumulus", 0.03)])
def test_between_patches_clearance_is_not_overstated_either(kind, blur):
    clouds = field(kind)
    points = random_points(clouds, 20_000)
    points[:, :2] = places(20_000, 0.0, 300.0)
    distance = 0.999 * on_plane(clouds, points, blur, radius=1e9)[1]
    is_clear = distance > 0.0
    assert is_clear.mean() > 0.1
    rng = np.random.default_rng(3)
    for _ in range(20):
        away = rng.standard_normal(points.shape)
        away /= np.linalg.norm(away, axis=1, keepdims=True)
        near = points + away * np.maximum(distance, 0.0)[:, None]
        assert not on_plane(clouds, near[is_clear], blur, radius=1e9)[0].any()


@kernel
def _fill_plane(field, radius, points, out, stretch):
    for n in range(points.shape[0]):
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        out[n, 0], out[n, 1] = plane_place(field, radius, x, y, z)
        stretch[n] = chart_stretch(field, radius, x, y, z)


def test_no_kilometre_crosses_more_of_the_plane_than_its_stretch_and_areas_are_kept():
    clouds = field("cumulus")
    rng = np.random.default_rng(4)
    up = rng.standard_normal((20_000, 3))
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    up = up[up[:, 2] > -0.9]
    centre = np.array([0.0, 0.0, RADIUS])

    def plane(points):
        out, stretch = np.empty((len(points), 2)), np.empty(len(points))
        _fill_plane(clouds, RADIUS, points, out, stretch)
        return out, stretch

    points = RADIUS * up - centre
    out, stretch = plane(points)
    steps = []
    first = np.cross(up, rng.standard_normal(3))
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    for along in (first, np.cross(up, first)):
        steps.append((plane(points + 1e-3 * along)[0] - out) / 1e-3)
        assert (np.linalg.norm(steps[-1], axis=1) <= stretch * (1.0 + 1e-5)).all()
    area = np.abs(steps[0][:, 0] * steps[1][:, 1] - steps[0][:, 1] * steps[1][:, 0])
    np.testing.assert_allclose(area, 1.0, rtol=2e-3)
