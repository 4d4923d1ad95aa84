"""Keeps distances from changing faster than the way along an axis, as true distances do not."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel


def limit_slopes(nodes: npt.NDArray[np.float32], spacing: npt.NDArray[np.float64]) -> None:
    """Move distances toward 0 until none differs from its neighbour's by more than their spacing.

    A distance that is too large would let rays step into clouds; its sign does not change.

    Parameters
    ----------
    nodes : ndarray of float32, shape (z, y, x)
        Distances from a surface, negative inside; periodic in y and x. [km]
    spacing : ndarray of float64, shape (3,)
        Of nodes along z, y and x. [km]
    """
    _along_x(nodes, float(spacing[2]))
    _along_y(nodes, float(spacing[1]))
    _along_z(nodes, float(spacing[0]))


@kernel
def _along_x(nodes, step):
    levels, rows, columns = nodes.shape
    for k in range(levels):
        for j in range(rows):
            row = nodes[k, j]
            # Twice around, since the first node's neighbours are not limited yet.
            for n in range(1, 2 * columns):
                i, before = n % columns, (n - 1) % columns
                row[i] = _limited(row[i], row[before], step)
            for n in range(2 * columns - 2, -1, -1):
                i, after = n % columns, (n + 1) % columns
                row[i] = _limited(row[i], row[after], step)


@kernel
def _along_y(nodes, step):
    levels, rows, columns = nodes.shape
    for k in range(levels):
        for n in range(1, 2 * rows):
            j, before = n % rows, (n - 1) % rows
            for i in range(columns):
                nodes[k, j, i] = _limited(nodes[k, j, i], nodes[k, before, i], step)
        for n in range(2 * rows - 2, -1, -1):
            j, after = n % rows, (n + 1) % rows
            for i in range(columns):
                nodes[k, j, i] = _limited(nodes[k, j, i], nodes[k, after, i], step)


@kernel
def _along_z(nodes, step):
    levels, rows, columns = nodes.shape
    for k in range(1, levels):
        for j in range(rows):
            for i in range(columns):
                nodes[k, j, i] = _limited(nodes[k, j, i], nodes[k - 1, j, i], step)
    for k in range(levels - 2, -1, -1):
        for j in range(rows):
            for i in range(columns):
                nodes[k, j, i] = _limited(nodes[k, j, i], nodes[k + 1, j, i], step)


@kernel
def _limited(value, neighbour, step):
    return max(min(value, max(neighbour, 0.0) + step), min(neighbour, 0.0) - step)
