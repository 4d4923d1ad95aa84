import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.transport.samples import BATCH_RAYS, MAX_SAMPLES, allocate_samples
from skybake.transport.shells import altitude_shells
from skybake.transport.trace import MAX_ARC, trace
from tests.kernels import fill_column, ray_limits
from tests.media import RADIUS, TOP, plain_medium
from tests.truth import truth_medium

CLEAR = plain_medium(extinction=[0.0, 0.0])
CLEAR_SHELLS = altitude_shells(CLEAR)
EARTH = truth_medium("EARTH_A")
EARTH_SHELLS = altitude_shells(EARTH)
HORIZON = -math.sqrt(1.0 - (RADIUS / (RADIUS + 2.0)) ** 2)


def traced(medium, r, mu, shells=None):
    samples = allocate_samples(medium)
    shells = altitude_shells(medium) if shells is None else shells
    rays = np.array([[r, mu]])
    assert trace(medium, shells, MAX_ARC, rays, 0, 1, samples) == 1
    assert samples.first[0] == 0
    whole = samples._replace(transmittance=samples.transmittance[0], column=samples.column[0])
    return whole, samples.number[0], samples.length[0], samples.hits_ground[0]


@given(
    st.one_of(
        st.floats(0.0, 1e6),
        st.sampled_from([0.0, 1e-8, 2.0, 100.0, 1e6, *CLEAR_SHELLS.tolist()]),
    ),
    st.one_of(
        st.floats(-1.0, 1.0),
        st.sampled_from([0.0, -0.0, -1e-16, 1e-16, -1e-9, 1.0, -1.0, HORIZON]),
        st.floats(-1e-7, 1e-7),
    ),
)
def test_steps_cover_every_ray_from_end_to_end_once(h, mu):
    samples, count, length, _ = traced(CLEAR, RADIUS + h, mu, CLEAR_SHELLS)
    first, last, _ = ray_limits(CLEAR, RADIUS + h, mu)
    assert count < MAX_SAMPLES
    assert length == last
    # Transmittance is 1 without extinction, so weights are the lengths themselves.
    assert samples.weight[:count].sum(axis=0) == pytest.approx(
        [last - first] * 2, rel=1e-9, abs=1e-9
    )
    distance = samples.distance[:count]
    # Crossings of shells round to a nanometre near the ground, to a millimetre far away.
    slack = 1e-12 * max(h, 1.0) + 1e-11
    assert (np.diff(distance) >= -slack).all()
    assert ((distance >= first - slack) & (distance <= last + slack)).all()


@pytest.mark.parametrize("offset", [-1e-12, 0.0, 1e-12])
@pytest.mark.parametrize("h", [1e-8, 2.0, 50.0, 100.0, 400.0, 1e6])
@pytest.mark.parametrize("edge", [RADIUS, TOP])
def test_rays_that_graze_the_ground_or_the_top_end(h, edge, offset):
    r = RADIUS + h
    mu = -math.sqrt(max(0.0, 1.0 - (edge / r) ** 2)) * (1.0 + offset)
    samples, count, _, _ = traced(EARTH, r, mu, EARTH_SHELLS)
    assert count < MAX_SAMPLES
    assert np.isfinite(samples.weight[:count]).all()
    assert ((samples.transmittance >= 0.0) & (samples.transmittance <= 1.0)).all()


@pytest.mark.parametrize(
    "optical_depth",
    [
        0.1,
        1.0,
        10.0,
        100.0,
        1e4,
    ],
)
@pytest.mark.parametrize(("h", "mu"), [(0.0, 1.0), (0.0, 0.0), (50.0, -0.01), (400.0, -0.9)])
def test_uniform_air_returns_one_less_transmittance_over_extinction(optical_depth, h, mu):
    first, last, _ = ray_limits(CLEAR, RADIUS + h, mu)
    extinction = optical_depth / (last - first)
    samples, count, _, _ = traced(plain_medium(extinction=extinction), RADIUS + h, mu)
    expected = -math.expm1(-optical_depth) / extinction
    assert count < MAX_SAMPLES
    assert samples.weight[:count].sum() == pytest.approx(expected, rel=3e-4)
    assert samples.transmittance[0] == pytest.approx(math.exp(-optical_depth), rel=1e-6, abs=1e-9)


def test_air_so_thick_that_no_light_passes_needs_few_samples():
    samples, count, _, _ = traced(plain_medium(extinction=100.0), RADIUS, 0.0)
    assert count < 500
    assert samples.transmittance[0] < 1e-8


@pytest.mark.parametrize("wavelengths", [[1e-6, 10.0], [10.0, 1e-6]])
def test_one_opaque_wavelength_does_not_end_the_others(wavelengths):
    samples, count, length, _ = traced(plain_medium(extinction=wavelengths), RADIUS, 0.0)
    thin = int(np.argmin(wavelengths))
    expected = -math.expm1(-1e-6 * length) / 1e-6
    assert samples.weight[:count, thin].sum() == pytest.approx(expected, rel=1e-6)


@given(st.one_of(st.floats(0.0, 100.0), st.floats(100.0, 1e5)), st.floats(-1.0, 1.0))
def test_no_step_crosses_a_shell_or_the_closest_point(h, mu):
    r = RADIUS + h
    samples, count, _, _ = traced(EARTH, r, mu, EARTH_SHELLS)
    pairs = samples.distance[:count].reshape(-1, 2)
    radius = samples.radius[:count].reshape(-1, 2)
    is_long = pairs @ [-1.0, 1.0] > 1e-4
    layer = np.searchsorted(EARTH_SHELLS, radius - RADIUS)
    np.testing.assert_array_equal(layer[is_long, 0], layer[is_long, 1])
    after_closest = pairs > -r * mu
    np.testing.assert_array_equal(after_closest[is_long, 0], after_closest[is_long, 1])


@given(st.floats(0.0, 100.0), st.floats(-1.0, 1.0))
def test_column_of_a_ray_matches_a_thousand_plain_steps(h, mu):
    r = RADIUS + h
    samples, _, length, hits_ground = traced(EARTH, r, mu, shells=EARTH_SHELLS)
    scratch, expected = np.empty(3), np.empty(3)
    closest = -r * mu
    if 0.0 < closest < length:
        # Quadratic steps crowd at a ray's start, so begin both halves at the dense middle.
        middle = math.sqrt(max(r * r - closest * closest, RADIUS**2))
        back, forth = np.empty(3), np.empty(3)
        fill_column(EARTH, middle, 0.0, closest, 1000, scratch, back)
        fill_column(EARTH, middle, 0.0, length - closest, 1000, scratch, forth)
        expected = back + forth
    elif hits_ground:
        mu_end = (r * mu + length) / RADIUS
        fill_column(EARTH, RADIUS, -mu_end, length, 1000, scratch, expected)
    else:
        fill_column(EARTH, r, mu, length, 1000, scratch, expected)
    if samples.transmittance.max() < 1e-8:
        return  # the ray ends where nothing more is seen
    # Steps end near the corners of the ozone's tent, not at them: its column alone is
    # off by a percent where little is left, the optical depth never by 0.002.
    error = EARTH.extinction.T @ np.abs(samples.column - expected)
    assert (error < 2e-3 * np.maximum(EARTH.extinction.T @ expected, 1.0)).all()


def test_a_limb_seen_from_a_million_km_is_the_limb():
    """Twice the half that starts level at the lowest point."""
    r = RADIUS + 1e6
    mu = -math.sqrt(1.0 - ((RADIUS + 20.0) / r) ** 2)
    limb, _, _, hits_ground = traced(EARTH, r, mu, shells=EARTH_SHELLS)
    half, _, _, _ = traced(EARTH, RADIUS + 20.0, 0.0, shells=EARTH_SHELLS)
    assert not hits_ground
    np.testing.assert_allclose(limb.column, 2.0 * half.column, rtol=1e-3)


def test_rays_that_do_not_fit_into_a_batch_are_left_for_the_next():
    h = np.linspace(0.0, 90.0, 3 * BATCH_RAYS)
    rays = np.stack([RADIUS + h, np.full_like(h, 0.1)], axis=1)
    samples = allocate_samples(EARTH)
    begin, single = 0, []
    while begin < len(rays):
        end = trace(EARTH, EARTH_SHELLS, MAX_ARC, rays, begin, len(rays), samples)
        assert begin < end <= begin + BATCH_RAYS
        used = samples.first[: end - begin] + samples.number[: end - begin]
        assert used.max() <= samples.distance.size
        single.extend(samples.transmittance[: end - begin].copy())
        begin = end
    for i in (0, 100, len(rays) - 1):
        alone = traced(EARTH, *rays[i], shells=EARTH_SHELLS)[0]
        np.testing.assert_array_equal(single[i], alone.transmittance)
