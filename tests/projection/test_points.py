"""Points of light on every chart: their flux, their place, and how they move."""

import math

import numpy as np
import pytest

from skybake.angles import direction_from_angles
from skybake.projection import (
    Angular,
    Cubemap,
    Equirect,
    Fisheye,
    Octahedral,
    Perspective,
)
from skybake.projection.points import spread_points

POLES = [[0.0, 1.0, 0.0], [1e-9, -1.0, 0.0], [0.0, 0.0, -1.0], [0.6, 0.0, -0.8]]

WHOLE = [
    Equirect(512),
    Equirect(64, "poles"),
    Cubemap(128),
    Cubemap(64, "vertical-cross"),
    Angular(200),
    Octahedral(128),
]
PARTIAL = [Fisheye(256), Perspective(320, 180)]


def anywhere(count=3000):
    vectors = np.random.default_rng(7).normal(size=(count, 3))
    vectors[: len(POLES)] = POLES
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def charts(projection):
    return [part.chart for canvas in projection.canvases() for part in canvas.parts]


def flux(projection, vectors):
    """Flux of each point, and its centroid, over all charts."""
    total, centroid = np.zeros(len(vectors)), np.zeros_like(vectors)
    for chart in charts(projection):
        spots = spread_points(chart, vectors)
        shape = chart.height, chart.width
        size = np.broadcast_to(chart.solid_angles(0, chart.height), shape).ravel()[spots.texel]
        zenith, bearing = (np.broadcast_to(a, shape) for a in chart.angles(0, chart.height))
        seen = direction_from_angles(bearing, math.pi / 2.0 - zenith).reshape(-1, 3)[spots.texel]
        np.add.at(total, spots.point, spots.weight * size)
        np.add.at(centroid, spots.point, (spots.weight * size)[:, None] * seen)
    return total, centroid


@pytest.mark.parametrize("projection", WHOLE, ids=lambda one: one.label)
def test_every_point_keeps_its_flux(projection):
    total, _ = flux(projection, anywhere())
    np.testing.assert_allclose(total, 1.0, rtol=1e-9)


@pytest.mark.parametrize("projection", PARTIAL, ids=lambda one: one.label)
def test_a_point_is_whole_or_not_shown(projection):
    total, _ = flux(projection, anywhere())
    shown = total > 0.0
    assert 0.02 < shown.mean() < 0.6
    np.testing.assert_allclose(total[shown], 1.0, rtol=1e-9)


@pytest.mark.parametrize("projection", WHOLE, ids=lambda one: one.label)
def test_a_point_is_where_it_is(projection):
    vectors = anywhere()
    _, centroid = flux(projection, vectors)
    centroid /= np.linalg.norm(centroid, axis=-1, keepdims=True)
    away = np.linalg.norm(centroid - vectors, axis=-1)
    texel = math.sqrt(
        max(float(chart.solid_angles(0, chart.height).max()) for chart in charts(projection))
    )
    assert np.median(away) < 0.05 * texel
    # What would lie beyond an edge stays at it, and beside a pole everything is in one ring.
    assert away.max() < 1.0 * texel


def test_a_moving_point_does_not_flicker():
    chart = charts(Equirect(512))[0]
    steps = np.linspace(0.0, 1.0, 33)
    bearings = 1.0 + steps * 2.0 * math.pi / 512
    peaks = [
        spread_points(chart, direction_from_angles([bearing], [0.3 + bearing - 1.0])).weight.max()
        for bearing in bearings
    ]
    assert max(peaks) / min(peaks) < 2.3


def test_spots_are_round_beside_the_zenith():
    chart = charts(Equirect(512))[0]
    spots = spread_points(chart, direction_from_angles([1.0], [math.radians(80.0)]))
    rows, columns = np.unique(spots.texel // 512), np.unique(spots.texel % 512)
    assert len(rows) in (3, 4)
    assert len(columns) * math.sin(math.radians(10.0)) == pytest.approx(3.0, abs=0.5)
