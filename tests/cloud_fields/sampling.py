"""Kernels of fields, made callable from Python for many points."""

import math

import numpy as np

from skybake.cloud_fields.chart import cloud_place
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


@kernel
def _fill_on_sphere(field, radius, points, blur, values, free):
    for n in range(points.shape[0]):
        px, py, altitude = points[n, 0], points[n, 1], points[n, 2]
        # From the plane back onto the sphere, up along the vertical of the place.
        across = math.sqrt(px * px + py * py) / radius
        sine = across * math.sqrt(max(1.0 - 0.25 * across * across, 0.0))
        scale = (radius + altitude) / radius * (sine / across if across > 0.0 else 1.0)
        px, py = px * scale, py * scale
        pz = (radius + altitude) * (1.0 - 0.5 * across * across) - radius
        x, y, erosion, room = cloud_place(field, radius, px, py, pz, altitude, blur)
        values[n] = extinction_at(field, x, y, altitude, blur, erosion)
        free[n] = min(clearance_at(field, x, y, altitude, blur), room)


def on_plane(field, points, blur=0.0, radius=6360.0):
    """Extinction and clearance at points of the plane, shape (point, 3) as x, y, altitude."""
    values, free = np.empty(len(points)), np.empty(len(points))
    points = np.ascontiguousarray(points, np.float64)
    _fill_on_sphere(field, radius, points, blur, values, free)
    return values, free


def plane_depths(field, points, levels=16, radius=6360.0):
    """Vertical optical depths at points of the plane, shape (point, 2)."""
    step = (field.top - field.base) / levels
    total = np.zeros(len(points))
    for level in range(levels):
        altitude = np.full(len(points), field.base + (level + 0.5) * step)
        total += on_plane(field, np.column_stack([points, altitude]), radius=radius)[0]
    return total * step
