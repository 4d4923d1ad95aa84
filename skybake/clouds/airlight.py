"""The light of the air along rays, in the shadow of clouds and lit by them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.clouds.air import ClearAir
from skybake.clouds.dimming import dimming_at
from skybake.jit.kernel import kernel
from skybake.optics.medium import Array
from skybake.scattering.segments import SHORTEST

STRETCHES = 12
CROWDING = 1.3
"""Power by which stretches are shorter near the observer."""

TINY = 1e-30


class AirTable(NamedTuple):
    """Light of clear air along rays, relative to all of a ray's light without clouds.

    Attributes
    ----------
    distance : ndarray of float64, shape (ray, stretch + 1)
        From where clouds may be, or throw shadows, to where no more can. [km]
    single : ndarray of float64, shape (ray, stretch + 2, channel)
        Sunlight scattered once, gathered up to each distance and to the ray's end.
    diffuse : ndarray of float64, shape (ray, stretch + 2, channel)
        The same of the rest, without the ground.
    sunlit, skylit : ndarray of float64, shape (ray, channel)
        Light of the ground by the sun and by the sky.
    ground : ndarray of float64, shape (ray, channel)
        Light of the ground by an irradiance of 1.
    glow : ndarray of float64, shape (ray, stretch + 2, channel)
        Light that air above clouds has from them, beyond that from the ground.
    transmittance : ndarray of float64, shape (ray, stretch + 1, channel)
        Of what is behind.
    total : ndarray of float64, shape (ray, channel)
        What all is relative to: radiance per unit irradiance, times the channels' weights.
    """

    distance: Array
    single: Array
    diffuse: Array
    sunlit: Array
    skylit: Array
    ground: Array
    glow: Array
    transmittance: Array
    total: Array


class AirRays(NamedTuple):
    """Rays along which the light of the air is looked up, see `fill_lit`.

    Attributes
    ----------
    table : AirTable
        Clear air.
    row, weight : ndarray, shape (ray, 4)
        Rows of the table between which a ray is.
    directions : ndarray of float64, shape (ray, 3)
        Of the rays.
    visible : ndarray of float32, shape (ray, stretch + 1)
        Share of the sun along them.
    """

    table: AirTable
    row: npt.NDArray[np.int64]
    weight: Array
    directions: Array
    visible: npt.NDArray[np.float32]


def shadowed_stretch(
    altitude: float, directions: Array, radius: float, top: float
) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Where rays are below the tops of clouds, [km], and whether they end on the ground."""
    r, slope = radius + altitude, directions[:, 2]
    b = r * slope
    chord = b * b - (altitude - top) * (2.0 * radius + altitude + top)
    ground = b * b - altitude * (2.0 * radius + altitude)
    root = np.sqrt(np.maximum(chord, 0.0))
    inside = altitude < top
    begin = np.where(inside, 0.0, -b - root)
    misses = (chord <= 0.0) | ((not inside) & (b >= 0.0))
    hits = (b < 0.0) & (ground > 0.0) & ~misses
    end = np.where(hits, -b - np.sqrt(np.maximum(ground, 0.0)), -b + root)
    return np.where(misses, 0.0, begin), np.where(misses, 0.0, end), hits


def stretch_ends(begin: Array, end: Array) -> Array:
    """Divide the ways from `begin` to `end` into stretches, shape (ray, stretch + 1). [km]"""
    share = (np.arange(STRETCHES + 1) / STRETCHES) ** CROWDING
    ends: Array = begin[:, None] + (end - begin)[:, None] * share
    return ends


def build_table(
    air: ClearAir,
    altitude: float,
    directions: Array,
    sun: Array,
    top: float,
    weights: Array,
    reflectance: Array,
) -> AirTable:
    """Gather the light of clear air along rays.

    Parameters
    ----------
    air : ClearAir
        The air.
    altitude : float
        Of the observer. [km]
    directions : ndarray of float64, shape (ray, 3)
        x east, y north, z up.
    sun : ndarray of float64, shape (3,)
        Toward the sun.
    top : float
        Of the highest clouds. [km]
    weights : ndarray of float64, shape (wavelength, channel)
        Of the channels.
    reflectance : ndarray of float64, shape (wavelength,)
        Of clouds and ground, seen from above.
    """
    begin, end, hits = shadowed_stretch(altitude, directions, air.radius, top)
    distance = stretch_ends(begin, end)
    # Stay above the ground, whose light belongs to what is behind, also once they are rounded.
    last = np.maximum(np.floor(end[hits] / SHORTEST) - 1.0, 0.0) * SHORTEST
    distance[hits] = np.minimum(distance[hits], last[:, None])
    spans = air.spans(altitude, directions, distance, sun)
    single = spans.single @ weights
    diffuse = spans.diffuse @ weights
    transmittance = spans.transmittance @ weights / weights.sum(axis=0)
    ground = np.where(hits[:, None], diffuse[:, -1] - diffuse[:, -2], 0.0)
    diffuse[:, -1] -= ground
    sunlit, lambertian = np.zeros_like(ground), np.zeros_like(ground)
    if hits.any():
        passes = spans.transmittance[hits, -1] * air.albedo / math.pi
        lambertian[hits] = passes @ weights / weights.sum(axis=0)
        lit = _sunlit_ground(air, altitude, directions[hits], end[hits], sun)
        sunlit[hits] = (lit * spans.transmittance[hits, -1]) @ weights
    sunlit = np.minimum(sunlit, ground)
    change = air.brightening(reflectance)
    glow = np.zeros_like(diffuse)
    if altitude > top or not hits.all():
        glow = (air.over_bright_spans(altitude, directions, distance, sun) * change) @ weights
        # Below the tops, and of the ground, other parts tell the light.
        beyond = np.where(hits[:, None], 0.0, glow[:, -1] - glow[:, -2])
        glow[:, 1:] = glow[:, :1]
        glow[:, -1] += beyond
    # In deep twilight light may be rounding, of either sign.
    total = np.abs(single[:, -1]) + np.abs(diffuse[:, -1]) + np.abs(ground)
    scale = 1.0 / np.maximum(total, TINY)
    return AirTable(
        distance=distance,
        single=single * scale[:, None],
        diffuse=diffuse * scale[:, None],
        sunlit=sunlit * scale,
        skylit=(ground - sunlit) * scale,
        ground=lambertian * scale,
        glow=glow * scale[:, None],
        transmittance=transmittance,
        total=total,
    )


def _sunlit_ground(
    air: ClearAir, altitude: float, directions: Array, distance: Array, sun: Array
) -> Array:
    """Radiance per unit irradiance of the ground where rays end, by the sun alone. [sr⁻¹]"""
    place = directions * distance[:, None] + [0.0, 0.0, air.radius + altitude]
    mu_s = place @ sun / np.linalg.norm(place, axis=1)
    nodes = np.unique(np.concatenate([np.linspace(-0.02, 0.1, 25), np.linspace(0.1, 1.0, 19)]))
    light = np.stack([air.sunlight(np.zeros(1), float(mu))[0] for mu in nodes])
    through = np.stack([np.interp(mu_s, nodes, column) for column in light.T], axis=1)
    lit: Array = air.albedo / math.pi * np.maximum(mu_s, 0.0)[:, None] * through
    return lit


@kernel
def fill_lit(
    table, row, weight, dimming, radius, altitude, directions, visible, first, last, lit, through
):
    """Write the light of air and ground with clouds around, relative to that without.

    Parameters
    ----------
    table : AirTable
        Clear air.
    row, weight : ndarray, shape (ray, 4)
        Rows of the table between which a ray is.
    dimming : Dimming
        Of the diffuse light.
    radius, altitude : float
        Of the ground, and of the observer above it. [km]
    directions : ndarray of float64, shape (ray, 3)
        Of the rays.
    visible : ndarray of float32, shape (ray, stretch + 1)
        Share of the sun along them, see `dim_visibility`.
    first, last : int
        Rays to do.
    lit : ndarray of float32, shape (ray, stretch + 2, channel)
        Receives the light gathered up to each distance, and all.
    through : ndarray of float32, shape (ray, stretch + 1, channel)
        Receives the transmittance up to each distance.
    """
    stretches = visible.shape[1] - 1
    channels = lit.shape[2]
    for n in range(first, last):
        slope = directions[n, 2]
        for c in range(channels):
            gathered = 0.0
            for q in range(stretches + 2):
                single = _gained(table.single, row[n], weight[n], q, c)
                diffuse = _gained(table.diffuse, row[n], weight[n], q, c)
                gathered += _gained(table.glow, row[n], weight[n], q, c)
                if 0 < q <= stretches:
                    # Before and beyond all clouds the sun shines.
                    s = _middle(table.distance, row[n], weight[n], q)
                    r = radius + altitude
                    h = math.sqrt(r * r + s * s + 2.0 * r * s * slope) - radius
                    single *= visible[n, q - 1]
                    diffuse *= dimming_at(dimming, h, c)
                gathered += single + diffuse
                if q <= stretches:
                    through[n, q, c] = _mean(table.transmittance[:, q, c], row[n], weight[n])
                else:
                    sunlit = _mean(table.sunlit[:, c], row[n], weight[n])
                    skylit = _mean(table.skylit[:, c], row[n], weight[n])
                    gathered += sunlit * visible[n, stretches] + skylit * dimming.ground[c]
                    ground = _mean(table.ground[:, c], row[n], weight[n])
                    gathered += ground * dimming.irradiance[c]
                lit[n, q, c] = gathered


@kernel
def _mean(column, row, weight):
    """Mean of a table's rows."""
    total = 0.0
    for p in range(4):
        if weight[p] != 0.0:
            total += weight[p] * column[row[p]]
    return total


@kernel
def _gained(values, row, weight, q, channel):
    """Mean of what rows of a table gather between one distance and the next."""
    total = _mean(values[:, q, channel], row, weight)
    if q > 0:
        total -= _mean(values[:, q - 1, channel], row, weight)
    return total


@kernel
def _middle(distance, row, weight, q):
    """Distance of the middle of a stretch. [km]"""
    return 0.5 * (_mean(distance[:, q - 1], row, weight) + _mean(distance[:, q], row, weight))
