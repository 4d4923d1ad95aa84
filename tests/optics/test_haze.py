"""Visibility and turbidity are those of the air that they make."""

import numpy as np
import pytest

from skybake.errors import PresetError
from skybake.optics.haze import haze_for_turbidity, haze_for_visibility, turbidity, visibility
from skybake.optics.medium import build_medium, vertical_optical_depth
from skybake.preset import load_preset

VEIL = {
    "kind": "aerosol",
    "optical_depth": 0.05,
    "angstrom_exponent": 1.0,
    "single_scattering_albedo": 1.0,
    "profile": {"kind": "tent", "center_km": 20.0, "half_width_km": 5.0},
    "phase": {"kind": "henyey-greenstein", "asymmetry": 0.7},
}
LOW = VEIL | {"optical_depth": 0.2, "profile": {"kind": "exponential", "scale_height_km": 1.0}}


def changed(overrides, depths):
    return load_preset("earth", overrides | {f"{k}.optical_depth": v for k, v in depths.items()})


def extinction_at_ground(planet):
    medium = build_medium(planet, np.array([550.0]))
    return float(medium.density[0] @ medium.extinction[:, 0])


@pytest.mark.parametrize("kilometres", [0.5, 5.0, 20.0, 80.0, 300.0])
def test_visibility_is_3_912_over_extinction_at_the_ground(kilometres):
    planet = changed({}, haze_for_visibility(load_preset("earth"), kilometres))
    assert 3.912 / extinction_at_ground(planet) == pytest.approx(kilometres, rel=1e-12)
    assert visibility(planet) == pytest.approx(kilometres, rel=1e-12)


def test_an_aerosol_has_the_optical_depth_of_its_extinction_times_its_scale_height():
    """Of an exponential of 2 km in otherwise empty air at 20 km: 3.912 / 20 * 2."""
    empty = {"air.pressure_pa": 0, "ozone": "none"}
    depth = haze_for_visibility(load_preset("earth", empty), 20.0)["aerosol"]
    assert depth == pytest.approx(3.912 / 20.0 * 2.0, rel=1e-4)


def test_visibility_of_pure_air_is_that_of_bodhaines_scattering():
    """Bodhaine et al. (1999): 1.149e-5 m⁻¹ at 550 nm, 288.15 K and 1013.25 hPa; table 4."""
    planet = load_preset("earth", {"aerosol": "none", "ozone": "none"})
    assert visibility(planet) == pytest.approx(3.912 / 1.149e-2, rel=0.02)


@pytest.mark.parametrize("ratio", [1.0, 2.0, 5.0])
def test_turbidity_is_gas_and_aerosol_over_gas(ratio):
    planet = changed({}, haze_for_turbidity(load_preset("earth"), ratio))
    air, _, aerosol = vertical_optical_depth(build_medium(planet, np.array([550.0])))[:, 0]
    assert (air + aerosol) / air == pytest.approx(ratio, rel=1e-12)
    assert turbidity(planet) == pytest.approx(ratio, rel=1e-12)


@pytest.mark.parametrize(
    ("solve", "value"), [(haze_for_visibility, 10.0), (haze_for_turbidity, 4.0)]
)
def test_aerosols_near_the_ground_are_scaled_alike_and_those_aloft_stay(solve, value):
    overrides = {"constituents.veil": VEIL, "constituents.low": LOW}
    planet = load_preset("earth", overrides)
    depths = solve(planet, value)
    assert set(depths) == {"aerosol", "low"}
    assert depths["low"] / depths["aerosol"] == pytest.approx(2.0, rel=1e-12)
    measure = visibility if solve is haze_for_visibility else turbidity
    assert measure(changed(overrides, depths)) == pytest.approx(value, rel=1e-12)


def test_haze_that_is_absent_can_be_brought_back():
    none = {"aerosol.optical_depth": 0.0}
    planet = changed(none, haze_for_visibility(load_preset("earth", none), 20.0))
    assert visibility(planet) == pytest.approx(20.0, rel=1e-12)


def test_turbidity_needs_a_gas_and_is_none_without():
    planet = load_preset("earth-hillaire2020")
    assert turbidity(planet) is None
    empty = load_preset("earth", {"air.pressure_pa": 0})
    with pytest.raises(PresetError, match="needs a constituent of kind gas, earth has air "):
        haze_for_turbidity(empty, 2.0)


@pytest.mark.parametrize(
    ("name", "solve", "value", "message"),
    [
        ("earth-hillaire2020", haze_for_visibility, 20.0, "needs a constituent of kind aerosol"),
        ("earth-hillaire2020", haze_for_turbidity, 2.0, "needs a constituent of kind aerosol"),
        ("earth", haze_for_visibility, 400.0, "must be at most 334.9 km, the visibility of earth "),
    ],
)
def test_what_no_haze_can_make_is_refused(name, solve, value, message):
    with pytest.raises(PresetError) as caught:
        solve(load_preset(name), value)
    assert str(caught.value).startswith(message)


def test_a_turbidity_below_that_of_the_layers_aloft_is_refused():
    planet = load_preset("earth", {"constituents.veil": VEIL})
    with pytest.raises(PresetError, match=r"must be at least 1\.5\d+, the turbidity of earth with"):
        haze_for_turbidity(planet, 1.2)
