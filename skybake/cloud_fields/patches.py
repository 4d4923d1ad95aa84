"""Patches of the plane, each of which holds the tile somewhere else, so that no lattice shows.

Patches are about as large as the tile and have bent edges. Toward an edge the surfaces of clouds
are eroded, those of one patch more and of the other less: clouds are small there, none is cut.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel

PATCHES = 64
"""Along each axis, after which their shifts repeat; a power of two."""

SIZE = 0.95
"""Distance between the middles of neighbours, in the period of the tile."""

_EDGE = 0.16
"""Shares of two patches in a place differ by less than this near their common edge."""

_MARGIN = 0.03
"""By how much farther than that clouds of other patches are taken into account."""

_BEND, _LENGTH = 0.12, 1.9
"""Amplitude and length of the waves of edges, in the distance of middles."""

_ROWS = 0.5 * math.sqrt(3.0)

_WAVE = 2.0 * math.pi * _BEND / _LENGTH
_STRETCH = (0.5 * _WAVE + math.sqrt(1.0 + 0.25 * _WAVE**2)) ** 2
"""By how much waves along both axes stretch a distance at most."""


def patch_shifts(period: npt.NDArray[np.float64], seed: int) -> npt.NDArray[np.float64]:
    """Return by what tiles are shifted in patches, shape (`PATCHES`, `PATCHES`, 2). [km]

    The first patch has the tile where it is.
    """
    shifts = np.random.default_rng([seed, 15]).random((PATCHES, PATCHES, 2)) * period
    shifts[0, 0] = 0.0
    return shifts


@kernel
def patch_shift(field, i, j):
    """Shift of the tile in a patch. [km]"""
    row = field.shifts[j & (PATCHES - 1), i & (PATCHES - 1)]
    return row[0], row[1]


@kernel
def patches_around(field, x, y):
    """Return the three patches nearest to a place of the plane, and their shares, which add to 1.

    Returns
    -------
    i, j, share, i, j, share, i, j, share
        Of each.
    """
    size = field.patch
    wave = 2.0 * math.pi / (_LENGTH * size)
    x += _BEND * size * math.sin(wave * y)
    y += _BEND * size * math.sin(wave * x)
    # Triangles between the middles of patches; shares are those of a point between its corners.
    q = y / (_ROWS * size)
    p = x / size - 0.5 * q
    i, j = math.floor(p), math.floor(q)
    p -= i
    q -= j
    i, j = int(i), int(j)
    if p + q < 1.0:
        return i, j, 1.0 - p - q, i + 1, j, p, i, j + 1, q
    return i + 1, j + 1, p + q - 1.0, i + 1, j, 1.0 - q, i, j + 1, 1.0 - p


@kernel
def nearest_shift(field, x, y):
    """Shift of the tile in the patch that a place lies in. [km]"""
    ai, aj, a, bi, bj, b, ci, cj, c = patches_around(field, x, y)
    if b > a and b >= c:
        return patch_shift(field, bi, bj)
    if c > a:
        return patch_shift(field, ci, cj)
    return patch_shift(field, ai, aj)


@kernel
def matters(share, most):
    """Whether a patch may have clouds at or near a place where another's share is `most`."""
    return share > most - _EDGE - _MARGIN


@kernel
def room_within(field, share, most):
    """Distance within which a patch that does not matter has no clouds. [km]"""
    return 0.5 * field.patch / _STRETCH * (most - _EDGE - share)


@kernel
def erosion_of(field, share, other):
    """How far surfaces of a patch are moved inward where the largest share of others is `other`.

    `vanishing` or more where the patch has no clouds. [km]
    """
    return erosion_at(field, (other - share) / _EDGE)


@kernel
def erosion_at(field, across):
    """How far surfaces are moved inward at a place across an edge. [km]

    All is left at -1, and nothing at 1; at 0 two patches have equal shares.
    """
    if across <= -1.0:
        return 0.0
    if across <= 0.0:
        return field.erosion * (1.0 + across) ** 2
    return field.erosion + (field.vanishing - field.erosion) * across**3
