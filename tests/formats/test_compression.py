import numpy as np
import OpenImageIO
import pytest

from skybake.errors import InputError, OutputError
from skybake.formats.compression import COMPRESSIONS, largest_value, parse_compression
from tests.formats.maps import listing, sky, write_map

LOSSY = {"pxr24": 0.0, "b44": 0.05, "b44a": 0.05, "dwaa": 0.1, "dwab": 0.1}


@pytest.mark.parametrize("compression", [*COMPRESSIONS, "zip:9", "dwaa:90", "dwab:0"])
def test_the_file_has_the_compression_that_was_asked_for(tmp_path, compression):
    """OpenImageIO writes zip for every name that it does not know."""
    write_map(tmp_path / "a.exr", sky(), compression=compression)
    stored = OpenImageIO.ImageInput.open(str(tmp_path / "a.exr")).spec()["compression"]

    assert stored == compression.partition(":")[0]


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_pixels_come_back_as_halves(tmp_path, compression):
    rows = sky()
    write_map(tmp_path / "a.exr", rows, compression=compression)
    back = OpenImageIO.ImageBuf(str(tmp_path / "a.exr")).get_pixels(OpenImageIO.FLOAT)

    tolerance = LOSSY.get(compression, 0.0)
    np.testing.assert_allclose(back, rows.astype(np.float16), rtol=tolerance, atol=tolerance / 10)


@pytest.mark.parametrize("text", ["htj2k", "zlib", "ZIP", "", ":4", "dwa"])
def test_an_unknown_compression_is_refused_with_the_known_ones(text):
    with pytest.raises(InputError, match=r"must be one of none, rle, .*, zstd, got"):
        parse_compression(text)


@pytest.mark.parametrize("text", ["zip:0", "zip:10", "zip:4.5", "zip:", "zip:high"])
def test_a_zip_level_that_is_no_level_is_refused(text):
    with pytest.raises(InputError, match="level of zip must be a whole number within 1 to 9, got"):
        parse_compression(text)


@pytest.mark.parametrize("text", ["dwaa:-1", "dwab:136", "dwaa:nan", "dwaa:inf"])
def test_a_dwa_level_beyond_the_known_limits_is_refused(text):
    with pytest.raises(InputError, match=r"level of dwa[ab] must be a number within 0 to 135, got"):
        parse_compression(text)


@pytest.mark.parametrize("text", ["piz:3", "none:1", "zips:2", "htj2k256:1"])
def test_a_level_for_a_compression_without_levels_is_refused(text):
    with pytest.raises(InputError, match="only zip, dwaa and dwab take a level"):
        parse_compression(text)


@pytest.mark.parametrize(
    ("compression", "limit"), [("dwaa:0", 63456), ("dwab", 62016), ("dwaa:90", 56760)]
)
def test_a_sun_that_dwa_would_turn_into_infinity_is_refused(tmp_path, compression, limit):
    rows = sky()
    rows[10, 20] = limit + 100.0

    with pytest.raises(OutputError, match=rf"at most {limit}, got {limit + 100}; use a larger"):
        write_map(tmp_path / "a.exr", rows, compression=compression)
    assert listing(tmp_path) == []


@pytest.mark.parametrize("level", [0, 20, 45, 70, 90, 110, 135])
@pytest.mark.parametrize("name", ["dwaa", "dwab"])
def test_what_dwa_may_hold_it_returns_finite(tmp_path, name, level):
    """Blocks of full, half and no light in each channel, the hardest that DWA is given."""
    random = np.random.default_rng(level)
    rows = sky(128, 128)
    limit = np.float32(largest_value("half", f"{name}:{level}"))
    for _ in range(300):
        y, x, size = random.integers(0, 120), random.integers(0, 120), random.integers(1, 9)
        rows[y : y + size, x : x + size] = limit * random.choice([0.0, 1.0, 1.0, 0.5], 3)
    write_map(tmp_path / "a.exr", rows, compression=f"{name}:{level}")

    assert np.isfinite(OpenImageIO.ImageBuf(str(tmp_path / "a.exr")).get_pixels()).all()


def test_dwa_limits_hold_for_float_pixels_too_as_it_stores_halves():
    assert largest_value("float", "dwaa") == largest_value("half", "dwaa") == 62016.0
    assert largest_value("float", "zip") == np.finfo(np.float32).max
