import numpy as np
import pytest

from skybake.optics.rayleigh import depolarisation_from_king, gas_scattering
from skybake.preset import ExponentialProfile, Gas, load_preset

STANDARD = 101325.0, 288.15


def gas(composition, pressure=STANDARD[0], temperature=STANDARD[1]) -> Gas:
    return Gas("gas", ExponentialProfile(8.0), pressure, temperature, tuple(composition.items()))


def test_air_scatters_as_bucholtz_tabulates():
    # Bucholtz (1995), Applied Optics 34, 2765, table 2: 1.149e-2 per km at 550 nm, 288.15 K.
    scattering, _ = gas_scattering(gas({"dry_air": 1.0}), np.array([550.0]))
    assert scattering[0] == pytest.approx(1.149e-2, rel=1e-3)


def test_air_has_the_cross_sections_of_bodhaine():
    # colour-science's own implementation of Bodhaine et al. (1999), which differs in how it
    # averages the King factor and takes 300 ppm of carbon dioxide.
    from colour.phenomena import scattering_cross_section

    wavelengths = np.array([400.0, 550.0, 700.0])
    scattering, _ = gas_scattering(gas({"dry_air": 1.0}), wavelengths)
    expected = scattering_cross_section(wavelengths * 1e-7) * 1e-4  # m²
    np.testing.assert_allclose(scattering, expected * 2.546899e25 * 1e3, rtol=1e-3)


def test_air_depolarises_as_young_found():
    # Young (1980): 0.0279, constant over the visible; Bates' dispersion is within 7 % of it.
    _, depolarisation = gas_scattering(gas({"dry_air": 1.0}), np.array([400.0, 550.0, 700.0]))
    np.testing.assert_allclose(depolarisation, 0.0279, rtol=0.07)
    assert np.all(np.diff(depolarisation) < 0.0)


def test_a_king_factor_of_1_048_is_a_depolarisation_of_0_0279():
    assert depolarisation_from_king(np.array([1.048]))[0] == pytest.approx(0.0279, abs=2e-4)


@pytest.mark.parametrize(
    ("name", "cross_section"),
    [("n2", 4.63e-31), ("co2", 1.164e-30), ("ar", 3.99e-31), ("ch4", 9.91e-31)],
)
def test_gases_have_the_cross_sections_of_he_2021_at_550_nm(name, cross_section):
    scattering, _ = gas_scattering(gas({name: 1.0}), np.array([550.0]))
    density = STANDARD[0] / (1.380649e-23 * STANDARD[1])
    assert scattering[0] / (density * 1e3) == pytest.approx(cross_section, rel=2e-3)


@pytest.mark.parametrize(("name", "cross_section"), [("h2", 1.005e-31), ("he", 6.41e-33)])
def test_light_gases_have_the_cross_sections_of_vardavas_and_carver_at_550_nm(name, cross_section):
    # Vardavas & Carver (1984), fits to older refractive indices: good to a few percent.
    scattering, _ = gas_scattering(gas({name: 1.0}), np.array([550.0]))
    density = STANDARD[0] / (1.380649e-23 * STANDARD[1])
    assert scattering[0] / (density * 1e3) == pytest.approx(cross_section, rel=0.06)


def test_the_gas_of_mars_scatters_fifty_times_less_than_air():
    # He et al. (2021) for 95.7 % CO2 at 610 Pa and 210 K.
    mars = load_preset("mars").constituents[0]
    assert isinstance(mars, Gas)
    scattering, _ = gas_scattering(mars, np.array([680.0, 550.0, 440.0]))
    np.testing.assert_allclose(scattering, [1.00e-4, 2.38e-4, 5.97e-4], rtol=5e-3)


def test_hydrogen_depolarises_as_its_two_polarisabilities_say():
    # Hohm (1993), Mol. Phys. 78, 929: mean 5.539 and anisotropy 2.107 atomic units at 632.8 nm.
    # Refractive indices, Peck & Huang (1977), give a mean of 5.53.
    _, depolarisation = gas_scattering(gas({"h2": 1.0}), np.array([400.0, 632.8, 800.0]))
    ratio = 6.0 * 2.107**2 / (45.0 * 5.539**2 + 7.0 * 2.107**2)
    assert depolarisation[1] == pytest.approx(ratio, rel=1e-3)
    assert np.all(np.diff(depolarisation) < 0.0)


def test_argon_does_not_depolarise():
    _, depolarisation = gas_scattering(gas({"ar": 1.0}), np.array([400.0, 700.0]))
    np.testing.assert_array_equal(depolarisation, 0.0)


def test_scattering_grows_with_pressure_and_falls_with_temperature():
    wavelengths = np.array([550.0])
    one, _ = gas_scattering(gas({"co2": 1.0}, 600.0, 200.0), wavelengths)
    other, _ = gas_scattering(gas({"co2": 1.0}, 1200.0, 400.0), wavelengths)
    np.testing.assert_allclose(one, other, rtol=1e-14)


def test_only_the_ratios_of_mole_fractions_count():
    wavelengths = np.array([550.0])
    one, _ = gas_scattering(gas({"co2": 0.5, "n2": 0.5}), wavelengths)
    other, _ = gas_scattering(gas({"co2": 0.497, "n2": 0.497}), wavelengths)
    np.testing.assert_allclose(one, other, rtol=1e-14)


def test_scattering_of_nitrogen_steps_little_where_its_two_fits_meet():
    # The published fits differ by 1.5e-4 in n - 1 at 21360 per cm.
    edge = 1e7 / 21360.0
    scattering, _ = gas_scattering(gas({"n2": 1.0}), np.array([edge - 1e-6, edge + 1e-6]))
    assert scattering[0] == pytest.approx(scattering[1], rel=4e-4)
