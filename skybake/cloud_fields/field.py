"""The extinction of a cloud layer at any point."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.clearance import surface_clearance, voxel_clearance
from skybake.cloud_fields.surface import surface_around, surface_detail, surface_extinction
from skybake.cloud_fields.voxels import linear_extinction, voxel_extinction
from skybake.jit.kernel import inlined_kernel, kernel

CONSTANT, LINEAR, SURFACE = 0, 1, 2
"""How values lie between nodes: voxels that are uniform, extinction that is linear between the
voxels' centres, and a signed distance from the surface of clouds, linear between nodes."""


class CloudField(NamedTuple):
    """A layer of clouds on a tile, with which the plane is covered.

    Fields of every kind have the same types, so that one compiled kernel serves them all.

    Attributes
    ----------
    kind : int
        `CONSTANT`, `LINEAR` or `SURFACE`.
    values : ndarray of float32, shape (z, y, x)
        Extinction of voxels, a single 0 for a surface. x runs east, y north, z up; x and y are
        periodic. [km⁻¹]
    distance : ndarray of int16, shape (z, y, x)
        From the surface, negative inside, at nodes, which lie at the lower faces of what would
        be voxels, with one plane more than these in z; a single 0 for voxels. [`STEP`]
    spacing : ndarray of float64, shape (3,)
        Of nodes or voxels along z, y and x. [km]
    period : ndarray of float64, shape (2,)
        After which the field repeats along x and y. [km]
    origin : ndarray of float64, shape (2,)
        The tile's coordinates x and y under the observer's feet. [km]
    base, top : float
        Altitudes between which there may be clouds. [km]
    extinction : ndarray of float64, shape (z,)
        Inside a surface, at the nodes' heights; a single 0 for voxels. [km⁻¹]
    edge, widest_edge : float
        Distance over which extinction falls from all to nothing at a surface, where all details
        are resolved and where few are. [km]
    condensation : float
        Altitude below which there is nothing inside a surface. [km]
    shift : ndarray of float64, shape (n,)
        By which a surface is moved outward so that blur keeps its mean extinction; of a blur
        that grows with the square of the index up to `largest_blur`. [km]
    largest_blur : float
        Beyond which nothing changes. [km]
    displacement : ndarray of float64, shape (noise, 9)
        By which the surface is displaced: of each noise the amplitude [km]; how many of its
        periods lie along x and y, first for its own x, then for its y, and along z for its z
        [km⁻¹]; and the shift of its x, y and z [periods]. Whole periods fit into the tile.
    noise : ndarray of int8, shape (n, n, n)
        Periodic, of zero mean, from -127 to 127 for -1 to 1.
    clearance : ndarray of float32, shape (z, y, x)
        Distance within which there is no cloud around any point of a block. [km]
    block : ndarray of float64, shape (3,)
        Size of a block along z, y and x. [km]
    near_clearance : ndarray of uint8, shape (z, y, x)
        The same around any point between nodes, where blur is at most `near_blur`; a single 0
        for voxels. [`near_unit`]
    near_unit, near_blur : float
        [km]
    patch : float
        Distance between the middles of neighbouring patches of the plane, each of which holds
        the tile somewhere else; 0 where it repeats to all sides. [km]
    shifts : ndarray of float64, shape (row, column, 2)
        By what the tile is shifted in patches. [km]
    erosion, vanishing : float
        How far the surface is moved inward on the edge of two patches, which keeps the mean
        extinction there; and where nothing is left of clouds. [km]
    """

    kind: int
    values: npt.NDArray[np.float32]
    distance: npt.NDArray[np.int16]
    spacing: npt.NDArray[np.float64]
    period: npt.NDArray[np.float64]
    origin: npt.NDArray[np.float64]
    base: float
    top: float
    extinction: npt.NDArray[np.float64]
    edge: float
    widest_edge: float
    condensation: float
    shift: npt.NDArray[np.float64]
    largest_blur: float
    displacement: npt.NDArray[np.float64]
    noise: npt.NDArray[np.int8]
    clearance: npt.NDArray[np.float32]
    block: npt.NDArray[np.float64]
    near_clearance: npt.NDArray[np.uint8]
    near_unit: float
    near_blur: float
    patch: float
    shifts: npt.NDArray[np.float64]
    erosion: float
    vanishing: float


@kernel
def extinction_at(field, x, y, altitude, blur, erosion=0.0):
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
    erosion : float, optional
        By which a surface is moved inward. [km]
    """
    return detailed_extinction(field, x, y, altitude, detail_at(field, blur), erosion)


@kernel
def clearance_at(field, x, y, altitude, blur):
    """Distance around a point within which there is no cloud, 0 or less if there may be one. [km]

    Distances are those of the tile, flat; parameters are those of `extinction_at`. It holds
    with any erosion.
    """
    return detailed_clearance(field, x, y, altitude, blur, detail_at(field, blur))


@kernel
def detail_at(field, blur):
    """Return what `detailed_extinction` and `detailed_clearance` need to know for a blur. [km]"""
    if field.kind == SURFACE:
        return surface_detail(field, blur)
    return 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0


@inlined_kernel
def detailed_extinction(field, x, y, altitude, detail, erosion=0.0):
    """Extinction at one of several points whose blur is the same, see `extinction_at`. [km⁻¹]"""
    if field.kind == SURFACE:
        return surface_extinction(field, x, y, altitude, detail, erosion)
    if field.kind == CONSTANT:
        return voxel_extinction(field, x, y, altitude)
    return linear_extinction(field, x, y, altitude)


@inlined_kernel
def detailed_around(field, x, y, altitude, detail, erosion):
    """Return the extinction at a point and how far clouds are from it, see `surface_around`."""
    if field.kind == SURFACE:
        return surface_around(field, x, y, altitude, detail, erosion)
    return detailed_extinction(field, x, y, altitude, detail, erosion), 0.0


@inlined_kernel
def detailed_clearance(field, x, y, altitude, blur, detail):
    """Clearance with the detail of a blur, see `clearance_at`. [km]"""
    if field.kind == SURFACE:
        return surface_clearance(field, x, y, altitude, blur, detail)
    return voxel_clearance(field, x, y, altitude)
