"""Baked maps, turned from one mapping to the other by programs that are not ours.

The sun stands at a bearing that no mirror and no quarter turn maps onto itself, so that a
face that is turned or exchanged is off by far more than any filter.
"""

import subprocess

import numpy as np
import pytest

from skybake.projection import cubemap
from tests.baking.maps import bake_map, luminance, pixels
from tests.formats.maps import program

EDGE = 64
# From 8 km up, for the ground below to have a side where the sun is.
SKY = {
    "elevation": 25.0,
    "sun_azimuth": 0.6,
    "altitude": 8.0,
    "sun_disc": "exclude",
    "pixel": "float",
}


def run(*arguments):
    result = subprocess.run(
        [str(a) for a in arguments], check=False, capture_output=True, text=True, timeout=120
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


def typical_and_worst(got, expected):
    """Median and 98th percentile of relative errors; no filter is as sharp as the horizon."""
    error = np.abs(got - expected).max(axis=-1) / expected.max(axis=-1)
    return np.median(error), np.quantile(error, 0.98)


def assert_same_face(got, expected, typical, worst, face=""):
    """Alike within half a texel of filter, and less alike however it is turned or mirrored."""
    median, most = typical_and_worst(got, expected)
    assert median < typical, face
    assert most < worst, face
    mirrored = got.transpose(1, 0, 2)
    turned = [np.rot90(image, k) for image in (got, mirrored) for k in range(4)][1:]
    assert min(typical_and_worst(image, expected)[0] for image in turned) > 2.0 * median, face


@pytest.mark.parametrize(
    ("options", "kind"),
    [
        ({"size": 64}, "latitude-longitude map"),
        ({"projection": "cubemap", "size": 16, "layout": "exr"}, "cube-face map"),
    ],
)
def test_exrheader_tells_the_kind_of_map(tmp_path, options, kind):
    bake_map(tmp_path / "a.exr", **options)
    text = run(program("exrheader"), tmp_path / "a.exr")
    assert f"envmap (type envmap): {kind}" in text
    assert "skybake:sunDirection (type v3f)" in text


def test_single_faces_do_not_claim_to_be_whole_maps(tmp_path):
    bake_map(tmp_path / "a.exr", projection="cubemap", size=16)
    assert "(type envmap)" not in run(program("exrheader"), tmp_path / "a_px.exr")


def test_exrenvmap_makes_our_cube_of_our_equirect_map(tmp_path):
    bake_map(tmp_path / "flat.exr", size=512, **SKY)
    cube = {"projection": "cubemap", "size": EDGE, "layout": "exr"}
    bake_map(tmp_path / "ours.exr", **cube, **SKY)
    run(program("exrenvmap"), "-c", "-w", EDGE, tmp_path / "flat.exr", tmp_path / "theirs.exr")
    ours = pixels(tmp_path / "ours.exr").reshape(6, EDGE, EDGE, 3)
    theirs = pixels(tmp_path / "theirs.exr").reshape(6, EDGE, EDGE, 3)
    for face, expected, got in zip(cubemap.FACES, ours, theirs, strict=True):
        assert_same_face(got, expected, 0.02, 0.15, face)


def test_exrenvmap_makes_our_equirect_map_of_our_cube(tmp_path):
    bake_map(tmp_path / "flat.exr", size=256, **SKY)
    cube = {"projection": "cubemap", "size": 256, "layout": "exr"}
    bake_map(tmp_path / "cube.exr", **cube, **SKY)
    run(program("exrenvmap"), "-l", "-w", 256, tmp_path / "cube.exr", tmp_path / "theirs.exr")
    expected, got = pixels(tmp_path / "flat.exr"), pixels(tmp_path / "theirs.exr")
    median, most = typical_and_worst(got, expected)
    assert median < 0.02
    assert most < 0.15
    for wrong in (got[:, ::-1], got[::-1], np.roll(got, 64, axis=1), np.roll(got, 128, axis=1)):
        assert typical_and_worst(wrong, expected)[1] > 2.0 * most


@pytest.mark.parametrize("elevation", [90.0, 88.0, 50.0])
def test_exrenvmap_finds_all_of_a_sun_where_rows_are_at_the_poles(tmp_path, elevation):
    """It takes the first row for the zenith, and a finer cube for what is between rows."""
    values = {"sun_disc": "only", "pixel": "float", "size": 128, "method": "hillaire"}
    share = {}
    for rows in ("poles", "centres"):
        baked, settings = bake_map(tmp_path / "a.exr", elevation=elevation, rows=rows, **values)
        run(program("exrenvmap"), "-c", "-w", 256, tmp_path / "a.exr", tmp_path / "cube.exr")
        light = luminance(tmp_path / "cube.exr", settings).reshape(6, -1)
        flux = (light @ cubemap.solid_angles(256).ravel()).sum()
        share[rows] = flux / baked.direct_normal_illuminance
    assert share["poles"] == pytest.approx(1.0, abs=0.02)
    assert elevation < 89.0 or share["centres"] < 0.6


@pytest.mark.parametrize("suffix", [".exr", ".hdr"])
def test_cmgen_takes_our_faces_from_our_equirect_map(tmp_path, suffix):
    bake_map(tmp_path / f"flat{suffix}", size=512, **SKY)
    baked, _ = bake_map(tmp_path / "ours.exr", projection="cubemap", size=EDGE, **SKY)
    extract = [f"--extract={tmp_path / 'theirs'}", "-f", "exr", "-s", EDGE]
    run(program("cmgen"), "-q", *extract, tmp_path / f"flat{suffix}")
    for face, file in zip(cubemap.FACES, baked.files, strict=True):
        theirs = pixels(tmp_path / "theirs" / "flat" / f"{face}.exr")
        assert_same_face(theirs, pixels(file), 0.03, 0.15, face)


@pytest.mark.parametrize("layout", ["cross", "vertical-cross"])
def test_cmgen_reads_our_crosses(tmp_path, layout):
    """Its own, too, have +Z in the middle, and -Z at the right or upside down at the bottom."""
    baked, _ = bake_map(tmp_path / "ours.exr", projection="cubemap", size=EDGE, **SKY)
    bake_map(tmp_path / "cross.exr", projection="cubemap", size=EDGE, layout=layout, **SKY)
    extract = [f"--extract={tmp_path / 'theirs'}", "--no-mirror", "-f", "exr", "-s", EDGE]
    run(program("cmgen"), "-q", *extract, tmp_path / "cross.exr")
    for face, file in zip(cubemap.FACES, baked.files, strict=True):
        theirs = pixels(tmp_path / "theirs" / "cross" / f"{face}.exr")
        assert_same_face(theirs, pixels(file), 0.03, 0.15, face)
