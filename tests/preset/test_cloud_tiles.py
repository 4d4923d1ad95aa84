"""Tiles of voxels in presets."""

import hashlib
import json
import math
import zipfile

import numpy as np
import pytest

from skybake.preset import (
    Tile,
    load_preset,
)
from tests.preset.files import message_about, only_layer, write


def save_tile(path, extinction=None, spacing=(0.05, 0.1, 0.2), **others):
    extinction = np.zeros((4, 8, 6), np.float32) if extinction is None else extinction
    np.savez(path, extinction_per_km=extinction, spacing_km=np.array(spacing), **others)
    return path


def test_a_tile_of_the_users_is_a_layer_and_its_digest_is_in_the_recipe(tmp_path):
    file = save_tile(tmp_path / "cloud.npz")
    text = '\n[clouds.own]\ntile = "cloud.npz"\nbase_km = 1.5\n'
    found = only_layer(tmp_path, 'interpolation = "constant"\norigin_km = [0.1, -0.2]', text)
    digest = hashlib.sha256(file.read_bytes()).hexdigest()
    assert found.tile == Tile(str(file.resolve()), digest, "constant", (0.1, -0.2))
    assert (found.kind, found.base, found.optical_depth, found.cover) == ("tile", 1.5, 0.0, 1.0)
    assert found.depth == pytest.approx(4 * 0.05)
    assert found.size == pytest.approx(min(8 * 0.1, 6 * 0.2))
    planet = load_preset(write(tmp_path, new=text))
    assert planet.recipe["files"] == {"cloud.npz": digest}
    assert json.loads(json.dumps(planet.recipe)) == planet.recipe


def test_compressed_tiles_in_single_precision_are_read_too(tmp_path):
    np.savez_compressed(
        tmp_path / "cloud.npz",
        extinction_per_km=np.zeros((2, 3, 4)),
        spacing_km=np.float32([0.5, 1, 1]),
    )
    found = only_layer(tmp_path, text='\n[clouds.own]\ntile = "cloud.npz"\nbase_km = 1\n')
    assert (found.depth, found.size) == (1.0, 3.0)


def test_a_tile_may_take_the_place_of_a_kind(tmp_path):
    save_tile(tmp_path / "cloud.npz")
    path = tmp_path / "own.toml"
    path.write_text('extends = "earth-fair"\n[clouds.low]\ntile = "cloud.npz"\nbase_km = 1\n')
    (low,) = load_preset(path).clouds
    assert low.kind == "tile"


def spoil(path, name, content):
    save_tile(path)
    with zipfile.ZipFile(path) as archive:
        members = {one: archive.read(one) for one in archive.namelist()}
    with zipfile.ZipFile(path, "w") as archive:
        for one, data in (members | {name: content}).items():
            archive.writestr(one, data)


TILE_FAULTS = [
    (lambda path: None, "tile: 'cloud.npz': cannot be read: No such file or directory"),
    (lambda path: path.mkdir(), "tile: 'cloud.npz': must be a regular file, got a folder"),
    (lambda path: path.write_bytes(b"no zip"), "tile: 'cloud.npz' must be an archive of numpy's"),
    (
        lambda path: np.savez(path, density=np.zeros(3)),
        "tile: 'cloud.npz' must hold the arrays extinction_per_km and spacing_km, got density",
    ),
    (
        lambda path: save_tile(path, np.zeros((3, 3))),
        "tile: 'cloud.npz': extinction_per_km must run along z, y and x, got shape (3, 3)",
    ),
    (
        lambda path: save_tile(path, np.zeros((3, 0, 3))),
        "tile: 'cloud.npz': extinction_per_km must run along z, y and x, got shape (3, 0, 3)",
    ),
    (
        lambda path: save_tile(path, spacing=(0.1, 0.1)),
        "tile: 'cloud.npz': spacing_km must be three numbers greater than 0 for z, y and x",
    ),
    (
        lambda path: save_tile(path, spacing=(0.1, math.nan, 0.1)),
        "tile: 'cloud.npz': spacing_km must be three numbers greater than 0 for z, y and x",
    ),
    (
        lambda path: save_tile(path, spacing=(20, 0.1, 0.1)),
        "base_km: the clouds must end below the atmosphere's top at 50 km, got 81 km",
    ),
    (
        lambda path: spoil(path, "extinction_per_km.npy", b"\x93NUMPY\x01\x00\x09\x00{'shape':"),
        "tile: 'cloud.npz' must be an archive of numpy's, as numpy.savez writes: an array's header",
    ),
    (
        lambda path: spoil(path, "extinction_per_km.npy", b""),
        "tile: 'cloud.npz' must be an archive of numpy's, as numpy.savez writes: an array has no",
    ),
]


@pytest.mark.parametrize(("make", "message"), TILE_FAULTS)
def test_a_tile_that_is_none_is_named_in_one_line(tmp_path, make, message):
    make(tmp_path / "cloud.npz")
    path = write(tmp_path, new='\n[clouds.own]\ntile = "cloud.npz"\nbase_km = 1\n')
    assert message_about(path).startswith(f"clouds.own.{message}")


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ('tile = "cloud.npz"', ".base_km: must be given"),
        ('tile = "cloud.vdb"\nbase_km = 1', ".tile: must be a file that ends in .npz, got 'cloud"),
        ("tile = 3\nbase_km = 1", ".tile: must be a line of text, got 3"),
        (
            'tile = "../cloud.npz"\nbase_km = 1',
            ".tile: '../cloud.npz': must be in the preset's folder or an absolute path",
        ),
        (
            'tile = "cloud.npz"\nbase_km = 1\ninterpolation = "cubic"',
            ".interpolation: must be one of linear, constant, got 'cubic'",
        ),
        (
            'tile = "cloud.npz"\nbase_km = 1\norigin_km = [1, 2, 3]',
            ".origin_km: must be two numbers, got 3",
        ),
        ('tile = "cloud.npz"\nbase_km = 1\ncover = 0.3', ": unknown key 'cover'; known keys: "),
    ],
)
def test_a_broken_rule_of_tiles_is_named_in_one_line(tmp_path, lines, message):
    save_tile(tmp_path / "cloud.npz")
    found = message_about(write(tmp_path, new=f"\n[clouds.own]\n{lines}\n"))
    assert found.startswith(f"clouds.own{message}")
