"""Stretches of a ray: where on it a path has its next vertex."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.reference.air import Air
from skybake.reference.directions import uniform
from skybake.reference.guide import look_up
from skybake.reference.rays import altitude_on_ray, place_at_depth

SEGMENTS_PER_STRETCH = 16

GUIDED_STRETCHES = 0.8
"""Share of a path's first vertices drawn by the guide, the others as an unguided photon's."""


def new_stretches(air: Air) -> npt.NDArray[np.float64]:
    """Room for `weigh_stretches`."""
    return np.empty(2 * len(air.altitude) // SEGMENTS_PER_STRETCH + 4)


@kernel
def weigh_stretches(air, guide, ray, h, mu_s, nu, lit, order, cumulative):
    """Give each stretch of the ray, and the ground last, a probability, as running sums.

    Parameters
    ----------
    lit : bool
        Whether sunlight that scatters here counts, or only what scattered before.
    order : int
        Of the scattering that the ray leads to.

    Returns
    -------
    stretches : int
        Number of entries, the ground included if the ray meets it.
    """
    cuts = ray.cuts
    r_start = air.r_bottom + h
    total = 0.0
    count = 0
    first = 0
    promise = _promise(air, guide, ray, 0, r_start, mu_s, nu, lit)
    while first < ray.segments:
        last = min(first + SEGMENTS_PER_STRETCH, ray.segments)
        promise_after = _promise(air, guide, ray, last, r_start, mu_s, nu, lit)
        share = math.exp(-cuts.depth[first]) * -math.expm1(cuts.depth[first] - cuts.depth[last])
        total += share * 0.5 * (promise + promise_after)
        cumulative[count] = total
        count += 1
        promise = promise_after
        first = last
    if ray.reaches_ground:
        ground_mu_s = _mu_s_at_cut(air, ray, ray.segments, r_start, mu_s, nu)
        light = look_up(guide, guide.ambient, 0.0, ground_mu_s)
        if lit:
            # Lambert's 1/pi against the mean phase function, 1/(4 pi).
            light += 4.0 * max(0.0, ground_mu_s) * look_up(guide, guide.direct, 0.0, ground_mu_s)
        total += math.exp(-cuts.depth[ray.segments]) * air.albedo * light
        cumulative[count] = total
        count += 1
    if total <= 0.0:
        return 0
    # The guide may be wrong by any factor where light is scattered often. Drawing some
    # places as if all promised the same, and of a long path most, bounds its weight.
    guided = GUIDED_STRETCHES / order
    unguided = 1.0 if ray.reaches_ground else -math.expm1(-cuts.depth[ray.segments])
    for b in range(count):
        passed = 1.0
        if not (ray.reaches_ground and b == count - 1):
            last = min((b + 1) * SEGMENTS_PER_STRETCH, ray.segments)
            passed = -math.expm1(-cuts.depth[last])
        cumulative[b] = guided * cumulative[b] / total + (1.0 - guided) * passed / unguided
    return count


@kernel
def _mu_s_at_cut(air, ray, i, r_start, mu_s, nu):
    return (r_start * mu_s + (ray.cuts.s[i] - ray.start) * nu) / (air.r_bottom + ray.cuts.h[i])


@kernel
def _promise(air, guide, ray, i, r_start, mu_s, nu, lit):
    h = ray.cuts.h[i]
    mu_s_there = _mu_s_at_cut(air, ray, i, r_start, mu_s, nu)
    light = look_up(guide, guide.ambient, h, mu_s_there)
    if lit:
        light += look_up(guide, guide.direct, h, mu_s_there)
    return light


@kernel
def draw_vertex(air, ray, stretches, cumulative, u, state):
    """Where the ray scatters or meets the ground, and the weight of having drawn that.

    A stretch is drawn by what it promises, the place in it as an unguided
    photon would be absorbed or scattered, given that it is there.

    Returns
    -------
    weight : float
        Transmittance x extinction x length over the probability drawn with.
    s, h : float
    shell : int
        -1 at the ground.
    """
    cuts = ray.cuts
    b = min(np.searchsorted(cumulative[:stretches], u, side="right"), stretches - 1)
    probability = cumulative[b] - (cumulative[b - 1] if b > 0 else 0.0)
    if probability <= 0.0:
        return 0.0, 0.0, 0.0, 0
    if ray.reaches_ground and b == stretches - 1:
        depth = cuts.depth[ray.segments]
        return math.exp(-depth) / probability, cuts.s[ray.segments], 0.0, -1
    first = b * SEGMENTS_PER_STRETCH
    last = min(first + SEGMENTS_PER_STRETCH, ray.segments)
    absorbed = -math.expm1(cuts.depth[first] - cuts.depth[last])
    target = cuts.depth[first] - math.log1p(-uniform(state) * absorbed)
    i = first + np.searchsorted(cuts.depth[first + 1 : last], target)
    s = place_at_depth(
        air,
        ray.h_tangent,
        cuts.shell[i],
        cuts.s[i],
        cuts.h[i],
        cuts.s[i + 1],
        cuts.h[i + 1],
        target - cuts.depth[i],
    )
    h = max(0.0, altitude_on_ray(air.r_bottom, ray.h_tangent, s))
    weight = math.exp(-cuts.depth[first]) * absorbed / probability
    return weight, s, h, cuts.shell[i]
