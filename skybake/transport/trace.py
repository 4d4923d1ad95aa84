"""Sample points along a line of sight, with the transmittance back to its start."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.transport.density import GAUSS_FAR, GAUSS_LOW, GAUSS_NEAR, GAUSS_SELF, fill_density
from skybake.transport.exponential import fast_exp
from skybake.transport.geometry import (
    distance_to_entry,
    distance_to_exit,
    radius_at,
    squared_closest_approach,
)
from skybake.transport.samples import MAX_SAMPLES

MAX_ARC = math.radians(0.5)
MAX_STEP_OPTICAL_DEPTH = 1.0
OPAQUE = 1e-9


@kernel
def ray_limits(medium, r, mu):
    """Where a ray enters and leaves the atmosphere, and whether it ends on the ground.

    Returns
    -------
    (float, float, bool)
        First and last distance in the atmosphere, equal if it misses that; whether
        the ray ends on the ground. [km]
    """
    first = 0.0
    if r > medium.r_top:
        first = distance_to_entry(r, mu, medium.r_top)
        if first == math.inf:
            return 0.0, 0.0, False
    ground = distance_to_entry(r, mu, medium.r_bottom)
    if ground < math.inf:
        return first, max(first, ground), True
    return first, max(first, distance_to_exit(r, mu, medium.r_top)), False


@kernel
def trace(medium, shells, max_arc, rays, begin, end, samples):
    """Fill `samples` along as many rays as it holds.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    shells : ndarray of float64
        Altitudes at which steps end, ascending from the ground to the top. [km]
    max_arc : float
        Largest angle, seen from the planet's centre, that a step may cover. [rad]
    rays : ndarray of float64, shape (ray, 2)
        Start of each ray, inside the atmosphere or outside [km], and cosine of its zenith angle.
    begin, end : int
        Rays to be traced.
    samples : Samples
        Work space that receives the result.

    Returns
    -------
    int
        The first ray that is left for the next batch, or `end`.

    Notes
    -----
    Steps end at shells, at the point closest to the planet, after `max_arc` and after
    one optical depth. Each has two Gauss-Legendre points, so that smooth integrands are
    integrated to fourth order and no kink of the profile falls inside a step.
    """
    capacity = samples.distance.size
    used = np.int64(0)
    i = begin
    while i < end and i - begin < samples.first.size and used + MAX_SAMPLES <= capacity:
        first = used
        used = _trace_ray(medium, shells, max_arc, rays[i], first, i - begin, samples)
        samples.first[i - begin] = first
        samples.number[i - begin] = used - first
        i += 1
    return i


@kernel
def trace_spans(medium, shells, max_arc, rays, distances, begin, end, samples):
    """Fill `samples` along as many rays as it holds, with steps that end at given distances.

    Parameters
    ----------
    distances : ndarray of float64, shape (ray, distance)
        Ascending along each ray. [km]
    others
        As of `trace`; `samples` has room for a ray's distances at least.

    Returns
    -------
    int
        The first ray that is left for the next batch, or `end`.

    Notes
    -----
    What `samples` holds of rays it holds here of spans between distances, the spans of a
    ray one after another: their own samples, and transmittance and columns from the ray's
    start to the span's end. The span that continues beyond the ground is the one that hits it.
    """
    capacity, number = samples.distance.size, distances.shape[1]
    used = np.int64(0)
    i = begin
    while (
        i < end
        and (i - begin + 1) * number <= samples.first.size
        and used + MAX_SAMPLES <= capacity
    ):
        used = _trace_spans_of_ray(
            medium, shells, max_arc, rays[i], distances[i], used, (i - begin) * number, samples
        )
        i += 1
    return i


@kernel
def _trace_ray(medium, shells, max_arc, start, first, ray, samples):
    """Append the samples of one ray from `first` on; returns the next free one."""
    t, t_last, samples.hits_ground[ray] = ray_limits(medium, start[0], start[1])
    samples.length[ray] = t_last
    transmittance, column = samples.transmittance[ray], samples.column[ray]
    for k in range(transmittance.size):
        transmittance[k] = 1.0
    for c in range(column.size):
        column[c] = 0.0
    return _extend(
        medium, shells, max_arc, start, t, t_last, first, first, samples, transmittance, column
    )


@kernel
def _trace_spans_of_ray(medium, shells, max_arc, start, distances, first, slot, samples):
    """Append the samples of one ray's spans from `first` on; returns the next free one."""
    t, t_last, hits_ground = ray_limits(medium, start[0], start[1])
    n = first
    for j in range(distances.size):
        transmittance, column = samples.transmittance[slot + j], samples.column[slot + j]
        for k in range(transmittance.size):
            transmittance[k] = 1.0 if j == 0 else samples.transmittance[slot + j - 1, k]
        for c in range(column.size):
            column[c] = 0.0 if j == 0 else samples.column[slot + j - 1, c]
        samples.first[slot + j] = n
        stop = min(distances[j], t_last)
        if stop > t:
            n = _extend(
                medium, shells, max_arc, start, t, stop, first, n, samples, transmittance, column
            )
            t = stop
        samples.number[slot + j] = n - samples.first[slot + j]
        samples.length[slot + j] = t_last
        is_seen = distances[j] > t_last and (j == 0 or distances[j - 1] <= t_last)
        samples.hits_ground[slot + j] = hits_ground and is_seen
    return n


@kernel
def _extend(medium, shells, max_arc, start, t, t_last, first, n, samples, transmittance, column):
    """Append a ray's samples between two distances from `n` on; returns the next free one.

    The ray's own begin at `first`; transmittance and columns are those up to `t`, and then
    those up to `t_last`.
    """
    r, mu = start[0], start[1]
    t_closest = -r * mu
    closest_squared = squared_closest_approach(r, mu)
    layer = _layer_at(shells, radius_at(r, mu, t) - medium.r_bottom, t < t_closest)
    arc = max_arc * medium.r_bottom
    brightest = 0.0
    for k in range(transmittance.size):
        brightest = max(brightest, transmittance[k])
    while t < t_last and brightest >= OPAQUE and n + 2 <= first + MAX_SAMPLES:
        descending = t < t_closest
        t_shell, next_layer = _next_shell(
            shells, layer, descending, medium.r_bottom, t_closest, closest_squared
        )
        # Rounding can put a shell that the ray has just crossed behind it.
        t_next = min(max(t_shell, t), t + arc, t_last)
        if n + 2 < first + MAX_SAMPLES // 2:
            t_next = _limit_depth(medium, r, mu, t, t_next, transmittance, samples.density[n])
        brightest = _add_step(medium, r, mu, t, t_next - t, n, samples, transmittance, column)
        n += 2
        if t_next >= t_shell:
            layer = next_layer
        t = t_next
    return n


@kernel
def _layer_at(shells, h, descending):
    """Index i such that `h`, or the point next to it along the ray, is in shells i..i+1."""
    i = 0
    while i < shells.size - 2 and (shells[i + 1] < h or (shells[i + 1] == h and not descending)):
        i += 1
    return i


@kernel
def _next_shell(shells, layer, descending, r_bottom, t_closest, closest_squared):
    """Distance of the next shell that the ray crosses, and the layer behind it."""
    if descending and layer == 0:
        # Only the ground is below, and there the ray ends by itself.
        return (math.inf if closest_squared < r_bottom * r_bottom else t_closest), 0
    if descending:
        r_shell = r_bottom + shells[layer]
        if r_shell * r_shell <= closest_squared:
            return t_closest, layer
        t_shell = t_closest - math.sqrt(r_shell * r_shell - closest_squared)
        return t_shell, layer - 1
    r_shell = r_bottom + shells[layer + 1]
    t_shell = t_closest + math.sqrt(max(0.0, r_shell * r_shell - closest_squared))
    if layer + 2 < shells.size:
        return t_shell, layer + 1
    return math.inf, layer


@kernel
def _limit_depth(medium, r, mu, t, t_next, transmittance, scratch):
    """Shorten a step until no wavelength that still counts gains more than one depth."""
    # The density at the middle of a long step says little about its start, hence the rounds.
    for _ in range(8):
        h = radius_at(r, mu, 0.5 * (t + t_next)) - medium.r_bottom
        fill_density(medium.density, medium.r_bottom, medium.r_top, h, scratch)
        thickest = 0.0
        for k in range(transmittance.size):
            extinction = 0.0
            for c in range(scratch.size):
                extinction += scratch[c] * medium.extinction[c, k]
            if transmittance[k] > 1e-6:
                thickest = max(thickest, extinction)
        depth = thickest * (t_next - t)
        if depth <= MAX_STEP_OPTICAL_DEPTH:
            break
        t_next = t + (t_next - t) * max(0.999 * MAX_STEP_OPTICAL_DEPTH / depth, 1.0 / 16.0)
    return t_next


@kernel
def _add_step(medium, r, mu, t, step, n, samples, transmittance, column):
    """Append the two points of a step and return the largest transmittance behind it."""
    constituents, wavelengths = medium.extinction.shape
    for i in range(2):
        distance = t + step * (GAUSS_LOW if i == 0 else 1.0 - GAUSS_LOW)
        radius = radius_at(r, mu, distance)
        samples.distance[n + i] = distance
        samples.radius[n + i] = radius
        h = radius - medium.r_bottom
        fill_density(medium.density, medium.r_bottom, medium.r_top, h, samples.density[n + i])
    for k in range(wavelengths):
        samples.weight[n, k] = 0.0
        samples.weight[n + 1, k] = 0.0
        transmittance[k] = 0.0
    for c in range(constituents):
        low = samples.density[n, c]
        high = samples.density[n + 1, c]
        to_low = column[c] + step * (GAUSS_SELF * low + GAUSS_FAR * high)
        to_high = column[c] + step * (GAUSS_NEAR * low + GAUSS_SELF * high)
        to_end = column[c] + 0.5 * step * (low + high)
        samples.column_to[n, c] = to_low
        samples.column_to[n + 1, c] = to_high
        column[c] = to_end
        for k in range(wavelengths):
            extinction = medium.extinction[c, k]
            samples.weight[n, k] -= extinction * to_low
            samples.weight[n + 1, k] -= extinction * to_high
            transmittance[k] -= extinction * to_end
    brightest = 0.0
    for k in range(wavelengths):
        samples.weight[n, k] = 0.5 * step * fast_exp(samples.weight[n, k])
        samples.weight[n + 1, k] = 0.5 * step * fast_exp(samples.weight[n + 1, k])
        transmittance[k] = fast_exp(transmittance[k])
        brightest = max(brightest, transmittance[k])
    return brightest
