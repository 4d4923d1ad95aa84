import colour
import numpy as np
import OpenImageIO
import pytest

from skybake.colour.space import (
    COLOUR_SPACES,
    colour_space_from_tags,
    find_colour_space,
    luminance_weights,
    rgb_from_xyz,
)
from skybake.errors import InputError

CONFIG = "ocio://cg-config-v4.0.0_aces-v2.0_ocio-v2.5"
RGB_SPACES = [space for space in COLOUR_SPACES.values() if space.name != "xyz"]
ALL_SPACES = list(COLOUR_SPACES.values())
IN_COLOUR_SCIENCE = {
    "lin_rec709": "ITU-R BT.709",
    "acescg": "ACEScg",
    "lin_rec2020": "ITU-R BT.2020",
    "lin_p3d65": "P3-D65",
    "aces2065-1": "ACES2065-1",
}


def name(space):
    return space.name


@pytest.mark.parametrize("space", ALL_SPACES, ids=name)
def test_every_matrix_is_that_of_the_aces_configuration(space):
    """OpenColorIO applies matrices in single precision."""
    converted = OpenImageIO.ImageBufAlgo.colorconvert(
        OpenImageIO.ImageBuf(np.eye(3, dtype=np.float32)[None]),
        "lin_ciexyzd65_scene",
        space.interop_id,
        colorconfig=CONFIG,
    )
    assert not converted.has_error, converted.geterror()
    np.testing.assert_allclose(
        rgb_from_xyz(space), converted.get_pixels(OpenImageIO.FLOAT)[0].T, rtol=0.0, atol=1e-6
    )


@pytest.mark.parametrize("space", RGB_SPACES, ids=name)
def test_every_matrix_is_that_of_colour_science(space):
    theirs = colour.RGB_COLOURSPACES[IN_COLOUR_SCIENCE[space.name]].copy()
    theirs.use_derived_matrix_XYZ_to_RGB = True
    xyz = np.random.default_rng(0).random((8, 3))

    expected = colour.XYZ_to_RGB(
        xyz,
        theirs,
        illuminant=np.array([0.3127, 0.3290]),
        chromatic_adaptation_transform="Bradford",
    )
    np.testing.assert_allclose(xyz @ rgb_from_xyz(space).T, expected, atol=1e-9)


@pytest.mark.parametrize("space", RGB_SPACES, ids=name)
def test_daylight_d65_of_luminance_one_is_white_in_every_space(space):
    d65 = np.array([0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290])

    np.testing.assert_allclose(rgb_from_xyz(space) @ d65, 1.0, rtol=1e-12)


@pytest.mark.parametrize("space", ALL_SPACES, ids=name)
def test_luminance_of_rgb_is_the_y_it_came_from(space):
    xyz = np.array([0.3, 0.7, 1.9])

    assert luminance_weights(space) @ rgb_from_xyz(space) @ xyz == pytest.approx(0.7)


@pytest.mark.parametrize("space", ALL_SPACES, ids=name)
def test_chromaticities_are_those_openimageio_knows_for_the_name(space):
    config = OpenImageIO.ColorConfig(CONFIG)

    np.testing.assert_allclose(
        space.chromaticities, config.get_chromaticities(space.interop_id), atol=1e-6
    )


@pytest.mark.parametrize("space", ALL_SPACES, ids=name)
def test_either_tag_leads_back_to_the_space(space):
    stored = tuple(np.float32(c) for c in space.chromaticities)

    assert colour_space_from_tags("a.exr", space.interop_id, None) is space
    assert colour_space_from_tags("a.exr", None, stored) is space
    assert colour_space_from_tags("a.exr", "made_up", stored) is space


def test_a_file_without_tags_is_rec709():
    assert colour_space_from_tags("a.exr", None, None) is COLOUR_SPACES["lin_rec709"]
    assert colour_space_from_tags("a.exr", "unknown", None) is COLOUR_SPACES["lin_rec709"]


def test_tags_of_another_space_are_refused_with_the_known_ones():
    with pytest.raises(InputError, match=r"^a.exr: .*lin_ap1_scene.*, got g24_rec709_display$"):
        colour_space_from_tags("a.exr", "g24_rec709_display", None)
    with pytest.raises(InputError, match=r"got chromaticities 0.9 0 0 0.9 0 0 0.3 0.3$"):
        colour_space_from_tags("a.exr", None, (0.9, 0.0, 0.0, 0.9, 0.0, 0.0, 0.3, 0.3))


def test_an_unknown_name_is_refused_with_the_known_ones():
    with pytest.raises(InputError, match=r"must be one of lin_rec709, acescg, .*, got 'srgb'"):
        find_colour_space("srgb")
