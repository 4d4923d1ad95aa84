import base64
import struct
import subprocess
import sys

import numpy as np
import pytest

from skybake.errors import InputError, OutputError
from skybake.formats.ktx2 import write_ktx2
from skybake.formats.whole_files import WholeFiles
from tests.formats.cubes import VK, cube_levels, decode, ktx_parse, read_ktx2, three_texture
from tests.formats.maps import listing

PIXELS = tuple(VK)
UNITS = {"half": 2, "float": 4, "rgb9e5": 4, "r11g11b10": 4}
# Half a step of the mantissa, of the largest channel of a shared exponent.
ERRORS = {"half": 2.0**-11, "float": 0.0, "rgb9e5": 2.0**-9, "r11g11b10": 2.0**-6}


@pytest.mark.parametrize("zstd", [True, False])
@pytest.mark.parametrize("pixel", PIXELS)
def test_levels_and_faces_come_back_in_their_order(tmp_path, pixel, zstd):
    levels = cube_levels()
    lost = write_ktx2(tmp_path / "a.ktx2", levels, pixel=pixel, zstd=zstd)
    header, stored, _, _ = read_ktx2(tmp_path / "a.ktx2")

    assert lost == 0
    assert header == {
        "vk": VK[pixel],
        "type_size": UNITS[pixel],
        "width": 16,
        "height": 16,
        "depth": 0,
        "layers": 0,
        "faces": 6,
        "levels": 3,
        "scheme": 2 if zstd else 0,
    }
    for level, texels in zip(levels, stored, strict=True):
        found = decode(texels, pixel).reshape(level.shape)
        largest = level if pixel != "rgb9e5" else level.max(axis=-1, keepdims=True)
        assert (np.abs(found - level) <= ERRORS[pixel] * largest).all()


def test_the_smallest_level_stands_first_in_the_file(tmp_path):
    write_ktx2(tmp_path / "a.ktx2", cube_levels())
    data = (tmp_path / "a.ktx2").read_bytes()
    places = [struct.unpack_from("<Q", data, 80 + 24 * k)[0] for k in range(3)]

    assert places == sorted(places, reverse=True)


@pytest.mark.parametrize("pixel", PIXELS)
def test_ktx_parse_reads_what_was_written(tmp_path, pixel):
    levels = cube_levels()
    attributes = {"colorInteropID": "lin_rec709_scene", "skybake:sunDirection": (0.0, 0.6, 0.8)}
    write_ktx2(tmp_path / "a.ktx2", levels, pixel=pixel, zstd=False, attributes=attributes)
    found = ktx_parse(tmp_path / "a.ktx2")

    assert (found["vkFormat"], found["typeSize"], found["faceCount"]) == (
        VK[pixel],
        UNITS[pixel],
        6,
    )
    assert (found["pixelWidth"], found["pixelHeight"], found["supercompressionScheme"]) == (
        16,
        16,
        0,
    )
    texts = found["keyValue"]
    assert texts["KTXorientation"] == "rd"
    assert texts["KTXwriter"].startswith("skybake ")
    assert bytes(texts["skybake:sunDirection"].values()) == b"0 0.6 0.8\0"
    (block,) = found["dataFormatDescriptor"]
    assert (block["colorModel"], block["colorPrimaries"], block["transferFunction"]) == (1, 1, 1)
    stored = [base64.b64decode(level["bytes"]) for level in found["levels"]]
    assert [decode(one, pixel).size for one in stored] == [level.size for level in levels]


@pytest.mark.parametrize("pixel", PIXELS)
def test_three_reads_texels_and_space_of_compressed_levels(tmp_path, pixel):
    levels = cube_levels()
    attributes = {"colorInteropID": "lin_rec709_scene"}
    write_ktx2(tmp_path / "a.ktx2", levels, pixel=pixel, attributes=attributes)
    found, stored = three_texture(tmp_path / "a.ktx2"), read_ktx2(tmp_path / "a.ktx2")[1]

    assert (found["colorSpace"], found["width"]) == ("srgb-linear", 16)
    assert [base64.b64decode(level) for level in found["levels"]] == stored


def samples(descriptor):
    """First bit, number of bits, channel with qualifiers, lower and upper of each sample."""
    total, vendor, version, size = struct.unpack_from("<IIHH", descriptor)
    assert (total, vendor, version, size) == (len(descriptor), 0, 2, len(descriptor) - 4)
    found = []
    for at in range(28, len(descriptor), 16):
        first, bits, channel, position, lower, upper = struct.unpack_from("<HBBIII", descriptor, at)
        assert position == 0
        found.append((first, bits + 1, channel, lower, upper))
    return found


def test_the_descriptor_tells_the_bits_of_each_channel(tmp_path):
    found = {}
    for pixel in PIXELS:
        write_ktx2(tmp_path / "a.ktx2", cube_levels(2, 1), pixel=pixel)
        found[pixel] = read_ktx2(tmp_path / "a.ktx2")[2]

    minus, one = 0xBF800000, 0x3F800000
    assert samples(found["half"]) == [
        (16 * i, 16, channel | 0xC0, minus, one) for i, channel in enumerate((0, 1, 2, 15))
    ]
    assert samples(found["float"]) == [
        (32 * i, 32, channel | 0xC0, minus, one) for i, channel in enumerate((0, 1, 2, 15))
    ]
    assert samples(found["r11g11b10"]) == [
        (0, 11, 0x80, 0, one),
        (11, 11, 0x81, 0, one),
        (22, 10, 0x82, 0, one),
    ]
    assert samples(found["rgb9e5"]) == [
        (0, 9, 0, 0, 8448),
        (27, 5, 0x20, 15, 31),
        (9, 9, 1, 0, 8448),
        (27, 5, 0x21, 15, 31),
        (18, 9, 2, 0, 8448),
        (27, 5, 0x22, 15, 31),
    ]
    sizes = {pixel: descriptor[20] for pixel, descriptor in found.items()}
    assert sizes == {"half": 8, "float": 16, "rgb9e5": 4, "r11g11b10": 4}


@pytest.mark.parametrize(
    ("space", "primaries"),
    [("lin_rec709_scene", 1), ("lin_p3d65_scene", 10), ("of_my_own", 0), (None, 0)],
)
def test_primaries_are_those_of_the_stated_space(tmp_path, space, primaries):
    attributes = {} if space is None else {"colorInteropID": space}
    write_ktx2(tmp_path / "a.ktx2", cube_levels(2, 1), attributes=attributes)
    descriptor = read_ktx2(tmp_path / "a.ktx2")[2]

    assert tuple(descriptor[12:16]) == (1, primaries, 1, 0)


def test_key_values_are_sorted_padded_and_end_with_zero(tmp_path):
    attributes = {
        "whiteLuminance": 39321.6,
        "a": "µ" * 300,
        "skybake:recipe": '{"planet": "earth"}',
    }
    write_ktx2(tmp_path / "a.ktx2", cube_levels(2, 1), attributes=attributes)
    texts = read_ktx2(tmp_path / "a.ktx2")[3]

    assert list(texts) == sorted(texts)
    assert texts["a"] == ("µ" * 300).encode() + b"\0"
    assert texts["whiteLuminance"] == b"39321.6\0"


@pytest.mark.parametrize(
    ("pixel", "value", "limit"),
    [
        ("half", 65505.0, "65504"),
        ("rgb9e5", 65409.0, "65408"),
        ("r11g11b10", 65025.0, "65024"),
        ("half", -7e4, "65504"),
    ],
)
def test_a_value_beyond_the_type_is_refused_and_nothing_is_written(tmp_path, pixel, value, limit):
    levels = cube_levels()
    levels[1][3, 2, 1, 0] = value

    message = rf"a.ktx2: radiance in {pixel} must be at most {limit}, got {value:g}"
    with pytest.raises(OutputError, match=message):
        write_ktx2(tmp_path / "a.ktx2", levels, pixel=pixel)
    assert listing(tmp_path) == []


@pytest.mark.parametrize("pixel", PIXELS)
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_value_that_is_not_finite_is_refused(tmp_path, pixel, value):
    levels = cube_levels()
    levels[0][5, 0, 0, 2] = value

    with pytest.raises(OutputError, match=r"a.ktx2: radiance must be finite, got -?(inf|nan)"):
        write_ktx2(tmp_path / "a.ktx2", levels, pixel=pixel)
    assert listing(tmp_path) == []


@pytest.mark.parametrize("pixel", PIXELS)
def test_the_largest_value_of_each_type_is_stored_exactly(tmp_path, pixel):
    largest = {"half": 65504.0, "float": 3.4e38, "rgb9e5": 65408.0, "r11g11b10": 65024.0}[pixel]
    levels = cube_levels(4, 1)
    levels[0][0, 0, 0] = (largest, 0.0, 64512.0)
    write_ktx2(tmp_path / "a.ktx2", levels, pixel=pixel)
    red, green, blue = decode(read_ktx2(tmp_path / "a.ktx2")[1][0], pixel)[0]

    assert (red, green, blue) == (np.float32(largest), 0.0, 64512.0)


@pytest.mark.parametrize("pixel", PIXELS)
def test_negative_values_are_kept_or_counted(tmp_path, pixel):
    levels = cube_levels(4, 1)
    levels[0][2, 1, :, 0] = -0.25
    lost = write_ktx2(tmp_path / "a.ktx2", levels, pixel=pixel)
    found = decode(read_ktx2(tmp_path / "a.ktx2")[1][0], pixel).reshape(levels[0].shape)

    is_signed = pixel in {"half", "float"}
    assert lost == (0 if is_signed else 4)
    assert (found[2, 1, :, 0] == (-0.25 if is_signed else 0.0)).all()


@pytest.mark.parametrize("pixel", ["rgb9e5", "r11g11b10"])
def test_packed_floats_are_the_nearest_from_the_smallest_on(tmp_path, pixel):
    """Against the nearest of all values that the format has."""
    grey = np.geomspace(1e-8, 6e4, 6 * 32 * 32).astype(np.float32)
    levels = [np.repeat(grey.reshape(6, 32, 32, 1), 3, -1)]
    write_ktx2(tmp_path / "a.ktx2", levels, pixel=pixel)
    found = decode(read_ktx2(tmp_path / "a.ktx2")[1][0], pixel)

    if pixel == "rgb9e5":
        all_values = np.unique(np.arange(512)[:, None] * 2.0 ** (np.arange(32)[None] - 24.0))
        columns = {0: all_values, 1: all_values, 2: all_values}
    else:
        eleven = [2.0**-14 * m / 64 for m in range(64)]
        eleven += [2.0 ** (e - 15) * (1 + m / 64) for e in range(1, 31) for m in range(64)]
        ten = [2.0**-14 * m / 32 for m in range(32)]
        ten += [2.0 ** (e - 15) * (1 + m / 32) for e in range(1, 31) for m in range(32)]
        columns = {0: np.array(eleven), 1: np.array(eleven), 2: np.array(ten)}
    for channel, values in columns.items():
        above = np.clip(np.searchsorted(values, grey), 1, len(values) - 1)
        nearest = np.minimum(np.abs(values[above] - grey), np.abs(values[above - 1] - grey))
        np.testing.assert_array_equal(np.abs(found[:, channel] - grey), nearest)


def test_the_same_cube_has_the_same_bytes(tmp_path):
    for name in ("a", "b"):
        write_ktx2(tmp_path / f"{name}.ktx2", cube_levels(64, 7))

    assert (tmp_path / "a.ktx2").read_bytes() == (tmp_path / "b.ktx2").read_bytes()


def write_set(folder, other, files):
    write_ktx2(folder / "a.ktx2", cube_levels(), files=files)
    write_ktx2(folder / "b.ktx2", other, files=files)


def test_a_cube_appears_with_the_rest_of_its_set(tmp_path):
    bright = cube_levels(largest=1e6)
    with pytest.raises(OutputError), WholeFiles() as files:
        write_set(tmp_path, bright, files)
    assert listing(tmp_path) == []
    with WholeFiles() as files:
        write_ktx2(tmp_path / "a.ktx2", cube_levels(), files=files)
        assert "a.ktx2" not in listing(tmp_path)
    assert listing(tmp_path) == ["a.ktx2"]


def test_an_unknown_pixel_is_refused_with_the_known_ones(tmp_path):
    message = "pixel: must be one of half, float, rgb9e5, r11g11b10, got 'bc6h'"
    with pytest.raises(InputError, match=message):
        write_ktx2(tmp_path / "a.ktx2", cube_levels(), pixel="bc6h")


@pytest.mark.parametrize(
    "levels",
    [
        [],
        [np.zeros((5, 4, 4, 3), np.float32)],
        [np.zeros((6, 4, 8, 3), np.float32)],
        [np.zeros((6, 4, 4, 3), np.float32), np.zeros((6, 1, 1, 3), np.float32)],
        [np.zeros((6, 1, 1, 3), np.float32), np.zeros((6, 0, 0, 3), np.float32)],
    ],
)
def test_levels_of_another_shape_are_an_error_of_the_program(tmp_path, levels):
    with pytest.raises(ValueError, match="cubemap must have"):
        write_ktx2(tmp_path / "a.ktx2", levels)
    assert listing(tmp_path) == []


def test_a_key_that_ktx_reserves_is_an_error_of_the_program(tmp_path):
    with pytest.raises(ValueError, match="got 'KTXswizzle'"):
        write_ktx2(tmp_path / "a.ktx2", cube_levels(), attributes={"KTXswizzle": "rgb1"})


def test_other_formats_import_no_zstd():
    code = "import sys, skybake.baking, skybake.formats.ktx2; sys.exit('zstandard' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
