"""Voxels in files, and their fields."""

import io
import zipfile

import numpy as np
import pytest

from skybake.cloud_fields.build import build_field
from skybake.cloud_fields.light_grid import ExtinctionGrid, light_grid
from skybake.cloud_fields.tiles import read_tile, tile_bytes, tile_field
from skybake.errors import InputError
from skybake.jit.arguments import flatten
from skybake.preset.clouds_model import Tile
from tests.cloud_fields.layers import field, layer
from tests.cloud_fields.sampling import clearance, column_depths, extinction, random_points

SPACING = np.array([0.25, 0.5, 0.5])
BASE = 1.0


def voxels(shape=(4, 6, 8), seed=1):
    rng = np.random.default_rng(seed)
    values = rng.random(shape) * (rng.random(shape) < 0.3)
    return ExtinctionGrid(values.astype(np.float32), SPACING, 0.0)


def by_numpy(grid, points, interpolation):
    z, y, x = ((points[:, 2 - i] - (BASE if i == 0 else 0.0)) / SPACING[i] for i in range(3))
    levels, rows, columns = grid.values.shape
    padded = np.pad(grid.values.astype(float), ((1, 1), (0, 0), (0, 0)))

    def voxel(k, j, i):
        k, j, i = (np.floor(each).astype(int) for each in (k, j, i))
        return padded[np.clip(k + 1, 0, levels + 1), j % rows, i % columns]

    if interpolation == "constant":
        return voxel(z, y, x)
    total = 0.0
    for dz in (0, 1):
        for dy in (0, 1):
            for dx in (0, 1):
                weight = 1.0
                for f, d in ((z, dz), (y, dy), (x, dx)):
                    share = f - 0.5 - np.floor(f - 0.5)
                    weight = weight * (share if d else 1.0 - share)
                total = total + weight * voxel(z - 0.5 + dz, y - 0.5 + dy, x - 0.5 + dx)
    return total


@pytest.mark.parametrize("interpolation", ["constant", "linear"])
def test_extinction_between_voxels_is_numpys(interpolation):
    grid = voxels()
    clouds = tile_field(grid, BASE, interpolation, (0.0, 0.0))
    points = np.random.default_rng(2).uniform([-9.0, -9.0, 0.5], [9.0, 9.0, 2.6], (20_000, 3))
    expected = by_numpy(grid, points, interpolation)
    np.testing.assert_allclose(extinction(clouds, points), expected, atol=1e-6)


@pytest.mark.parametrize("interpolation", ["constant", "linear"])
def test_clearance_of_voxels_is_never_overstated(interpolation):
    grid = voxels((12, 40, 36))
    grid.values[:] *= np.random.default_rng(4).random(grid.values.shape) < 0.003
    clouds = tile_field(grid, BASE, interpolation, (0.0, 0.0))
    points = random_points(clouds, 20_000)
    distance = clearance(clouds, points)
    assert (distance > 0.5).mean() > 0.1
    rng = np.random.default_rng(3)
    for _ in range(20):
        away = rng.standard_normal(points.shape)
        away *= 0.999 / np.linalg.norm(away, axis=1, keepdims=True)
        near = points + away * np.maximum(distance, 0.0)[:, None]
        assert not extinction(clouds, near[distance > 0.0]).any()


@pytest.mark.parametrize("interpolation", ["constant", "linear"])
@pytest.mark.parametrize("spacing", [(0.25, 0.5, 0.5), (0.1, 0.3, 0.7), (1.0, 1.0, 1.0)])
def test_a_coarser_or_finer_grid_of_voxels_has_their_mean(interpolation, spacing):
    grid = voxels()
    coarse = light_grid(tile_field(grid, BASE, interpolation, (0.0, 0.0)), np.array(spacing))
    whole = grid.values.mean((1, 2), dtype=float).sum() * SPACING[0]
    assert coarse.values.mean((1, 2), dtype=float).sum() * coarse.spacing[0] == pytest.approx(whole)
    if interpolation == "constant" and spacing == tuple(SPACING):
        np.testing.assert_allclose(coarse.values, grid.values, rtol=1e-6)


def test_the_grid_of_cumuli_has_their_mean():
    clouds = field("cumulus")
    grid = light_grid(clouds, np.array([0.04, 0.1, 0.1]))
    mean = grid.values.mean((1, 2), dtype=float).sum() * grid.spacing[0]
    assert mean == pytest.approx(column_depths(clouds, 151).mean(), rel=0.02)


def test_a_file_has_the_voxels_that_were_written(tmp_path):
    grid, path = voxels(), tmp_path / "cloud.npz"
    path.write_bytes(tile_bytes(grid))
    again = read_tile(path, path.name)
    np.testing.assert_array_equal(again.values, grid.values)
    np.testing.assert_array_equal(again.spacing, grid.spacing)
    assert tile_bytes(again) == tile_bytes(grid)


def test_a_layer_of_voxels_lies_where_it_says(tmp_path):
    grid, path = voxels(), tmp_path / "cloud.npz"
    path.write_bytes(tile_bytes(grid))
    tile = Tile(str(path), "0", "constant", (0.5, 1.0))
    clouds = build_field(layer("cumulus", kind="tile", base=BASE, optical_depth=0.0, tile=tile))
    assert tuple(clouds.origin) == (0.5, 1.0)
    assert (clouds.base, clouds.top) == (1.0, 2.0)


def test_a_layer_of_voxels_needs_the_kernels_of_every_other(tmp_path):
    path = tmp_path / "cloud.npz"
    path.write_bytes(tile_bytes(voxels((10, 12, 14))))
    tile = Tile(str(path), "0", "linear", (0.0, 0.0))
    clouds = build_field(layer("cumulus", kind="tile", base=BASE, optical_depth=0.0, tile=tile))
    assert min(clouds.clearance.shape) > 1
    assert flatten(clouds).kinds == flatten(field("stratus")).kinds


def content(**arrays):
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    return buffer.getvalue()


def with_value(value):
    values = np.ones((4, 3, 2))
    values[3, 1, 0] = value
    return content(extinction_per_km=values, spacing_km=SPACING)


def with_header_only(shape):
    buffer, member = io.BytesIO(), io.BytesIO()
    np.lib.format.write_array_header_1_0(
        member, {"descr": "<f4", "fortran_order": False, "shape": shape}
    )
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("extinction_per_km.npy", member.getvalue())
        spacing = io.BytesIO()
        np.save(spacing, SPACING)
        archive.writestr("spacing_km.npy", spacing.getvalue())
    return buffer.getvalue()


ONES = np.ones((2, 2, 2))
BAD = {
    "no archive": (b"voxels", "must be an archive as numpy.savez writes: File is not a zip file"),
    "no extinction": (
        content(spacing_km=SPACING, density=ONES),
        "must hold the array extinction_per_km, got density, spacing_km",
    ),
    "no spacing": (
        content(extinction_per_km=ONES),
        "must hold the array spacing_km, got extinction_per_km",
    ),
    "two axes": (
        content(extinction_per_km=np.ones((3, 4)), spacing_km=SPACING),
        "extinction_per_km must be along z, y and x, got shape (3, 4)",
    ),
    "no voxels": (
        content(extinction_per_km=np.ones((3, 0, 4)), spacing_km=SPACING),
        "extinction_per_km must be along z, y and x, got shape (3, 0, 4)",
    ),
    "two spacings": (
        content(extinction_per_km=ONES, spacing_km=SPACING[:2]),
        "spacing_km must be 3 numbers, for z, y and x, got shape (2,)",
    ),
    "no height": (
        content(extinction_per_km=ONES, spacing_km=np.array([0.0, 1.0, 1.0])),
        "spacing_km must be greater than 0 along z, got 0.0",
    ),
    "endless": (
        content(extinction_per_km=ONES, spacing_km=np.array([1.0, 1.0, np.inf])),
        "spacing_km must be greater than 0 along x, got inf",
    ),
    "text": (
        content(extinction_per_km=np.full((2, 2, 2), "a"), spacing_km=SPACING),
        "extinction_per_km must be numbers, got <U1",
    ),
    "objects": (
        content(extinction_per_km=np.full((2, 2, 2), None), spacing_km=SPACING),
        "extinction_per_km must be numbers, got object",
    ),
    "negative": (
        with_value(-0.5),
        "extinction_per_km must be finite and at least 0, got -0.5 in voxel (z, y, x) (3, 1, 0)",
    ),
    "no number": (
        with_value(np.nan),
        "extinction_per_km must be finite and at least 0, got nan in voxel (z, y, x) (3, 1, 0)",
    ),
    "beyond floats": (
        with_value(1e39),
        "extinction_per_km must be finite and at least 0, got inf in voxel (z, y, x) (3, 1, 0)",
    ),
    "truncated": (
        with_header_only((4, 4, 4)),
        "extinction_per_km must be complete (EOF: reading array data, expected 256 bytes got 0)",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_file_is_named_with_its_problem(tmp_path, name):
    data, problem = BAD[name]
    path = tmp_path / "cloud.npz"
    path.write_bytes(data)
    with pytest.raises(InputError) as caught:
        read_tile(path, path.name)
    assert str(caught.value) == f"cloud.npz: {problem}"


def test_voxels_beyond_memory_are_refused_unread(tmp_path):
    path = tmp_path / "cloud.npz"
    path.write_bytes(with_header_only((100_000, 10_000, 10_000)))
    with pytest.raises(InputError, match=r"10000 x 10000 voxels need 100000\.0 GB of memory, got"):
        read_tile(path, path.name)


def test_a_pipe_is_no_tile(tmp_path):
    with pytest.raises(InputError, match="must be a regular file, got a folder"):
        read_tile(tmp_path, "cloud.npz")
