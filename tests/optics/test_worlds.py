"""Tables and presets of other worlds against what was published of them."""

import numpy as np
import pytest

from skybake.optics.medium import aerosol_optical_depth, altitude_nodes, build_medium
from skybake.optics.phase import (
    build_phase,
    integrate_phase,
    phase_henyey_greenstein,
    scattering_angles,
)
from skybake.preset import Aerosol, TabulatedPhase, load_preset

NU = np.cos(scattering_angles())[:, None]
GREEN = np.array([550.0])


def aerosol(preset, name="aerosol"):
    (found,) = (c for c in load_preset(preset).constituents if c.name == name)
    assert isinstance(found, Aerosol)
    return found


# Hess et al. (1998), OPAC, at 80 % humidity and 550 nm: single scattering albedo, asymmetry, and
# the exponent between 440 and 700 nm that its tables give.
OPAC = {
    "earth-clear": (0.972, 0.709, 1.31),
    "earth-hazy": (0.892, 0.698, 1.35),
    "earth-urban": (0.817, 0.689, 1.34),
    "earth-maritime": (0.997, 0.772, 0.09),
}


@pytest.mark.parametrize("preset", OPAC)
def test_aerosols_by_mie_theory_have_the_optics_that_opac_publishes(preset):
    albedo, asymmetry, exponent = OPAC[preset]
    medium = build_medium(load_preset(preset), GREEN)
    assert medium.scattering[2, 0] / medium.extinction[2, 0] == pytest.approx(albedo, abs=0.003)
    phase = build_phase(aerosol(preset).phase, GREEN)
    assert integrate_phase(phase * NU)[0] == pytest.approx(asymmetry, abs=0.003)
    blue, red = aerosol_optical_depth(aerosol(preset), np.array([440.0, 700.0]))
    assert np.log(blue / red) / np.log(700.0 / 440.0) == pytest.approx(exponent, abs=0.03)


def test_the_desert_table_of_opac_has_the_optics_that_opac_publishes():
    """OPAC 4's desert has spheroids."""
    changes = {
        "aerosol.relative_extinction": "opac_desert",
        "aerosol.single_scattering_albedo": "opac_desert",
        "aerosol.phase.table": "opac_desert_phase",
    }
    medium = build_medium(load_preset("earth-desert-dust", changes), GREEN)
    assert medium.scattering[2, 0] / medium.extinction[2, 0] == pytest.approx(0.888, abs=0.003)
    assert integrate_phase(medium.phase[2] * NU)[0] == pytest.approx(0.729, abs=0.003)


def test_desert_dust_absorbs_as_little_as_over_the_sahara():
    """Kim et al. (2011), AERONET: single scattering albedo of 0.946 +- 0.005 at 550 nm."""
    medium = build_medium(load_preset("earth-desert-dust"), np.array([440.0, 550.0, 675.0]))
    blue, green, red = medium.scattering[2] / medium.extinction[2]
    assert green == pytest.approx(0.946, abs=0.005)
    # Iron oxides: most in the blue.
    assert blue < green - 0.02 < red - 0.02


def test_droplets_of_earth_have_the_aureole_that_one_asymmetry_cannot_give():
    """3.7 times what Henyey & Greenstein have at 0.5 deg from the sun, a sixth less at 10."""
    at = np.radians([0.5, 10.0])
    phase = aerosol("earth").phase
    table = build_phase(phase, GREEN)[:, 0]
    asymmetry = integrate_phase(table[:, None] * NU)
    formula = phase_henyey_greenstein(np.cos(at), asymmetry)
    ratio = np.interp(at, scattering_angles(), table) / formula
    np.testing.assert_allclose(ratio, [3.7, 0.84], rtol=0.02)


@pytest.mark.parametrize("preset", ["earth", "exo-m-dwarf"])
def test_the_phase_function_is_that_of_the_particles_whose_colour_it_has(preset):
    """Kinne (2019): the mean of Earth has an asymmetry of 0.702 at 550 nm; OPAC 0.703."""
    assert isinstance(aerosol(preset).phase, TabulatedPhase)
    phase = build_phase(aerosol(preset).phase, GREEN)
    assert integrate_phase(phase * NU)[0] == pytest.approx(0.703, abs=0.003)


def test_sea_salt_has_a_bow_and_smoke_has_none():
    def bow(preset):
        phase = aerosol(preset).phase
        assert isinstance(phase, TabulatedPhase)
        table = build_phase(phase, GREEN)[:, 0]
        low, high = np.interp(np.radians([115.0, 145.0]), scattering_angles(), table)
        return high / low

    assert bow("earth-maritime") > 2.0
    assert bow("earth-urban") < 1.3


def test_volcanic_droplets_scatter_forward_and_take_all_colours_alike():
    """After Pinatubo extinction was flat from 385 to 600 nm (Russell et al. 1996)."""
    stratospheric = aerosol("earth-volcanic", "stratospheric")
    blue, red = aerosol_optical_depth(stratospheric, np.array([385.0, 600.0]))
    assert blue / red == pytest.approx(1.0, abs=0.15)


def test_droplets_of_venus_have_the_asymmetry_of_titov():
    """Titov et al. (2018): 0.679, 0.718 and 0.750 at 655, 550 and 445 nm."""
    phase = build_phase(aerosol("venus-cloudtop", "haze").phase, np.array([655.0, 550.0, 445.0]))
    np.testing.assert_allclose(integrate_phase(phase * NU), [0.679, 0.718, 0.750], atol=0.02)


@pytest.mark.parametrize(
    ("preset", "low", "high"),
    [
        ("earth-snow", 0.95, 0.98),  # Grenfell et al. (1994): 0.96 to 0.98
        ("earth-maritime", 0.06, 0.08),  # Payne (1972): 0.06 under an overcast sky
        ("earth-desert-dust", 0.10, 0.20),
        ("exo-m-dwarf", 0.10, 0.20),
        ("venus-cloudtop", 0.88, 0.92),  # Mallama et al. (2006): 0.90
        ("titan", 0.05, 0.15),
    ],
)
def test_grounds_are_as_bright_as_published_at_550_nm(preset, low, high):
    assert low < build_medium(load_preset(preset), GREEN).ground_albedo[0] < high


def test_the_blue_giants_are_blue_and_the_gas_giants_are_not():
    """Karkoschka (1998): 0.58 and 0.57 at 440 nm against 0.44 and 0.35 at 640 nm; Saturn rises."""
    at = np.array([440.0, 640.0])
    for preset, is_blue in (
        ("neptune", True),
        ("uranus", True),
        ("jupiter", False),
        ("saturn", False),
    ):
        blue, red = build_medium(load_preset(preset), at).ground_albedo
        assert (blue > 1.2 * red) == is_blue


@pytest.mark.parametrize(
    ("preset", "gravity", "molar_mass"),
    [
        ("jupiter", 23.1, 2.31),
        ("saturn", 9.08, 2.31),
        ("uranus", 8.87, 2.31),
        ("neptune", 11.15, 2.39),
        ("titan", 1.354, 27.3),
        ("venus-cloudtop", 8.87, 43.45),
    ],
)
def test_gas_of_a_world_weighs_as_much_as_its_pressure(preset, gravity, molar_mass):
    """Barometric law: its column is p / (m g), in molecules per square metre."""
    planet = load_preset(preset)
    gas = planet.constituents[0]
    altitude = altitude_nodes(planet.radius, planet.radius + planet.atmosphere_top)
    column = np.trapezoid(build_medium(planet, GREEN).density[:, 0], altitude) * 1e3
    column *= gas.pressure / (1.380649e-23 * gas.temperature)
    weight = column * molar_mass * 1.66053907e-27 * gravity
    assert weight == pytest.approx(gas.pressure, rel=0.01)


def test_titans_haze_has_the_optical_depths_that_huygens_measured():
    """Tomasko et al. (2008): 5.6, 8.1 and 12.2 in all at 680, 550 and 440 nm."""
    wavelengths = np.array([680.0, 550.0, 440.0])
    depth = sum(
        aerosol_optical_depth(aerosol("titan", f"{layer}_haze"), wavelengths)
        for layer in ("upper", "middle", "lower")
    )
    np.testing.assert_allclose(depth, [5.6, 8.1, 12.2], rtol=0.02)


def test_titans_haze_has_the_mean_cosines_of_the_table_of_tomasko():
    """Tomasko et al. (2008), table 1: 0.73 to 0.80, at most 0.783 up to 600 nm."""
    wavelengths = np.array([360.0, 480.0, 600.0, 713.0, 830.0])
    for layer in ("upper", "middle", "lower"):
        phase = build_phase(aerosol("titan", f"{layer}_haze").phase, wavelengths)
        cosines = integrate_phase(phase * NU)
        np.testing.assert_allclose(cosines, [0.729, 0.756, 0.783, 0.799, 0.788], atol=0.003)


def test_titans_haze_absorbs_more_above_80_km_by_the_rule_of_doose():
    """Doose et al. (2016): (0.565 + albedo above 200 km) / 1.5 below 80 km, 0.963 at 553 nm."""
    at = np.array([553.0, 650.0])
    upper, lower = (
        medium.scattering[i] / medium.extinction[i]
        for medium in [build_medium(load_preset("titan"), at)]
        for i in (1, 3)
    )
    np.testing.assert_allclose(lower, [0.963, 0.988], atol=0.002)
    # A weighted mean of both: 0.544 of the haze above 80 km is as it is below.
    np.testing.assert_allclose(upper, 0.544 * lower + 0.456 * (1.5 * lower - 0.565), atol=0.002)


def test_the_deck_of_venus_has_the_colour_of_the_planet():
    """Mallama et al. (2017), table 7: 0.658 at 438 nm and 0.348 at 366 nm, 0.689 at 551 nm."""
    albedo = build_medium(load_preset("venus-cloudtop"), np.array([366.0, 438.0, 551.0]))
    blue = albedo.ground_albedo / albedo.ground_albedo[2]
    np.testing.assert_allclose(blue, np.array([0.348, 0.658, 0.689]) / 0.689, atol=0.002)


def test_the_dwarfs_planet_gets_the_power_of_earth_from_a_disc_of_two_degrees():
    star = load_preset("exo-m-dwarf").star
    assert np.degrees(2.0 * star.angular_radius) == pytest.approx(2.0, abs=0.05)
    # A black body of 3000 K under that angle; 1361 W/m2 on Earth.
    assert 5.670374e-8 * 3000.0**4 * np.sin(star.angular_radius) ** 2 == pytest.approx(
        1361.0, rel=0.02
    )
    peak = star.irradiance.values[star.irradiance.wavelength.index(550.0)] * star.dilution
    radiance = 3.7417718e-16 / np.pi / 550e-9**5 / np.expm1(0.01438777 / (550e-9 * 3000.0)) * 1e-9
    assert peak == pytest.approx(np.pi * radiance * np.sin(star.angular_radius) ** 2, rel=1e-3)
