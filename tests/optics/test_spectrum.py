from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.errors import PresetError
from skybake.optics.spectrum import (
    eval_band_mean,
    eval_spectrum,
    limb_darkening,
    star_irradiance,
    star_spectrum,
)
from skybake.preset import Spectrum, load_preset

RAMP = Spectrum("a.toml: ground.albedo", (400.0, 450.0, 600.0), (0.0, 0.5, 0.2))


def test_a_spectrum_is_exact_at_its_nodes_and_linear_between():
    values = eval_spectrum(RAMP, np.array([600.0, 425.0, 450.0, 400.0, 525.0]))
    np.testing.assert_allclose(values, [0.2, 0.25, 0.5, 0.0, 0.35], rtol=1e-15)


def test_one_value_holds_at_every_wavelength():
    np.testing.assert_array_equal(
        eval_spectrum(Spectrum("", (), (3.0,)), np.array([1.0, 9e9])), 3.0
    )


@pytest.mark.parametrize("wavelength", [399.9, 600.1, np.nan])
@pytest.mark.parametrize("evaluate", [eval_spectrum, lambda s, w: eval_band_mean(s, w, 10.0)])
def test_a_wavelength_beyond_the_nodes_is_refused_with_their_range(wavelength, evaluate):
    with pytest.raises(PresetError) as caught:
        evaluate(RAMP, np.array([500.0, wavelength]))
    assert str(caught.value) == (
        f"a.toml: ground.albedo: wavelength must be within 400 to 600 nm, got {wavelength:g} nm"
    )


@given(st.lists(st.floats(400.0, 600.0), min_size=2, max_size=8, unique=True))
def test_means_over_adjoining_bands_add_up_to_the_integral(edges):
    edges = np.sort(edges)
    if np.diff(edges).min() < 1e-3:
        return
    parts = [
        eval_band_mean(RAMP, np.array([(a + b) / 2.0]), b - a)[0] * (b - a)
        for a, b in pairwise(edges)
    ]
    nodes = np.union1d(edges, [450.0])
    nodes = nodes[(nodes >= edges[0]) & (nodes <= edges[-1])]
    whole = np.trapezoid(np.interp(nodes, RAMP.wavelength, RAMP.values), nodes)
    assert sum(parts) == pytest.approx(whole, rel=1e-9, abs=1e-9)


def test_a_band_of_no_width_is_the_spectrum_itself():
    wavelengths = np.array([410.0, 600.0])
    np.testing.assert_array_equal(
        eval_band_mean(RAMP, wavelengths, 0.0), eval_spectrum(RAMP, wavelengths)
    )


def test_a_band_is_cut_at_the_ends_of_the_spectrum():
    assert eval_band_mean(RAMP, np.array([400.0]), 20.0)[0] == pytest.approx(0.05)


def test_sunlight_above_the_atmosphere_is_133_1_klx_and_5930_kelvin():
    import colour

    # ASTM G173 under the CIE 1931 observer; Darula, Kittler & Gueymard (2005) give 133.3.
    wavelengths, irradiance = star_spectrum(load_preset("earth").star)
    cmfs = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    bars = np.stack([np.interp(wavelengths, cmfs.wavelengths, cmfs.values[:, k]) for k in range(3)])
    xyz = 683.002 * np.trapezoid(irradiance * bars, wavelengths, axis=1)
    assert xyz[1] == pytest.approx(133.1e3, rel=1e-3)
    assert xyz[0] / xyz.sum() == pytest.approx(0.3234, abs=2e-4)
    assert xyz[1] / xyz.sum() == pytest.approx(0.3327, abs=2e-4)


def test_the_stars_own_table_ends_where_colour_matching_functions_do():
    wavelengths, irradiance = star_spectrum(load_preset("mars").star)
    assert (wavelengths[0], wavelengths[-1]) == (360.0, 830.0)
    assert np.all(np.diff(wavelengths) > 0.0)
    assert wavelengths.shape == irradiance.shape


def test_sunlight_on_mars_is_weaker_by_the_square_of_the_distance():
    wavelengths = np.array([440.0, 550.0, 680.0])
    ratio = star_irradiance(load_preset("mars").star, wavelengths) / star_irradiance(
        load_preset("earth").star, wavelengths
    )
    np.testing.assert_allclose(ratio, 1.5237**-2, rtol=1e-12)


def test_sunlight_at_550_nm_is_1_87_watts_per_square_metre_and_nanometre():
    # Mean over 545-555 nm of ASTM E490, a different measurement, is 1.866.
    irradiance = star_irradiance(load_preset("earth").star, np.array([550.0]))
    assert irradiance[0] == pytest.approx(1.866, rel=5e-3)


def test_limb_darkening_agrees_with_a_published_fit_to_allens_table():
    # Polynomials in angstrom of SolarSoft's darklimb_u and darklimb_v, 400-1500 nm.
    wavelengths = np.array([400.0, 450.0, 500.0, 550.0, 600.0, 700.0, 800.0])
    fit_u = [3.0453572e-19, -1.3389747e-14, 2.2540875e-10, -1.8144591e-6, 6.9093916e-3, -8.9829751]
    fit_v = [-2.599494e-19, 1.1444469e-14, -1.9359644e-10, 1.5788029e-6, -6.2212632e-3, 9.289118]
    fit = np.polyval(fit_u, 10.0 * wavelengths), np.polyval(fit_v, 10.0 * wavelengths)
    table = limb_darkening(load_preset("earth").star, wavelengths)
    mu = np.linspace(0.1, 1.0, 10)[:, None]
    published, ours = (1.0 - u * (1.0 - mu) - v * (1.0 - mu**2) for u, v in (fit, table))
    # The fit itself misses the table by up to 0.02.
    np.testing.assert_allclose(ours, published, atol=0.025)


def test_the_suns_limb_is_darker_in_the_blue_and_nowhere_negative():
    u, v = limb_darkening(load_preset("earth").star, np.array([400.0, 550.0, 700.0]))
    assert np.all(np.diff(1.0 - u - v) > 0.0)
    assert np.all(1.0 - u - v > 0.0)


def test_the_suns_disc_has_the_mean_that_was_measured():
    # Neckel & Labs (1994), Solar Phys. 153, 91, table I: mean over the disc to its centre.
    wavelengths = np.array([390.915, 445.125, 492.905, 559.95, 610.975, 700.875, 811.76])
    u, v = limb_darkening(load_preset("earth").star, wavelengths)
    measured = [0.7204, 0.7596, 0.7823, 0.8061, 0.8221, 0.8434, 0.8621]
    np.testing.assert_allclose(1.0 - u / 3.0 - v / 2.0, measured, atol=3e-4)
