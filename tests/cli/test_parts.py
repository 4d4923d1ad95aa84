"""Maps whose sky, clouds and sun are parts of one file."""

import os
from pathlib import Path

import numpy as np
import OpenEXR
import OpenImageIO
import pytest

from skybake.formats.exr_chunks import find_fault
from skybake.formats.reader import read_image
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.projection.equirect import solid_angles
from tests.cli.cloudy import LAYER, few_voxels
from tests.cli.runs import SMALL, invoke, listing

HALF = 2.0**-11
ROW = 10
SUN = ("--sun", str(90.0 - (ROW + 0.5) * 180.0 / 32.0))
"""In the middle of a row."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Maps of a world with and without clouds, and with and without parts."""
    folder, before = tmp_path_factory.mktemp("parts"), Path.cwd()
    os.chdir(folder)
    few_voxels(folder)
    clouds = ("--clouds", LAYER, "--clouds-quality", "draft")
    for name, arguments in {
        "clear": (),
        "sky": ("--sun-disc", "exclude"),
        "separate": ("--sun-disc", "separate"),
        "layers": ("--layers",),
        "cloudy": clouds,
        "cloudy-layers": (*clouds, "--layers"),
        "cloudy-separate": (*clouds, "--sun-disc", "separate", "--layers"),
    }.items():
        result = invoke("render", *SMALL, *SUN, *arguments, "-o", f"{name}.exr", "--quiet")
        assert result.exit_code == 0, result.output
    os.chdir(before)
    return folder


def parts(path):
    """Pixels of each part by its name, as OpenEXR's own package reads them, and the headers."""
    with OpenEXR.File(str(path)) as file:
        pixels = {p.name(): next(iter(p.channels.values())).pixels.copy() for p in file.parts}
        return pixels, {p.name(): dict(p.header) for p in file.parts}


def test_a_separate_disc_is_a_part_of_floats_beside_the_sky(folder):
    found, headers = parts(folder / "separate.exr")

    assert list(found) == ["sky", "sun", "transmittance"]
    assert [one.dtype for one in found.values()] == [np.float16, np.float32, np.float16]
    np.testing.assert_array_equal(found["sky"], read_image(folder / "sky.exr")[0])
    whole = read_image(folder / "clear.exr")[0]
    together = found["sky"].astype(float) + found["sun"]
    np.testing.assert_allclose(together, whole, rtol=2 * HALF, atol=1e-6)
    for header in headers.values():
        assert header["envmap"] == OpenEXR.ENVMAP_LATLONG
        assert header["colorInteropID"] == "lin_rec709_scene"
        assert header["skybake:directNormalIlluminance"] > 5e4


def test_the_disc_has_the_illuminance_that_the_file_states(folder):
    found, headers = parts(folder / "separate.exr")
    size = solid_angles(64, 32)[:, None, None]
    flux = (found["sun"].astype(float) * size).sum(axis=(0, 1))
    lux = flux @ (0.2126, 0.7152, 0.0722) * headers["sun"]["whiteLuminance"]

    assert lux == pytest.approx(headers["sun"]["skybake:directNormalIlluminance"], rel=1e-3)


def test_the_transmittance_is_that_of_the_sunlight(folder):
    found, headers = parts(folder / "separate.exr")
    through = found["transmittance"].astype(float)
    stated = np.array(headers["sun"]["skybake:sunColour"])
    stated = stated * headers["sun"]["skybake:directNormalIlluminance"]
    scene = Scene(load_preset("earth"), map_settings(size=64))
    above = scene.rgb_weights.sum(axis=0) * headers["sun"]["whiteLuminance"]

    np.testing.assert_allclose(through[ROW], (stated / above)[None] * np.ones((64, 1)), rtol=3e-3)
    assert (np.diff(through[:16, 0, 0]) < 0.0).all()
    assert not through[16:].any()
    assert through.max() < 1.0


def test_layers_of_a_clear_sky_are_the_map_the_sky_and_the_disc(folder):
    found, _ = parts(folder / "layers.exr")

    assert list(found) == ["beauty", "sky", "sun"]
    np.testing.assert_array_equal(found["beauty"], read_image(folder / "clear.exr")[0])
    np.testing.assert_array_equal(found["sky"], read_image(folder / "sky.exr")[0])


def test_layers_with_clouds_add_up_to_the_map(folder):
    found, _ = parts(folder / "cloudy-layers.exr")
    whole = read_image(folder / "cloudy.exr")[0]
    clouds = found["clouds"].astype(float)
    alpha = clouds[..., 3:]
    sky = found["sky"].astype(float)
    together = sky * (1.0 - alpha) + clouds[..., :3] + found["sun"]

    assert list(found) == ["beauty", "sky", "clouds", "sun"]
    np.testing.assert_array_equal(found["beauty"], whole)
    np.testing.assert_array_equal(found["sky"], read_image(folder / "sky.exr")[0])
    scale = np.maximum(sky, np.abs(whole)).max(axis=2, keepdims=True)
    assert (np.abs(together - whole) <= 4 * HALF * scale).all()
    assert alpha.min() == 0.0
    assert 0.5 < alpha.max() <= 1.0


def test_clouds_hide_what_is_behind_the_air(folder):
    cloudy, clear = parts(folder / "cloudy-separate.exr")[0], parts(folder / "separate.exr")[0]
    alpha = cloudy["clouds"][..., 3:].astype(float)

    assert list(cloudy) == ["beauty", "sky", "clouds", "sun", "transmittance"]
    expected = clear["transmittance"].astype(float) * (1.0 - alpha)
    np.testing.assert_allclose(cloudy["transmittance"], expected, rtol=4 * HALF, atol=2 * HALF)


def test_clouds_above_an_extended_horizon_add_up_too(folder, tmp_path, monkeypatch):
    monkeypatch.chdir(folder)
    arguments = ("--clouds", LAYER, "--clouds-quality", "draft", "--below-horizon", "extend")
    path = tmp_path / "a.exr"
    result = invoke("render", "--size", "16", *SUN, *arguments, "--layers", "-o", path, "--quiet")
    assert (result.exit_code, result.stderr) == (0, "")
    found = {name: one.astype(float) for name, one in parts(path)[0].items()}

    clouds = found["clouds"]
    together = found["sky"] * (1.0 - clouds[..., 3:]) + clouds[..., :3] + found["sun"]
    np.testing.assert_allclose(together, found["beauty"], rtol=4 * HALF, atol=1e-3)


def test_a_program_that_reads_one_part_gets_the_map_or_the_sky(folder):
    assert read_image(folder / "layers.exr")[0].shape == (32, 64, 3)
    source = OpenImageIO.ImageInput.open(str(folder / "cloudy-layers.exr"))
    names = []
    while source.seek_subimage(len(names), 0):
        names.append(source.spec().getattribute("oiio:subimagename"))
    source.close()
    assert names == ["beauty", "sky", "clouds", "sun"]


@pytest.mark.parametrize("damage", [lambda data: data[:-1], lambda data: data[: len(data) // 2]])
def test_a_file_of_parts_that_lacks_bytes_is_told(folder, tmp_path, damage):
    data = (folder / "layers.exr").read_bytes()
    path = tmp_path / "a.exr"
    path.write_bytes(data)
    assert find_fault(path) is None
    path.write_bytes(damage(data))
    assert find_fault(path) is not None


FAULTS = """
--sun-disc separate -o a.hdr => --sun-disc separate: needs an .exr output
--sun-disc separate --mips => --sun-disc separate: cannot be combined with --mips
--layers -o a.hdr => --layers: needs an .exr output that holds the sky, without --mips
--layers --mips => --layers: needs an .exr output that holds the sky, without --mips
--layers --sun-disc only => --layers: needs an .exr output that holds the sky, without --mips
"""


@pytest.mark.parametrize("case", FAULTS.strip().splitlines())
def test_options_that_do_not_go_together_are_one_line(tmp_path, monkeypatch, case):
    monkeypatch.chdir(tmp_path)
    arguments, message = case.split("=>")
    result = invoke("render", *SMALL, *arguments.split())

    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert message.strip() in result.stderr
    assert listing(tmp_path) == []


def test_a_chart_has_no_layers(tmp_path):
    result = invoke("chart", "--layers", "-o", tmp_path / "a.exr")

    assert (result.exit_code, result.stderr) == (2, "skybake: --layers: a chart has none\n")
    assert listing(tmp_path) == []
