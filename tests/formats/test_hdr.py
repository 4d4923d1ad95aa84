import hashlib

import numpy as np
import OpenImageIO
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from skybake.errors import InputError, OutputError
from skybake.formats.hdr import read_header, round_to_rgbe
from skybake.formats.reader import read_attributes
from tests.formats.maps import listing, sky, write_map


def pixels(path):
    return OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.FLOAT)


def test_every_value_is_within_half_a_step_of_eight_bits_under_the_largest(tmp_path):
    rows = sky(256, 128)
    write_map(tmp_path / "a.hdr", rows)

    error = (pixels(tmp_path / "a.hdr") - rows) / rows.max(axis=-1, keepdims=True)
    assert np.abs(error).max() <= 1.0 / 256.0


def test_a_map_is_on_average_as_bright_as_what_was_baked(tmp_path):
    """ScaledMedium, as the library does it, would lose 0.3 %."""
    rows = np.random.default_rng(0).uniform(1.0, 4.0, (64, 128, 3)).astype(np.float32)
    write_map(tmp_path / "a.hdr", rows)

    assert pixels(tmp_path / "a.hdr").mean() == pytest.approx(rows.mean(), rel=2e-4)


@given(arrays(np.float32, (1, 8, 3), elements=st.floats(0.0, 2.0**60, width=32)))
def test_rounding_twice_is_rounding_once(values):
    once = round_to_rgbe(values)

    np.testing.assert_array_equal(round_to_rgbe(once), once)


def test_the_library_stores_rounded_values_as_they_are(tmp_path):
    random = np.random.default_rng(1)
    rows = np.exp(random.normal(0.0, 8.0, (64, 128, 1))) * random.random((64, 128, 3))
    rounded = round_to_rgbe(rows.astype(np.float32))
    write_map(tmp_path / "a.hdr", rounded)

    np.testing.assert_array_equal(pixels(tmp_path / "a.hdr"), rounded)


def test_the_sun_is_stored_unclipped(tmp_path):
    rows = sky()
    rows[5, 5] = 1.6e9
    write_map(tmp_path / "a.hdr", rows)

    np.testing.assert_allclose(pixels(tmp_path / "a.hdr")[5, 5], 1.6e9, rtol=1 / 256)


def test_the_header_says_what_the_pixels_are(tmp_path):
    path = tmp_path / "a.hdr"
    write_map(
        path,
        sky(),
        colorspace="lin_rec2020",
        attributes={
            "Software": "skybake 9.9",
            "DateTime": "2026:06:21 05:00:00",
            "skybake:sunDirection": (0.0, 0.6, 0.8),
            "skybake:recipe": "first\n\nsecond = 1",
        },
    )
    lines = path.read_bytes().partition(b"\n\n")[0].decode().split("\n")

    assert lines[0] == "#?RADIANCE"
    assert set(lines[1:]) == {
        "FORMAT=32-bit_rle_rgbe",
        "SOFTWARE=skybake 9.9",
        "CAPDATE=2026:06:21 05:00:00",
        "EXPOSURE=0.0045522054",
        "PRIMARIES=0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329",
        "# colorInteropID=lin_rec2020_scene",
        "# skybake:sunDirection=0 0.6 0.8",
        "# skybake:recipe=first\\n\\nsecond = 1",
    }


def test_a_long_text_is_cut_into_short_lines_and_joined_again(tmp_path):
    path = tmp_path / "a.hdr"
    recipe = "# planet = µ  \\ " * 300
    write_map(path, sky(), attributes={"skybake:recipe": recipe, "skybake:none": ""})
    lines = path.read_bytes().partition(b"\n\n")[0].split(b"\n")

    assert max(len(line) for line in lines) < 128
    assert read_header(path)["skybake:recipe"] == recipe.replace("\\", "\\\\")
    assert read_header(path)["skybake:none"] == ""
    assert pixels(path).shape == (64, 128, 3)


def test_exposure_gives_the_luminance_by_the_rule_of_radiance(tmp_path):
    """Radiance: luminance = 179 lm/W * value / EXPOSURE."""
    write_map(tmp_path / "a.hdr", sky(), white_luminance=1234.5)

    exposure = float(read_header(tmp_path / "a.hdr")["EXPOSURE"])
    assert 179.0 * 1.0 / exposure == pytest.approx(1234.5)


def test_without_exposure_a_comment_gives_the_luminance_of_white(tmp_path):
    path = tmp_path / "a.hdr"
    writer = write_map(path, sky(), white_luminance=1234.5, states_exposure=False)
    lines = path.read_bytes().partition(b"\n\n")[0].split(b"\n")

    assert writer.clamped == 0
    assert b"# whiteLuminance=1234.5" in lines
    assert not [line for line in lines if b"EXPOSURE" in line]
    assert read_attributes(path)["whiteLuminance"] == 1234.5


@pytest.mark.parametrize("white", ["-1", "0", "nan", "inf"])
def test_a_luminance_of_white_that_cannot_be_is_none(tmp_path, white):
    path = tmp_path / "a.hdr"
    path.write_bytes(
        b"#?RADIANCE\n# whiteLuminance=%s\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\1\2\3\4"
        % white.encode()
    )
    assert "whiteLuminance" not in read_attributes(path)


def test_exposures_of_several_programs_multiply(tmp_path):
    (tmp_path / "a.hdr").write_bytes(b"#?RADIANCE\nEXPOSURE=2\nEXPOSURE=0.25\n\n-Y 1 +X 1\n")

    assert read_header(tmp_path / "a.hdr") == {"EXPOSURE": "0.5"}


def test_negative_values_become_zero_and_are_counted(tmp_path):
    rows = sky()
    rows[3, 4] = (-0.25, 0.5, -1e-6)
    writer = write_map(tmp_path / "a.hdr", rows)

    assert writer.clamped == 2
    np.testing.assert_array_equal(pixels(tmp_path / "a.hdr")[3, 4], (0.0, 0.5, 0.0))


@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan])
def test_a_value_that_is_not_finite_is_refused(tmp_path, value):
    rows = sky()
    rows[40, 3, 1] = value

    with pytest.raises(OutputError, match=r"a.hdr: radiance must be finite, got -?(inf|nan)"):
        write_map(tmp_path / "a.hdr", rows)
    assert listing(tmp_path) == []


def test_xyz_is_refused_as_the_format_would_take_it_for_rgb(tmp_path):
    with pytest.raises(InputError, match="a Radiance picture must hold RGB"):
        write_map(tmp_path / "a.hdr", sky(), colorspace="xyz")
    assert listing(tmp_path) == []


def test_the_same_map_has_the_same_bytes(tmp_path):
    digests = set()
    for band in (16, 64):
        write_map(tmp_path / "a.hdr", sky(), band)
        digests.add(hashlib.sha256((tmp_path / "a.hdr").read_bytes()).hexdigest())

    assert len(digests) == 1


def test_halves_are_taken_as_well(tmp_path):
    rows = sky().astype(np.float16)
    write_map(tmp_path / "a.hdr", rows)

    np.testing.assert_array_equal(
        pixels(tmp_path / "a.hdr"), round_to_rgbe(rows.astype(np.float32))
    )
