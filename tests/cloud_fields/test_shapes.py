"""Clouds that are generated."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

from skybake.cloud_fields.build import EVOLUTION, build_field
from skybake.cloud_fields.cirrus import cirrus
from skybake.cloud_fields.cumulus import cumulus
from skybake.cloud_fields.fit import LEAST_DEPTH
from skybake.cloud_fields.noise import billows
from skybake.cloud_fields.patching import with_patches
from skybake.preset.cloud_kinds import DEFAULTS
from tests.cloud_fields.layers import KINDS, field, layer
from tests.cloud_fields.sampling import clearance, column_depths, extinction, random_points

SLOW_KINDS = dict.fromkeys(("cumulus", "altocumulus"), pytest.mark.slow)
"""Whose tiles take longest to draw, and which are drawn as others are."""


def is_covered(depths, optical_depth):
    return depths > LEAST_DEPTH * min(optical_depth, 1.0)


@pytest.mark.parametrize("kind", KINDS)
def test_cover_and_optical_depth_are_those_of_the_layer(kind):
    wanted = DEFAULTS[kind]
    depths = column_depths(field(kind), 151)
    covered = is_covered(depths, wanted.optical_depth)
    assert covered.mean() == pytest.approx(wanted.cover, abs=0.02)
    assert depths[covered].mean() == pytest.approx(wanted.optical_depth, rel=0.03)


@pytest.mark.parametrize(
    ("kind", "cover"),
    [pytest.param("cumulus", 0.1, marks=pytest.mark.slow), ("cumulus", 0.9), ("cirrus", 0.8)],
)
def test_few_and_many_clouds_cover_what_they_should(kind, cover):
    depths = column_depths(field(kind, cover=cover), 113)
    assert is_covered(depths, DEFAULTS[kind].optical_depth).mean() == pytest.approx(cover, abs=0.02)


def test_a_deck_much_deeper_than_its_cells_has_its_little_cover_too():
    clouds = field("altocumulus", cover=0.02, depth=0.5, size=0.1, optical_depth=200.0)
    assert is_covered(column_depths(clouds, 151), 200.0).mean() == pytest.approx(0.02, abs=0.01)


@pytest.mark.parametrize(
    "kind", [pytest.param(kind, marks=SLOW_KINDS.get(kind, ())) for kind in KINDS]
)
def test_full_cover_leaves_no_gap(kind):
    depths = column_depths(field(kind, cover=1.0), 113)
    assert is_covered(depths, DEFAULTS[kind].optical_depth).mean() > 0.995


@pytest.mark.parametrize("kind", KINDS)
def test_no_cover_is_no_cloud_at_all(kind):
    clear = build_field(layer(kind, cover=0.0))
    points = np.random.default_rng(1).random((1000, 3)) * 10.0
    assert not extinction(clear, points).any()
    assert (clearance(clear, points[points[:, 2] > 0.0]) > 0.0).all()


@pytest.mark.parametrize("kind", KINDS)
def test_a_field_repeats_after_its_period_to_the_bit(kind):
    clouds = field(kind)
    # Sums of these and of periods are exact.
    points = np.floor(random_points(clouds, 20_000) * 2.0**14) / 2.0**14
    shifts = np.array([3.0 * clouds.period[0], -2.0 * clouds.period[1], 0.0])
    for blur in (0.0, 0.02):
        np.testing.assert_array_equal(
            extinction(clouds, points, blur), extinction(clouds, points + shifts, blur)
        )


@pytest.mark.parametrize("kind", KINDS)
def test_there_is_no_seam_where_the_tile_ends(kind):
    clouds = field(kind)
    rng = np.random.default_rng(2)
    y, z = rng.random(20_000) * clouds.period[1], rng.uniform(clouds.base, clouds.top, 20_000)

    def change(x):
        low, high = (np.stack([np.full_like(y, x + step), y, z], 1) for step in (-1e-4, 1e-4))
        return np.abs(extinction(clouds, high) - extinction(clouds, low)).mean()

    inside = [change(share * clouds.period[0]) for share in (0.2, 0.4, 0.6, 0.8)]
    assert change(0.0) < 1.5 * max(inside)


@pytest.mark.slow
@pytest.mark.parametrize("shape", [cumulus, functools.partial(cirrus, wind_from=0.0)])
def test_the_same_seed_makes_the_same_bytes_and_another_another_field(shape):
    first, again, other = (shape(0.3, 1.0, 0.4, 0.5, 20.0, seed) for seed in (3, 3, 4))
    for one, same in zip(first, again, strict=True):
        np.testing.assert_array_equal(one, same)
    assert (first.distance != other.distance).mean() > 0.2


def test_a_field_from_disk_is_the_one_that_was_built_of_that_seed_and_of_no_other(monkeypatch):
    arguments = 0.3, 8.0, 1.0, 2.0, 0.3, 5, math.radians(270.0)
    like = layer("cirrus", cover=0.3, base=8.0, depth=1.0, size=2.0, optical_depth=0.3, seed=5)
    build_field(like)
    build_field.__globals__["_shaped"].cache_clear()
    monkeypatch.setitem(build_field.__globals__["_SHAPES"], "cirrus", None)
    built = with_patches(cirrus(*arguments), like.seed)
    for one, other in zip(build_field(like), built, strict=True):
        np.testing.assert_array_equal(one, other)
    other = cirrus(*arguments[:5], 6, *arguments[6:])
    assert (other.distance != built.distance).mean() > 0.2


def test_bases_of_cumuli_are_flat():
    clouds = field("cumulus")
    like = DEFAULTS["cumulus"]
    points = random_points(clouds, 200_000)
    points[:, 2] = like.base - 0.04 * like.size
    assert not extinction(clouds, points).any()
    points[:, 2] = like.base + 0.04 * like.size
    assert (extinction(clouds, points) > 0.0).mean() > 0.5 * like.cover


def test_billows_have_no_mean_and_fill_their_range():
    noise = billows(1).astype(float)
    assert abs(noise.mean()) < 0.5
    assert np.abs(noise).max() == 127.0
    steps = [np.abs(np.diff(noise, axis=axis)).mean() for axis in range(3)]
    seams = [np.abs(noise.take(0, axis) - noise.take(-1, axis)).mean() for axis in range(3)]
    np.testing.assert_allclose(seams, steps, rtol=0.15)


@pytest.mark.parametrize("kind", KINDS)
def test_blur_keeps_the_mean_extinction(kind):
    clouds = field(kind)
    points = random_points(clouds, 200_000)
    sharp = extinction(clouds, points).mean()
    for blur in (0.01, 0.05, 0.2, 2.0):
        assert extinction(clouds, points, blur).mean() == pytest.approx(sharp, rel=0.03)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("blur", [0.0, 0.03, 0.5])
def test_clearance_is_never_overstated(kind, blur):
    clouds = field(kind)
    points = random_points(clouds, 20_000)
    distance = clearance(clouds, points, blur)
    is_clear = distance > 0.0
    assert is_clear.mean() > 0.1
    rng = np.random.default_rng(3)
    for _ in range(20):
        away = rng.standard_normal(points.shape)
        away *= 0.999 / np.linalg.norm(away, axis=1, keepdims=True)
        near = points + away * np.maximum(distance, 0.0)[:, None]
        assert not extinction(clouds, near[is_clear], blur).any()


def test_clearance_is_never_overstated_once_clouds_have_changed():
    clouds = build_field(layer("cumulus"), 0.4 * EVOLUTION)
    points = random_points(clouds, 40_000)
    for blur in (0.0, 0.03):
        distance = clearance(clouds, points, blur)
        assert not extinction(clouds, points[distance > 0.0], blur).any()
    # The map for one moment is not that for another.
    assert (clouds.near_clearance != field("cumulus").near_clearance).mean() > 0.01


def test_wind_carries_clouds_by_its_drift_and_nothing_else():
    like = layer("altocumulus", wind_speed=0.01, wind_from=np.radians(225.0))
    calm = replace(like, wind_speed=0.0)
    moment = 0.4 * EVOLUTION
    still, drifted = build_field(calm, moment), build_field(like, moment)
    np.testing.assert_array_equal(drifted.distance, still.distance)
    drift = 0.01 * moment / np.sqrt(2.0)
    np.testing.assert_allclose(drifted.origin, still.origin - drift)


@pytest.mark.slow
def test_evolution_is_continuous_and_replaces_all_clouds():
    like = layer("altocumulus", wind_speed=0.0)
    points = random_points(build_field(like), 50_000)
    values = {}

    def change(first, second):
        for time in (first, second):
            if time not in values:
                values[time] = extinction(build_field(like, time), points)
        return np.abs(values[second] - values[first]).mean()

    # Also where a generation ends.
    for moment in (0.0, 100.0, EVOLUTION - 0.05):
        steps = [change(moment, moment + step) for step in (0.1, 1.0, 100.0)]
        assert 0.0 <= steps[0] < 0.15 * steps[1] < 0.1 * steps[2]
    kept = np.corrcoef(values[0.0], extinction(build_field(like, 2.0 * EVOLUTION), points))
    assert abs(kept[0, 1]) < 0.2
    nearly = np.corrcoef(values[0.0], values[100.0])
    assert nearly[0, 1] > 0.6


@pytest.mark.parametrize(
    "kind", ["altocumulus", *(pytest.param(each, marks=pytest.mark.slow) for each in KINDS)]
)
def test_clouds_that_take_the_place_of_others_have_their_cover_and_optical_depth(kind):
    like = layer(kind)
    for moment in (0.7 * EVOLUTION, 1.4 * EVOLUTION):
        depths = column_depths(build_field(like, moment), 80, levels=30)
        covered = is_covered(depths, like.optical_depth)
        assert covered.mean() == pytest.approx(like.cover, abs=0.06)
        assert depths.mean() == pytest.approx(like.cover * like.optical_depth, rel=0.05)


@pytest.mark.parametrize("wind_from", [60.0, 270.0])
def test_trails_of_cirrus_lie_along_the_wind(wind_from):
    bearing = np.radians(wind_from)
    clouds = build_field(layer("cirrus", wind_from=bearing))
    points = random_points(clouds, 20_000)
    along = 0.4 * np.array([np.sin(bearing), np.cos(bearing), 0.0])
    across = along[[1, 0, 2]] * [1.0, -1.0, 0.0]
    here = extinction(clouds, points)
    near = [extinction(clouds, points + away) for away in (along, across)]
    lags, widths = (np.corrcoef(here, each)[0, 1] for each in near)
    assert lags > 0.7
    assert widths < 0.7 * lags
    # What has fallen lags behind, where the wind comes from.
    high, low = (clouds.base + share * (clouds.top - clouds.base) for share in (0.75, 0.45))
    points[:, 2] = high
    heads, lower = extinction(clouds, points), points + np.array([0.0, 0.0, low - high])
    behind, before = (
        np.corrcoef(heads, extinction(clouds, lower + 3.0 * sign * along))[0, 1] for sign in (1, -1)
    )
    assert behind > before + 0.1
