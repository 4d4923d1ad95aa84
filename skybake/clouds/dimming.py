"""How clouds change the diffuse light in them, beneath them, and on the ground."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from skybake.clouds.air import ClearAir
from skybake.clouds.layer import Grid, SolvedLayer
from skybake.clouds.quadrature import double_gauss
from skybake.jit.kernel import kernel
from skybake.optics.medium import Array

FAINT = 0.01
"""Of the light that clouds send down, below which that of a clear sky is not compared with it."""

SPHERE = 7
"""Order of the directions over which a clear sky's light is averaged."""


class Dimming(NamedTuple):
    """How clouds change the diffuse light around them.

    Attributes
    ----------
    altitude : ndarray of float64, shape (level,)
        Ascending. [km]
    ratio : ndarray of float64, shape (level, channel)
        Mean radiance with clouds over that without; 1 above them.
    ground : ndarray of float64, shape (channel,)
        The same of the irradiance of the ground by the sky.
    irradiance : ndarray of float64, shape (channel,)
        Of the ground by clouds, where hardly any comes from a clear sky that could be compared.
    """

    altitude: Array
    ratio: Array
    ground: Array
    irradiance: Array


def dimming_by(
    grids: Sequence[Grid],
    layers: Sequence[SolvedLayer],
    suns: Sequence[int],
    air: ClearAir,
    weights: Array,
    sun: Array,
) -> Dimming:
    """Compare the light of layers with that of the clear sky.

    Parameters
    ----------
    grids, layers : sequence of Grid and SolvedLayer
        From the highest down.
    suns : sequence of int
        Which of a layer's suns is that over the observer.
    air, weights
        As of `solve_layer`.
    sun : ndarray of float64, shape (3,)
        Toward the sun.
    """
    quadrature = double_gauss(SPHERE, 0.0)
    altitudes, ratios = [], []
    for grid, layer, at in zip(grids, layers, suns, strict=True):
        edges = np.array([grid.base, grid.top])
        clear = []
        for altitude in edges.tolist():
            light = air.light_at(altitude, -quadrature.direction, sun)
            clear.append(quadrature.weight @ ((light.single + light.diffuse) @ weights))
        share = ((grid.levels - edges[0]) / (edges[1] - edges[0]))[:, None]
        between = np.maximum(clear[0] + share * (clear[1] - clear[0]), 1e-300)
        altitudes.append(grid.levels)
        ratios.append(layer.mean_radiance[at] / between)
    altitude, ratio = np.concatenate(altitudes), np.concatenate(ratios)
    order = np.argsort(altitude, kind="stable")
    down, bare = layers[-1].down[suns[-1]], layers[-1].down_clear[suns[-1]]
    is_faint = bare < FAINT * down
    return Dimming(
        # Levels of layers that overlap must ascend too.
        altitude=altitude[order] + 1e-9 * np.arange(order.size),
        ratio=ratio[order],
        ground=np.where(is_faint, 1.0, down / np.maximum(bare, 1e-300)),
        irradiance=np.where(is_faint, down, 0.0),
    )


@kernel
def dimming_at(dimming, h, channel):
    """Ratio of diffuse light at an altitude."""
    levels = dimming.altitude.size
    if h >= dimming.altitude[levels - 1]:
        return 1.0
    if h <= dimming.altitude[0]:
        return dimming.ratio[0, channel]
    k = 0
    while h > dimming.altitude[k + 1]:
        k += 1
    u = (h - dimming.altitude[k]) / (dimming.altitude[k + 1] - dimming.altitude[k])
    return dimming.ratio[k, channel] + u * (
        dimming.ratio[k + 1, channel] - dimming.ratio[k, channel]
    )
