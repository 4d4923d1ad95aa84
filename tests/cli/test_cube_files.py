"""Cubemaps in one file, and maps with smaller copies of themselves."""

import json
import math
from pathlib import Path

import numpy as np
import OpenEXR
import OpenImageIO
import pytest

from skybake.baking import bake
from skybake.errors import InputError, OutputError
from skybake.formats.reader import read_attributes, read_image
from skybake.image.settings import map_settings
from skybake.projection import Cubemap, Equirect
from skybake.projection.cubemap import FACES, solid_angles
from tests.cli.runs import invoke, listing
from tests.formats.cubes import decode, read_dds, read_ktx2

EDGE = 16


def settings(**values):
    return map_settings(Cubemap(EDGE), method="hillaire", **values)


@pytest.fixture(scope="module")
def faces(tmp_path_factory):
    """Six faces that a cubemap in single files has, shape (6, EDGE, EDGE, 3), and their folder."""
    folder = tmp_path_factory.mktemp("faces")
    bake("earth", folder / "a_{face}.exr", settings())
    return np.stack([read_image(folder / f"a_{face}.exr")[0] for face in FACES]), folder


def levels_of(path):
    """Levels of an OpenEXR file."""
    source, levels = OpenImageIO.ImageInput.open(str(path)), []
    while source.seek_subimage(0, len(levels)):
        levels.append(np.asarray(source.read_image(0, len(levels), 0, 3), np.float64))
    source.close()
    return levels


def test_a_ktx2_holds_the_six_faces_and_what_an_exr_states(tmp_path, faces):
    pixels, folder = faces
    baked = bake("earth", tmp_path / "a.ktx2", settings())
    header, (level,), _, texts = read_ktx2(tmp_path / "a.ktx2")

    assert baked.files == (tmp_path / "a.ktx2",)
    assert (baked.pixel, header["scheme"]) == ("half", 2)
    np.testing.assert_array_equal(decode(level, "half").reshape(pixels.shape), pixels)
    stated = read_attributes(tmp_path / "a.ktx2")
    attributes = read_attributes(folder / "a_px.exr")
    for name in ("skybake:recipeHash", "skybake:recipe", "colorInteropID"):
        assert stated[name] == attributes[name]
    assert float(stated["whiteLuminance"]) == pytest.approx(attributes["whiteLuminance"])
    direction = np.array(stated["skybake:sunDirection"].split(), float)
    np.testing.assert_allclose(direction, attributes["skybake:sunDirection"], atol=1e-7)
    assert texts["KTXorientation"] == b"rd\0"


def test_a_dds_holds_the_six_faces(tmp_path, faces):
    bake("earth", tmp_path / "a.dds", settings())

    for face, (level,) in zip(faces[0], read_dds(tmp_path / "a.dds"), strict=True):
        np.testing.assert_array_equal(level, face)


@pytest.mark.parametrize("pixel", ["float", "rgb9e5", "r11g11b10"])
def test_a_ktx2_holds_the_type_that_was_asked_for(tmp_path, faces, pixel):
    error = {"float": 2.0**-11, "rgb9e5": 2.0**-8, "r11g11b10": 2.0**-5}[pixel]
    baked = bake("earth", tmp_path / "a.ktx2", settings(pixel=pixel, compression="none"))
    header, (level,), _, _ = read_ktx2(tmp_path / "a.ktx2")
    found = decode(level, pixel).reshape(faces[0].shape)

    assert (baked.pixel, header["scheme"]) == (pixel, 0)
    largest = faces[0].max(axis=-1, keepdims=True)
    assert (np.abs(found - faces[0]) <= error * largest + 1e-6).all()


def test_auto_takes_float_where_half_does_not_hold_the_sun(tmp_path):
    assert bake("earth", tmp_path / "a.ktx2", settings(units="nits")).pixel == "float"
    assert bake("earth", tmp_path / "a.dds", settings(units="nits")).pixel == "float"


@pytest.mark.parametrize("name", ["a.ktx2", "a.dds"])
def test_a_sun_beyond_half_is_refused_and_nothing_is_left(tmp_path, name):
    with pytest.raises(OutputError, match="radiance in half must be at most 65504, got"):
        bake("earth", tmp_path / name, settings(units="nits", pixel="half"))
    assert listing(tmp_path) == []


def test_values_that_small_floats_lose_are_told(tmp_path):
    dusk = settings(pixel="r11g11b10", sun_elevation=math.radians(-6.0), sun_disc="exclude")
    with pytest.raises(OutputError, match="small floats must hold most values within 1%, got"):
        bake("earth", tmp_path / "a.ktx2", dusk)


@pytest.mark.parametrize("name", ["a.ktx2", "a.dds"])
def test_every_level_of_a_cube_holds_the_light_of_the_whole(tmp_path, name):
    bake("earth", tmp_path / name, settings(mips=True))
    if name == "a.dds":
        faces = read_dds(tmp_path / name)
        levels = [np.stack([face[k] for face in faces]) for k in range(len(faces[0]))]
    else:
        stored = read_ktx2(tmp_path / name)[1]
        levels = [
            decode(one, "half").reshape(6, EDGE >> k, EDGE >> k, 3) for k, one in enumerate(stored)
        ]
    light = [
        (level * solid_angles(level.shape[1])[None, :, :, None]).sum(axis=(0, 1, 2))
        for level in levels
    ]

    assert [level.shape[1] for level in levels] == [16, 8, 4, 2, 1]
    np.testing.assert_allclose(light, light[:1] * np.ones((5, 1)), rtol=1e-3)


def test_every_level_of_an_equirect_exr_holds_the_light_of_the_whole(tmp_path):
    bake("earth", tmp_path / "a.exr", map_settings(size=64, method="hillaire", mips=True))
    levels = levels_of(tmp_path / "a.exr")
    light = []
    for level in levels[:-1]:
        edge = np.cos(np.linspace(0.0, math.pi, len(level) + 1))
        size = 2.0 * math.pi / level.shape[1] * (edge[:-1] - edge[1:])
        light.append((level * size[:, None, None]).sum(axis=(0, 1)))
    light.append(4.0 * math.pi * levels[-1][0, 0])

    assert [level.shape[:2] for level in levels[-3:]] == [(2, 4), (1, 2), (1, 1)]
    np.testing.assert_allclose(light, light[:1] * np.ones((7, 1)), rtol=1e-3)


def test_the_first_level_of_an_exr_is_the_map_without_levels(tmp_path, faces):
    bake("earth", tmp_path / "a.exr", settings(mips=True))

    for face, pixels in zip(FACES, faces[0], strict=True):
        path = tmp_path / f"a_{face}.exr"
        np.testing.assert_array_equal(levels_of(path)[0], pixels)
        np.testing.assert_array_equal(read_image(path)[0], pixels)


def test_openexr_reads_a_map_with_levels_as_an_environment(tmp_path):
    bake("earth", tmp_path / "a.exr", map_settings(size=64, method="hillaire", mips=True))
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        header, pixels = dict(file.header()), file.channels()["RGB"].pixels.copy()

    assert header["type"] == OpenEXR.tiledimage
    assert header["envmap"] == OpenEXR.ENVMAP_LATLONG
    np.testing.assert_array_equal(pixels, read_image(tmp_path / "a.exr")[0])


def render(*arguments):
    return invoke("render", "--method", "hillaire", "--quiet", *arguments)


def test_the_command_line_writes_cubes_in_one_file(tmp_path):
    target = tmp_path / "a.ktx2"
    result = render("--projection", "cubemap", "--size", "8", "--mips", "-o", target, "--json")

    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["files"] == [str(target)]
    assert read_ktx2(target)[0]["levels"] == 4
    assert listing(tmp_path) == ["a.ktx2"]


FAULTS = """
-o a.ktx2 => --output: .ktx2 needs --projection cubemap
--projection cubemap --cube-layout cross -o a.dds => --cube-layout cross: needs an .exr or .hdr
--projection cubemap --compression zip -o a.ktx2 => --compression: of a .ktx2 must be zstd or none
--projection cubemap --compression none -o a.dds => --compression: needs an .exr or .ktx2 output
--pixel rgb9e5 -o a.exr => --pixel rgb9e5: needs a .ktx2 output
--projection cubemap --pixel r11g11b10 -o a.dds => --pixel r11g11b10: needs a .ktx2 output
--mips -o a.hdr => --mips: needs an .exr, .ktx2 or .dds output
"""


@pytest.mark.parametrize("case", FAULTS.strip().splitlines())
def test_options_that_do_not_go_together_are_one_line(case):
    arguments, message = case.split("=>")
    result = render(*arguments.split())

    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert message.strip() in result.stderr


@pytest.mark.parametrize(
    ("name", "values", "message"),
    [
        ("a.ktx2", {"projection": Equirect(64)}, "must be of a cubemap in faces"),
        ("a.ktx2", {"projection": Cubemap(8, "cross")}, "must be of a cubemap in faces"),
        ("a_{face}.ktx2", {"projection": Cubemap(8)}, "name must have no {face}"),
        ("a.dds", {"projection": Cubemap(8), "pixel": "rgb9e5"}, "must be one of half, float"),
        ("a.ktx2", {"projection": Cubemap(8), "compression": "piz"}, "must be zstd or none"),
        ("a.exr", {"pixel": "r11g11b10"}, "pixel r11g11b10 must be in .ktx2"),
        ("a.hdr", {"mips": True}, "mips must be in .exr, .ktx2 or .dds"),
        ("a.exr", {"size": 96, "mips": True}, "a size that is a power of two, got 96"),
        ("a.exr", {"size": 64, "rows": "poles", "mips": True}, "with centred rows"),
        ("a.exr", {"projection": Cubemap(8, "exr"), "mips": True}, "or of a cubemap in faces"),
    ],
)
def test_a_format_that_cannot_hold_the_map_is_refused(tmp_path, name, values, message):
    with pytest.raises(InputError) as caught:
        bake("earth", tmp_path / name, map_settings(**values))
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert listing(tmp_path) == []


def test_frames_of_cubes_are_skipped_where_they_exist(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for suffix in ("ktx2", "dds"):
        command = (
            *("sequence", "--method", "hillaire", "--projection", "cubemap", "--size", "4"),
            *("--sun", "20deg..30deg", "--frames", "1-2", "-o", f"a.#.{suffix}", "--json"),
            *("--workers", "1", "--quiet", "--skip-existing"),
        )
        told = [json.loads(invoke(*command).stdout) for _ in range(2)]

        assert [(one["baked"], one["skipped"]) for one in told] == [(2, 0), (0, 2)]
        assert Path(f"a.0002.{suffix}").is_file()
