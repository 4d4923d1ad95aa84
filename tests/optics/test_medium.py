import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from skybake.errors import PresetError
from skybake.optics.medium import ALTITUDE_NODES, altitude_nodes, build_medium
from skybake.optics.phase import SCATTERING_ANGLES, integrate_phase, scattering_angles
from skybake.optics.spectrum import limb_darkening, star_irradiance
from skybake.preset import TentProfile, load_preset, preset_names

RGB = np.array([680.0, 550.0, 440.0])
EARTH, MARS, HILLAIRE = (load_preset(name) for name in ("earth", "mars", "earth-hillaire2020"))


def optical_depth(planet, wavelengths):
    medium = build_medium(planet, wavelengths)
    altitude = altitude_nodes(medium.r_bottom, medium.r_top)
    return medium.extinction * np.trapezoid(medium.density, altitude, axis=0)[:, None]


VISIBLE = np.array([360.0, 405.0, 550.0, 643.0, 780.0, 830.0])
BEYOND_EYE = np.array([350.0, 550.0, 870.0, 1000.0])
WIDE = "earth", "earth-clear", "earth-hazy", "earth-urban", "earth-volcanic", "mars", "mars-storm"


@pytest.mark.parametrize(
    ("name", "wavelengths"),
    [(name, VISIBLE) for name in preset_names()] + [(name, BEYOND_EYE) for name in WIDE],
)
def test_every_preset_is_physical_from_360_to_830_nm_and_some_beyond(name, wavelengths):
    planet = load_preset(name)
    if planet.rendering == "rgb":
        wavelengths = RGB
    medium = build_medium(planet, wavelengths)
    count = len(planet.constituents)
    assert medium.density.shape == (ALTITUDE_NODES, count)
    assert medium.phase.shape == (count, SCATTERING_ANGLES, len(wavelengths))
    assert medium.extinction.shape == (count, len(wavelengths))
    assert np.all(medium.density >= 0.0)
    assert np.all(medium.scattering >= 0.0)
    assert np.all(medium.scattering <= medium.extinction)
    assert np.all(medium.phase > 0.0)
    assert np.all((medium.ground_albedo >= 0.0) & (medium.ground_albedo <= 1.0))
    np.testing.assert_allclose(integrate_phase(np.moveaxis(medium.phase, 1, 0)), 1.0, rtol=1e-4)
    assert all(array.dtype == np.float64 for array in medium[2:])


def test_light_and_the_suns_disc_are_known_where_the_air_is():
    for planet in (EARTH, MARS):
        assert (star_irradiance(planet.star, BEYOND_EYE) > 0.0).all()
        assert np.isfinite(limb_darkening(planet.star, BEYOND_EYE)).all()
    # ASTM G173, and leaves, which are bright in the near infrared.
    assert star_irradiance(EARTH.star, np.array([1000.0]))[0] == pytest.approx(0.743, abs=0.01)
    assert build_medium(EARTH, np.array([1000.0])).ground_albedo[0] > 0.35


def test_order_of_wavelengths_does_not_matter():
    wavelengths = np.array([440.0, 550.0, 680.0])
    up, down = build_medium(EARTH, wavelengths), build_medium(EARTH, wavelengths[::-1])
    np.testing.assert_array_equal(up.extinction, down.extinction[:, ::-1])
    np.testing.assert_array_equal(up.phase, down.phase[:, :, ::-1])
    np.testing.assert_array_equal(up.ground_albedo, down.ground_albedo[::-1])


def test_hillaires_earth_has_exactly_his_constants():
    medium = build_medium(HILLAIRE, RGB)
    assert (medium.r_bottom, medium.r_top) == (6360.0, 6460.0)
    np.testing.assert_array_equal(
        medium.scattering,
        [[5.802e-3, 13.558e-3, 33.1e-3], [3.996e-3] * 3, [0.0] * 3],
    )
    np.testing.assert_allclose(
        medium.extinction,
        [[5.802e-3, 13.558e-3, 33.1e-3], [4.440e-3] * 3, [0.650e-3, 1.881e-3, 0.085e-3]],
        rtol=1e-15,
    )
    np.testing.assert_array_equal(medium.ground_albedo, 0.3)
    altitude = altitude_nodes(6360.0, 6460.0)
    tent = np.maximum(0.0, 1.0 - np.abs(altitude - 25.0) / 15.0)
    expected = np.stack([np.exp(-altitude / 8.0), np.exp(-altitude / 1.2), tent], axis=1)
    np.testing.assert_allclose(medium.density, expected, rtol=1e-14)
    nu = np.cos(scattering_angles())[:, None]
    rayleigh = 3.0 / (16.0 * np.pi) * (1.0 + nu**2)
    cornette_shanks = 3.0 / (8.0 * np.pi) * 0.36 * (1.0 + nu**2) / (2.64 * (1.64 - 1.6 * nu) ** 1.5)
    np.testing.assert_allclose(medium.phase[0], np.repeat(rayleigh, 3, axis=1), rtol=1e-14)
    np.testing.assert_allclose(medium.phase[1], np.repeat(cornette_shanks, 3, axis=1), rtol=1e-12)


def test_rayleigh_optical_depth_of_the_air_is_0_0972_at_550_nm():
    # Bodhaine et al. (1999) for a standard surface pressure; 0.2 % for how the AFGL
    # profile's column differs from the weight of 101325 Pa.
    assert optical_depth(EARTH, np.array([550.0]))[0, 0] == pytest.approx(0.0972, rel=2e-3)


def test_ozone_has_300_dobson_units_over_the_ground():
    # Absorption by a column of 300 * 2.687e20 per m², at the maximum of the Chappuis band.
    depth = optical_depth(EARTH, np.array([602.0]))[1, 0]
    assert depth / 5.03e-25 == pytest.approx(300.0 * 2.687e20, rel=0.01)


def test_the_ozone_layer_is_densest_between_20_and_25_km():
    medium = build_medium(EARTH, RGB)
    altitude = altitude_nodes(medium.r_bottom, medium.r_top)
    assert 20.0 < altitude[np.argmax(medium.density[:, 1])] < 25.0
    assert medium.density[:, 1].max() == pytest.approx(1.0, rel=1e-3)


def test_bands_smooth_the_fine_structure_of_ozone_and_nothing_else():
    wavelengths = np.array([360.0, 603.0])
    narrow, broad = (build_medium(EARTH, wavelengths, width) for width in (0.0, 20.0))
    assert not np.any(np.isclose(narrow.extinction[1], broad.extinction[1], rtol=1e-3))
    np.testing.assert_array_equal(narrow.extinction[[0, 2]], broad.extinction[[0, 2]])


def test_aerosol_has_its_optical_depth_at_its_wavelength_whatever_else_is_asked():
    for wavelengths in (np.array([550.0]), np.array([400.0, 550.0, 700.0])):
        depth = optical_depth(EARTH, wavelengths)[2]
        assert depth[wavelengths == 550.0] == pytest.approx(0.1, rel=1e-12)


def test_continental_aerosol_has_the_angstrom_exponent_and_albedo_of_opac():
    # Hess et al. (1998), continental average at 80 % humidity: 1.4, 0.925, 0.703.
    medium = build_medium(EARTH, np.array([440.0, 550.0, 830.0]))
    blue, green, red = medium.extinction[2]
    assert np.log(blue / red) / np.log(830.0 / 440.0) == pytest.approx(1.4, abs=0.05)
    assert medium.scattering[2, 1] / green == pytest.approx(0.925, abs=0.001)
    mean_cosine = integrate_phase(medium.phase[2] * np.cos(scattering_angles())[:, None])
    assert mean_cosine[1] == pytest.approx(0.703, abs=0.001)


def test_an_angstrom_exponent_sets_the_colour_of_haze():
    aerosol = replace(EARTH.constituents[2], extinction_spectrum=1.3)
    hazy = replace(EARTH, constituents=(aerosol,))
    np.testing.assert_allclose(optical_depth(hazy, RGB)[0], 0.1 * (RGB / 550.0) ** -1.3, rtol=1e-12)


def test_martian_dust_is_grey_in_extinction_and_absorbs_blue():
    # Wolff et al. (2009) indices: 0.972, 0.898, 0.788; exponent -0.09 +- 0.04 over the visible
    # (Lemmon et al. 2024 find -0.09 between 440 and 880 nm).
    medium = build_medium(MARS, RGB)
    red, _, blue = medium.extinction[1]
    np.testing.assert_allclose(
        medium.scattering[1] / medium.extinction[1], [0.972, 0.898, 0.788], atol=0.002
    )
    assert -np.log(red / blue) / np.log(680.0 / 440.0) == pytest.approx(-0.09, abs=0.06)
    assert optical_depth(MARS, np.array([550.0]))[1, 0] == pytest.approx(0.5, rel=1e-12)


def test_martian_ground_is_that_of_arabia():
    # McCord et al. (1971): 0.203 at 561 nm, 0.371 at 693 nm.
    albedo = build_medium(MARS, np.array([560.835, 692.693])).ground_albedo
    np.testing.assert_allclose(albedo, [0.203038, 0.3708], rtol=1e-12)


def test_wavelengths_beyond_the_presets_spectra_are_refused_with_their_range():
    with pytest.raises(PresetError) as caught:
        build_medium(EARTH, np.array([550.0, 1001.0]))
    assert str(caught.value) == (
        "earth.toml: constituents.ozone.cross_section_m2: "
        "wavelength must be within 350 to 1000 nm, got 1001 nm"
    )


def test_a_layer_thinner_than_the_altitude_steps_is_refused():
    dust = replace(MARS.constituents[1], profile=TentProfile(99.9, 0.001))
    with pytest.raises(PresetError, match=r"^mars: constituents\.dust\.profile: must be thicker"):
        build_medium(replace(MARS, constituents=(dust,)), RGB)


def test_a_medium_is_built_without_scipy_pandas_or_numba():
    code = (
        "import sys, numpy as np; from skybake.preset import load_preset; "
        "from skybake.optics.medium import build_medium; "
        "build_medium(load_preset('mars'), np.array([550.0])); "
        "sys.exit(bool({'scipy', 'pandas', 'numba', 'colour'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
