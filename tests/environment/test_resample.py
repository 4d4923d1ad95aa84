"""Maps in other projections and sizes keep their light."""

import math

import numpy as np
import pytest

from skybake.angles import direction_from_angles
from skybake.environment.environment import charts_of
from skybake.environment.resample import resample
from skybake.jit.workers import Workers
from skybake.projection import Angular, Cubemap, Equirect, Fisheye, Octahedral, Perspective
from tests.environment.maps import SUN, brightest, energy, lit, noisy, vectors

WHOLE = (
    Equirect(256),
    Equirect(600),
    Equirect(256, "poles"),
    Cubemap(32),
    Cubemap(150, "cross"),
    Octahedral(128),
    Octahedral(300),
    Angular(128),
)
SUNS = (SUN, (0.001, 0.0), (math.pi / 2, math.pi / 4), (math.pi / 2, 0.0), (2.0, 6.28))
"""Within a face, in the zenith, on an edge of a cube, on the seam of an equirect map."""


@pytest.mark.parametrize(
    ("source", "sun"),
    [(Equirect(512), sun) for sun in SUNS]
    + [(Cubemap(100, "exr"), SUNS[2]), (Octahedral(256), SUNS[1])],
)
def test_energy_is_kept_to_a_thousandth_with_a_sun(source, sun):
    environment = lit(source, sun)
    before = energy(environment)
    for projection in WHOLE:
        after = energy(resample(environment, projection, 0.3))
        np.testing.assert_allclose(after, before, rtol=1e-3, err_msg=repr(projection))


@pytest.mark.parametrize("width", [64, 256, 1024])
def test_energy_of_lamps_at_random_is_kept_to_a_thousandth(width):
    environment = noisy(width)
    before = energy(environment)
    for projection in (Equirect(128), Cubemap(32)):
        after = energy(resample(environment, projection))
        np.testing.assert_allclose(after, before, rtol=1e-3, err_msg=repr(projection))


@pytest.mark.parametrize("projection", WHOLE)
def test_a_map_of_one_value_stays_one(projection):
    environment = lit(Cubemap(40), sun=None)
    for picture in environment.pixels:
        picture[...] = (0.25, 3.0, 7.0)
    result = resample(environment, projection, 1.0)
    for chart, here in charts_of(projection, result.pixels):
        nowhere = chart.looks_nowhere(0, chart.height)
        seen = here.reshape(-1, 3) if nowhere is None else here[~nowhere]
        np.testing.assert_allclose(seen, np.broadcast_to((0.25, 3.0, 7.0), seen.shape), rtol=1e-6)


@pytest.mark.parametrize("projection", WHOLE)
def test_every_projection_shows_directions_where_they_are(projection):
    environment = lit(Equirect(512), sun=None)
    result = resample(environment, projection)
    for chart, here in charts_of(projection, result.pixels):
        x, y, z = vectors(chart)
        nowhere = chart.looks_nowhere(0, chart.height)
        shown = np.ones(here.shape[:2], bool) if nowhere is None else ~nowhere
        coarse = 0.06 if projection == Angular(128) else 0.02
        np.testing.assert_allclose(here[shown, 1], (0.4 + 0.1 * x)[shown], rtol=coarse)
        np.testing.assert_allclose(here[shown, 0], (0.3 + 0.2 * y + 0.05 * x)[shown], rtol=coarse)
        np.testing.assert_allclose(
            here[shown, 2], (0.6 + 0.3 * y * y - 0.2 * z)[shown], rtol=coarse
        )


def test_the_own_projection_and_size_change_no_pixel():
    for projection in (Equirect(256), Cubemap(50, "cross"), Octahedral(90), Equirect(64, "poles")):
        environment = lit(projection)
        for before, after in zip(
            environment.pixels, resample(environment, projection).pixels, strict=True
        ):
            np.testing.assert_array_equal(after, before)


def test_layouts_of_a_cube_differ_in_places_only():
    environment = lit(Cubemap(50))
    for layout in ("cross", "vertical-cross", "row", "column", "exr"):
        there = resample(environment, Cubemap(50, layout))
        back = resample(there, Cubemap(50))
        np.testing.assert_array_equal(back.pixels, environment.pixels)


def test_a_turn_by_whole_columns_changes_no_pixel():
    environment = lit(Equirect(256))
    turned = resample(environment, Equirect(256), 2.0 * math.pi * 40 / 256)
    np.testing.assert_array_equal(turned.pixels[0], np.roll(environment.pixels[0], -40, axis=1))


def test_half_a_size_is_the_mean_of_texels_by_their_solid_angles():
    environment = noisy(64)
    result = resample(environment, Equirect(32))
    (chart, pixels), *_ = charts_of(environment.projection, environment.pixels)
    weight = np.broadcast_to(chart.solid_angles(0, 32), (32, 64))[..., None]
    flux = (pixels * weight).reshape(16, 2, 32, 2, 3).sum(axis=(1, 3))
    mean = flux / weight.reshape(16, 2, 32, 2, 1).sum(axis=(1, 3))
    np.testing.assert_allclose(result.pixels[0], mean, rtol=2e-3)


@pytest.mark.parametrize("rotation", [0.0, 0.7, -2.0])
def test_a_rotation_is_the_bearing_of_minus_z(rotation):
    environment = lit(Equirect(512))
    result = resample(environment, Cubemap(256), rotation)
    expected = direction_from_angles(SUN[1] - rotation, math.pi / 2 - SUN[0])
    assert brightest(result) @ expected > math.cos(0.01)
    back = resample(result, Equirect(512), 0.0)
    straight = direction_from_angles(SUN[1], math.pi / 2 - SUN[0])
    assert brightest(back) @ straight > math.cos(0.015)


def test_enlarged_maps_are_smooth_also_over_the_edges_of_faces():
    environment = lit(Cubemap(16), sun=None)
    result = resample(environment, Equirect(1024))
    pixels = result.pixels[0][:, :, 1].astype(float)
    across = np.abs(np.diff(pixels, axis=1, append=pixels[:, :1])).max()
    down = np.abs(np.diff(pixels, axis=0)).max()
    # A texel is eleven pixels; boxes would step by all of its difference to the next.
    assert across < 0.1 * 2 / 16 / 3
    assert down < 0.1 * 2 / 16 / 3


def test_the_result_has_the_same_bits_for_any_number_of_threads():
    environment = lit(Equirect(512))
    for projection in (Cubemap(100), Equirect(300)):
        one, three = (
            resample(environment, projection, 0.1, Workers(count)).pixels for count in (1, 3)
        )
        for alone, shared in zip(one, three, strict=True):
            np.testing.assert_array_equal(alone, shared)


def test_a_view_of_a_part_holds_the_light_of_that_part():
    environment = lit(Equirect(512))
    fine = Perspective(400, 300, 1.0, SUN[1], math.pi / 2 - SUN[0])
    coarse = Perspective(40, 30, 1.0, SUN[1], math.pi / 2 - SUN[0])
    np.testing.assert_allclose(
        energy(resample(environment, coarse)), energy(resample(environment, fine)), rtol=1e-3
    )


def test_a_sun_on_the_rim_of_a_view_does_not_bring_all_of_its_light():
    elevation = math.pi / 2 - SUN[0]
    environment = lit(Equirect(512), radius=0.03, radiance=1e3)
    aside = Perspective(64, 64, 0.5, SUN[1] + 0.25 / math.cos(elevation), elevation)
    half = energy(resample(environment, aside))[0]
    whole = energy(resample(environment, Perspective(64, 64, 0.5, SUN[1], elevation)))[0]
    assert 0.2 < half / whole < 0.8


def test_what_a_dome_does_not_show_is_black():
    dome = resample(lit(Equirect(256)), Fisheye(128, elevation=math.pi / 2))
    result = resample(dome, Equirect(256))
    assert (result.pixels[0][66:] == 0.0).all()
    assert (result.pixels[0][:62] > 0.0).all()
