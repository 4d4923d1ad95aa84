"""Correlated colour temperatures, against colour-science."""

import colour
import numpy as np
import pytest

from skybake.colour.space import xyz_from_xy
from skybake.colour.temperature import correlated_temperature
from skybake.colour.white_balance import white_from_kelvin

# Near black bodies, and off them to both sides.
CHROMATICITIES = [
    *((0.3127, 0.3290), (0.4476, 0.4074), (0.34567, 0.35850), (0.5267, 0.4133), (0.2807, 0.2884)),
    *((0.40, 0.42), (0.36, 0.33)),
]


@pytest.mark.parametrize("xy", CHROMATICITIES)
def test_temperatures_are_those_of_colour_science(xy):
    light = xyz_from_xy(*xy)
    uv = colour.UCS_to_uv(colour.XYZ_to_UCS(light))
    kelvin, _ = colour.temperature.uv_to_CCT_Ohno2013(uv)
    assert correlated_temperature(2.5 * light) == pytest.approx(kelvin, rel=5e-4)


@pytest.mark.parametrize("kelvin", [1000.1, 1500.0, 2856.0, 3999.0])
def test_a_black_body_has_its_own_temperature(kelvin):
    assert correlated_temperature(white_from_kelvin(kelvin)) == pytest.approx(kelvin, rel=1e-5)


@pytest.mark.parametrize(
    "light",
    [
        (0.0, 0.0, 0.0),
        (np.nan, 1.0, 1.0),
        xyz_from_xy(0.30, 0.60),
        xyz_from_xy(0.16, 0.02),
        xyz_from_xy(0.70, 0.29),
        xyz_from_xy(0.2450, 0.2450),
    ],
    ids=["none", "nan", "green", "violet", "red", "hotter than 25000 K"],
)
def test_what_looks_like_no_black_body_has_none(light):
    assert correlated_temperature(np.array(light)) is None
