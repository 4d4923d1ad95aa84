"""How clouds lie on the sphere.

Places are in a frame whose origin is on the ground under the observer: x runs east, y north, z up.
"""

from __future__ import annotations

import math

from skybake.cloud_fields.clearance import surface_clearance
from skybake.cloud_fields.patches import (
    erosion_of,
    matters,
    nearest_shift,
    patch_shift,
    patches_around,
    room_within,
)
from skybake.cloud_fields.surface import surface_detail, surface_distance
from skybake.jit.kernel import inlined_kernel, kernel

_LOWEST = 0.05
"""Share of the radius above the planet's centre from where on down a tile of voxels is not narrowed
any further: far beyond what an observer sees."""

_FARTHEST = 0.02
"""The same of the square of half the angle's cosine, for drawn clouds: close to the antipode."""


@kernel
def chart_scale(field, radius, x, y, z):
    """By what a place's x and y are multiplied for those of the plane.

    Voxels of a file are projected from the planet's centre to the plane that touches it under the
    observer; drawn clouds such that areas are kept, after Lambert.
    """
    if field.patch == 0.0:
        return radius / max(radius + z, _LOWEST * radius)
    above = radius + z
    r = math.sqrt(x * x + y * y + above * above)
    return radius * math.sqrt(2.0 / (r * max(r + above, 2.0 * _FARTHEST * r)))


@kernel
def chart_stretch(field, radius, x, y, z):
    """Kilometres of the plane that a kilometre may cross at a place, at most; at least 1."""
    scale = chart_scale(field, radius, x, y, z)
    if field.patch == 0.0:
        height = max(radius + z, _LOWEST * radius)
        return max(1.0, scale * math.sqrt(1.0 + (x * x + y * y) / (height * height)))
    return max(1.0, scale)


@kernel
def plane_place(field, radius, x, y, z):
    """Coordinates of a place on the plane, with the field's origin under the observer. [km]"""
    scale = chart_scale(field, radius, x, y, z)
    return field.origin[0] + x * scale, field.origin[1] + y * scale


@kernel
def tile_place(field, radius, x, y, z):
    """Coordinates of the tile at a place; lines through the planet's centre keep theirs. [km]

    Of patches of the tile it is the one that the place lies in.

    Parameters
    ----------
    field : CloudField
        The layer.
    radius : float
        Of the ground. [km]
    x, y, z : float
        The place. [km]

    Returns
    -------
    x, y : float
        For `skybake.cloud_fields.field.extinction_at`; only other kernels can take them.
    """
    x, y = plane_place(field, radius, x, y, z)
    if field.patch == 0.0:
        return x, y
    east, north = nearest_shift(field, x, y)
    return x + east, y + north


@kernel
def cloud_place(field, radius, x, y, z, altitude, blur):
    """Coordinates of the tile whose cloud is nearest to a place, or which it lies in.

    Parameters
    ----------
    field, radius, x, y, z
        As `tile_place` takes them.
    altitude, blur : float
        As `skybake.cloud_fields.field.extinction_at` takes them.

    Returns
    -------
    x, y, erosion : float
        For `skybake.cloud_fields.field.extinction_at`. [km]
    room : float
        Distance on the plane within which no other patch has clouds. [km]
    """
    x, y = plane_place(field, radius, x, y, z)
    around = shares_around(field, x, y)
    east, north, room = lone_patch(field, around)
    if room > 0.0:
        return x + east, y + north, 0.0, room
    detail = surface_detail(field, blur)
    east, north, erosion, room, _ = shared_place(field, around, x, y, altitude, blur, detail)
    return x + east, y + north, erosion, room


@kernel
def shares_around(field, x, y):
    """Return what `patches_around` does; a tile that repeats to all sides has a single patch."""
    if field.patch == 0.0:
        return 0, 0, 1.0, 0, 0, 0.0, 0, 0, 0.0
    return patches_around(field, x, y)


@kernel
def lone_patch(field, around):
    """Shift of the tile in the midst of some patches, and the distance within which it is the same.

    The distance is 0 where several of them may have clouds; they are those of `shares_around`. [km]
    """
    if field.patch == 0.0:
        return 0.0, 0.0, math.inf
    ai, aj, a, bi, bj, b, ci, cj, c = around
    if b > a:
        ai, aj, a, bi, bj, b = bi, bj, b, ai, aj, a
    if c > a:
        ai, aj, a, ci, cj, c = ci, cj, c, ai, aj, a
    other = max(b, c)
    if matters(other, a):
        return 0.0, 0.0, 0.0
    east, north = patch_shift(field, ai, aj)
    return east, north, room_within(field, other, a)


@inlined_kernel
def shared_place(field, around, x, y, altitude, blur, detail):
    """Find the nearest cloud at a place of the plane where several patches may have some.

    Returns
    -------
    east, north : float
        Shift of the tile in the patch of that cloud. [km]
    erosion, room : float
        As of `cloud_place`. [km]
    number : int
        Of the patch, among those around.
    """
    ai, aj, a, bi, bj, b, ci, cj, c = around
    most = max(a, b, c)
    # Beyond the three there are others, whose shares are 0 here.
    room = room_within(field, 0.0, most)
    nearest, erosion, number = math.inf, 0.0, 0
    east = north = clear = 0.0
    for n in range(3):
        if n == 0:
            i, j, share, other = ai, aj, a, max(b, c)
        elif n == 1:
            i, j, share, other = bi, bj, b, max(a, c)
        else:
            i, j, share, other = ci, cj, c, max(a, b)
        if not matters(share, most):
            room = min(room, room_within(field, share, most))
            continue
        dx, dy = patch_shift(field, i, j)
        free = surface_clearance(field, x + dx, y + dy, altitude, blur, detail)
        if free > 0.0:
            if nearest == math.inf and share == most:
                east, north, erosion = dx, dy, erosion_of(field, share, other)
                number = n
            room = min(room, free)
            continue
        eroded = erosion_of(field, share, other)
        distance = surface_distance(field, x + dx, y + dy, altitude, detail) + eroded
        if distance < nearest:
            room = min(room, clear) if nearest < math.inf else room
            nearest, erosion, clear, number = distance, eroded, free, n
            east, north = dx, dy
        else:
            room = min(room, free)
    return east, north, erosion, room, number


@kernel
def patch_of(around, number):
    """Row and column of one of the patches around a place."""
    ai, aj, _, bi, bj, _, ci, cj, _ = around
    if number == 0:
        return aj, ai
    if number == 1:
        return bj, bi
    return cj, ci


@kernel
def erosion_in(field, around, row, column):
    """How far surfaces of a patch are moved inward where these patches are around. [km]"""
    ai, aj, a, bi, bj, b, ci, cj, c = around
    if ai == column and aj == row:
        return erosion_of(field, a, max(b, c))
    if bi == column and bj == row:
        return erosion_of(field, b, max(a, c))
    if ci == column and cj == row:
        return erosion_of(field, c, max(a, b))
    return erosion_of(field, 0.0, max(a, b, c))
