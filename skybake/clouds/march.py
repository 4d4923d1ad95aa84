"""What an observer sees of one layer of clouds."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.chart import (
    chart_stretch,
    erosion_in,
    lone_patch,
    patch_of,
    plane_place,
    shared_place,
    shares_around,
)
from skybake.cloud_fields.field import detail_at, detailed_around, detailed_clearance
from skybake.clouds.particles import TERMS
from skybake.clouds.source import fill_source, prepare_ray
from skybake.jit.kernel import inlined_kernel, kernel
from skybake.optics.medium import Array
from skybake.transport.exponential import fast_exp

NOT_PREPARED = -1.0

FARTHEST = 600.0
"""Length of a ray within a layer, beyond which it is not followed. [km]"""

OPAQUE = 0.01
"""Transmittance below which nothing behind is seen."""

BRIGHT = 0.4
"""Share of a ray's light that is still to come above which each step looks light up."""

SHARED = 0.08
"""Share of a ray's light whose steps, thereafter, have one look between them."""

SIMILAR = 1.02
"""Ratio of blurs that are not told apart."""

LEVELS = 12
"""Steps in which a ray crosses a layer at least."""

NEAR = 2.0
"""Shortest steps within which there are clouds, so that it is not looked up how far they are."""

THINNEST = 0.02
"""Extinction below which there is no cloud. [km⁻¹]"""


class Marching(NamedTuple):
    """How finely rays are sampled.

    Attributes
    ----------
    depth : float
        Optical depth of a step, without forward peaks.
    shortest, longest : float
        Step where nothing is known; the longest within a cloud, so that none is passed over. [km]
    taps : int
        Samples of the detailed field on the first way to the sun; voxels of light tell the rest.
    reach : float
        Length of that way. [km]
    pixel : float
        Angle below which nothing needs to be resolved. [rad]
    """

    depth: float
    shortest: float
    longest: float
    taps: int
    reach: float
    pixel: float


class MarchScratch(NamedTuple):
    """Work space of `fill_march`; each thread needs its own."""

    corner: npt.NDArray[np.int64]
    weight: Array
    harmonic: Array
    toward: npt.NDArray[np.float32]
    moments: npt.NDArray[np.float32]
    source: Array
    truncated: Array
    peak: Array
    local: Array
    blend: Array


def allocate_march(channels: int, order: int) -> MarchScratch:
    """Make the work space for a number of channels and an order."""
    harmonics = (order + 1) ** 2
    return MarchScratch(
        corner=np.empty((8, 3), np.int64),
        weight=np.empty(8),
        harmonic=np.empty(harmonics),
        toward=np.empty(harmonics, np.float32),
        moments=np.empty(channels * harmonics, np.float32),
        source=np.zeros(channels),
        truncated=np.empty(channels),
        peak=np.empty((channels, TERMS)),
        local=np.empty((2, 3)),
        blend=np.empty((4, channels)),
    )


@kernel
def fill_march(
    field, light, radius, altitude, directions, ends, sun, marching, first, last, scratch,
    seen, through,
):  # fmt: skip
    """Follow rays through a layer.

    Parameters
    ----------
    field : CloudField
        The layer.
    light : LayerLight
        Its light.
    radius, altitude : float
        Of the ground, and of the observer above it. [km]
    directions : ndarray of float64, shape (ray, 3)
        x east, y north, z up.
    ends : ndarray of float64, shape (ray,)
        Distances beyond which nothing is seen. [km]
    sun : ndarray of float64, shape (3,)
        Toward the sun, in these axes.
    marching : Marching
        How finely.
    first, last : int
        Rays to follow.
    scratch : MarchScratch
        Work space.
    seen : ndarray of float32, shape (ray, channel)
        Receives the radiance, without the air between.
    through : ndarray of float32, shape (ray, 3)
        Receives the transmittance without forward peaks, which is that of what is behind; the true
        one, which is that of a sharp image; and the mean distance of what is seen, or 0. [km]

    Notes
    -----
    Midpoints of steps of equal optical depth; empty space is left out by its clearance, and close
    to clouds by the distance from their displaced surface. Sunlight
    that is scattered once is exact; that within forward peaks is followed as a series in the depth
    up to there (`Particles`); the rest comes from the moments of diffuse light.
    """
    channels = seen.shape[1]
    keep = 1.0 - light.fraction
    for n in range(first, last):
        for c in range(channels):
            seen[n, c] = 0.0
        through[n, 0] = through[n, 1] = 1.0
        through[n, 2] = 0.0
        dx, dy, dz = directions[n, 0], directions[n, 1], directions[n, 2]
        begin = _entry(radius, altitude, dz, field.base, field.top)
        end = min(_exit(radius, altitude, dz, field.base, field.top, begin), ends[n])
        if end <= begin:
            continue
        # Farther from the observer the plane is stretched more.
        far = end * dx, end * dy, altitude + end * dz
        stretch = chart_stretch(field, radius, far[0], far[1], far[2])
        # Up to where one patch alone has clouds.
        alone = east = north = 0.0
        is_lone, row, column = True, 0, 0
        passes, depth, place = 1.0, 0.0, NOT_PREPARED
        weighted = total = due = 0.0
        share, is_new, is_near = 1.0, True, False
        known, detail = begin * marching.pixel, detail_at(field, begin * marching.pixel)
        at = begin
        # However coarse pixels are, a ray sees the layer at several heights.
        coarsest = (
            (field.top - field.base) / LEVELS / max(_slope(radius, altitude, dz, begin), 1e-6)
        )
        shortest = marching.shortest + min(at * marching.pixel, coarsest)
        step = shortest
        while at < end:
            step = min(step, end - at + 1e-6)
            middle = at + 0.5 * step
            px, py, pz = middle * dx, middle * dy, altitude + middle * dz
            above = pz + radius
            h = math.sqrt(px * px + py * py + above * above) - radius
            blur = middle * marching.pixel
            x, y = plane_place(field, radius, px, py, pz)
            if blur > SIMILAR * known:
                known, detail = blur, detail_at(field, blur)
            if middle >= alone:
                around = shares_around(field, x, y)
                east, north, room = lone_patch(field, around)
                is_lone = room > 0.0
                if not is_lone:
                    east, north, _, room, number = shared_place(
                        field, around, x, y, h, blur, detail
                    )
                    row, column = patch_of(around, number)
                alone = middle + room / stretch
            room = max(alone - middle, 0.0)
            shortest = marching.shortest + min(blur, coarsest)
            if not is_near:
                clear = detailed_clearance(field, x + east, y + north, h, blur, detail) / stretch
                clear = min(clear, room)
                if clear > 0.5 * shortest:
                    _add(scratch.source, due, seen[n])
                    due, is_new = 0.0, True
                    at = max(middle + clear, at + shortest)
                    step = shortest
                    continue
            erosion = 0.0
            if not is_lone:
                erosion = erosion_in(field, shares_around(field, x, y), row, column)
            x, y = x + east, y + north
            extinction, free = detailed_around(field, x, y, h, detail, erosion)
            if extinction < THINNEST:
                leap = min(free / stretch, room)
                is_near = 0.0 < leap < NEAR * shortest
                if leap > 0.5 * shortest:
                    _add(scratch.source, due, seen[n])
                    due, is_new = 0.0, True
                at = max(middle + leap, at + step)
                step = shortest
                continue
            is_near = True
            scaled = extinction * keep
            if scaled * step > 1.6 * marching.depth and step > 1.01 * shortest:
                step = max(marching.depth / scaled, shortest)
                continue
            stops = 1.0 - fast_exp(-scaled * step)
            weight = passes * stops
            if is_new or passes > BRIGHT or due >= SHARED:
                # Light between two looks is the mean of both.
                _add(scratch.source, 0.5 * due, seen[n])
                if place == NOT_PREPARED:
                    place = prepare_ray(light, radius, altitude, directions[n], sun, begin, scratch)
                to_eye = depth + 0.5 * extinction * step
                fill_source(
                    field, light, marching, place, x, y, h, blur, detail, erosion, to_eye, scratch
                )
                _add(scratch.source, 0.5 * due + weight, seen[n])
                due, is_new = 0.0, False
            else:
                due += weight
            weighted += weight * middle
            total += weight
            passes *= 1.0 - stops
            depth += extinction * step
            at += step
            if passes < OPAQUE:
                if due > 0.0:
                    # The light of the last steps is brighter or darker than where the rest began.
                    _add(scratch.source, 0.5 * due, seen[n])
                    to_eye = depth - 0.5 * extinction * step
                    fill_source(
                        field,
                        light,
                        marching,
                        place,
                        x,
                        y,
                        h,
                        blur,
                        detail,
                        erosion,
                        to_eye,
                        scratch,
                    )
                    due *= 0.5
                # What is not followed is as bright as what is.
                share = 1.0 / (1.0 - passes)
                passes = 0.0
                break
            step = min(max(marching.depth / scaled, shortest), 2.0 * step)
            step = min(step, max(marching.longest, shortest))
        for c in range(channels):
            seen[n, c] = share * (seen[n, c] + due * scratch.source[c])
        through[n, 0] = passes
        through[n, 1] = math.exp(-depth) if passes > 0.0 else 0.0
        through[n, 2] = weighted / total if total > 0.0 else 0.0


@inlined_kernel
def _add(source, weight, out):
    for c in range(source.size):
        out[c] += weight * source[c]


@kernel
def _slope(radius, altitude, dz, distance):
    """Cosine of the angle between a ray and the vertical at a distance, without its sign."""
    above = radius + altitude
    r = math.sqrt(distance * distance + above * (above + 2.0 * distance * dz))
    return abs(distance + above * dz) / r


@kernel
def _entry(radius, altitude, slope, base, top):
    """Distance at which a ray enters a layer; infinite if it does not. [km]"""
    r = radius + altitude
    b = r * slope
    if altitude > top:
        inside = b * b - (altitude - top) * (2.0 * radius + altitude + top)
        if b >= 0.0 or inside <= 0.0:
            return math.inf
        return -b - math.sqrt(inside)
    if altitude >= base:
        return 0.0
    to_ground = b * b - altitude * (2.0 * radius + altitude)
    if b < 0.0 and to_ground > 0.0:
        return math.inf
    return -b + math.sqrt(b * b + (base - altitude) * (2.0 * radius + altitude + base))


@kernel
def _exit(radius, altitude, slope, base, top, entry):
    """Distance at which a ray leaves a layer and does not come back. [km]"""
    if entry == math.inf:
        return 0.0
    r = radius + altitude
    b = r * slope
    leaves = -b + math.sqrt(max(b * b + (top - altitude) * (2.0 * radius + altitude + top), 0.0))
    if altitude >= base and b < 0.0:
        below = b * b - (altitude - base) * (2.0 * radius + altitude + base)
        # A ray that comes down to the ground leaves it once; others rise again behind.
        if below > 0.0 and b * b > altitude * (2.0 * radius + altitude):
            leaves = -b - math.sqrt(below)
    return min(leaves, entry + FARTHEST)
