"""Kernels of fields, made callable from Python for many points."""

import numpy as np

from skybake.cloud_fields.field import clearance_at, extinction_at
from skybake.jit.kernel import kernel


@kernel
def _fill_extinction(field, points, blur, values):
    for n in range(points.shape[0]):
        values[n] = extinction_at(field, points[n, 0], points[n, 1], points[n, 2], blur)


@kernel
def _fill_clearance(field, points, blur, values):
    for n in range(points.shape[0]):
        values[n] = clearance_at(field, points[n, 0], points[n, 1], points[n, 2], blur)


def extinction(field, points, blur=0.0):
    """Extinction at points of the tile, shape (point, 3) as x, y, altitude."""
    values = np.empty(len(points))
    _fill_extinction(field, np.ascontiguousarray(points, np.float64), blur, values)
    return values


def clearance(field, points, blur=0.0):
    """Clearance at such points."""
    values = np.empty(len(points))
    _fill_clearance(field, np.ascontiguousarray(points, np.float64), blur, values)
    return values


def random_points(field, count, seed=1):
    """Points within the tile and its layer, and a little outside of the latter."""
    unit = np.random.default_rng(seed).random((count, 3))
    height = field.top - field.base
    low = np.array([0.0, 0.0, field.base - 0.1 * height])
    return low + unit * [*field.period, 1.2 * height]


def column_depths(field, count, levels=70):
    """Vertical optical depths of a square of columns, by another rule than the engine's."""
    x, y = ((np.arange(count) + 0.5) / count * period for period in field.period)
    step = (field.top - field.base) / levels
    z = field.base + (np.arange(levels) + 0.5) * step
    points = np.stack(np.meshgrid(x, y, z, indexing="ij"), -1).reshape(-1, 3)
    return extinction(field, points).reshape(count, count, levels).sum(-1) * step
