"""Voxels of clouds in files of numpy's, read and written."""

from __future__ import annotations

import io
import os
import zipfile
from pathlib import Path
from typing import Literal

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.clearance import block_clearance, blocks_of
from skybake.cloud_fields.empty import empty_field
from skybake.cloud_fields.field import CONSTANT, LINEAR, CloudField
from skybake.cloud_fields.light_grid import ExtinctionGrid
from skybake.errors import InputError
from skybake.input_files import LARGEST_TILE, read_bytes

EXTINCTION, SPACING = "extinction_per_km", "spacing_km"
"""Arrays of a file: extinction along z, y and x, and the spacing of its voxels."""

_VOXELS_PER_BLOCK = (2, 4, 4)
_BYTES_PER_VOXEL = 6
_KINDS = "fiu"


def read_tile(path: Path, where: str) -> ExtinctionGrid:
    """Read voxels.

    Parameters
    ----------
    path : Path
        Of a ``.npz`` that holds `EXTINCTION` and `SPACING`.
    where : str
        What names it, for messages.

    Returns
    -------
    ExtinctionGrid
        Whose base is at 0.

    Raises
    ------
    InputError
        If the file cannot be read or is too large for memory, if an array is missing or has
        another shape, or if an extinction is negative or no finite number.
    """
    content = read_bytes(path, where, LARGEST_TILE)
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            spacing = _array(archive, SPACING, where)
            _check_spacing(spacing, where)
            values = _array(archive, EXTINCTION, where)
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, OSError, EOFError) as error:
        raise InputError(f"{where}: must be an archive as numpy.savez writes: {error}") from error
    with np.errstate(over="ignore"):
        extinction = np.ascontiguousarray(values, np.float32)
    grid = ExtinctionGrid(extinction, spacing.astype(np.float64), 0.0)
    check_voxels(grid, where)
    return grid


def check_voxels(grid: ExtinctionGrid, where: str) -> None:
    """Raise an `InputError` that names the first voxel which cannot be."""
    values = grid.values
    is_good = np.isfinite(values) & (values >= 0.0)
    if not is_good.all():
        voxel = tuple(int(each) for each in np.argwhere(~is_good)[0])
        raise InputError(
            f"{where}: {EXTINCTION} must be finite and at least 0, "
            f"got {values[voxel]} in voxel (z, y, x) {voxel}"
        )


def tile_bytes(grid: ExtinctionGrid) -> bytes:
    """Return the content of a file of voxels, the same for the same voxels."""
    buffer = io.BytesIO()
    np.savez_compressed(buffer, extinction_per_km=grid.values, spacing_km=grid.spacing)
    return buffer.getvalue()


def tile_field(
    grid: ExtinctionGrid,
    base: float,
    interpolation: Literal["constant", "linear"],
    origin: tuple[float, float],
) -> CloudField:
    """Return the field of voxels.

    Parameters
    ----------
    grid : ExtinctionGrid
        The voxels.
    base : float
        Altitude of the lowest voxels' lower face. [km]
    interpolation : {"constant", "linear"}
        Within a voxel; linear values reach half a voxel below and above all voxels.
    origin : tuple of float
        The tile's coordinates x and y under the observer. [km]
    """
    values, spacing = grid.values, grid.spacing
    beyond = 0.0 if interpolation == "constant" else 0.5 * float(spacing[0])
    levels, rows, columns = values.shape
    cells = values > 0.0
    if interpolation == "linear":
        for axis in (1, 2):
            cells = cells | np.roll(cells, 1, axis) | np.roll(cells, -1, axis)
        above, below = (
            np.pad(cells, ((0, 1), (0, 0), (0, 0))),
            np.pad(cells, ((1, 0), (0, 0), (0, 0))),
        )
        cells = above | below
    mask, block = blocks_of(cells, spacing, _VOXELS_PER_BLOCK)
    return empty_field()._replace(
        kind=CONSTANT if interpolation == "constant" else LINEAR,
        values=values,
        spacing=spacing,
        period=np.array([columns * spacing[2], rows * spacing[1]]),
        origin=np.array(origin, np.float64),
        base=base - beyond,
        top=base + levels * float(spacing[0]) + beyond,
        clearance=block_clearance(mask, block),
        block=block,
    )


def _array(archive: zipfile.ZipFile, name: str, where: str) -> npt.NDArray[np.generic]:
    """Read an array whose header has shown that it fits into memory."""
    try:
        member = archive.open(f"{name}.npy")
    except KeyError:
        names = ", ".join(sorted(each.removesuffix(".npy") for each in archive.namelist()))
        raise InputError(f"{where}: must hold the array {name}, got {names or 'none'}") from None
    with member:
        try:
            version = np.lib.format.read_magic(member)
            read = {
                (1, 0): np.lib.format.read_array_header_1_0,
                (2, 0): np.lib.format.read_array_header_2_0,
            }[version]
            shape, _, kind = read(member)
        except (ValueError, KeyError) as error:
            raise InputError(f"{where}: {name} must be an array of numpy's ({error})") from error
    if kind.kind not in _KINDS:
        raise InputError(f"{where}: {name} must be numbers, got {kind}")
    expected = 1 if name == SPACING else 3
    if len(shape) != expected or 0 in shape:
        what = "3 numbers, for z, y and x" if name == SPACING else "along z, y and x"
        raise InputError(f"{where}: {name} must be {what}, got shape {shape}")
    _check_memory(shape, kind.itemsize, where)
    with archive.open(f"{name}.npy") as member:
        try:
            array: npt.NDArray[np.generic] = np.lib.format.read_array(member, allow_pickle=False)
        except ValueError as error:
            raise InputError(f"{where}: {name} must be complete ({error})") from error
    return array


def _check_spacing(spacing: npt.NDArray[np.generic], where: str) -> None:
    if spacing.shape != (3,):
        raise InputError(
            f"{where}: {SPACING} must be 3 numbers, for z, y and x, got shape {spacing.shape}"
        )
    for axis, step in zip("zyx", spacing.astype(np.float64), strict=True):
        if not (np.isfinite(step) and step > 0.0):
            raise InputError(
                f"{where}: {SPACING} must be greater than 0 along {axis}, got {float(step)!r}"
            )


def _check_memory(shape: tuple[int, ...], item: int, where: str) -> None:
    voxels = 1
    for count in shape:
        voxels *= count
    needed, present = voxels * (item + _BYTES_PER_VOXEL), _memory()
    if present is not None and needed > present:
        counts = " x ".join(str(count) for count in shape)
        raise InputError(
            f"{where}: {counts} voxels need {needed / 1e9:.1f} GB of memory, "
            f"got {present / 1e9:.1f} GB"
        )


def _memory() -> int | None:
    """Memory of this machine, where that is known. [byte]"""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return None
