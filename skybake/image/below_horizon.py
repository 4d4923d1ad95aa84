"""What a map shows below the true horizon instead of the ground."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from skybake.errors import InputError
from skybake.image.layers import Pixels
from skybake.image.scene import Scene
from skybake.image.settings import View
from skybake.optics.medium import Array, Medium

Evaluate = Callable[[Array, Array, Array], Pixels]

RING = 512
"""Azimuths at which the light of the horizon is taken."""

RING_FOOTPRINT = math.radians(0.1)

LEAST = 1e-3
"""Share of a pixel above the horizon that is neglected; from the ground it is a bit below 90deg."""

_DEPTHS = 96
_FLATTEST = 1e-9

_ZENITHS, _AZIMUTHS = 32, 64
_PROBE_FOOTPRINT = 2e-3


def check_horizon(view: View, medium: Medium) -> None:
    """Refuse to extend a horizon that has no light: that of a planet seen from space.

    Raises
    ------
    InputError
        If the observer is above the atmosphere.
    """
    top = medium.r_top - medium.r_bottom
    if view.altitude >= top:
        raise InputError(
            "below horizon: extend needs an observer in the atmosphere, below "
            f"{top:g} km, got {view.altitude:g} km"
        )


def without_ground(scene: Scene, evaluate: Evaluate) -> Evaluate:
    """Return what evaluates pixels without the ground.

    Parameters
    ----------
    scene : Scene
        Whose view is `black` or `extend` below the horizon.
    evaluate : callable
        Evaluates pixels with the ground, as `Scene.evaluate`.

    Notes
    -----
    Where light is extended, each direction below the horizon has the mean of the horizon's light
    all around, weighted by the Poisson kernel of the cap below it: the one function that goes over
    into the horizon's light without a seam and whose value at every point is the mean of those
    around it. So it is never brighter or darker than the horizon, softer with depth, and at the
    nadir the mean.
    """
    horizon = scene.table.zenith_horizon
    extends = scene.settings.view.below_horizon == "extend"

    def seen(zenith: Array, azimuth: Array, footprint: Array) -> Pixels:
        extent = np.maximum(np.asarray(footprint, float), _FLATTEST)
        low, high = zenith - 0.5 * extent, zenith + 0.5 * extent
        above = np.clip((horizon - low) / extent, 0.0, 1.0)
        above = np.where(above < LEAST, 0.0, above)
        is_whole = above >= 1.0
        middle = np.where(is_whole, zenith, 0.5 * (low + np.minimum(high, horizon)))
        # Details of clouds follow the median, which is to be that of pixels as they are.
        height = np.where(above > 0.0, np.maximum(above * extent, _FLATTEST), extent)
        rows = np.asarray((above > 0.0).any(axis=1))
        # Clouds cannot be looked for in no pixel at all.
        rows[0] |= not rows.any()
        shape = np.broadcast_shapes(zenith.shape, azimuth.shape)
        sky = evaluate(*(_rows(part, rows) for part in (middle, azimuth, height)))
        out = np.zeros((*shape, sky.shape[2]), np.float32)
        share = np.broadcast_to(above, zenith.shape)[..., None].astype(np.float32)
        out[rows] = sky * share[rows]
        if extends and not is_whole.all():
            below = np.where(is_whole, horizon, 0.5 * (np.maximum(low, horizon) + high))
            out += (1.0 - share) * _extended(evaluate, horizon, below, azimuth)
        return out

    return seen


def _rows(part: Array, rows: np.ndarray) -> Array:
    return part[rows] if part.shape[0] == rows.size else part


def _extended(evaluate: Evaluate, horizon: float, zenith: Array, azimuth: Array) -> Pixels:
    """Light of the horizon at zenith angles below it."""
    around = 2.0 * math.pi * np.arange(RING) / RING
    just_above = np.full((1, 1), horizon - 0.5 * RING_FOOTPRINT)
    ring = evaluate(just_above, around[None], np.full((1, 1), RING_FOOTPRINT))[0]
    # Radii of the stereographic picture of the cap, in which that function is harmonic as well.
    radius = np.linspace(0.0, 1.0, _DEPTHS)[:, None, None]
    order = np.arange(RING // 2 + 1)[None, :, None]
    table = np.fft.irfft(np.fft.rfft(ring, axis=0)[None] * radius**order, RING, axis=1)
    edge = math.tan(0.5 * (math.pi - horizon))
    place = np.tan(0.5 * np.clip(math.pi - zenith, 0.0, math.pi - horizon)) / edge
    row = np.clip(place, 0.0, 1.0) * (_DEPTHS - 1)
    turns = azimuth / (2.0 * math.pi)
    column = (turns - np.floor(turns)) * RING
    top, left = np.minimum(row.astype(int), _DEPTHS - 2), column.astype(int)
    down, right = (row - top)[..., None], (column - left)[..., None]
    left, after = left % RING, (left + 1) % RING
    upper = table[top, left] * (1.0 - right) + table[top, after] * right
    lower = table[top + 1, left] * (1.0 - right) + table[top + 1, after] * right
    light: Pixels = (upper * (1.0 - down) + lower * down).astype(np.float32)
    return light


def light_from_below(scene: Scene) -> tuple[float, float]:
    """Return the illuminance of a horizontal plane that looks down, without the sun's disc. [lx]

    Returns
    -------
    by_map : float
        By what the map shows below.
    by_ground : float
        By the ground.
    """
    node, weight = np.polynomial.legendre.leggauss(_ZENITHS)
    # There are jumps at the horizon and, seen from space, at the upper limb.
    edges = scene.table.zenith_first, scene.table.zenith_horizon
    borders = math.pi / 2.0, *(max(edge, math.pi / 2.0) for edge in edges), math.pi
    azimuth = 2.0 * math.pi * (np.arange(_AZIMUTHS) + 0.5)[None] / _AZIMUTHS
    totals = np.zeros(2)
    for first, last in pairwise(borders):
        if last - first < _FLATTEST:
            continue
        zenith = 0.5 * (first + last) + 0.5 * (last - first) * node
        share = 0.5 * (last - first) * weight * np.abs(np.cos(zenith)) * np.sin(zenith)
        places = zenith[:, None], azimuth, np.full((1, 1), _PROBE_FOOTPRINT)
        for i, evaluate in enumerate((without_ground(scene, scene.evaluate), scene.evaluate)):
            luminance = evaluate(*places).astype(float) @ scene.luminance
            totals[i] += 2.0 * math.pi * float(share @ luminance.mean(axis=1))
    return float(totals[0]), float(totals[1])
