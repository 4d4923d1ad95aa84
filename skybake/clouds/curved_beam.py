"""The sun's beam through a layer of voxels that follows the planet's curvature."""

from __future__ import annotations

import math

import numpy as np

from skybake.clouds.beam import gather_plane, mean_passing, scatter_plane
from skybake.jit.kernel import kernel
from skybake.transport.exponential import fast_exp32

DARK = np.float32(14.0)
"""Optical depth beyond which a beam is not followed."""

PARTS_BETWEEN = 8
"""After how many parts of the way a plane of rays is looked at, whether all are dark."""


@kernel
def fill_curved_beam(
    extinction, spacing, radius, x, y, z, ray, met, mean, leaving
):  # fmt: skip
    """Write the mean of a low sun's beam in each voxel, and what leaves at either face.

    Parameters
    ----------
    extinction, spacing, x, y, ray, met, mean
        As of `skybake.clouds.beam.fill_beam`.
    radius : float
        Of the sphere on which the layer lies. [km]
    z : float
        Of the unit vector toward the sun, at every place of the layer.
    leaving : ndarray of float32, shape (2, y, x)
        Receives what reaches the air beneath the layer, and that above it. The light of a sun below
        the horizontal comes beneath where it has crossed the layer far away, and stands as high
        above the horizontal; that of a sun above it comes whole to what is above.

    Notes
    -----
    Toward the sun a ray rises against the layer by s^2 / 2R over a distance s, so that even a sun
    on the horizontal is at the end of a finite way. A sun below the horizontal lights a voxel from
    the base, clear as if no clouds were farther on, as far as rays go down to there; of the rest
    of the voxel, whose rays pass their lowest point within the layer, the way is followed to the
    top. Each level has rays of its own, one for each voxel of its plane.
    """
    levels, rows, columns = extinction.shape
    thickness = spacing[0]
    # How far below itself a ray to a sun below the horizontal comes.
    dip = 0.5 * radius * z * z if z < 0.0 else 0.0
    for k in range(levels):
        _fill(mean[k], 0.0)
        low = k * thickness
        under = min(max((dip - low) / thickness, 0.0), 1.0)
        if under > 0.0:
            place = low + _mean_height(radius, z, -under * thickness)
            begin = _distance_down(radius, z, place - low)
            _fill(ray, 0.0)
            _follow(extinction, spacing, radius, x, y, z, place, k - 1, begin, ray, met)
            length = _distance_down(radius, z, under * thickness)
            _cross(extinction[k], spacing, radius, x, y, z, length, under, True, ray, met, mean[k])
        if under < 1.0:
            place = low + thickness - _mean_height(radius, z, (1.0 - under) * thickness)
            begin = _distance_up(radius, z, low + thickness - place)
            _fill(ray, 0.0)
            _follow(extinction, spacing, radius, x, y, z, place, k + 1, begin, ray, met)
            length = _distance_up(radius, z, (1.0 - under) * thickness)
            _cross(
                extinction[k], spacing, radius, x, y, z, length, 1.0 - under, False, ray, met,
                mean[k],
            )  # fmt: skip
    _fill(ray, 0.0)
    _follow(extinction, spacing, radius, x, y, abs(z), 0.0, 0, 0.0, ray, met)
    for j in range(rows):
        for i in range(columns):
            leaving[0, j, i] = math.exp(-ray[j, i])
    _fill(ray, 0.0)
    if z < 0.0:
        _follow(extinction, spacing, radius, x, y, z, levels * thickness, levels - 1, 0.0, ray, met)
    for j in range(rows):
        for i in range(columns):
            leaving[1, j, i] = math.exp(-ray[j, i])


@kernel
def _distance_up(radius, z, height):
    """Distance toward the sun at which a ray is so far above its place, for the last time."""
    return math.sqrt(radius * radius * z * z + 2.0 * radius * height) - radius * z


@kernel
def _distance_down(radius, z, depth):
    """Distance toward a sun below the horizontal at which a ray is so far below its place."""
    return -radius * z - math.sqrt(max(radius * radius * z * z - 2.0 * radius * depth, 0.0))


@kernel
def _mean_height(radius, z, height):
    """Height of a ray toward the sun where it has come as far as others on average.

    They are rays that come to heights from 0 to the given one, all above or all below their places.
    """
    square = radius * radius * z * z
    end = max(square + 2.0 * radius * height, 0.0)
    root = (end * math.sqrt(end) - square * math.sqrt(square)) / (3.0 * radius * height)
    distance = -radius * z + (root if height > 0.0 else -root)
    return abs(_height(radius, z, distance))


@kernel
def _follow(extinction, spacing, radius, x, y, z, place, level, begin, depth, met):
    """Add optical depths of rays toward the sun, from a level on until they leave the layer.

    Parameters
    ----------
    place : float
        Height above the base of the place that the rays come from. [km]
    level : int
        Which they enter at first.
    begin : float
        Distance from their place where they do. [km]
    depth : ndarray of float32, shape (y, x)
        By where rays are at `begin`.
    """
    levels = extinction.shape[0]
    thickness = spacing[0]
    falls = z < 0.0 and begin < -radius * z
    at, k, count = begin, level, 0
    while 0 <= k < levels:
        to_face = place - k * thickness
        if falls and radius * z * z > 2.0 * to_face:
            end, after = _distance_down(radius, z, to_face), k - 1
        else:
            falls = False
            end, after = _distance_up(radius, z, thickness - to_face), k + 1
        length = max(end - at, 0.0)
        parts = _parts(spacing, x, y, length)
        step = np.float32(length / parts)
        for part in range(parts):
            s = at - begin + (part + 0.5) / parts * length
            gather_plane(extinction[k], x * s / spacing[2], y * s / spacing[1], met)
            for j in range(depth.shape[0]):
                for i in range(depth.shape[1]):
                    depth[j, i] += met[j, i] * step
            count += 1
            if count % PARTS_BETWEEN == 0 and _least(depth) > DARK:
                return
        at, k = end, after


@kernel
def _cross(plane, spacing, radius, x, y, z, length, share, is_below, ray, met, mean):
    """Add the mean beam in a plane of voxels, which it enters with optical depths of `ray`.

    Places at equal distances along the rays stand for unequal parts of the voxels' height.
    """
    rows, columns = ray.shape
    least = _least(ray)
    if least > DARK:
        return
    for j in range(rows):
        for i in range(columns):
            ray[j, i] = fast_exp32(-ray[j, i])
    parts = _parts(spacing, x, y, length)
    step = length / parts
    whole = abs(_height(radius, z, length))
    reached = 0.0
    for part in range(parts):
        height = _height(radius, z, (part + 1) * step)
        height = max(-height if is_below else height, 0.0)
        weight = np.float32(share * max(height - reached, 0.0) / max(whole, 1e-12))
        reached = max(height, reached)
        s = (part + 0.5) * step
        gather_plane(plane, -x * s / spacing[2], -y * s / spacing[1], met)
        brightest = np.float32(0.0)
        for j in range(rows):
            for i in range(columns):
                depth = met[j, i] * np.float32(step)
                passes = fast_exp32(-depth)
                met[j, i] = weight * ray[j, i] * mean_passing(depth, passes)
                ray[j, i] *= passes
                brightest = max(brightest, ray[j, i])
        if weight > 0.0:
            scatter_plane(met, -x * s / spacing[2], -y * s / spacing[1], mean)
        if brightest < 1e-6:
            return


@kernel
def _height(radius, z, distance):
    """Height above its place of a ray toward the sun."""
    return distance * (z + 0.5 * distance / radius)


@kernel
def _parts(spacing, x, y, length):
    across = math.hypot(x / spacing[2], y / spacing[1]) * length
    return max(1, math.ceil(across))


@kernel
def _least(plane):
    least = plane[0, 0]
    for j in range(plane.shape[0]):
        for i in range(plane.shape[1]):
            least = min(least, plane[j, i])
    return least


@kernel
def _fill(plane, value):
    for j in range(plane.shape[0]):
        for i in range(plane.shape[1]):
            plane[j, i] = value
