"""Derived figures of a planet, against what is published of it."""

import math

import numpy as np
import pytest

from skybake.errors import InputError, PresetError
from skybake.inspect.summary import summarise, summary_text
from skybake.optics.medium import build_medium
from skybake.preset import load_preset, preset_names
from skybake.scattering.atmosphere import build_atmosphere
from skybake.sky.sky import WAVELENGTHS
from tests.preset.files import PHASE, write
from tests.truth import henyey_greenstein


def constituents(summary):
    return {one.name: one for one in summary.constituents}


@pytest.fixture(scope="module")
def earth():
    return summarise(load_preset("earth"))


def test_the_sun_above_the_atmosphere_has_133_kilolux_and_half_a_degree(earth):
    """133.1 klx, ASTM E490 and G173; 959.63 arcsec at 1 au, Auwers (1891)."""
    assert earth.sun_illuminance == pytest.approx(133.1e3, rel=5e-3)
    assert math.degrees(earth.sun_angular_diameter) == pytest.approx(2 * 959.63 / 3600, rel=1e-3)


def test_the_optical_depth_of_air_is_that_of_bodhaine(earth):
    """Bodhaine et al. (1999), table 3 at sea level: 0.2218 at 450, 0.0972 at 550, 0.0493 at 650."""
    depth = constituents(earth)["air"].optical_depth
    np.testing.assert_allclose(depth, [0.2218, 0.0972, 0.0493], rtol=5e-3)


def test_columns_are_those_of_the_preset_and_of_hydrostatic_air(earth):
    """A pressure of 1013.25 hPa is 2.15e29 molecules of 28.96 g/mol over each square metre."""
    columns = {name: one.column for name, one in constituents(earth).items()}
    assert columns["ozone"] == pytest.approx(300 * 2.6868e20, rel=1e-4)
    assert columns["air"] == pytest.approx(101325 / 9.80665 / 28.9644e-3 * 6.02214e23, rel=5e-3)
    assert columns["aerosol"] is None


def test_the_total_is_the_sum_and_its_albedo_the_mean_by_extinction(earth):
    *parts, total = earth.constituents
    depths = np.stack([one.optical_depth for one in parts])
    albedos = np.stack([one.single_scattering_albedo for one in parts])
    np.testing.assert_allclose(total.optical_depth, depths.sum(axis=0), rtol=1e-12)
    expected = (depths * albedos).sum(axis=0) / depths.sum(axis=0)
    np.testing.assert_allclose(total.single_scattering_albedo, expected, rtol=1e-12)


def test_an_empty_constituent_has_no_albedo_and_is_told_without_nan():
    planet = load_preset("earth", {"aerosol.optical_depth": 0, "ozone.column_du": 0})
    summary = summarise(planet)
    assert np.isnan(constituents(summary)["ozone"].single_scattering_albedo).all()
    np.testing.assert_array_equal(summary.constituents[-1].single_scattering_albedo, 1.0)
    text = summary_text(planet, summary)
    assert "nan" not in text
    told = [line.split() for line in text.splitlines()]
    assert ["ozone", "0", "0", "0", "-", "-", "-"] in told
    assert ["column", "of", "ozone:", "0", "molecules/m2,", "0", "DU"] in told


@pytest.mark.parametrize(("depth", "refused"), [(29.0, False), (33.0, False), (45.0, True)])
def test_air_is_called_too_thick_where_the_solver_refuses_it(depth, refused):
    """Dust of depth 33 has 28 without its forward peak."""
    planet = load_preset("mars", {"dust.optical_depth": depth})
    summary = summarise(planet)
    assert (summary.refusal is not None) == refused
    lines = summary_text(planet, summary).splitlines()
    told = [line for line in lines if line.startswith("will not render: ")]
    assert told == ([f"will not render: {summary.refusal}"] if refused else [])
    if refused:
        with pytest.raises(InputError) as caught:
            build_atmosphere(build_medium(planet, WAVELENGTHS), "full")
        assert str(caught.value) == summary.refusal


def test_wavelengths_stay_within_those_of_the_preset():
    narrow = {"wavelengths_nm": [600, 500, 470]}
    figures = summarise(load_preset("earth", narrow))
    assert figures.wavelengths.tolist() == [470.0, 550.0, 600.0]
    figures = summarise(load_preset("earth", {"wavelengths_nm": [600, 590, 580]}))
    assert figures.wavelengths.tolist() == [580.0, 600.0]
    assert figures.visibility is None


def test_what_no_table_of_altitudes_resolves_is_refused():
    thin = {"aerosol.profile": {"kind": "tent", "center_km": 90.05, "half_width_km": 0.001}}
    with pytest.raises(PresetError, match=r"aerosol\.profile: must be thicker than 0\.2 km"):
        summarise(load_preset("earth", thin))


@pytest.mark.parametrize("name", preset_names())
def test_the_figures_of_every_preset_are_told_in_lines_of_numbers(name):
    planet = load_preset(name)
    text = summary_text(planet, summarise(planet))
    assert text.startswith(f"{name}: {planet.title}\n")
    assert "nan" not in text
    assert "inf" not in text.lower().replace("infra", "")
    assert all(len(line) <= 100 or line.startswith("data quality") for line in text.splitlines())


def test_a_table_with_a_peak_beyond_truncation_is_told_to_be_no_rendering(tmp_path):
    angle = np.concatenate([np.linspace(0.0, 20.0, 2001), np.linspace(20.1, 180.0, 1600)])
    phase = henyey_greenstein(np.radians(angle), 0.97)
    rows = "\n".join(f"{a:.4f},{p:.8g}" for a, p in zip(angle, phase, strict=True))
    (tmp_path / "peak.csv").write_text(f"angle_deg,550\n{rows}\n", encoding="utf-8")
    planet = load_preset(write(tmp_path, PHASE, '{ kind = "tabulated", table = "peak.csv" }'))
    refusal = summarise(planet).refusal
    assert "forward peak of a phase function" in refusal
    assert f"will not render: {refusal}" in summary_text(planet, summarise(planet))


def test_layers_of_clouds_are_listed_and_change_no_other_figure():
    cloudy, clear = load_preset("earth-fair"), load_preset("earth")
    cloudy_lines = summary_text(cloudy, summarise(cloudy)).splitlines()[1:]
    clear_lines = summary_text(clear, summarise(clear)).splitlines()[1:]
    layer = "clouds low: 1.2 to 2.1 km, cumulus, cover 0.4, optical depth 25 at 550 nm"
    assert [line for line in cloudy_lines if line not in clear_lines] == [layer]
