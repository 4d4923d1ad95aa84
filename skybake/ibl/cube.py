"""Cubes of radiance in memory: their directions, their sizes, and coarser ones of the same light.

A cube is an array of float32, shape (6, edge, edge, 3): faces in the order and orientation of
`skybake.projection.cubemap`, whose texels look in the world's own directions.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from skybake.projection.cubemap import FACES, SPACES, face_directions, solid_angles

Array = npt.NDArray[np.float64]
Cube = npt.NDArray[np.float32]

COARSEST = 2
"""Edge of the last level of a pyramid. [pixel]"""

_KEPT = 16


@lru_cache(_KEPT)
def texel_directions(edge: int) -> Cube:
    """Return unit vectors of all texels, shape (6, edge, edge, 3)."""
    vectors = np.stack([face_directions(face, edge) for face in FACES]).astype(np.float32)
    vectors.flags.writeable = False
    return vectors


@lru_cache(_KEPT)
def texel_sizes(edge: int) -> Array:
    """Return the solid angles of a face's texels, shape (edge, edge); six make 4 pi. [sr]"""
    sizes = solid_angles(edge)
    sizes.flags.writeable = False
    return sizes


def coarser(cube: Cube, edge: int) -> Cube:
    """Return the cube at a smaller size: means over solid angle, so that no light is lost.

    Parameters
    ----------
    cube : ndarray of float32, shape (6, n, n, channel)
        The light.
    edge : int
        A divisor of n. [pixel]
    """
    size = cube.shape[1]
    if size == edge:
        return cube
    factor = size // edge
    sizes = texel_sizes(size)
    blocks = (6, edge, factor, edge, factor, cube.shape[3])
    light = (cube * sizes[..., None].astype(np.float32)).reshape(blocks)
    total = sizes.reshape(edge, factor, edge, factor).sum(axis=(1, 3))
    mean: Cube = (light.sum(axis=(2, 4), dtype=np.float64) / total[..., None]).astype(np.float32)
    return mean


def pyramid(cube: Cube) -> list[Cube]:
    """Return the cube and all coarser ones, each of half the edge, down to `COARSEST`."""
    levels = [cube]
    while levels[-1].shape[1] > COARSEST:
        levels.append(coarser(levels[-1], levels[-1].shape[1] // 2))
    return levels


def with_borders(cube: Cube) -> Cube:
    """Return faces with a border of the texels beyond their edges, shape (6, n + 2, n + 2, 3).

    Between texel centres on both sides of an edge light is then interpolated from the same
    four texels, and at a corner from the same three: no seam shows.
    """
    edge = cube.shape[1]
    padded = np.empty((6, edge + 2, edge + 2, cube.shape[3]), np.float32)
    padded[:, 1:-1, 1:-1] = cube
    face, row, column = _beyond(edge)
    padded[:, 0, 1:-1] = cube[face[:, 0], row[:, 0], column[:, 0]]
    padded[:, -1, 1:-1] = cube[face[:, 1], row[:, 1], column[:, 1]]
    padded[:, 1:-1, 0] = cube[face[:, 2], row[:, 2], column[:, 2]]
    padded[:, 1:-1, -1] = cube[face[:, 3], row[:, 3], column[:, 3]]
    for y, inner_y in ((0, 1), (-1, -2)):
        for x, inner_x in ((0, 1), (-1, -2)):
            three = padded[:, y, inner_x] + padded[:, inner_y, x] + padded[:, inner_y, inner_x]
            padded[:, y, x] = three / np.float32(3.0)
    return padded


def in_space(cube: Cube, space: str) -> Cube:
    """Return the faces as a cube in another space holds them, see `skybake.projection.cubemap`."""
    signs = np.array(SPACES[space])
    if (signs == 1).all():
        return cube
    edge = cube.shape[1]
    return np.ascontiguousarray(cube[places(texel_directions(edge) * signs, edge)])


def places(vectors: Array, edge: int) -> tuple[npt.NDArray[np.intp], ...]:
    """Return face, row and column of the texels that directions, shape (..., 3), fall in."""
    size = np.abs(vectors)
    axis = np.argmax(size, axis=-1)
    x, y, z = np.moveaxis(vectors, -1, 0)
    is_negative = np.take_along_axis(vectors, axis[..., None], -1)[..., 0] < 0.0
    sign = np.where(is_negative, -1.0, 1.0)
    right = np.select([axis == 0, axis == 1], [-sign * z, x], sign * x)
    down = np.select([axis == 0, axis == 1], [-y, sign * z], -y)
    largest = np.take_along_axis(size, axis[..., None], -1)[..., 0]
    row, column = (
        np.clip(np.floor((0.5 * along / largest + 0.5) * edge), 0, edge - 1).astype(np.intp)
        for along in (down, right)
    )
    return 2 * axis + is_negative, row, column


@lru_cache(_KEPT)
def _beyond(edge: int) -> tuple[npt.NDArray[np.intp], ...]:
    """Face, row and column of the texels above, below, left and right of each face."""
    along = (2.0 * np.arange(edge) + 1.0) / edge - 1.0
    past = np.full(edge, 1.0 + 1e-6)
    around = [(along, -past), (along, past), (-past, along), (past, along)]
    vectors = np.empty((6, 4, edge, 3))
    corners = {face: face_directions(face, 1)[0, 0] for face in FACES}
    for i, face in enumerate(FACES):
        forward = corners[face]
        right, down = _axes(face)
        for side, (u, v) in enumerate(around):
            vectors[i, side] = forward + u[:, None] * right + v[:, None] * down
    return places(vectors, edge)


def _axes(face: str) -> tuple[Array, Array]:
    """Return unit vectors to the right of a face and down it."""
    four = face_directions(face, 2)
    right, down = four[0, 1] - four[0, 0], four[1, 0] - four[0, 0]
    return right / np.linalg.norm(right), down / np.linalg.norm(down)
