"""The light of all layers over an observer."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from skybake.clouds.air import ClearAir
from skybake.clouds.layer import Reflectance, SolvedLayer, Surroundings, solve_layer
from skybake.clouds.particles import divide_phase
from skybake.clouds.reflectance import reflectance_of
from skybake.clouds.suns import suns_over
from skybake.clouds.unlit import Layer
from skybake.jit.workers import Workers
from skybake.optics.medium import Array


def solve_layers(
    layers: Sequence[Layer],
    air: ClearAir,
    altitude: float,
    sun: Array,
    weights: Array,
    workers: Workers,
) -> list[SolvedLayer]:
    """Solve for the light of each layer.

    A layer is lit by what those above leave on average, and stands over what those below reflect.

    Parameters
    ----------
    layers : sequence of Layer
        From the highest down.
    air, altitude, sun, weights, workers
        As of `skybake.clouds.cloudscape.Cloudscape`.
    """
    particles = [divide_phase(each.phase, each.middle, each.order) for each in layers]
    reflects: list[Reflectance] = []
    for layer, particle in zip(reversed(layers), reversed(particles), strict=True):
        beneath = reflects[-1].flux if reflects else None
        above = air.from_above
        reflects.append(reflectance_of(layer.grid, particle, above, weights, sun, beneath, workers))
    reflects.reverse()
    out: list[SolvedLayer] = []
    sun_share = sky_ratio = np.ones(weights.shape[1])
    for k, (layer, particle) in enumerate(zip(layers, particles, strict=True)):
        ground = reflects[k + 1].flux if k + 1 < len(reflects) else None
        around = Surroundings(sun_share, sky_ratio, ground)
        suns = suns_over(sun, air.radius, altitude, layer.field.top)
        own = int(np.argmin(np.abs(suns[:, 2] - sun[2])))
        given = layer.grid, particle, air, weights, suns, own
        solved = solve_layer(*given, around, reflects[k], workers)
        at = nearest_sun(solved, sun)
        sun_share = sun_share * float(solved.leaving[at, 0].mean())
        sky_ratio = solved.down[at] / np.maximum(solved.down_clear[at], 1e-300)
        out.append(solved)
    return out


def nearest_sun(solved: SolvedLayer, sun: Array) -> int:
    """Which of the suns of a layer is nearest in height to one."""
    return int(np.argmin(np.abs(solved.light.sun_mu - sun[2])))
