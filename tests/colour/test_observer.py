from pathlib import Path

import colour
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import skybake
from skybake.colour.observer import LUMINOUS_EFFICACY, load_observer, xyz_weights

NODES = np.linspace(380.0, 720.0, 16)
SUN = np.loadtxt(
    Path(skybake.__path__[0]) / "data" / "sun_astm_g173.csv", delimiter=",", skiprows=3
).T


def test_the_table_is_the_one_of_colour_science():
    wavelengths, xyz_bar = load_observer()
    published = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]

    np.testing.assert_array_equal(wavelengths, published.wavelengths)
    np.testing.assert_allclose(xyz_bar, published.values, rtol=1e-9)


def test_the_table_cannot_be_changed_by_a_caller():
    with pytest.raises(ValueError, match="read-only"):
        load_observer()[1][0] = 0.0


def test_a_constant_spectrum_has_the_xyz_of_the_star_by_colour_science():
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    # In its domain of 1, colour-science returns hundredths of what k asks for.
    expected = 100.0 * colour.colorimetry.sd_to_XYZ_integration(
        np.interp(observer.wavelengths, *SUN),
        observer,
        colour.sd_ones(observer.shape),
        k=LUMINOUS_EFFICACY,
        shape=observer.shape,
    )

    np.testing.assert_allclose(xyz_weights(NODES, *SUN).sum(axis=0), expected, rtol=1e-9)


def test_the_sun_lights_the_top_of_the_air_with_133_kilolux():
    """Darula, Kittler and Gueymard (2005) give 133.1 to 133.8 klx."""
    assert 133.05e3 < xyz_weights(NODES, *SUN)[:, 1].sum() < 133.85e3


def test_a_spectrum_linear_between_the_nodes_is_integrated_exactly():
    wavelengths, xyz_bar = load_observer()
    values = np.random.default_rng(0).random(NODES.size)
    spectrum = np.interp(wavelengths, NODES, values) * np.interp(wavelengths, *SUN)

    np.testing.assert_allclose(
        values @ xyz_weights(NODES, *SUN),
        LUMINOUS_EFFICACY * (spectrum[:, None] * xyz_bar).sum(axis=0),
        rtol=1e-12,
    )


def test_one_wavelength_stands_for_the_whole_spectrum():
    weights = xyz_weights(np.array([550.0]), *SUN)

    np.testing.assert_allclose(weights[0], xyz_weights(NODES, *SUN).sum(axis=0), rtol=1e-12)


@given(st.lists(st.floats(300.0, 900.0), min_size=1, max_size=20, unique=True).map(sorted))
def test_weights_are_positive_and_their_sum_does_not_depend_on_the_nodes(nodes):
    weights = xyz_weights(np.array(nodes), *SUN)

    assert weights.min() >= 0.0
    np.testing.assert_allclose(weights.sum(axis=0), xyz_weights(NODES, *SUN).sum(axis=0), rtol=1e-9)


@pytest.mark.parametrize("nodes", [[], [500.0, 400.0], [500.0, 500.0], [400.0, np.nan, 500.0]])
def test_wavelengths_that_do_not_ascend_are_refused(nodes):
    with pytest.raises(ValueError, match="must ascend"):
        xyz_weights(np.array(nodes), *SUN)


def test_a_star_that_does_not_cover_the_visible_is_refused():
    with pytest.raises(ValueError, match="must cover 360 to 830 nm, got 400 to 800 nm"):
        xyz_weights(NODES, np.array([400.0, 800.0]), np.ones(2))
