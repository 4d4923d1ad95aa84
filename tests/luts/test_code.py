"""Code that looks tables up: it compiles, and draws the sky that a render shows."""

import math
import shutil
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest

from skybake.luts.parametrisations import PARAMETRISATIONS
from skybake.luts.shading import write_functions
from tests.cli.runs import invoke
from tests.luts.browser import compiled, drawn, webgpu_messages
from tests.luts.sets import baked, scene_of, vector

PAGE = Path(__file__).parents[2] / "docs" / "tables_example.html"

GLSL = """#version {version}
precision highp float;
{code}
uniform highp sampler2D flat_table;
uniform highp sampler3D volume;
out vec4 colour;
void main() {{
    vec3 direction = vec3(0.6, 0.8, 0.0);
    vec3 light = luts_sky(flat_table, direction) + luts_sun(flat_table, direction)
        + luts_multiple_scattering(flat_table, 1.0, 0.5);
    colour = vec4(luts_through_air(volume, volume, luts_screen(direction), 2.0, light), 1.0);
}}
"""
HLSL = """{code}
Texture2D<float4> flat_table;
Texture3D<float4> volume;
SamplerState linear_sampler;
float4 main() : SV_Target {{
    float3 direction = float3(0.6, 0.8, 0.0);
    float3 light = luts_sky(flat_table, linear_sampler, direction)
        + luts_sun(flat_table, linear_sampler, direction)
        + luts_multiple_scattering(flat_table, linear_sampler, 1.0, 0.5);
    float2 place = luts_screen(direction);
    return float4(luts_through_air(volume, linear_sampler, volume, linear_sampler, place, 2.0,
        light), 1.0);
}}
"""


@pytest.fixture(scope="module", params=PARAMETRISATIONS)
def folder(request, tmp_path_factory):
    """Small tables of one parametrisation."""
    made = tmp_path_factory.mktemp(request.param)
    sizes = {"sky_view_size": (16, 12), "aerial_size": (4, 4, 4)}
    baked(made, scene_of(), parametrisation=request.param, **sizes)
    return made


@pytest.mark.parametrize("version", ["300 es", "330"])
def test_glsl_compiles_for_browsers_and_desktops(folder, version, tmp_path):
    shader = tmp_path / "shader.frag"
    shader.write_text(GLSL.format(version=version, code=(folder / "luts.glsl").read_text()))
    status, lines = compiled(shader)
    assert status == 0, lines


def test_hlsl_compiles(folder, tmp_path):
    shader = tmp_path / "shader.frag"
    shader.write_text(HLSL.format(code=(folder / "luts.hlsl").read_text()))
    status, lines = compiled(shader, *("-D", "-e", "main", "-V", "-o", str(tmp_path / "a.spv")))
    assert status == 0, lines


@pytest.mark.slow
def test_wgsl_compiles_in_a_browser(folder):
    assert webgpu_messages(folder / "luts.wgsl") == []


def test_what_binds_more_loosely_is_kept_in_brackets():
    text = "def f(a: float, b: float) -> float:\n    return a - (b - 2) * -a / (b * a)\n"
    assert "return a - (b - 2.0) * (-a) / (b * a);" in write_functions("glsl", text)
    choice = "def f(a: float) -> float:\n    return (1 if a < 0 else 2) * a\n"
    assert "(a < 0.0 ? 1.0 : 2.0) * a" in write_functions("hlsl", choice)
    assert "select(2.0, 1.0, a < 0.0) * a" in write_functions("wgsl", choice)


def test_what_shaders_have_not_is_refused():
    with pytest.raises(ValueError, match=r"function must not hold 'a \*\* 2'"):
        write_functions("glsl", "def f(a: float) -> float:\n    return a ** 2\n")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("preset", "sun", "altitude"),
    [("earth-hillaire2020", 5.0, 0.2), ("earth-hillaire2020", 60.0, 0.0), ("mars", 5.0, 2.0)],
)
def test_the_sky_drawn_from_tables_is_the_sky_of_a_render(tmp_path, preset, sun, altitude):
    """By the page of the documentation, which was written from it alone; 2 % are allowed."""
    where = ("--preset", preset, "--sun", f"{sun}deg", "--altitude", f"{altitude}km")
    files, rendered = tmp_path / "sky", tmp_path / "sky.exr"
    assert invoke("luts", *where, "-q", "-o", files).exit_code == 0
    stored = ("--size", "256x128", "--pixel", "float", "--sun-disc", "exclude")
    assert invoke("render", *where, *stored, "-q", "-o", rendered).exit_code == 0
    shutil.copy(PAGE, files)
    found = drawn(files / PAGE.name, (256, 128), "&view=map")
    expected = OpenImageIO.ImageBuf(str(rendered)).get_pixels(OpenImageIO.FLOAT)[..., :3]
    # A render averages over pixels, a table knows one value: rows at the horizon differ.
    for rows in (slice(0, 63), slice(66, 128)):
        error = found[rows] / expected[rows] - 1.0
        assert math.sqrt((error**2).mean()) < 0.01


@pytest.mark.slow
def test_the_disc_drawn_from_tables_is_that_of_a_render(tmp_path):
    """A camera of one degree looks at the sun."""
    scene = scene_of(sun=5.0)
    look = {"azimuth": math.radians(215.0), "elevation": math.radians(5.0)}
    about = baked(tmp_path, scene, fov=math.radians(1.0), aspect=1.0, **look)
    shutil.copy(PAGE, tmp_path)
    seen = drawn(tmp_path / PAGE.name, (200, 200), "&view=sky")
    normal, _ = scene.sun.irradiance_per_irradiance()
    pixel = (2.0 * math.tan(math.radians(0.5)) / 200) ** 2
    sky = seen[0, 0]
    found = (seen - sky).sum(axis=(0, 1)) * pixel
    np.testing.assert_allclose(found, normal @ scene.rgb_weights, rtol=0.02)
    # Its middle is the sun's, half a pixel beside that of the picture.
    brightest = seen[..., 1] > 0.5 * seen[..., 1].max()
    rows, columns = np.nonzero(brightest)
    assert abs(rows.mean() - 99.5) < 0.6
    assert abs(columns.mean() - 99.5) < 0.6
    assert vector(about, "SUN_DIRECTION") @ vector(about, "CAMERA_FORWARD") > 1.0 - 1e-12
