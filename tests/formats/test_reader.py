import numpy as np
import OpenEXR
import pytest

from skybake.errors import InputError
from skybake.formats.reader import read_image
from tests.formats.maps import sky, write_map


@pytest.mark.parametrize("pixel", ["half", "float"])
def test_what_was_written_is_read(tmp_path, pixel):
    rows = sky()
    write_map(
        tmp_path / "a.exr",
        rows,
        pixel=pixel,
        colorspace="acescg",
        attributes={"skybake:sunDirection": (0.0, 0.6, 0.8)},
    )
    pixels, attributes = read_image(tmp_path / "a.exr")

    assert pixels.dtype == np.float32
    np.testing.assert_array_equal(
        pixels, rows.astype(np.float16 if pixel == "half" else np.float32)
    )
    assert attributes["colorInteropID"] == "lin_ap1_scene"
    assert len(attributes["chromaticities"]) == 8
    assert attributes["whiteLuminance"] == pytest.approx(39321.6)
    np.testing.assert_allclose(attributes["skybake:sunDirection"], (0.0, 0.6, 0.8))


def test_a_radiance_picture_has_the_same_tags_as_an_exr(tmp_path):
    write_map(tmp_path / "a.hdr", sky(), colorspace="lin_p3d65", white_luminance=200.0)
    pixels, attributes = read_image(tmp_path / "a.hdr")

    assert pixels.shape == (64, 128, 3)
    assert attributes["colorInteropID"] == "lin_p3d65_scene"
    np.testing.assert_allclose(attributes["chromaticities"][:2], (0.68, 0.32))
    assert attributes["whiteLuminance"] == pytest.approx(200.0)


def test_a_radiance_picture_by_others_says_nothing_of_scale_or_space(tmp_path):
    """As FreeImage writes them: an exposure of 0 means that it is not known."""
    (tmp_path / "a.hdr").write_bytes(
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=0\n\n-Y 1 +X 2\n" + bytes([128] * 8)
    )
    pixels, attributes = read_image(tmp_path / "a.hdr")

    np.testing.assert_allclose(pixels, 0.5)
    assert "whiteLuminance" not in attributes
    assert "chromaticities" not in attributes


def test_an_exr_by_others_is_read_by_channel_names_not_their_order(tmp_path):
    channels = {
        name: np.full((4, 8), value, np.float32)
        for name, value in zip("BAGR", (3, 0.5, 2, 1), strict=True)
    }
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, channels) as file:
        file.write(str(tmp_path / "a.exr"))
    pixels, attributes = read_image(tmp_path / "a.exr")

    np.testing.assert_array_equal(pixels, np.broadcast_to((1.0, 2.0, 3.0), (4, 8, 3)))
    assert "colorInteropID" not in attributes


def one_channel(path):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"Y": np.ones((4, 8), np.float32)}) as file:
        file.write(str(path))


def infinite(path):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": np.full((4, 8, 3), np.inf, np.float16)}) as file:
        file.write(str(path))


def damaged(path):
    write_map(path, np.random.default_rng(0).random((64, 128, 3), dtype=np.float32))
    path.write_bytes(path.read_bytes()[:-5000])


def eight_bits(path):
    path.write_bytes(b"P6 2 1 255\n" + bytes(6))


@pytest.mark.parametrize(
    ("name", "make", "message"),
    [
        ("missing.exr", lambda path: None, "must be an image file, got nothing$"),
        ("folder.exr", lambda path: path.mkdir(), "must be an image file, got a folder$"),
        ("empty.exr", lambda path: path.touch(), "must be an image, got "),
        ("text.exr", lambda path: path.write_text("hello " * 50), "must be an image, got "),
        ("text.hdr", lambda path: path.write_text("#?RADIANCE\nno"), "must be an image, got "),
        ("damaged.exr", damaged, "must be complete, got "),
        ("damaged.hdr", damaged, "must be complete, got "),
        ("grey.exr", one_channel, "channels must be R, G, B, got Y$"),
        ("infinite.exr", infinite, "pixels must be finite, got inf in R at column 0, row 0$"),
        ("eight.ppm", eight_bits, "pixels must be half or float, got uint8$"),
    ],
)
def test_what_cannot_be_read_is_refused_in_one_line(tmp_path, capfd, name, make, message):
    path = tmp_path / name
    make(path)

    with pytest.raises(InputError, match=message) as caught:
        read_image(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_a_header_with_text_for_a_number_is_refused(tmp_path):
    (tmp_path / "a.hdr").write_bytes(
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nPRIMARIES=red\n\n-Y 1 +X 2\n" + bytes([128] * 8)
    )

    with pytest.raises(InputError, match="EXPOSURE and PRIMARIES must be numbers"):
        read_image(tmp_path / "a.hdr")
