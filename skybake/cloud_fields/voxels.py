"""Extinction between voxels of a file."""

from __future__ import annotations

import math

from skybake.jit.kernel import kernel


@kernel
def voxel_extinction(field, x, y, altitude):
    """Extinction of the voxel that holds a point. [km⁻¹]"""
    levels, rows, columns = field.values.shape
    k = math.floor((altitude - field.base) / field.spacing[0])
    if k < 0 or k >= levels:
        return 0.0
    j = math.floor(y / field.spacing[1]) % rows
    i = math.floor(x / field.spacing[2]) % columns
    return float(field.values[k, j, i])


@kernel
def linear_extinction(field, x, y, altitude):
    """Trilinear between centres; it falls to 0 within a voxel beyond the first and last plane.

    `base` and `top` of the field include that voxel's half. [km⁻¹]
    """
    levels, rows, columns = field.values.shape
    fz = (altitude - field.base) / field.spacing[0] - 1.0
    if fz <= -1.0 or fz >= levels:
        return 0.0
    fy, fx = y / field.spacing[1] - 0.5, x / field.spacing[2] - 0.5
    k, j, i = math.floor(fz), math.floor(fy), math.floor(fx)
    u, v, w = fx - i, fy - j, fz - k
    i, j = i % columns, j % rows
    east, north = (i + 1) % columns, (j + 1) % rows
    low = high = 0.0
    if k >= 0:
        plane = field.values[k]
        a = plane[j, i] + u * (plane[j, east] - plane[j, i])
        b = plane[north, i] + u * (plane[north, east] - plane[north, i])
        low = a + v * (b - a)
    if k + 1 < levels:
        plane = field.values[k + 1]
        a = plane[j, i] + u * (plane[j, east] - plane[j, i])
        b = plane[north, i] + u * (plane[north, east] - plane[north, i])
        high = a + v * (b - a)
    return low + w * (high - low)
