"""Prepares a field whose tile is to lie elsewhere in each patch of the plane."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.field import CloudField
from skybake.cloud_fields.patches import SIZE, patch_shifts
from skybake.cloud_fields.surface import STEP

_STRIDE = 3
_TRIALS = 14
_COVERED = 0.1
_ELSEWHERE = ((0.5, 0.5), (0.31, 0.74), (0.62, 0.19))
"""Shifts of the tile, in its period, over which the mean is taken."""


def with_patches(field: CloudField, seed: int) -> CloudField:
    """Return a field of a surface that covers the plane in patches.

    Parameters
    ----------
    field : CloudField
        That repeats to all sides.
    seed : int
        Another one, other shifts.
    """
    vanishing = vanishing_of(field)
    return field._replace(
        patch=SIZE * float(field.period.min()),
        shifts=patch_shifts(field.period, seed),
        erosion=_mean_keeping_erosion(field, vanishing),
        vanishing=vanishing,
    )


def vanishing_of(field: CloudField) -> float:
    """Return how far a surface has to be moved inward for nothing to be left of it. [km]"""
    farthest = float(np.abs(field.displacement[:, 0]).sum()) + 0.5 * field.widest_edge
    return farthest + float(field.shift.max()) - STEP * int(field.distance.min())


def _mean_keeping_erosion(field: CloudField, vanishing: float) -> float:
    """Return the erosion with which two tiles have extinction and cover of one, about. [km]"""
    nodes = STEP * field.distance[:, ::_STRIDE, ::_STRIDE].astype(np.float32) - field.shift[0]
    # What noise displaces is, on average, a surface with a wider edge.
    width = np.float32(field.edge + 1.5 * float(np.abs(field.displacement[:, 0]).sum()))
    both = []
    for east, north in _ELSEWHERE:
        turns = round(north * nodes.shape[1]), round(east * nodes.shape[2])
        both.append(np.minimum(nodes, np.roll(nodes, turns, (1, 2))))

    def measure(distance: npt.NDArray[np.float32]) -> npt.NDArray[np.float64]:
        share = np.clip(0.5 - distance / width, 0.0, 1.0)
        depth = np.tensordot(field.extinction, share, (0, 0)) * field.spacing[0]
        return np.array([depth.mean(), (depth > _COVERED).mean()])

    wanted = measure(nodes)
    low, high = 0.0, vanishing
    for _ in range(_TRIALS):
        middle = 0.5 * (low + high)
        found = sum(measure(each + np.float32(middle)) for each in both) / len(both)
        low, high = (middle, high) if (found / wanted).sum() > 2.0 else (low, middle)
    return 0.5 * (low + high)
