"""The extinction of a cloud layer at any point."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel

CONSTANT, LINEAR, SURFACE = 0, 1, 2
"""How values lie between nodes: voxels that are uniform, extinction that is linear between the
voxels' centres, and a signed distance from the surface of clouds, linear between nodes."""


class CloudField(NamedTuple):
    """A layer of clouds that repeats to all sides.

    Attributes
    ----------
    kind : int
        `CONSTANT`, `LINEAR` or `SURFACE`.
    values : ndarray of float32, shape (z, y, x)
        Extinction of voxels [km⁻¹]; or distance from the surface, negative inside [km], with
        nodes at the lower faces of what would be voxels and one plane more than these in z. x
        runs east, y north, z up; x and y are periodic.
    spacing : ndarray of float64, shape (3,)
        Of nodes or voxels along z, y and x. [km]
    origin : ndarray of float64, shape (2,)
        The tile's coordinates x and y under the observer's feet. [km]
    base, top : float
        Altitudes between which there may be clouds. [km]
    floor : float
        Altitude of the lowest node, or of the lower face of the lowest voxels. [km]
    extinction : ndarray of float64, shape (z,)
        Inside a surface, at the nodes' heights; empty for voxels. [km⁻¹]
    edge : float
        Distance over which extinction falls from all to nothing at a surface. [km]
    displacement : ndarray of float64, shape (noise, 5)
        By which the surface is displaced: of each noise the amplitude, the period, and the shift
        of its x, y and z. [km]
    noise : ndarray of float32, shape (n, n, n)
        Periodic, of zero mean, between -1 and 1.
    """

    kind: int
    values: npt.NDArray[np.float32]
    spacing: npt.NDArray[np.float64]
    origin: npt.NDArray[np.float64]
    base: float
    top: float
    floor: float
    extinction: npt.NDArray[np.float64]
    edge: float
    displacement: npt.NDArray[np.float64]
    noise: npt.NDArray[np.float32]


@kernel
def extinction_at(field, x, y, altitude, blur):
    """Extinction at a point of the tile, whose details below `blur` are left out. [km⁻¹]

    Parameters
    ----------
    field : CloudField
        The layer.
    x, y : float
        Coordinates of the tile, `origin` included. [km]
    altitude : float
        Above the ground. [km]
    blur : float
        Size below which nothing needs to be resolved. [km]
    """
    if field.kind == CONSTANT:
        return _voxel(field, x, y, altitude)
    return _between_voxels(field, x, y, altitude)


@kernel
def clearance_at(field, x, y, altitude, blur):
    """Distance around a point within which there is no cloud, 0 or less if there may be one. [km]"""
    return 0.0


@kernel
def _voxel(field, x, y, altitude):
    levels, rows, columns = field.values.shape
    k = int(math.floor((altitude - field.floor) / field.spacing[0]))
    if k < 0 or k >= levels:
        return 0.0
    j = int(math.floor(y / field.spacing[1])) % rows
    i = int(math.floor(x / field.spacing[2])) % columns
    return float(field.values[k, j, i])


@kernel
def _between_voxels(field, x, y, altitude):
    """Trilinear between centres; extinction falls to 0 within a voxel beyond the first and last plane."""
    levels, rows, columns = field.values.shape
    fz = (altitude - field.floor) / field.spacing[0] - 0.5
    if fz <= -1.0 or fz >= levels:
        return 0.0
    fy, fx = y / field.spacing[1] - 0.5, x / field.spacing[2] - 0.5
    k, j, i = int(math.floor(fz)), int(math.floor(fy)), int(math.floor(fx))
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
