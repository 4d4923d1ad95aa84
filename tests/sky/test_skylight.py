"""Light of several sources, and of one in several colour spaces."""

import dataclasses
import math

import numpy as np
import pytest

from skybake.angles import direction_from_angles, zenith_azimuth
from skybake.errors import InputError
from skybake.sky import spectral_table
from skybake.sky.disc import Disc
from skybake.sky.observer import Observer
from skybake.sky.sky import Sky
from skybake.sky.skylight import Skylight
from skybake.sky.spectral_table import fold_table
from tests.skies import truth_atmosphere, truth_skylight, white_source

SUN, MOON = white_source(20.0, 180.0), white_source(-3.0, 75.0, irradiance=0.3)
RANDOM = np.random.default_rng(5)
DIRECTIONS = RANDOM.normal(size=(60, 3))


def lit_by(*sources, altitude=0.5):
    return Skylight(truth_atmosphere("EARTH_A", "hillaire"), Observer(altitude), sources)


def test_two_suns_of_half_the_irradiance_give_the_light_of_one():
    half = dataclasses.replace(SUN, irradiance=0.5 * SUN.irradiance)
    np.testing.assert_allclose(
        lit_by(half, half).radiance(DIRECTIONS), lit_by(SUN).radiance(DIRECTIONS), rtol=1e-12
    )


def test_the_light_of_two_different_sources_adds():
    both, one, other = (
        lit_by(*each).radiance(DIRECTIONS) for each in ((SUN, MOON), (SUN,), (MOON,))
    )
    assert (one != other).any()
    np.testing.assert_allclose(both, one + other, rtol=1e-12)


def test_no_source_gives_no_light():
    assert (lit_by().radiance(DIRECTIONS) == 0.0).all()


def test_each_source_has_its_own_table_that_knows_where_it_stands():
    light = lit_by(SUN, MOON)
    tables = [light.spectral_table(source) for source in light.sources]
    assert [table.geometry.source_zenith for table in tables] == [SUN.zenith, MOON.zenith]
    assert tables[0].light.diffuse.max() > 10.0 * tables[1].light.diffuse.max()


def test_another_colour_space_or_scale_traces_no_ray(monkeypatch):
    light = lit_by(SUN)
    table = light.spectral_table(SUN)
    monkeypatch.setattr("skybake.sky.skylight.trace_rays", None)
    weights = RANDOM.uniform(size=(3, 3))
    plain, brighter = (fold_table(table, light.basis, each) for each in (weights, 8.0 * weights))
    np.testing.assert_array_equal(brighter.values, 8.0 * plain.values)
    assert plain.values.any()


def test_folding_changes_nothing_of_the_spectral_table():
    light = lit_by(SUN)
    table = light.spectral_table(SUN)
    before = table.light.single.copy(), table.light.diffuse.copy()
    folded = [fold_table(table, light.basis, np.eye(3)) for _ in range(2)]
    np.testing.assert_array_equal(folded[0].values, folded[1].values)
    np.testing.assert_array_equal(table.light.single, before[0])
    np.testing.assert_array_equal(table.light.diffuse, before[1])


def test_azimuths_that_are_there_already_are_resampled_to_themselves():
    values = RANDOM.uniform(size=(2, 3, 9, 4))
    np.testing.assert_allclose(spectral_table.resample_azimuths(values, 9), values, atol=1e-12)


class Shutter:
    """Lets pass what lies to one side of a bearing."""

    def __init__(self, azimuth):
        self.azimuth = azimuth

    @property
    def uncovered(self):
        return np.full(SUN.irradiance.shape, 0.5)

    def visible_share(self, azimuth, zenith):
        assert azimuth.shape == zenith.shape
        return np.where(azimuth < self.azimuth, 1.0, 0.0)


def test_an_occluder_takes_its_share_of_the_disc():
    half = dataclasses.replace(SUN, occluder=Shutter(SUN.azimuth))
    bare, covered = (Disc(lit_by(each), each) for each in (SUN, half))
    for whole, left in zip(
        bare.irradiance_per_irradiance(), covered.irradiance_per_irradiance(), strict=True
    ):
        np.testing.assert_allclose(left, 0.5 * whole, rtol=1e-3)
    zenith, distance = np.full(2, SUN.zenith), np.full(2, 0.001)
    azimuth = SUN.azimuth + np.array([-0.001, 0.001])
    seen = covered.radiance_per_irradiance(zenith, distance, azimuth)
    np.testing.assert_array_equal(seen[0], bare.radiance_per_irradiance(zenith, distance)[0])
    assert (seen[1] == 0.0).all()
    with pytest.raises(ValueError, match="azimuth: must be given for a source with an occluder"):
        covered.radiance_per_irradiance(zenith, distance)


def test_segments_end_at_the_radiance_of_the_whole_ray():
    light = lit_by(SUN, MOON)
    up = np.abs(DIRECTIONS) + np.array([0.0, 0.02, 0.0])
    segments = light.segments(up.reshape(6, 10, 3), [0.0, 1.0, 30.0, math.inf])
    assert segments.radiance.shape == segments.transmittance.shape == (6, 10, 4, 3)
    assert (segments.radiance[..., 0, :] == 0.0).all()
    assert (np.diff(segments.radiance, axis=2) > 0.0).all()
    whole = light.radiance(up).reshape(6, 10, 3)
    np.testing.assert_allclose(segments.radiance[..., -1, :], whole, rtol=2e-3)


def test_segments_of_the_first_order_alone_are_refused():
    with pytest.raises(InputError, match="segments: method must not be march"):
        truth_skylight("EARTH_A", 20.0, 0.0, "march").segments(DIRECTIONS, [1.0])


@pytest.mark.parametrize("altitude", [-1e-3, math.inf, math.nan])
def test_places_that_do_not_exist_are_refused(altitude):
    with pytest.raises(InputError, match="altitude: must be at least 0 m"):
        Observer(altitude)


@pytest.mark.parametrize(("elevation", "azimuth"), [(91.0, 0.0), (math.nan, 0.0), (10.0, math.inf)])
def test_sources_that_stand_nowhere_are_refused(elevation, azimuth):
    with pytest.raises(InputError, match=r"source (elevation|azimuth): must be"):
        white_source(elevation, azimuth)


def test_angles_of_a_direction_are_those_that_it_is_made_of():
    azimuth = RANDOM.uniform(-math.pi, math.pi, 50)
    elevation = RANDOM.uniform(-1.5, 1.5, 50)
    direction = direction_from_angles(azimuth, elevation)
    np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(
        zenith_azimuth(7.0 * direction), (math.pi / 2.0 - elevation, azimuth), atol=1e-12
    )


def test_the_light_of_a_sun_that_is_lower_than_any_solved_one_fades_on():
    field = Sky("earth", 0.5).atmosphere.field
    lowest = 0.5 * math.pi - field.sun_angle[-1]
    up = np.array([0.0, 1.0, 0.0])
    before, at, after, deep = (
        Sky("earth", lowest + math.radians(each)).radiance(up).sum() for each in (1, 0, -1, -20)
    )
    assert at / before == pytest.approx(after / at, rel=0.3)
    assert deep < 1e-6 * at
