"""Flat textures and volumes in KTX 2 files."""

import base64
import struct

import numpy as np
import pytest

from skybake.errors import InputError, OutputError
from skybake.formats.ktx2_texture import write_ktx2_texture
from tests.formats.cubes import VK, ktx_parse
from tests.formats.maps import listing

SHAPES = [(5, 7, 3), (5, 7, 4), (4, 5, 7, 3), (4, 5, 7, 4)]
TYPES = {"half": "<f2", "float": "<f4"}


def noise(shape):
    return np.random.default_rng(3).random(shape, dtype=np.float32)


def with_alpha(values):
    alpha = np.ones((*values.shape[:-1], 1), np.float32)
    return values if values.shape[-1] == 4 else np.concatenate([values, alpha], axis=-1)


@pytest.mark.parametrize("pixel", TYPES)
@pytest.mark.parametrize("shape", SHAPES)
def test_ktx_parse_reads_textures_and_volumes_as_they_were_written(tmp_path, shape, pixel):
    values = noise(shape)
    tags = {"colorInteropID": "lin_rec709_scene", "skybake:table": "noise"}
    write_ktx2_texture(tmp_path / "a.ktx2", values, pixel=pixel, attributes=tags)
    found = ktx_parse(tmp_path / "a.ktx2")

    is_volume = len(shape) == 4
    assert found["vkFormat"] == VK[pixel]
    assert (found["pixelWidth"], found["pixelHeight"]) == (7, 5)
    assert found["pixelDepth"] == (4 if is_volume else 0)
    assert (found["layerCount"], found["faceCount"], found["levelCount"]) == (0, 1, 1)
    assert found["supercompressionScheme"] == 0
    assert found["keyValue"]["KTXorientation"] == ("rdi" if is_volume else "rd")
    (level,) = found["levels"]
    texels = np.frombuffer(base64.b64decode(level["bytes"]), TYPES[pixel]).astype(np.float32)
    expected = with_alpha(values).astype(TYPES[pixel]).astype(np.float32)
    np.testing.assert_array_equal(texels.reshape(expected.shape), expected)


@pytest.mark.parametrize("pixel", TYPES)
def test_texels_begin_at_a_multiple_of_their_size_and_end_the_file(tmp_path, pixel):
    write_ktx2_texture(tmp_path / "a.ktx2", noise((3, 3, 3)), pixel=pixel)
    data = (tmp_path / "a.ktx2").read_bytes()
    begin, stored, plain = struct.unpack_from("<3Q", data, 80)
    assert begin % (8 if pixel == "half" else 16) == 0
    assert stored == plain == len(data) - begin


@pytest.mark.parametrize(
    ("pixel", "value", "problem"),
    [
        ("float", np.nan, "values must be finite, got nan"),
        ("float", -np.inf, "values must be finite, got -inf"),
        ("half", -70000.0, "values in half must be at most 65504, got 70000"),
    ],
)
def test_what_a_type_cannot_hold_is_refused_and_leaves_no_file(tmp_path, pixel, value, problem):
    values = noise((3, 3, 3))
    values[1, 1, 1] = value
    with pytest.raises(OutputError, match=problem):
        write_ktx2_texture(tmp_path / "a.ktx2", values, pixel=pixel)
    assert listing(tmp_path) == []


def test_other_types_and_shapes_are_refused(tmp_path):
    with pytest.raises(InputError, match="pixel: must be one of half, float, got 'rgb9e5'"):
        write_ktx2_texture(tmp_path / "a.ktx2", noise((3, 3, 3)), pixel="rgb9e5")
    with pytest.raises(ValueError, match="3 or 4 channels"):
        write_ktx2_texture(tmp_path / "a.ktx2", noise((3, 3, 2)))
