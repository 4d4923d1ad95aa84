"""Light up to a distance: the whole ray in the limit, and parts that add up to it."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skybake.errors import InputError
from skybake.optics.phase import eval_phase
from skybake.scattering.ray import trace_rays
from skybake.scattering.segments import MAX_DISTANCES, trace_segments
from tests.kernels import ray_limits
from tests.media import cosine_to_sun
from tests.skies import truth_atmosphere

PLACES = [
    ("EARTH_A", 0.001, 40.0),
    ("EARTH_HAZE", 0.5, 10.0),
    ("EARTH_A", 2.0, -4.0),
    ("EARTH_A", 400.0, 10.0),
    ("EARTH_A", 400.0, -8.0),
    ("MARS_A", 0.001, 20.0),
    ("MARS_A", 10.0, -5.0),
]


def rays(name, h, elevation):
    """Rays up, down and through the horizon, in fans of five azimuths."""
    medium = truth_atmosphere(name).medium
    r = medium.r_bottom + h
    horizon = math.pi - math.asin(min(medium.r_bottom / r, 1.0))
    offset = np.radians([-80.0, -30.0, -5.0, -1.0, -0.2, 0.2, 1.0, 5.0, 40.0])
    zenith = np.unique(np.clip(horizon + offset, 0.0, math.pi))
    zenith, azimuth = (
        x.ravel() for x in np.meshgrid(zenith, np.linspace(0.1, 3.0, 5), indexing="ij")
    )
    mu, mu_s = np.cos(zenith), np.full(zenith.shape, math.sin(math.radians(elevation)))
    return np.full(mu.shape, r), mu, mu_s, cosine_to_sun(mu, mu_s, azimuth)


def ends_of(name, r, mu):
    """Where each ray enters the atmosphere, and where it ends."""
    medium = truth_atmosphere(name).medium
    return np.array([ray_limits(medium, *ray)[:2] for ray in zip(r, mu, strict=True)]).T


def moved(distance, r, mu, mu_s, nu):
    """The same rays, from places farther on."""
    there = np.sqrt(r * r + distance * (distance + 2.0 * r * mu))
    return there, (r * mu + distance) / there, (r * mu_s + distance * nu) / there, nu


def radiance(atmosphere, nu, single, diffuse):
    """With phase functions, shape (ray, wavelength)."""
    phase = eval_phase(atmosphere.scaled.phase, np.clip(nu, -1.0, 1.0))
    return (single * phase).sum(axis=1) + diffuse


def assert_close(light, expected, tolerance):
    """Where it is brighter than a thousandth of the brightest."""
    bright = expected > 1e-3 * expected.max(axis=0)
    assert bright.any()
    assert np.abs(light[bright] / expected[bright] - 1.0).max() < tolerance


@pytest.mark.parametrize(("name", "h", "elevation"), PLACES)
def test_an_infinite_distance_gives_the_whole_ray(name, h, elevation):
    atmosphere = truth_atmosphere(name)
    arguments = rays(name, h, elevation)
    whole = trace_rays(atmosphere, *arguments)
    light = trace_segments(atmosphere, *arguments, [math.inf])
    np.testing.assert_array_equal(light.single[:, 0], whole.single)
    np.testing.assert_array_equal(light.diffuse[:, 0], whole.diffuse)


@pytest.mark.parametrize(("name", "h", "elevation"), PLACES)
def test_many_distances_add_up_to_the_whole_ray_within_its_own_error(name, h, elevation):
    """More steps are more exact: the light of whole rays is within a per mille or two itself."""
    atmosphere = truth_atmosphere(name)
    arguments = rays(name, h, elevation)
    first, last = ends_of(name, *arguments[:2])
    shares = np.append(np.linspace(0.0, 1.0, 17), 1.5)
    ends = (first + (last - first) * shares[:, None]).T
    many = trace_segments(atmosphere, *arguments, ends)
    whole = trace_segments(atmosphere, *arguments, [math.inf])
    nu = arguments[3]
    light, expected = (
        radiance(atmosphere, nu, each.single[:, -1], each.diffuse[:, -1]) for each in (many, whole)
    )
    assert_close(light, expected, 2e-3)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
@pytest.mark.parametrize(("name", "h", "elevation"), PLACES)
def test_two_parts_of_a_ray_compose_to_the_whole_within_a_per_mille(name, h, elevation, share):
    atmosphere = truth_atmosphere(name)
    arguments = rays(name, h, elevation)
    first, last = ends_of(name, *arguments[:2])
    crosses = last > first
    arguments = [each[crosses] for each in arguments]
    distance = (first + (last - first) * share)[crosses]
    whole = trace_segments(atmosphere, *arguments, [math.inf])
    front = trace_segments(atmosphere, *arguments, distance[:, None])
    behind = trace_segments(atmosphere, *moved(distance, *arguments), [math.inf])
    passes = np.repeat(front.transmittance, whole.single.shape[2], axis=1)
    passes[:, atmosphere.medium.extinction.shape[0] :] = front.unscattered
    single = front.single[:, 0] + passes * behind.single[:, 0]
    diffuse = front.diffuse[:, 0] + front.transmittance[:, 0] * behind.diffuse[:, 0]
    nu = arguments[3]
    expected = radiance(atmosphere, nu, whole.single[:, 0], whole.diffuse[:, 0])
    assert_close(radiance(atmosphere, nu, single, diffuse), expected, 1e-3)


@pytest.mark.parametrize(("name", "h", "elevation"), PLACES)
def test_no_distance_gathers_nothing_and_hides_nothing(name, h, elevation):
    light = trace_segments(truth_atmosphere(name), *rays(name, h, elevation), [0.0])
    assert (light.single == 0.0).all()
    assert (light.diffuse == 0.0).all()
    assert (light.transmittance == 1.0).all()
    assert (light.unscattered == 1.0).all()


@settings(max_examples=30)
@given(
    st.sampled_from(PLACES),
    st.lists(st.floats(0.0, 3000.0), min_size=1, max_size=12).map(sorted),
)
def test_light_only_grows_and_transmittance_only_falls_with_distance(place, distances):
    light = trace_segments(truth_atmosphere(place[0]), *rays(*place), distances)
    # Sums are in single precision.
    assert (np.diff(light.single, axis=1) >= -1e-7 * light.single.max()).all()
    assert (np.diff(light.diffuse, axis=1) >= -1e-7 * light.diffuse.max()).all()
    for passes in (light.transmittance, light.unscattered):
        assert (np.diff(passes, axis=1) <= 0.0).all()
        assert ((passes >= 0.0) & (passes <= 1.0)).all()
    assert (light.unscattered <= light.transmittance * (1.0 + 1e-6)).all()


def test_the_ground_is_seen_beyond_it_only():
    atmosphere = truth_atmosphere("EARTH_A")
    mu = np.array([-1.0])
    r = np.array([atmosphere.medium.r_bottom + 2.0])
    light = trace_segments(atmosphere, r, mu, np.array([0.8]), np.array([-0.8]), [2.0, 2.01, 9.0])
    before, just, far = light.diffuse[0]
    assert (just > 1.5 * before).all()
    np.testing.assert_array_equal(just, far)


def test_distances_of_each_ray_are_as_they_are_for_it_alone():
    atmosphere = truth_atmosphere("EARTH_A")
    arguments = rays("EARTH_A", 2.0, 5.0)
    distances = np.sort(np.random.default_rng(3).uniform(0.0, 200.0, (len(arguments[0]), 4)))
    distances[5:10] = distances[5]
    together = trace_segments(atmosphere, *arguments, distances)
    for i in (0, 5, 7, 20):
        alone = trace_segments(atmosphere, *(each[i : i + 1] for each in arguments), distances[i])
        for part, expected in zip(together, alone, strict=True):
            np.testing.assert_allclose(part[i], expected[0], rtol=1e-5)


@pytest.mark.parametrize(
    ("distances", "message"),
    [
        ([-1.0], "must ascend from 0 km"),
        ([2.0, 1.0], "must ascend from 0 km"),
        ([math.nan], "must ascend from 0 km"),
        ([], "must be 1 to 1024"),
        (5.0, "must be 1 to 1024"),
        (np.arange(MAX_DISTANCES + 1.0), "must be 1 to 1024"),
    ],
)
def test_distances_that_are_none_are_refused(distances, message):
    with pytest.raises(InputError, match=f"distances: {message}"):
        trace_segments(truth_atmosphere("EARTH_A"), *rays("EARTH_A", 0.0, 10.0), distances)
