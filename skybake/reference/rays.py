"""Straight rays through the shells between altitude nodes, and their optical depths.

A ray is known by the altitude of its point nearest the planet's centre, `h_tangent`, and a
place on it by the signed distance `s` from that point, negative on the way down. Altitudes, not
radii, enter every difference: r² - p² of two radii would lose half the digits.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.reference.air import Air


class Cuts(NamedTuple):
    """Places where a ray crosses shells, in order from its start.

    Attributes
    ----------
    s, h, depth : ndarray of float64
        Distance from the ray's nearest point to the centre, altitude, and
        optical depth from the start. [km, km, 1]
    shell : ndarray of int64
        Shell between this cut and the next.
    """

    s: npt.NDArray[np.float64]
    h: npt.NDArray[np.float64]
    depth: npt.NDArray[np.float64]
    shell: npt.NDArray[np.int64]


class Ray(NamedTuple):
    """A ray in the atmosphere.

    Attributes
    ----------
    cuts : Cuts
        Valid from 0 to `segments`.
    segments : int
        0 if the ray misses the atmosphere.
    h_tangent : float
        Altitude of the nearest point to the centre, on the ray's line. [km]
    start : float
        Distance from the nearest point at which the ray starts; before the
        first cut if that is outside the atmosphere. [km]
    reaches_ground : bool
    """

    cuts: Cuts
    segments: int
    h_tangent: float
    start: float
    reaches_ground: bool


@kernel
def tangent_altitude(r_bottom, h, mu):
    """Altitude of the ray's nearest point to the centre; it may be below the ground."""
    return h - (r_bottom + h) * mu * mu / (1.0 + math.sqrt(max(0.0, 1.0 - mu * mu)))


@kernel
def distance_from_tangent(r_bottom, h_tangent, h):
    """Distance along the ray between its nearest point and altitude `h`."""
    return math.sqrt(max(0.0, (h - h_tangent) * (2.0 * r_bottom + h + h_tangent)))


@kernel
def altitude_on_ray(r_bottom, h_tangent, s):
    """Altitude at distance `s` from the ray's nearest point."""
    p = r_bottom + h_tangent
    return h_tangent + s * s / (math.sqrt(p * p + s * s) + p)


@kernel
def hits_ground(h_tangent, mu):
    """Whether a ray that starts above the ground meets it."""
    return mu < 0.0 and h_tangent < 0.0


@kernel
def shell_of(altitude, h):
    """Index of the shell, nodes k to k + 1, that holds altitude `h`."""
    last = len(altitude) - 2
    k = min(max(int(math.sqrt(max(0.0, h / altitude[-1])) * (last + 1)), 0), last)
    while k > 0 and altitude[k] > h:
        k -= 1
    while k < last and altitude[k + 1] <= h:
        k += 1
    return k


@kernel
def node_value(altitude, values, k, h):
    """Linear interpolation in shell `k`."""
    f = (h - altitude[k]) / (altitude[k + 1] - altitude[k])
    return values[k] + f * (values[k + 1] - values[k])


@kernel
def column(air, h_tangent, k, s0, extinction0, s1, extinction1):
    """Optical depth between two places of a ray in shell `k`, on one side of its nearest point.

    Extinction is linear in altitude, and altitude all but quadratic in s: the trapezium with the
    correction for curvature leaves an error of order (length/radius)⁴.
    """
    length = s1 - s0
    slope = (air.extinction[k + 1] - air.extinction[k]) / (air.altitude[k + 1] - air.altitude[k])
    p = air.r_bottom + h_tangent
    middle = 0.5 * (s0 + s1)
    r2 = p * p + middle * middle
    curvature = p * p / (r2 * math.sqrt(r2))
    chord = 0.5 * (extinction0 + extinction1) * length
    return max(0.0, chord - slope * curvature * length * length * length / 12.0)


@kernel
def depth_ascending(air, h_tangent, h0, h1):
    """Optical depth from altitude `h0` up to `h1` along a ray beyond its nearest point."""
    altitude = air.altitude
    k = shell_of(altitude, h0)
    s0 = distance_from_tangent(air.r_bottom, h_tangent, h0)
    extinction0 = node_value(altitude, air.extinction, k, h0)
    depth = 0.0
    while k < len(altitude) - 2 and altitude[k + 1] < h1:
        s1 = distance_from_tangent(air.r_bottom, h_tangent, altitude[k + 1])
        extinction1 = air.extinction[k + 1]
        depth += column(air, h_tangent, k, s0, extinction0, s1, extinction1)
        s0, extinction0 = s1, extinction1
        k += 1
    s1 = distance_from_tangent(air.r_bottom, h_tangent, h1)
    extinction1 = node_value(altitude, air.extinction, k, h1)
    return depth + column(air, h_tangent, k, s0, extinction0, s1, extinction1)


@kernel
def transmittance_to_space(air, h, mu):
    """Transmittance from altitude `h` to the top along cosine `mu`; 0 through the ground."""
    h_tangent = tangent_altitude(air.r_bottom, h, mu)
    if hits_ground(h_tangent, mu):
        return 0.0
    top = air.altitude[-1]
    if mu >= 0.0:
        if h >= top:
            return 1.0
        return math.exp(-depth_ascending(air, h_tangent, h, top))
    if h_tangent >= top:
        return 1.0
    depth = depth_ascending(air, h_tangent, h_tangent, min(h, top))
    if h >= top:
        return math.exp(-2.0 * depth)
    return math.exp(-depth - depth_ascending(air, h_tangent, h_tangent, top))


def new_cuts(air: Air) -> Cuts:
    """Room for `trace`: every shell may be crossed twice."""
    size = 2 * len(air.altitude) + 2
    return Cuts(np.empty(size), np.empty(size), np.empty(size), np.empty(size, np.int64))


@kernel
def trace(air, h, mu, cuts):
    """Cut the ray from altitude `h` along cosine `mu` at every shell it crosses, into `cuts`."""
    altitude = air.altitude
    top = altitude[-1]
    h_tangent = tangent_altitude(air.r_bottom, h, mu)
    start = math.copysign(distance_from_tangent(air.r_bottom, h_tangent, h), mu)
    reaches_ground = hits_ground(h_tangent, mu)
    if h >= top and (mu >= 0.0 or h_tangent >= top):
        return Ray(cuts, 0, h_tangent, start, False)
    h_now = min(h, top)
    k = shell_of(altitude, h_now)
    cuts.s[0] = math.copysign(distance_from_tangent(air.r_bottom, h_tangent, h_now), mu)
    cuts.h[0] = h_now
    n = 0
    if mu < 0.0:
        lowest = max(0.0, h_tangent)
        while True:
            h_now = max(altitude[k], lowest)
            cuts.shell[n] = k
            n += 1
            cuts.s[n] = -distance_from_tangent(air.r_bottom, h_tangent, h_now)
            cuts.h[n] = h_now
            if h_now <= lowest:
                break
            k -= 1
    if not reaches_ground:
        while k < len(altitude) - 1:
            cuts.shell[n] = k
            n += 1
            cuts.s[n] = distance_from_tangent(air.r_bottom, h_tangent, altitude[k + 1])
            cuts.h[n] = altitude[k + 1]
            k += 1
    cuts.depth[0] = 0.0
    for i in range(n):
        k = cuts.shell[i]
        before = node_value(altitude, air.extinction, k, cuts.h[i])
        after = node_value(altitude, air.extinction, k, cuts.h[i + 1])
        cuts.depth[i + 1] = cuts.depth[i] + column(
            air, h_tangent, k, cuts.s[i], before, cuts.s[i + 1], after
        )
    return Ray(cuts, n, h_tangent, start, reaches_ground)


@kernel
def place_at_depth(air, h_tangent, k, s0, h0, s1, h1, target):
    """Where, from `s0` to `s1` in shell `k`, the optical depth from `s0` reaches `target`."""
    before = node_value(air.altitude, air.extinction, k, h0)
    after = node_value(air.altitude, air.extinction, k, h1)
    length = s1 - s0
    # Extinction as linear in s gives the first guess, Newton's steps the rest.
    root = math.sqrt(max(0.0, before * before + 2.0 * (after - before) * target / length))
    s = s0 + min(length, 2.0 * target / max(before + root, 1e-300))
    for _ in range(3):
        h = altitude_on_ray(air.r_bottom, h_tangent, s)
        extinction = node_value(air.altitude, air.extinction, k, h)
        if extinction <= 0.0:
            break
        error = column(air, h_tangent, k, s0, before, s, extinction) - target
        s = min(max(s - error / extinction, s0), s1)
    return s
