"""Mean extinction of a layer on a grid that is coarse enough for solving for the light in it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import CONSTANT, SURFACE, CloudField, clearance_at, extinction_at
from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS, Workers

_SAMPLES = 2


class ExtinctionGrid(NamedTuple):
    """Extinction of voxels that are uniform.

    Attributes
    ----------
    values : ndarray of float32, shape (z, y, x)
        In km⁻¹; periodic in y and x.
    spacing : ndarray of float64, shape (3,)
        Of voxels along z, y and x. [km]
    base : float
        Altitude of the lowest voxels' lower face. [km]
    """

    values: npt.NDArray[np.float32]
    spacing: npt.NDArray[np.float64]
    base: float


def light_grid(
    field: CloudField, spacing: npt.NDArray[np.float64], workers: Workers = ALL_CPUS
) -> ExtinctionGrid:
    """Average a field over voxels.

    Parameters
    ----------
    field : CloudField
        The layer; its `origin` does not matter.
    spacing : ndarray of float64, shape (3,)
        Of voxels along z, y and x, about: whole numbers of them fit into the tile, and into its
        height. [km]
    workers : Workers, optional
        Who share the rows.

    Returns
    -------
    ExtinctionGrid
        Of voxels of a file, exactly the mean; near surfaces that of 8 points.
    """
    extent = np.array([field.top - field.base, field.period[1], field.period[0]])
    counts = np.maximum(np.rint(extent / spacing), 1.0).astype(int)
    steps = np.where(extent > 0.0, extent, 1.0) / counts
    if field.kind != SURFACE:
        return ExtinctionGrid(_mean_of_voxels(field, counts), steps, field.base)
    values = np.zeros(counts, np.float32)

    def work(first: int, last: int) -> None:
        _fill(field, steps, values, first, last)

    workers.run_rows(int(counts[1]), work, chunk=8)
    return ExtinctionGrid(values, steps, field.base)


def _mean_of_voxels(field: CloudField, counts: npt.NDArray[np.int_]) -> npt.NDArray[np.float32]:
    """Average along each axis in turn, since values between voxels are products over the axes."""
    is_linear = field.kind != CONSTANT
    values = field.values.astype(np.float64)
    for axis, count in enumerate(counts):
        weights = _weights(values.shape[axis], int(count), is_linear, is_periodic=axis > 0)
        values = np.moveaxis(np.tensordot(weights, values, (1, axis)), 0, axis)
    return np.ascontiguousarray(values, np.float32)


def _weights(
    voxels: int, count: int, is_linear: bool, *, is_periodic: bool
) -> npt.NDArray[np.float64]:
    """Return the shares of voxels, shape (count, voxels), in the means of equal intervals.

    The intervals divide the period, or the height with the half voxel beyond both ends into
    which linear values reach.
    """
    beyond = 0.5 if is_linear and not is_periodic else 0.0
    edges = np.linspace(-beyond, voxels + beyond, count + 1)[:, None]
    weights = np.zeros((count, voxels))
    for period in (-1, 0, 1) if is_periodic else (0,):
        centres = np.arange(voxels) + 0.5 + period * voxels
        away = edges - centres
        if is_linear:
            # The integral of a hat of unit height and half width 1.
            near = np.clip(away, -1.0, 1.0)
            integral = 0.5 + near - 0.5 * near * np.abs(near)
        else:
            integral = np.clip(away, -0.5, 0.5) + 0.5
        weights += np.diff(integral, axis=0)
    return weights * (count / (voxels + 2.0 * beyond))


@kernel
def _fill(field, steps, values, first, last):
    """Means of the rows from `first` to below `last` in all planes."""
    levels, _, columns = values.shape
    dz, dy, dx = steps[0], steps[1], steps[2]
    half = 0.5 * math.sqrt(dx * dx + dy * dy + dz * dz)
    for k in range(levels):
        for j in range(first, last):
            for i in range(columns):
                x, y, z = i * dx, j * dy, field.base + k * dz
                clear = clearance_at(field, x + 0.5 * dx, y + 0.5 * dy, z + 0.5 * dz, 0.0)
                if clear >= half:
                    continue
                total = 0.0
                for c in range(_SAMPLES):
                    for b in range(_SAMPLES):
                        for a in range(_SAMPLES):
                            total += extinction_at(
                                field,
                                x + (a + 0.5) / _SAMPLES * dx,
                                y + (b + 0.5) / _SAMPLES * dy,
                                z + (c + 0.5) / _SAMPLES * dz,
                                0.0,
                            )
                values[k, j, i] = total / _SAMPLES**3
