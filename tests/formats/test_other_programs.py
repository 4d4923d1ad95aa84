"""What we write, read by programs and formulas that are not ours."""

import subprocess

import numpy as np
import OpenImageIO
import pytest

from tests.formats.maps import program, sky, write_map

GREY = 0.5

# Direction of a texel of a cube map, u right and v down in [-1, 1]; OpenGL's faces.
FACES = {
    "px": lambda u, v: (1.0, -v, -u),
    "nx": lambda u, v: (-1.0, -v, u),
    "py": lambda u, v: (u, 1.0, v),
    "ny": lambda u, v: (u, -1.0, -v),
    "pz": lambda u, v: (u, -v, 1.0),
    "nz": lambda u, v: (-u, -v, -1.0),
}


def run(*arguments):
    return subprocess.run(
        [str(a) for a in arguments], check=True, capture_output=True, text=True
    ).stdout


def pixels(path):
    return OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.FLOAT)


def directions_as_colours(width, height):
    """(1 + direction) / 2 at texel centres, north -Z at the left edge, east +X at a quarter."""
    bearing = 2.0 * np.pi * (np.arange(width) + 0.5) / width
    zenith = np.pi * (np.arange(height) + 0.5)[:, None] / height
    direction = np.stack(
        [
            np.sin(zenith) * np.sin(bearing),
            np.broadcast_to(np.cos(zenith), (height, width)),
            -np.sin(zenith) * np.cos(bearing),
        ],
        axis=-1,
    )
    return (0.5 + 0.5 * direction).astype(np.float32)


def test_exrheader_names_the_tags(tmp_path):
    path = tmp_path / "a.exr"
    write_map(
        path,
        sky(),
        colorspace="acescg",
        envmap="latlong",
        compression="piz",
        attributes={"skybake:sunDirection": (0.0, 0.6, 0.8)},
    )
    text = run(program("exrheader"), path)

    for line in (
        "envmap (type envmap): latitude-longitude map",
        'colorInteropID (type string): "lin_ap1_scene"',
        "chromaticities (type chromaticities):",
        "adoptedNeutral (type v2f): (0.32168 0.33767)",
        "whiteLuminance (type float): 39321.6",
        "skybake:sunDirection (type v3f): (0 0.6 0.8)",
        'capDate (type string): "1970:01:01 00:00:00"',
        "compression (type compression): piz",
        "R, 16-bit floating-point, sampling 1 1",
    ):
        assert line in text


def test_exrenvmap_finds_the_directions_where_openexr_puts_them(tmp_path):
    """`exrenvmap` samples on borders, so half a texel of 1/256 of a turn is granted."""
    write_map(tmp_path / "a.exr", directions_as_colours(256, 128), envmap="latlong")
    run(program("exrenvmap"), "-c", "-w", 64, tmp_path / "a.exr", tmp_path / "cube.exr")
    cube = pixels(tmp_path / "cube.exr").reshape(6, 64, 64, 3)[..., :3]
    centres = 2.0 * cube[:, 31:33, 31:33].mean(axis=(1, 2)) - 1.0

    axes = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    np.testing.assert_allclose(centres, axes, atol=0.03)


def test_exrenvmap_reads_our_cube_tag(tmp_path):
    cube = np.concatenate([np.full((32, 32, 3), face / 6.0, np.float32) for face in range(6)])
    write_map(tmp_path / "cube.exr", cube, envmap="cube")
    run(program("exrenvmap"), "-l", "-w", 256, tmp_path / "cube.exr", tmp_path / "latlong.exr")
    latlong = pixels(tmp_path / "latlong.exr")[..., 0]
    height, width = latlong.shape

    # From left to right: -Z, +X, +Z, -X; above all +Y.
    middle = latlong[height // 2, [1, width // 4, width // 2, 3 * width // 4]]
    np.testing.assert_allclose(middle, np.array([5, 0, 4, 1]) / 6.0, atol=2e-3)
    assert latlong[2, 0] == pytest.approx(2 / 6.0, abs=2e-3)


@pytest.mark.parametrize("suffix", [".exr", ".hdr"])
def test_cmgen_takes_the_faces_of_a_cube_map_from_our_map(tmp_path, suffix):
    """Filament's cube map of the world, error of its filter and of RGBE's eight bits."""
    write_map(tmp_path / f"a{suffix}", directions_as_colours(512, 256), envmap="latlong")
    run(
        program("cmgen"),
        "-q",
        f"--extract={tmp_path}",
        "-f",
        "exr",
        "-s",
        64,
        tmp_path / f"a{suffix}",
    )

    v, u = np.mgrid[0:64, 0:64] / 32.0 + 1.0 / 64.0 - 1.0
    for face, direction in FACES.items():
        expected = np.stack(np.broadcast_arrays(*direction(u, v)), axis=-1)
        expected /= np.linalg.norm(expected, axis=-1, keepdims=True)
        got = 2.0 * pixels(tmp_path / "a" / f"{face}.exr")[..., :3] - 1.0
        assert np.abs(got - expected).max() < 0.03, face


@pytest.mark.parametrize("suffix", [".exr", ".hdr"])
def test_cmgen_takes_the_values_as_they_are_in_spite_of_exposure(tmp_path, suffix):
    """Filament adds half a step to the eight bits of RGBE: 128.5 / 256 for 0.5."""
    path = tmp_path / f"a{suffix}"
    recipe = "planet = earth\n" * 200
    rows = np.full((64, 128, 3), GREY, np.float32)
    write_map(path, rows, white_luminance=1.0, attributes={"skybake:recipe": recipe})
    run(program("cmgen"), "-q", f"--extract={tmp_path}", "-f", "exr", "-s", 32, path)

    np.testing.assert_allclose(pixels(tmp_path / "a" / "pz.exr"), GREY, rtol=1 / 250)


@pytest.mark.parametrize("suffix", [".exr", ".hdr"])
def test_oiiotool_reads_what_idiff_finds_equal_to_the_source(tmp_path, suffix):
    rows = sky()
    write_map(tmp_path / f"a{suffix}", rows, envmap="latlong")
    source = OpenImageIO.ImageBuf(rows)
    assert source.write(str(tmp_path / "source.tif"))

    run(program("oiiotool"), tmp_path / f"a{suffix}", "-d", "float", "-o", tmp_path / "copy.tif")
    result = subprocess.run(
        [program("idiff"), "-fail", "0.004", "-warn", "0.004", "copy.tif", "source.tif"],
        cwd=tmp_path,
        check=False,
        capture_output=True,
        text=True,
    )
    assert result.returncode == 0, result.stdout
    assert result.stdout.strip().endswith("PASS")
