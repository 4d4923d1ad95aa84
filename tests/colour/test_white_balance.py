"""White balance, beside colour-science."""

import colour
import numpy as np
import pytest

from skybake.colour.space import BRADFORD, COLOUR_SPACES, D65, rgb_from_xyz, xyz_from_xy
from skybake.colour.white_balance import automatic_white, balance, chromaticity, white_from_kelvin
from skybake.errors import InputError

REC709 = COLOUR_SPACES["lin_rec709"]
DUST = xyz_from_xy(0.38, 0.37)


@pytest.mark.parametrize("kelvin", [4000.0, 5003.0, 6504.0, 7000.0, 7001.0, 15000.0, 25000.0])
def test_a_temperature_of_daylight_has_the_chromaticity_of_the_cie(kelvin):
    expected = colour.temperature.CCT_to_xy_CIE_D(kelvin)

    np.testing.assert_allclose(chromaticity(white_from_kelvin(kelvin)), expected, atol=1e-9)


@pytest.mark.parametrize("kelvin", [1000.0, 1900.0, 2856.0, 3999.0])
def test_a_lower_temperature_is_that_of_a_black_body(kelvin):
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    radiance = colour.sd_blackbody(kelvin, observer.shape).values
    lamp = radiance @ observer.values

    np.testing.assert_allclose(
        chromaticity(white_from_kelvin(kelvin)), colour.XYZ_to_xy(lamp), atol=1e-5
    )


@pytest.mark.parametrize("space", COLOUR_SPACES.values(), ids=lambda space: space.name)
def test_the_adaptation_is_that_of_bradford_in_every_space(space):
    matrix = colour.adaptation.matrix_chromatic_adaptation_VonKries(
        DUST, xyz_from_xy(*D65), transform="Bradford"
    )
    xyz = np.array([0.3, 0.4, 0.9])
    to_rgb = rgb_from_xyz(space)

    np.testing.assert_allclose(
        balance(space, 700.0 * DUST) @ to_rgb @ xyz, to_rgb @ matrix @ xyz, rtol=1e-4
    )


def test_the_light_itself_becomes_grey_and_keeps_its_luminance():
    light = rgb_from_xyz(REC709) @ (250.0 * DUST)

    np.testing.assert_allclose(balance(REC709, DUST) @ light, [250.0] * 3, rtol=1e-9)


def test_daylight_of_6504_kelvin_is_left_as_it_is():
    np.testing.assert_allclose(balance(REC709, white_from_kelvin(6504.0)), np.eye(3), atol=2e-3)


def weakest_response(light):
    """Of three receptors, relative to the strongest."""
    responses = (BRADFORD @ light) / (BRADFORD @ xyz_from_xy(*D65))
    return responses.min() / responses.max()


@pytest.mark.parametrize("light", [DUST, 300.0 * white_from_kelvin(3000.0)])
def test_what_is_taken_as_white_is_the_light_itself(light):
    np.testing.assert_array_equal(automatic_white(light), light)


@pytest.mark.parametrize("light", [(0.53, 0.44, 0.01), (0.6, 0.4, 0.0), (0.7, 0.28, -0.01)])
def test_in_light_without_blue_one_sees_its_colour(light):
    np.testing.assert_allclose(
        chromaticity(automatic_white(np.array(light))), D65, atol=1e-3, rtol=0
    )


def test_between_these_less_and_less_of_the_light_is_taken_as_white():
    lights = [np.array([0.53, 0.44, blue]) for blue in np.geomspace(0.2, 0.005, 200)]
    whites = np.array([chromaticity(automatic_white(light)) for light in lights])

    assert weakest_response(lights[0]) > 0.2
    assert weakest_response(lights[-1]) < 0.04
    assert np.abs(np.diff(whites, axis=0)).max() < 0.01
    np.testing.assert_allclose(whites[-1], D65, atol=1e-3)


@pytest.mark.parametrize("light", [(0.0, 0.0, 0.0), (np.nan, 1.0, 1.0), (-1.0, -1.0, -1.0)])
def test_what_is_no_light_is_refused(light):
    with pytest.raises(InputError, match="white balance: must be by a light, got XYZ"):
        balance(REC709, np.array(light))
