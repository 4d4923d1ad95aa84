"""What a map shows, where."""

import functools
import math

import numpy as np
import pytest

from skybake.angles import zenith_azimuth
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.projection import cubemap, equirect
from tests.baking.maps import bake_map, pixels

PRESETS = ("earth", "mars", "earth-hillaire2020")


@functools.cache
def scene(preset, elevation, altitude=0.0, **options):
    settings = map_settings(
        sun_elevation=math.radians(elevation), altitude=altitude, units="nits", **options
    )
    made = Scene(load_preset(preset), settings)
    if (elevation, altitude) != (30.0, 0.0):
        made.sky.__dict__["atmosphere"] = scene(preset, 30.0).sky.atmosphere
    return made


def sky_luminance(made, rows=32):
    """Luminance of a small equirect map without the disc, in cd/m2."""
    zenith = equirect.row_zeniths(rows)[:, None]
    azimuth = equirect.column_bearings(2 * rows)[None]
    values = made.evaluate(zenith, azimuth, math.pi / rows)
    assert np.isfinite(values).all()
    return values @ made.luminance


def sample(image, vectors):
    """Bilinear lookup of directions in an equirect image."""
    height, width = image.shape[:2]
    zenith, bearing = zenith_azimuth(vectors)
    row = np.clip(zenith / math.pi * height - 0.5, 0.0, height - 1.001)
    column = bearing % (2.0 * math.pi) / (2.0 * math.pi) * width - 0.5
    i, j = np.floor(row).astype(int), np.floor(column).astype(int)
    u, v = (row - i)[..., None], (column - j)[..., None]
    j, k = j % width, (j + 1) % width
    upper = image[i, j] * (1.0 - v) + image[i, k] * v
    lower = image[i + 1, j] * (1.0 - v) + image[i + 1, k] * v
    return upper * (1.0 - u) + lower * u


@pytest.mark.parametrize(("preset", "elevation"), [("earth", 30.0), ("mars", 5.0), ("earth", -4.0)])
def test_equirect_and_cubemap_show_the_same_sky(tmp_path, preset, elevation):
    """At every texel of every face but those that touch the horizon and the aureole's peak."""
    options = {"sun_disc": "exclude", "pixel": "float", "sun_azimuth": 2.2}
    flat, _ = bake_map(tmp_path / "flat.exr", preset, elevation, size=1024, **options)
    cube, _ = bake_map(
        tmp_path / "cube.exr", preset, elevation, size=64, projection="cubemap", **options
    )
    image = pixels(flat.files[0])
    sun = np.array(flat.sun_direction)
    for face, file in zip(cubemap.FACES, cube.files, strict=True):
        vectors = cubemap.face_directions(face, 64)
        steady = (np.abs(vectors[..., 1]) > 0.05) & (vectors @ sun < math.cos(math.radians(5.0)))
        expected = sample(image, vectors)
        error = np.abs(pixels(file) - expected) / expected.max(axis=-1, keepdims=True)
        assert error[steady].max() < 0.004, face


def test_cross_exr_cube_and_faces_hold_the_same_pixels(tmp_path):
    edge = 32
    options = {"projection": "cubemap", "size": edge, "sun_azimuth": 0.4}
    faces, _ = bake_map(tmp_path / "a.exr", **options)
    cross, _ = bake_map(tmp_path / "cross.exr", layout="cross", **options)
    column, _ = bake_map(tmp_path / "column.exr", layout="exr", **options)
    cross_pixels, column_pixels = pixels(cross.files[0]), pixels(column.files[0])
    assert cross_pixels.shape == (3 * edge, 4 * edge, 3)
    assert column_pixels.shape == (6 * edge, edge, 3)
    covered = np.zeros(cross_pixels.shape[:2], bool)
    for i, (face, file) in enumerate(zip(cubemap.FACES, faces.files, strict=True)):
        expected = pixels(file)
        row, left = (edge * k for k in cubemap.CROSS_ORIGINS[face])
        block = np.s_[row : row + edge, left : left + edge]
        np.testing.assert_array_equal(cross_pixels[block], expected)
        covered[block] = True
        np.testing.assert_array_equal(
            column_pixels[i * edge : (i + 1) * edge], cubemap.openexr_face(face, expected)
        )
    assert (cross_pixels[~covered] == 0.0).all()


@pytest.mark.parametrize("azimuth", [0.0, 45.0, 90.0, 180.0, 270.0])
def test_sun_stands_at_its_bearing(tmp_path, azimuth):
    baked, _ = bake_map(
        tmp_path / "a.exr", elevation=40.0, size=360, sun_azimuth=math.radians(azimuth)
    )
    image = pixels(baked.files[0]).sum(axis=-1)
    row, column = np.unravel_index(image.argmax(), image.shape)
    assert abs(row + 0.5 - 50.0) <= 1.0
    turn = (column + 0.5 - azimuth + 180.0) % 360.0 - 180.0
    assert abs(turn) <= 1.0


@pytest.mark.parametrize("preset", PRESETS)
def test_no_seam_is_at_the_wrap(tmp_path, preset):
    """With the sun elsewhere, neighbours across the wrap differ as neighbours do."""
    baked, _ = bake_map(tmp_path / "a.exr", preset, 20.0, size=512, sun_azimuth=1.0, pixel="float")
    image = pixels(baked.files[0]).astype(float)
    step = np.abs(np.diff(np.concatenate([image[:, -3:], image[:, :3]], axis=1), axis=1))
    assert (step[:, 2] <= 1.5 * step.max(axis=1) + 1e-6 * image.max()).all()
    inner = np.maximum(step[:, [0, 1, 3, 4]].max(axis=1), 1e-4 * image[:, 0])
    assert (step[:, 2] <= 1.5 * inner).all()


@pytest.mark.parametrize("elevation", [60.0, 5.0, -4.0])
@pytest.mark.parametrize("preset", PRESETS)
def test_no_star_is_at_the_poles(preset, elevation):
    """Columns around a pole look within 0.2 deg of each other, which is a percent on Mars."""
    made = scene(preset, elevation)
    height = math.pi / 1024
    azimuth = equirect.column_bearings(256)[None]
    for zenith in (0.5 * height, math.pi - 0.5 * height):
        row = made.evaluate(np.array([[zenith]]), azimuth, height)[0] @ made.luminance
        assert np.ptp(row) < 0.02 * row.mean()
        assert np.abs(np.diff(row)).max() < 1e-3 * row.mean()


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("elevation", [60.0, pytest.param(5.0, marks=pytest.mark.slow), 0.0, -4.0])
def test_nothing_is_black_below_the_horizon(preset, elevation):
    luminance = sky_luminance(scene(preset, elevation))
    below, above = luminance[16:], luminance[:16]
    assert (below > 0.0).all()
    assert below.min() > 1e-3 * above.mean()


GRID_ALTITUDES = (0.0, 0.002, 8.0, 35.0, 100.0, 400.0, 36_000.0, 1e6)
GRID_ELEVATIONS = (-90.0, -50.0, -18.0, -12.0, -6.0, -2.0, -0.27, 0.0, 0.27, 5.0, 45.0, 90.0)


def check_place(preset, elevation, altitude):
    luminance = sky_luminance(scene(preset, elevation, altitude))
    # Sums of lobes of both signs in single precision leave a little of the brightest.
    assert luminance.min() >= -1e-6 * luminance.max()
    assert luminance.max() >= 0.0
    if elevation >= 0.0:
        assert luminance.max() > 0.0


@pytest.mark.parametrize("i", range(len(GRID_ELEVATIONS)))
def test_every_sun_and_place_gives_light_that_is_finite_and_not_negative(i):
    altitude = GRID_ALTITUDES[(5 * i) % len(GRID_ALTITUDES)]
    check_place(PRESETS[i % len(PRESETS)], GRID_ELEVATIONS[i], altitude)


@pytest.mark.slow
@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("altitude", GRID_ALTITUDES)
@pytest.mark.parametrize("elevation", GRID_ELEVATIONS)
def test_whole_grid_of_suns_and_places_gives_light_that_is_not_negative(
    preset, altitude, elevation
):
    check_place(preset, elevation, altitude)


@pytest.mark.parametrize("preset", PRESETS)
def test_twilight_darkens_with_every_degree(preset):
    luminance = [
        sky_luminance(scene(preset, elevation), 16)[:8].mean()
        for elevation in (2.0, 0.0, -3.0, -6.0, -9.0, -12.0, -18.0)
    ]
    assert (np.diff(luminance) < 0.0).all()
    assert luminance[-1] >= 0.0


def test_sky_of_earth_darkens_with_altitude_at_the_zenith():
    luminance = [
        float(
            scene("earth", 30.0, h).evaluate(np.zeros((1, 1)), np.zeros((1, 1)), 1e-9)[0, 0]
            @ scene("earth", 30.0).luminance
        )
        for h in (0.0, 1.0, 4.0, 10.0, 30.0, 80.0)
    ]
    assert (np.diff(luminance) < 0.0).all()


def xy(made, zenith, azimuth):
    """Chromaticity of a direction, angles in degrees."""
    cosines = np.cos(np.radians(zenith)), None
    sun = made.sun_zenith
    theta, phi = math.radians(zenith), math.radians(azimuth)
    nu = cosines[0] * math.cos(sun) + math.sin(theta) * math.sin(sun) * math.cos(phi)
    light = made.sky.radiance_per_irradiance(np.array([cosines[0]]), np.array([nu]))
    xyz = light[0] @ made.xyz_weights
    return xyz[:2] / xyz.sum()


def test_noon_and_twilight_of_earth_are_blue():
    """Bluer than D65 (0.3127, 0.3290); clear zeniths have 15 to 25 kK (Hernandez-Andres 2001)."""
    for elevation in (60.0, 30.0, 5.0, -4.0):
        x, y = xy(scene("earth", elevation), 0.0, 0.0)
        assert x < 0.29, elevation
        assert y < 0.30, elevation


def test_horizon_below_a_setting_sun_is_orange():
    x, y = xy(scene("earth", 0.0), 89.0, 2.0)
    assert x > 0.42
    assert y > 0.35


def test_sky_of_mars_is_butterscotch_by_day_and_blue_about_the_setting_sun():
    day = xy(scene("mars", 60.0), 75.0, 180.0)
    assert day[0] > 0.36
    aureole, far = xy(scene("mars", 2.0), 86.0, 0.0), xy(scene("mars", 2.0), 70.0, 180.0)
    assert aureole[0] < 0.3127 < far[0]
