import hashlib

import numpy as np
import OpenEXR
import OpenImageIO
import pytest

from skybake.errors import InputError, OutputError
from skybake.formats.reader import read_attributes
from skybake.formats.writer import open_map
from tests.formats.maps import HEIGHT, WIDTH, listing, map_spec, sky, write_map

RECIPE = '{"planet": "earth"}\n# second line, with "quotes" and µ'


def header(path):
    with OpenEXR.File(str(path), header_only=True) as file:
        return dict(file.header())


def pixels(path):
    with OpenEXR.File(str(path)) as file:
        return file.channels()["RGB"].pixels.copy()


def test_attributes_have_the_standard_types(tmp_path):
    path = tmp_path / "a.exr"
    write_map(
        path,
        sky(),
        colorspace="acescg",
        envmap="latlong",
        attributes={
            "skybake:sunDirection": (0.0, 0.6, 0.8),
            "skybake:sunIlluminance": 98765.0,
            "skybake:bands": (380.0, 550.0, 720.0, 830.0),
            "skybake:frame": 12,
            "skybake:recipe": RECIPE,
            "Software": "skybake 9.9",
            "DateTime": "2026:06:21 05:00:00",
        },
    )
    found = header(path)

    assert found["envmap"] == OpenEXR.ENVMAP_LATLONG
    assert found["colorInteropID"] == "lin_ap1_scene"
    np.testing.assert_allclose(
        found["chromaticities"], (0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767)
    )
    assert found["adoptedNeutral"].shape == (2,)
    np.testing.assert_allclose(found["adoptedNeutral"], (0.32168, 0.33767), rtol=1e-6)
    assert found["whiteLuminance"] == pytest.approx(39321.6)
    assert found["skybake:sunDirection"].dtype == np.float32
    np.testing.assert_allclose(found["skybake:sunDirection"], (0.0, 0.6, 0.8))
    assert found["skybake:sunIlluminance"] == 98765.0
    assert found["skybake:frame"] == 12
    assert found["skybake:recipe"] == RECIPE
    assert found["Software"] == "skybake 9.9"
    assert found["capDate"] == "2026:06:21 05:00:00"
    assert found["compression"] == OpenEXR.ZIP_COMPRESSION
    assert found["lineOrder"] == OpenEXR.INCREASING_Y


@pytest.mark.parametrize(("pixel", "kind"), [("half", np.float16), ("float", np.float32)])
def test_pixels_are_stored_as_the_type_that_was_asked_for(tmp_path, pixel, kind):
    rows = sky()
    write_map(tmp_path / "a.exr", rows, pixel=pixel)

    stored = pixels(tmp_path / "a.exr")
    assert stored.dtype == kind
    np.testing.assert_array_equal(stored, rows.astype(kind))


def test_halves_given_are_halves_stored(tmp_path):
    rows = sky().astype(np.float16)
    write_map(tmp_path / "a.exr", rows)

    np.testing.assert_array_equal(pixels(tmp_path / "a.exr"), rows)


def test_six_faces_in_a_column_are_tagged_as_an_openexr_cube(tmp_path):
    write_map(tmp_path / "a.exr", sky(16, 96), envmap="cube")

    assert header(tmp_path / "a.exr")["envmap"] == OpenEXR.ENVMAP_CUBE


def test_a_map_without_directions_is_not_tagged_as_one(tmp_path):
    write_map(tmp_path / "a.exr", sky())

    assert "envmap" not in header(tmp_path / "a.exr")


@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan])
@pytest.mark.parametrize("pixel", ["half", "float"])
def test_a_value_that_is_not_finite_is_refused(tmp_path, value, pixel):
    rows = sky()
    rows[40, 3, 1] = value

    with pytest.raises(OutputError, match=r"a.exr: radiance must be finite, got -?(inf|nan)"):
        write_map(tmp_path / "a.exr", rows, pixel=pixel)
    assert listing(tmp_path) == []


@pytest.mark.parametrize("value", [65505.0, 65520.0, 1.6e9, -7e4])
def test_a_value_that_half_would_turn_into_infinity_is_refused(tmp_path, value):
    rows = sky()
    rows[0, 0, 0] = value

    with pytest.raises(OutputError, match=r"radiance in half with zip must be at most 65504, got"):
        write_map(tmp_path / "a.exr", rows)
    assert listing(tmp_path) == []


def test_the_largest_half_and_a_sun_in_float_are_stored_exactly(tmp_path):
    rows = sky()
    rows[0, 0] = 65504.0
    write_map(tmp_path / "half.exr", rows)
    rows[0, 0] = 1.6e9
    write_map(tmp_path / "float.exr", rows, pixel="float")

    assert (pixels(tmp_path / "half.exr")[0, 0] == 65504.0).all()
    assert (pixels(tmp_path / "float.exr")[0, 0] == np.float32(1.6e9)).all()


@pytest.mark.parametrize("compression", ["zip", "piz", "dwaa", "htj2k256", "zstd"])
def test_the_same_map_has_the_same_bytes_whatever_the_threads_and_bands(tmp_path, compression):
    rows = sky(256, 512)
    digests = set()
    before = OpenImageIO.get_int_attribute("threads")
    try:
        for threads, band in ((1, 16), (2, 512), (4, 100)):
            OpenImageIO.attribute("threads", threads)
            write_map(tmp_path / "a.exr", rows, band, compression=compression, envmap="latlong")
            digests.add(hashlib.sha256((tmp_path / "a.exr").read_bytes()).hexdigest())
    finally:
        OpenImageIO.attribute("threads", before)

    assert len(digests) == 1


@pytest.mark.parametrize(
    ("y_begin", "shape"),
    [
        (16, (16, WIDTH, 3)),
        (0, (15, WIDTH, 3)),
        (0, (16, WIDTH, 4)),
        (0, (16, WIDTH - 1, 3)),
    ],
)
def test_rows_out_of_order_or_of_another_shape_are_an_error_of_the_program(
    tmp_path, y_begin, shape
):
    with (
        pytest.raises(ValueError, match="rows must follow row 0"),
        open_map(tmp_path / "a.exr", map_spec()) as writer,
    ):
        writer.write_rows(y_begin, y_begin + 16, np.zeros(shape, np.float32))
    assert listing(tmp_path) == []


def test_a_map_that_lacks_rows_does_not_appear(tmp_path):
    with (
        pytest.raises(ValueError, match=f"rows must be written to {HEIGHT}, got 48"),
        open_map(tmp_path / "a.exr", map_spec()) as writer,
    ):
        writer.write_rows(0, 48, sky()[:48])
    assert listing(tmp_path) == []


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"pixel": "uint8"}, "pixel: must be one of half, float, rgb9e5, r11g11b10, got 'uint8'"),
        ({"white_luminance": 0.0}, "white_luminance: must be positive, got 0 cd/m2"),
        ({"white_luminance": float("nan")}, "white_luminance: must be positive, got nan cd/m2"),
        ({"width": 0}, "size: width and height must be at least 1, got 0x64"),
    ],
)
def test_a_spec_that_no_file_can_hold_is_refused(options, message):
    with pytest.raises(InputError, match=message):
        map_spec(**options)


@pytest.mark.parametrize("name", ["a.png", "a", "a.exr.txt"])
def test_an_unknown_suffix_is_refused_with_the_known_ones(tmp_path, name):
    with (
        pytest.raises(InputError, match=r"suffix must be one of .exr, .hdr, .ktx2, .dds, got"),
        open_map(tmp_path / name, map_spec()),
    ):
        pass
    assert listing(tmp_path) == []


def test_the_suffix_may_be_written_in_capitals(tmp_path):
    write_map(tmp_path / "A.EXR", sky())

    assert header(tmp_path / "A.EXR")["type"] == OpenEXR.scanlineimage


@pytest.mark.parametrize("letter", ["x", "µ", "€", "😀"])
@pytest.mark.parametrize("length", [0, 1, 63, 84, 127, 254, 255, 256, 300, 4000])
def test_a_long_text_is_cut_into_pieces_and_joined_again(tmp_path, length, letter):
    """FFmpeg 5.1 reads 255 bytes of an attribute."""
    path, text = tmp_path / "a.exr", letter * length + "."
    write_map(path, sky(), attributes={"skybake:recipe": text, "skybake:recipeHash": "0123"})
    texts = [value for value in header(path).values() if isinstance(value, str)]
    assert max(len(value.encode()) for value in texts) <= 255
    found = read_attributes(path)
    assert found["skybake:recipe"] == text
    assert found["skybake:recipeHash"] == "0123"
    assert not [name for name in found if name.startswith("skybake:recipe:")]


def test_texts_that_only_look_like_pieces_stay_apart(tmp_path):
    path = tmp_path / "a.exr"
    attributes = {"a": "short", "a:2": "other", "b": "x" * 250, "b:3": "not the second"}
    write_map(path, sky(), attributes=attributes)
    found = read_attributes(path)
    assert {name: found[name] for name in attributes} == attributes
