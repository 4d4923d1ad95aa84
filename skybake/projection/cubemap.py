"""Cubemaps whose texels look in the world's own directions.

Faces come in the order +X -X +Y -Y +Z -Z (east, west, up, down, south, north)
with row 0 at v = -1::

    px (1,-v,-u)  nx (-1,-v,u)  py (u,1,v)  ny (u,-1,-v)  pz (u,-v,1)  nz (-u,-v,-1)

That is what OpenGL, Vulkan and D3D sample with a world direction, and what
cmgen writes. Texel centres lie at (i + 1/2) / edge.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.projection.equirect import CELLS_PER_RADIUS, Array, Cells, cover, subdivide

FACES = ("px", "nx", "py", "ny", "pz", "nz")

# Right, up and forward of each face: direction = forward + u * right - v * up.
_FRAMES = {
    "px": ((0, 0, -1), (0, 1, 0), (1, 0, 0)),
    "nx": ((0, 0, 1), (0, 1, 0), (-1, 0, 0)),
    "py": ((1, 0, 0), (0, 0, -1), (0, 1, 0)),
    "ny": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    "pz": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "nz": ((-1, 0, 0), (0, 1, 0), (0, 0, -1)),
}

CROSS_ORIGINS = {"py": (0, 1), "nx": (1, 0), "pz": (1, 1), "px": (1, 2), "nz": (1, 3), "ny": (2, 1)}
"""Row and column, in edges, of each face in a horizontal cross of 3 by 4."""


def face_directions(face: str, edge: int, first: int = 0, last: int | None = None) -> Array:
    """Return unit vectors of the texels in rows first..last, shape (last - first, edge, 3)."""
    u = (2.0 * np.arange(edge) + 1.0) / edge - 1.0
    v = u[first : edge if last is None else last, None]
    return _face_vectors(face, *np.broadcast_arrays(u, v))


def zenith_bearing(directions: Array) -> tuple[Array, Array]:
    """Zenith angles and compass bearings of unit vectors, each of shape (...). [rad]"""
    x, y, z = np.moveaxis(directions, -1, 0)
    return np.arctan2(np.hypot(x, z), y), np.arctan2(x, -z)


def face_angles(face: str, edge: int, first: int, last: int) -> tuple[Array, Array]:
    """Angles of the texels in rows first..last, like `zenith_bearing` of `face_directions`.

    Returns
    -------
    zenith : ndarray of float64, shape (last - first, edge)
        [rad]
    bearing : ndarray of float64, shape (1, edge) or (last - first, edge)
        One row where the face stands upright, since its columns then do too. [rad]
    """
    u = ((2.0 * np.arange(edge) + 1.0) / edge - 1.0)[None]
    v = u[0, first:last, None]
    x, y, z = (
        forward + (right * u if right else 0.0) - (up * v if up else 0.0)
        for right, up, forward in zip(*_FRAMES[face], strict=True)
    )
    return np.arctan2(np.hypot(x, z), y), np.arctan2(x, -z)


def solid_angles(edge: int) -> Array:
    """Solid angles of a face's texels, shape (edge, edge); six faces make 4 pi. [sr]"""
    texel = np.arange(edge)
    return _texel_solid_angles(edge, texel[:, None], texel)


def openexr_face(face: str, rows: npt.NDArray[np.generic]) -> npt.NDArray[np.generic]:
    """Turn a face, shape (edge, edge, ...), the way OpenEXR's cube environment wants it.

    ImfEnvmap.cpp, CubeMap: X and Z faces are mirrored left to right against the
    order of this module, Y faces top to bottom.
    """
    return rows[::-1] if is_flipped_vertically(face) else rows[:, ::-1]


def is_flipped_vertically(face: str) -> bool:
    """Whether OpenEXR's cube holds a face upside down rather than mirrored."""
    return face in ("py", "ny")


def disc_cells(face: str, edge: int, zenith: float, bearing: float, radius: float) -> Cells:
    """Cut the part of a disc that falls on one face into cells.

    Parameters
    ----------
    face, edge : str, int
        Name and size of the face.
    zenith, bearing, radius : float
        Centre of the disc and its angular radius. [rad]

    Returns
    -------
    Cells
        Each adds to the one texel that it lies in; the other weights are 0.
        None if the disc misses the face.
    """
    right, up, forward = (np.array(axis, dtype=float) for axis in _FRAMES[face])
    centre = np.array(
        [
            math.sin(zenith) * math.sin(bearing),
            math.cos(zenith),
            -math.sin(zenith) * math.cos(bearing),
        ]
    )
    # Cells that the edge cuts may have their centres outside it.
    reach = radius * (1.0 + 2.0 / CELLS_PER_RADIUS)
    bounds = _disc_bounds(right @ centre, up @ centre, forward @ centre, reach)
    axes, widths = zip(
        *(subdivide(low + 1.0, high + 1.0, 2.0 / edge, radius, (0, edge)) for low, high in bounds),
        strict=True,
    )
    column, row = (grid.ravel() for grid in np.meshgrid(*axes))
    u, v = 2.0 * column / edge - 1.0, 2.0 * row / edge - 1.0
    vectors = _face_vectors(face, u, v)
    distance = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(vectors - centre, axis=-1), 1.0))
    size = widths[0] * widths[1] / (1.0 + u * u + v * v) ** 1.5
    distance, covered = cover(distance, radius, np.sqrt(size), size)
    inside = covered > 0.0
    texel = np.zeros((np.count_nonzero(inside), 4), np.int64)
    texel[:, 0] = row[inside].astype(np.int64) * edge + column[inside].astype(np.int64)
    weight = np.zeros(texel.shape)
    weight[:, 0] = 1.0 / _texel_solid_angles(edge, *np.divmod(texel[:, 0], edge))
    return Cells(
        zenith=zenith_bearing(vectors[inside])[0],
        distance=distance[inside],
        solid_angle=covered[inside],
        texel=texel,
        weight=weight,
    )


def _texel_solid_angles(
    edge: int, row: npt.NDArray[np.int64], column: npt.NDArray[np.int64]
) -> Array:
    u, v = 2.0 * column / edge - 1.0, 2.0 * row / edge - 1.0
    size: Array = (
        _corner_solid_angle(u + 2.0 / edge, v + 2.0 / edge)
        - _corner_solid_angle(u, v + 2.0 / edge)
        - _corner_solid_angle(u + 2.0 / edge, v)
        + _corner_solid_angle(u, v)
    )
    return size


def _corner_solid_angle(u: Array, v: Array) -> Array:
    """Solid angle of the rectangle from a face's centre to a corner, with its sign. [sr]"""
    area: Array = np.arctan2(u * v, np.sqrt(u * u + v * v + 1.0))
    return area


def _face_vectors(face: str, u: Array, v: Array) -> Array:
    right, up, forward = (np.array(axis, dtype=float) for axis in _FRAMES[face])
    vectors = forward + u[..., None] * right - v[..., None] * up
    unit: Array = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit


def _disc_bounds(
    x: float, y: float, z: float, radius: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Ranges of u and v that hold a disc around (x, y, z) of a face; empty if behind it."""
    # Beyond 60 deg from a face's centre a disc of up to 5 deg is on another face.
    if z < math.cos(math.atan(math.sqrt(2.0)) + radius):
        return (2.0, 2.0), (2.0, 2.0)
    reach = math.tan(radius) * (1.0 + (x * x + y * y) / (z * z)) * 1.1
    return (x / z - reach, x / z + reach), (-y / z - reach, -y / z + reach)
