"""How much of the sun reaches the air and the ground around a layer of clouds."""

from __future__ import annotations

import math

from skybake.cloud_fields.chart import tile_place
from skybake.clouds.light import sun_share
from skybake.jit.kernel import kernel

SAMPLES = 6
"""Places in each stretch of a ray at which the sun is looked for, at most; a voxel each will do."""


@kernel
def dim_visibility(
    field, light, leaving, radius, altitude, directions, distances, sun, first, last, out
):
    """Multiply shares of the sun that reach stretches of rays, and their ends, by a layer's.

    Parameters
    ----------
    field, light : CloudField, LayerLight
        The layer.
    leaving : ndarray of float32, shape (sun, 2, y, x)
        Of `SolvedLayer`.
    radius, altitude : float
        Of the ground, and of the observer above it. [km]
    directions : ndarray of float64, shape (ray, 3)
        x east, y north, z up.
    distances : ndarray of float64, shape (ray, stretch + 1)
        Ends of the stretches. [km]
    sun : ndarray of float64, shape (3,)
        Toward the sun.
    first, last : int
        Rays to do.
    out : ndarray of float32, shape (ray, stretch + 1)
        Means over stretches, and the share at the end of the last.
    """
    stretches = out.shape[1] - 1
    for n in range(first, last):
        direction = directions[n]
        for q in range(stretches):
            begin, end = distances[n, q], distances[n, q + 1]
            samples = min(max(math.ceil((end - begin) / light.spacing[2]), 1), SAMPLES)
            total = 0.0
            for i in range(samples):
                s = begin + (end - begin) * (i + 0.5) / samples
                total += _visible(field, light, leaving, radius, altitude, direction, s, sun)
            out[n, q] *= total / samples
        s = distances[n, stretches] * (1.0 - 1e-9)
        out[n, stretches] *= _visible(field, light, leaving, radius, altitude, direction, s, sun)


@kernel
def _visible(field, light, leaving, radius, altitude, direction, distance, sun):
    """Share of the sun at one place of a ray."""
    px, py = distance * direction[0], distance * direction[1]
    above = altitude + distance * direction[2] + radius
    r = math.sqrt(px * px + py * py + above * above)
    h = r - radius
    mu_s = (sun[0] * px + sun[1] * py + sun[2] * above) / r
    base = light.base
    top = base + light.beam.shape[1] * light.spacing[0]
    if h > top and mu_s > 0.0:
        return 1.0
    if base <= h <= top:
        x, y = tile_place(field, radius, px, py, above - radius)
        return _beam_at(light, sun_share(light, mu_s), x, y, h)
    # Where the beam left the layer: for places below it up the way to the sun, even to one below
    # the horizontal, whose light comes by the planet's edge; for those above it down the way.
    face = base if h < base else top
    chord = r * r * mu_s * mu_s + (face - h) * (2.0 * radius + face + h)
    if chord < 0.0:
        return 1.0
    to_face = (math.sqrt(chord) if h < base else -math.sqrt(chord)) - r * mu_s
    place = sun_share(light, (r * mu_s + to_face) / (radius + face))
    which = int(place)
    share = place - which
    px, py, above = px + to_face * sun[0], py + to_face * sun[1], above + to_face * sun[2]
    x, y = tile_place(field, radius, px, py, above - radius)
    side = 0 if h < base else 1
    value = _between(leaving[which, side], light, x, y)
    if share > 0.0:
        value += share * (_between(leaving[which + 1, side], light, x, y) - value)
    return value


@kernel
def _beam_at(light, place, x, y, h):
    """Share of the sun's beam in the voxel at a point, between suns."""
    which = int(place)
    share = place - which
    _, levels, rows, columns = light.beam.shape
    k = min(int((h - light.base) / light.spacing[0]), levels - 1)
    j, i = math.floor(y / light.spacing[1]) % rows, math.floor(x / light.spacing[2]) % columns
    beam = float(light.beam[which, k, j, i])
    if share > 0.0:
        beam += share * (light.beam[which + 1, k, j, i] - beam)
    return beam


@kernel
def _between(plane, light, x, y):
    rows, columns = plane.shape
    fy, fx = y / light.spacing[1] - 0.5, x / light.spacing[2] - 0.5
    j, i = math.floor(fy), math.floor(fx)
    v, u = fy - j, fx - i
    j, i = j % rows, i % columns
    north, east = (j + 1) % rows, (i + 1) % columns
    low = plane[j, i] + u * (plane[j, east] - plane[j, i])
    high = plane[north, i] + u * (plane[north, east] - plane[north, i])
    return float(low + v * (high - low))
