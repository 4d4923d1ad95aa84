"""Pixels of files in every projection, against rays in the directions that documents give them."""

import math

import numpy as np
import pytest

from skybake.image.scene import Scene
from skybake.preset import load_preset
from skybake.projection.cubemap import VERTICAL_ORIGINS, face_directions
from tests.baking.maps import bake_map, luminance, pixels

EDGE = 96


def places(width, height):
    """From -1 to 1, to the right and downward."""
    u = (2.0 * np.arange(width) + 1.0) / width - 1.0
    v = (2.0 * np.arange(height) + 1.0) / height - 1.0
    return np.broadcast_arrays(u[None], v[:, None])


def by_angles(zenith, bearing):
    zenith, bearing = np.broadcast_arrays(zenith, bearing)
    sine = np.sin(zenith)
    return np.stack([sine * np.sin(bearing), np.cos(zenith), -sine * np.cos(bearing)], axis=-1)


def angular():
    u, v = places(EDGE, EDGE)
    a, t = math.pi * np.hypot(u, v), np.arctan2(-v, u)
    seen = np.stack([np.sin(a) * np.cos(t), np.sin(a) * np.sin(t), -np.cos(a)], axis=-1)
    return np.where((a < 0.97 * math.pi)[..., None], seen, np.nan)


def octahedral():
    u, v = places(EDGE, EDGE)
    up = 1.0 - np.abs(u) - np.abs(v)
    x = np.where(up < 0.0, np.sign(u) * (1.0 - np.abs(v)), u)
    z = np.where(up < 0.0, np.sign(v) * (1.0 - np.abs(u)), v)
    return np.stack([x, up, z], axis=-1) / np.linalg.norm([x, up, z], axis=0)[..., None]


def cross():
    seen = np.full((4 * EDGE, 3 * EDGE, 3), np.nan)
    for face, (row, column) in VERTICAL_ORIGINS.items():
        block = face_directions(face, EDGE)
        block = block[::-1, ::-1] if face == "nz" else block
        top, left = row * EDGE, column * EDGE
        seen[top : top + EDGE, left : left + EDGE] = block
    return seen


def rows_at_poles():
    zenith = math.pi * np.arange(EDGE // 2)[:, None] / (EDGE // 2 - 1)
    return by_angles(zenith, 2.0 * math.pi * (np.arange(EDGE) + 0.5) / EDGE)


def centres():
    zenith = math.pi * (np.arange(EDGE // 2)[:, None] + 0.5) / (EDGE // 2)
    return by_angles(zenith, 2.0 * math.pi * (np.arange(EDGE) + 0.5) / EDGE)


MAPS = {
    "angular": ({"projection": "angular"}, angular),
    "octahedral": ({"projection": "octahedral"}, octahedral),
    "vertical cross": ({"projection": "cubemap", "layout": "vertical-cross"}, cross),
    "rows at poles": ({"rows": "poles"}, rows_at_poles),
    "equirect": ({}, centres),
}


@pytest.mark.parametrize(("altitude", "rotation"), [(0.0, math.radians(75.0)), (12.0, 0.0)])
@pytest.mark.parametrize("name", MAPS)
def test_pixels_are_the_light_of_their_rays(tmp_path, name, rotation, altitude):
    options, directions = MAPS[name]
    values = {"size": EDGE, "sun_azimuth": 1.0, "sun_disc": "exclude", "pixel": "float"}
    values |= {"altitude": altitude, "rotation": rotation, **options}
    baked, settings = bake_map(tmp_path / "a.exr", elevation=25.0, **values)
    shown, seen = luminance(baked.files[0], settings), directions()
    # On the map -Z is at the bearing of the rotation.
    turn = 1.0 - rotation
    sun = by_angles(math.radians(65.0), turn)
    assert baked.sun_direction == pytest.approx(tuple(sun), abs=1e-12)
    scene = Scene(load_preset("earth"), settings)
    dip = math.acos(6371.0 / (6371.0 + altitude))
    steady = np.isfinite(seen[..., 0]) & (seen @ sun < math.cos(math.radians(5.0)))
    steady &= np.abs(seen[..., 1] + math.sin(dip)) > math.sin(math.radians(5.0))
    row, column = np.nonzero(steady)
    some = np.random.default_rng(0).choice(len(row), 300, replace=False)
    row, column = row[some], column[some]
    vectors = seen[row, column]
    light = scene.sky.radiance_per_irradiance(vectors[:, 1], vectors @ sun)
    rays = light @ scene.xyz_weights[:, 1]
    np.testing.assert_allclose(shown[row, column], rays, rtol=0.005)


@pytest.mark.parametrize("name", MAPS)
def test_the_sun_is_where_its_direction_is(tmp_path, name):
    options, directions = MAPS[name]
    values = {"size": EDGE, "sun_azimuth": 4.0, "sun_disc": "only", "rotation": 0.5, **options}
    baked, _ = bake_map(tmp_path / "a.exr", elevation=50.0, method="hillaire", **values)
    image = pixels(baked.files[0]).sum(axis=-1)
    seen = directions()[np.unravel_index(image.argmax(), image.shape)]
    assert math.degrees(math.acos(min(seen @ np.array(baked.sun_direction), 1.0))) < 4.0


@pytest.mark.parametrize("name", MAPS)
def test_a_turned_map_of_a_turned_sun_is_the_same_map(tmp_path, name):
    options, _ = MAPS[name]
    values = {"size": EDGE, "method": "hillaire", "pixel": "float", **options}
    plain, _ = bake_map(tmp_path / "plain.exr", sun_azimuth=2.0, **values)
    turned, _ = bake_map(tmp_path / "turned.exr", sun_azimuth=2.5, rotation=0.5, **values)
    np.testing.assert_array_equal(pixels(turned.files[0]), pixels(plain.files[0]))
