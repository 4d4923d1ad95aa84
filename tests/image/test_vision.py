"""How the eye sees the dark in pictures."""

import numpy as np
import pytest

from skybake.colour.space import find_colour_space, rgb_from_xyz, xyz_from_xy
from skybake.errors import InputError
from skybake.image.picture_settings import PictureSettings
from skybake.image.vision import as_seen, scotopic_luminance

SPACE = find_colour_space("acescg")
TO_RGB = rgb_from_xyz(SPACE)


def seen_xyz(xy, luminance, white=1.0):
    """What the eye makes of light, through pixels of a scale."""
    pixels = (TO_RGB @ xyz_from_xy(*xy) * luminance / white).astype(np.float32)
    looks = as_seen(pixels[None, None], SPACE, white, "eye")[0, 0].astype(float)
    return np.linalg.inv(TO_RGB) @ looks * white


def test_by_day_the_eye_sees_what_a_camera_sees():
    day = seen_xyz((0.31, 0.33), 50.0)
    np.testing.assert_allclose(day, xyz_from_xy(0.31, 0.33) * 50.0, rtol=1e-5)


@pytest.mark.parametrize("white", [1.0, 0.15])
def test_in_the_dark_all_light_has_one_colour(white):
    for xy in ((0.45, 0.41), (0.25, 0.3)):
        x, y, z = seen_xyz(xy, 1e-3, white)
        assert (x, y) / (x + y + z) == pytest.approx((0.25, 0.25), abs=1e-4)


def test_in_the_dark_blue_light_is_brighter_than_red_of_the_same_luminance():
    red, blue = (seen_xyz(xy, 1e-3)[1] for xy in ((0.5, 0.4), (0.2, 0.2)))
    assert blue > 3.0 * red
    # White stays as bright as it was.
    assert seen_xyz((0.333, 0.333), 1e-3)[1] == pytest.approx(1e-3, rel=0.05)


# Scotopic over photopic luminance, of 1700 and 683 lm/W: CIE's D65 and A.
@pytest.mark.parametrize(("xy", "ratio"), [((0.3127, 0.329), 2.47), ((0.4476, 0.4074), 1.41)])
def test_scotopic_luminance_is_that_of_known_lights(xy, ratio):
    assert scotopic_luminance(xyz_from_xy(*xy)) == pytest.approx(ratio, rel=0.1)


def test_no_light_stays_none():
    assert (as_seen(np.zeros((1, 1, 3), np.float32), SPACE, 1.0, "eye") == 0.0).all()


def test_a_camera_changes_nothing():
    pixels = np.ones((1, 2, 3), np.float32)
    assert as_seen(pixels, SPACE, 1.0, "camera") is pixels


def test_another_vision_is_refused():
    with pytest.raises(InputError, match="vision: must be one of camera, eye, got 'cat'"):
        PictureSettings(vision="cat")
