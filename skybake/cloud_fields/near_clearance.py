"""How far from each cell of a drawn cloud's tile there is none: a fine map, for what is not far."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.cell_distances import cell_distances
from skybake.cloud_fields.field import CloudField
from skybake.cloud_fields.noise import BILLOW_SIZE
from skybake.cloud_fields.surface import AT_BASE, STEP
from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS

_BLUR = 0.25
"""Largest blur for which the map holds, in the widest edge of the clouds."""

_UNITS = 4.0
"""Steps of the map in the least side of a node's cell."""

_WIDEST_WINDOW = 24
"""Voxels of noise along a side of a cell above which its own maximum is worth nothing."""


def with_near_clearance(field: CloudField) -> CloudField:
    """Return the field of a surface with the map for its displacement as it is now."""
    levels, rows, columns = field.distance.shape
    cells = np.empty((levels - 1, rows, columns), np.uint8)
    blur = _BLUR * field.widest_edge
    reach, most, least = _reach(field, blur)
    nearby = _largest_nearby(field)

    def mark(first: int, last: int) -> None:
        _mark(field, nearby, blur, reach, most, least, cells, first, last)

    ALL_CPUS.run_rows(levels - 1, mark, chunk=2)
    unit = float(field.spacing.min()) / _UNITS
    return field._replace(
        near_clearance=cell_distances(cells, field.spacing, unit), near_unit=unit, near_blur=blur
    )


def _reach(field: CloudField, blur: float) -> tuple[float, float, float]:
    """How far from the surface there may be cloud, without what the coarsest noise displaces.

    Returns
    -------
    reach : float
        By edge, finer noises and shift, at most for blurs up to `blur`. [km]
    most, least : float
        Amplitude of the coarsest noise, without blur and with it. [km]
    """
    amplitudes, waves = field.displacement[:, 0], field.displacement[:, 5]
    # Between these, all parts are linear in the blur.
    bends = np.concatenate([[0.0, blur, field.widest_edge - field.edge], 0.25 / waves])
    bends = bends[(bends >= 0.0) & (bends <= blur)]
    left = np.maximum(amplitudes * (1.0 - 4.0 * bends[:, None] * waves), 0.0)
    edges = 0.5 * np.minimum(field.edge + bends, field.widest_edge)
    last = len(field.shift) - 1
    known = math.ceil(math.sqrt(min(blur / field.largest_blur, 1.0)) * last)
    shift = float(field.shift[: known + 1].max())
    reach = float((edges + left[:, 1:].sum(1)).max())
    return reach + shift, float(left[:, 0].max()), float(left[:, 0].min())


def _largest_nearby(field: CloudField) -> npt.NDArray[np.int8]:
    """Largest value of the coarsest noise around each voxel that a cell around it can hold."""
    row, (dz, dy, dx) = field.displacement[0], field.spacing
    wide, deep = (abs(row[q]) * dx + abs(row[q + 1]) * dy for q in (1, 3))
    sides = abs(row[5]) * dz, deep, wide
    largest = field.noise
    for axis, side in enumerate(sides):
        half = math.ceil(0.5 * side * BILLOW_SIZE)
        if 2 * half + 2 > _WIDEST_WINDOW:
            return np.full_like(field.noise, 127)
        # Between voxels a value is not above those of its neighbours.
        turns = range(-half, half + 2)
        largest = np.maximum.reduce([np.roll(largest, -turn, axis) for turn in turns])
    return largest


@kernel
def _mark(field, nearby, blur, reach, most, least, cells, first, last):
    """Write 1 for cells that may hold cloud and 0 for others, in planes `first` to below `last`."""
    _, rows, columns = field.distance.shape
    dz, dy, dx = field.spacing[0], field.spacing[1], field.spacing[2]
    row = field.displacement[0]
    size = nearby.shape[0]
    mask = size - 1
    lowest = field.condensation - 0.5 * min(field.edge + blur, field.widest_edge)
    for q in range(field.displacement.shape[0]):
        lowest -= AT_BASE * field.displacement[q, 0]
    for k in range(first, last):
        upper = field.base + (k + 1) * dz
        fz = row[5] * (upper - 0.5 * dz) + row[8]
        a = int((fz - math.floor(fz)) * size) & mask
        for j in range(rows):
            north = j + 1 if j + 1 < rows else 0
            y = (j + 0.5) * dy
            for i in range(columns):
                east = i + 1 if i + 1 < columns else 0
                low = field.distance[k, j, i]
                for plane in (field.distance[k], field.distance[k + 1]):
                    low = min(low, plane[j, i], plane[j, east], plane[north, i], plane[north, east])
                distance = STEP * low - reach
                if distance >= most:
                    cells[k, j, i] = 0
                    continue
                x = (i + 0.5) * dx
                fx, fy = row[1] * x + row[2] * y + row[6], row[3] * x + row[4] * y + row[7]
                b = int((fy - math.floor(fy)) * size) & mask
                c = int((fx - math.floor(fx)) * size) & mask
                noise = nearby[a, b, c] / 127.0
                moved = noise * (most if noise > 0.0 else least)
                cells[k, j, i] = distance < moved and upper > lowest
