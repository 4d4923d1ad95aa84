"""Stokes vectors of the sky against a vector Monte Carlo and published tables."""

import math

import numpy as np
import pytest

from skybake.angles import direction_from_angles
from skybake.errors import InputError
from skybake.optics.matrix import rayleigh_matrix
from skybake.optics.medium import Medium, altitude_nodes
from skybake.optics.phase import scattering_angles
from skybake.scattering.atmosphere import load_atmosphere
from skybake.sky.observer import Observer
from skybake.sky.pixels import allocate_pixels, fill_directions
from skybake.sky.skylight import Skylight
from skybake.sky.stokes import linear_polarisation, stokes_per_irradiance
from skybake.sky.stokes_table import fold_stokes, stokes_table
from tests.media import cosine_to_sun
from tests.skies import white_source
from tests.truth import TRUTH_WAVELENGTHS, load_vector_truth, rayleigh, vector_medium

SUNS = (60.0, 10.0, 0.0, -4.0)


def skylight(name, elevation, altitude=0.001, method="full"):
    source = white_source(elevation)
    return Skylight(load_atmosphere(vector_medium(name), method), Observer(altitude), (source,))


def rows_of(name, elevation, wavelength):
    """Rows of a table; the zenith is left out, where azimuths have no meaning."""
    table = load_vector_truth(name)
    return table[
        (table["sun_elevation_deg"] == elevation)
        & (table["wavelength_nm"] == wavelength)
        & (table["view_zenith_deg"] > 0.0)
    ]


def seen(light, rows, elevation):
    """Stokes vectors in the directions of a table's rows, (row, 4, wavelength)."""
    mu = np.cos(np.radians(rows["view_zenith_deg"]))
    azimuth = np.radians(rows["relative_azimuth_deg"])
    nu = cosine_to_sun(mu, np.full_like(mu, math.sin(math.radians(elevation))), azimuth)
    return stokes_per_irradiance(light, light.sources[0], mu, nu)


def rms_beyond_noise(error, noise):
    return math.sqrt(max(float(np.mean(error**2) - np.mean(noise**2)), 0.0))


@pytest.mark.parametrize("elevation", SUNS)
@pytest.mark.parametrize("name", ["RAY", pytest.param("RAYMIE", marks=pytest.mark.slow)])
def test_intensity_and_polarisation_are_those_of_vector_transfer(name, elevation):
    light = skylight(name, elevation)
    for k, wavelength in enumerate(TRUTH_WAVELENGTHS):
        rows = rows_of(name, elevation, wavelength)
        whole, even, odd, _ = seen(light, rows, elevation)[:, :, k].T
        error, noise = whole / rows["I"] - 1.0, rows["stderr_I"] / rows["I"]
        assert rms_beyond_noise(error, noise) < 0.002
        assert np.abs(error).max() < 0.01
        for element, got in (("Q", even), ("U", odd)):
            error = got / whole - rows[element] / rows["I"]
            assert rms_beyond_noise(error, rows[f"stderr_{element}"] / rows["I"]) < 0.0015
            assert np.abs(error).max() < 0.005


@pytest.mark.slow
def test_the_method_scalar_has_the_intensity_of_light_without_polarisation():
    rows = rows_of("RAY", 0.0, 440.0)
    light = skylight("RAY", 0.0, method="scalar")
    mu = np.cos(np.radians(rows["view_zenith_deg"]))
    nu = cosine_to_sun(mu, np.zeros_like(mu), np.radians(rows["relative_azimuth_deg"]))
    got = light.radiance_per_irradiance(light.sources[0], mu, nu)[:, 2]
    error = got / rows["scalar_I"] - 1.0
    assert rms_beyond_noise(error, rows["scalar_stderr"] / rows["scalar_I"]) < 0.002
    assert np.abs(got / rows["I"] - 1.0).max() > 0.05
    with pytest.raises(InputError, match="method must be full"):
        light.stokes(np.array([0.0, 1.0, 0.0]))


def test_the_first_parameter_is_the_radiance():
    light = skylight("RAY", 10.0)
    directions = np.random.default_rng(3).normal(size=(20, 3))
    np.testing.assert_allclose(
        light.stokes(directions)[:, 0], light.radiance(directions), rtol=1e-12
    )


def test_u_changes_sign_across_the_plane_of_the_sun_and_q_does_not():
    light = skylight("RAY", 10.0)
    left, right = (
        direction_from_angles(light.sources[0].azimuth + turn, math.radians(40.0))
        for turn in (1.0, -1.0)
    )
    a, b = light.stokes(np.stack([left, right]))
    np.testing.assert_allclose(a[:2], b[:2], rtol=1e-6)
    np.testing.assert_allclose(a[2], -b[2], rtol=1e-6)
    # Clockwise of its bearing the sun is below to the left, and the E-vector across that way.
    assert (a[2] > 0.0).all()


def test_light_is_most_polarised_across_a_quarter_of_the_sky_from_the_sun():
    light = skylight("RAY", 10.0)
    angle = np.radians(np.arange(0.0, 166.0, 5.0))
    directions = direction_from_angles(light.sources[0].azimuth, angle + math.radians(10.0))
    degree, _ = linear_polarisation(light.stokes(directions))
    most = np.degrees(angle[degree.argmax(axis=0)])
    np.testing.assert_allclose(most, 90.0, atol=5.0)
    # Light that is scattered often, and from the ground, dilutes the blue most.
    assert (np.diff(degree.max(axis=0)) < 0.0).all()
    assert 0.7 < degree.max() < 0.95


@pytest.mark.parametrize(("elevation", "view_azimuth"), [(0.0, 0.0), (0.0, 180.0), (10.0, 180.0)])
def test_neutral_points_are_where_those_of_the_table_are(elevation, view_azimuth):
    """Babinet's above the sun and Arago's above the point opposite to it."""
    light = skylight("RAY", elevation)
    for k, wavelength in enumerate(TRUTH_WAVELENGTHS):
        rows = rows_of("RAY", elevation, wavelength)
        rows = rows[rows["relative_azimuth_deg"] == view_azimuth]
        rows = np.sort(rows, order="view_zenith_deg")
        got = seen(light, rows, elevation)[:, :2, k]
        places = [
            neutral_point(rows["view_zenith_deg"], *each)
            for each in ((rows["Q"], rows["I"]), (got[:, 1], got[:, 0]))
        ]
        assert abs(places[0] - places[1]) < 0.3
        from_sun = 90.0 - places[0] - elevation * (1.0 if view_azimuth == 0.0 else -1.0)
        assert 8.0 < from_sun < 30.0


@pytest.mark.slow
@pytest.mark.parametrize("view_azimuth", [0.0, 180.0])
def test_neutral_points_at_sunset_are_20_degrees_away_and_farther_in_haze(view_azimuth):
    """Neuberger (1951), Introduction to Physical Meteorology, 196; Sekera (1951), Compendium, 79.

    They write "about 20" and "close to 20" of what observers saw, which here is green light.
    """
    rows = np.zeros(100, [("view_zenith_deg", float), ("relative_azimuth_deg", float)])
    rows["view_zenith_deg"], rows["relative_azimuth_deg"] = (
        np.linspace(40.0, 89.5, 100),
        view_azimuth,
    )
    green = list(TRUTH_WAVELENGTHS).index(550.0)
    away = []
    for name in ("RAY", "RAYMIE"):
        got = seen(skylight(name, 0.0), rows, 0.0)[..., green]
        away.append(90.0 - neutral_point(rows["view_zenith_deg"], got[:, 1], got[:, 0]))
    assert away == pytest.approx([20.0, 20.0], abs=3.0)
    assert away[1] > away[0] + 1.0


def neutral_point(zenith, even, whole):
    """Zenith angle at which Q / I changes sign, nearest to the horizon."""
    ratio = even / whole
    (changes,) = np.nonzero(np.diff(np.sign(ratio)))
    i = changes[-1]
    share = ratio[i] / (ratio[i] - ratio[i + 1])
    return zenith[i] + share * (zenith[i + 1] - zenith[i])


@pytest.mark.parametrize("altitude", [0.001, 400.0])
def test_a_folded_table_has_the_stokes_vectors_of_rays(altitude):
    light = skylight("RAY", 5.0, altitude)
    (source,) = light.sources
    folded = fold_stokes(stokes_table(light, source, light.spectral_table(source)), np.eye(3))
    random = np.random.default_rng(7)
    zenith, azimuth = np.arccos(random.uniform(-1.0, 1.0, 300)), random.uniform(0.0, 6.28, 300)
    zenith[:30], azimuth[30:60] = random.uniform(0.0, 0.05, 30), random.normal(0.0, 0.01, 30)
    if altitude > 100.0:
        zenith = random.uniform(1.95, math.pi, 300)
    pixels = []
    for table in folded:
        out = np.zeros((300, 1, 3), np.float32)
        places = zenith[:, None].copy(), azimuth[:, None].copy(), np.full((1, 1), 1e-6)
        fill_directions(table, *places, 0, 300, allocate_pixels(table, 1), out)
        pixels.append(out[:, 0])
    pixels[1] *= np.sin(azimuth)[:, None]
    directions = direction_from_angles(source.azimuth + azimuth, math.pi / 2.0 - zenith)
    expected = light.stokes(directions)
    bright = expected[:, 0] > 1e-4 * expected[:, 0].max(axis=0)
    for got, each in zip(pixels, (1, 2), strict=True):
        error = np.abs(got - expected[:, each]) / expected[:, 0]
        assert error[bright].max() < (3e-4 if altitude < 100.0 else 3e-3)


@pytest.mark.slow
def test_a_flat_layer_has_the_stokes_vectors_of_coulsons_tables():
    """Natraj, Li & Yung (2009), Astrophys. J. 691, 1909; their Q and U have the other sign.

    Optical depth 0.5 over a black ground, cosine of the sun 0.2, light that leaves at the top.
    """
    radius, height = 1e6, 10.0
    matrix = rayleigh_matrix(np.zeros(1))[None]
    phase = rayleigh(scattering_angles())[None, :, None].copy()
    extinction = np.full((1, 1), 0.5 / height)
    density = np.ones((altitude_nodes(radius, radius + height).size, 1))
    medium = Medium(
        radius, radius + height, density, extinction, extinction, phase, np.zeros(1), matrix
    )
    source = white_source(math.degrees(math.asin(0.2)), wavelengths=1)
    light = Skylight(load_atmosphere(medium, "full"), Observer(height), (source,))
    mu, azimuth = np.array([-0.4, -0.4, -0.9999999]), np.radians([0.0, 60.0, 60.0])
    got = stokes_per_irradiance(light, source, mu, cosine_to_sun(mu, 0.2, azimuth))[..., 0]
    table = np.array(
        [
            [0.16889020, -0.01119511, 0.0],
            [0.12752450, 0.06066038, -0.05293867],
            [0.05300496, 0.01877930, -0.03252669],
        ]
    )
    np.testing.assert_allclose(got[:, 0] * math.pi, table[:, 0], rtol=5e-4)
    np.testing.assert_allclose(got[:, 1:3] * math.pi, table[:, 1:], atol=5e-4 * table[0, 0])
