import hashlib
import json
import math

import pytest

from skybake.errors import PresetWarning
from skybake.preset import (
    Aerosol,
    Coefficients,
    Gas,
    TabulatedPhase,
    TabulatedProfile,
    load_preset,
    preset_names,
    preset_text,
)
from skybake.preset.phases import integral_over_sphere
from tests.preset.files import MINIMAL, PHASE, message_about, write


@pytest.mark.parametrize("name", preset_names())
def test_every_preset_loads_and_says_what_it_is(name):
    planet = load_preset(name)
    assert planet.name == name
    assert planet.title
    assert planet.constituents


def test_the_recipe_of_every_preset_is_its_toml_and_survives_json():
    for name in preset_names():
        planet = load_preset(name)
        assert json.loads(json.dumps(planet.recipe)) == planet.recipe
        assert planet.recipe["planet"]["radius_km"] == planet.radius


def test_a_preset_of_skybake_can_be_copied_and_loads_the_same_from_the_users_folder(tmp_path):
    path = tmp_path / "earth.toml"
    path.write_text(preset_text("earth"), encoding="utf-8")
    copy, original = load_preset(path), load_preset("earth")
    assert copy.radius == original.radius
    assert [c.name for c in copy.constituents] == ["air", "ozone", "aerosol"]
    assert copy.recipe == original.recipe


def test_a_text_with_the_ending_toml_is_a_path(tmp_path, monkeypatch):
    write(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert load_preset("ball.toml") == load_preset("./ball.toml")
    assert load_preset("ball.toml").name == "ball"


def test_a_minimal_preset_gets_a_uniform_disc_and_spectral_rendering(tmp_path):
    planet = load_preset(write(tmp_path))
    assert planet.rendering == "spectral"
    assert planet.wavelengths is None
    assert planet.star.limb_darkening_u.values == (0.0,)


def test_angular_radius_of_the_sun_is_16_arcmin_from_earth_and_two_thirds_from_mars():
    # Sixteen arcminutes: 959.63 arcsec, Auwers (1891), still the value of almanacs.
    earth, mars = load_preset("earth").star, load_preset("mars").star
    assert math.degrees(earth.angular_radius) * 3600 == pytest.approx(959.63, rel=1e-3)
    assert mars.angular_radius == pytest.approx(earth.angular_radius / 1.5237, rel=1e-5)
    assert mars.dilution == pytest.approx(1.5237**-2, rel=1e-12)


def test_hillaires_earth_keeps_the_order_of_its_wavelengths_for_red_green_and_blue():
    planet = load_preset("earth-hillaire2020")
    assert planet.rendering == "rgb"
    assert planet.wavelengths == (680.0, 550.0, 440.0)


def test_a_gas_that_follows_a_table_is_dense_as_given_at_the_ground():
    air = load_preset("earth").constituents[0]
    assert isinstance(air, Gas)
    assert isinstance(air.profile, TabulatedProfile)
    assert air.profile.density[0] == 1.0


def test_coefficients_that_do_not_scatter_need_no_phase_function(tmp_path):
    more = """
[constituents.smoke]
kind = "coefficients"
absorption_per_km = 0.1
profile = { kind = "tent", center_km = 5.0, half_width_km = 2.0 }
"""
    smoke = load_preset(write(tmp_path, new=more)).constituents[1]
    assert isinstance(smoke, Coefficients)
    assert smoke.scattering.values == (0.0,)


def test_tables_of_the_user_are_found_beside_the_preset_and_named_by_digest(tmp_path):
    (tmp_path / "albedo").mkdir()
    sand = tmp_path / "albedo" / "sand.csv"
    sand.write_text("\ufeff# seen\nwavelength_nm,albedo\n380,0.2\n800,0.5\n", encoding="utf-8")
    grains = tmp_path / "grains.csv"
    grains.write_text("angle_deg,550\n0,0.0795775\n180,0.0795775\n", encoding="utf-8")
    path = write(tmp_path, "albedo = 0.2", 'albedo = "albedo/sand.csv"')
    text = path.read_text(encoding="utf-8")
    old = '{ kind = "henyey-greenstein", asymmetry = 0.7 }'
    planet = load_preset(
        write(tmp_path, old, '{ kind = "tabulated", table = "grains.csv" }', text=text)
    )
    assert planet.ground.albedo.values == (0.2, 0.5)
    haze = planet.constituents[0]
    assert isinstance(haze, Aerosol)
    assert isinstance(haze.phase, TabulatedPhase)
    assert haze.phase.wavelength == ()
    assert planet.recipe["files"] == {
        "albedo/sand.csv": hashlib.sha256(sand.read_bytes()).hexdigest(),
        "grains.csv": hashlib.sha256(grains.read_bytes()).hexdigest(),
    }


def test_data_quality_is_told_of_a_planet_and_may_be_absent(tmp_path):
    assert load_preset(write(tmp_path)).data_quality is None
    path = write(tmp_path, "title", 'data_quality = """\n  Guessed,\n  all of it. """\ntitle')
    assert load_preset(path).data_quality == "Guessed,\n  all of it."


def test_spectra_may_be_arrays_that_share_their_wavelengths(tmp_path):
    more = """
[constituents.smoke]
kind = "coefficients"
wavelength_nm = [360, 550, 830]
scattering_per_km = [0.3, 0.2, 0.1]
absorption_per_km = [0.03, 0.02, 0.01]
profile = { kind = "tent", center_km = 5.0, half_width_km = 2.0 }
phase = { kind = "henyey-greenstein", wavelength_nm = [380, 720], asymmetry = [0.6, 0.5] }
"""
    smoke = load_preset(write(tmp_path, new=more)).constituents[1]
    assert isinstance(smoke, Coefficients)
    assert smoke.scattering.wavelength == smoke.absorption.wavelength == (360.0, 550.0, 830.0)
    assert smoke.absorption.values == (0.03, 0.02, 0.01)
    assert smoke.phase.asymmetry.wavelength == (380.0, 720.0)


def test_wavelengths_that_no_array_uses_are_an_unknown_key(tmp_path):
    path = write(tmp_path, "albedo = 0.2", "albedo = 0.2\nwavelength_nm = [380, 720]")
    assert message_about(path) == "ground: unknown key 'wavelength_nm'; known keys: albedo"


def test_spectra_need_not_cover_more_than_the_wavelengths_that_are_rendered(tmp_path):
    albedo = "albedo = { wavelength_nm = [500, 600], values = [0.1, 0.2] }"
    narrow = "wavelengths_nm = [600, 500]\n"
    text = narrow + MINIMAL.replace("albedo = 0.2", albedo)
    assert load_preset(write(tmp_path, text=text)).ground.albedo.values == (0.1, 0.2)
    message = message_about(write(tmp_path, text=text.replace("[600, 500]", "[610, 500]")))
    assert message == "ground.albedo: must cover 500 to 610 nm, got 500 to 600 nm"


def isotropic(scale: float) -> str:
    value = scale / (4.0 * math.pi)
    return f"angle_deg,550\n0,{value!r}\n70,{value!r}\n180,{value!r}\n"


@pytest.mark.parametrize("scale", [1.0, 1.0009, 0.9991])
def test_a_phase_table_that_is_off_by_its_rounding_is_taken_silently(tmp_path, scale):
    (tmp_path / "grains.csv").write_text(isotropic(scale), encoding="utf-8")
    load_preset(write(tmp_path, PHASE, '{ kind = "tabulated", table = "grains.csv" }'))


@pytest.mark.parametrize("scale", [1.0095, 0.9905])
def test_a_phase_table_that_is_off_by_less_than_a_hundredth_is_taken_with_a_note(tmp_path, scale):
    (tmp_path / "grains.csv").write_text(isotropic(scale), encoding="utf-8")
    path = write(tmp_path, PHASE, '{ kind = "tabulated", table = "grains.csv" }')
    with pytest.warns(
        PresetWarning, match=f"phase.table: integrates to {scale:.4f} over .* 550 nm"
    ):
        load_preset(path)


@pytest.mark.parametrize("scale", [1.0105, 0.9895, 4.0 * math.pi])
def test_a_phase_table_that_is_off_by_more_than_a_hundredth_is_refused(tmp_path, scale):
    (tmp_path / "grains.csv").write_text(isotropic(scale), encoding="utf-8")
    path = write(tmp_path, PHASE, '{ kind = "tabulated", table = "grains.csv" }')
    assert message_about(path) == (
        "constituents.haze.phase.table: must integrate to 1 over the sphere within 1 %, "
        f"got {scale:.4f} at 550 nm"
    )


@pytest.mark.parametrize("asymmetry", [0.0, 0.5, -0.7, 0.9])
def test_the_integral_of_a_fine_table_of_henyey_and_greenstein_is_1(asymmetry):
    """Henyey & Greenstein (1941) is normalised in closed form."""
    angle = tuple(math.pi * i / 3600 for i in range(3601))
    values = tuple(
        (1 - asymmetry**2) / (4 * math.pi * (1 + asymmetry**2 - 2 * asymmetry * math.cos(a)) ** 1.5)
        for a in angle
    )
    assert integral_over_sphere(angle, values) == pytest.approx(1.0, abs=1e-5)
