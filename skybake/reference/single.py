"""Light scattered or reflected exactly once, by quadrature along the ray."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.reference.air import Air
from skybake.reference.directions import Direction, advance, dot, phase_and_lobe, scattering_at
from skybake.reference.rays import (
    altitude_on_ray,
    column,
    new_cuts,
    node_value,
    place_at_depth,
    trace,
    transmittance_to_space,
)

LONGEST_PIECE = 1e-3
"""Of the planet's radius: 6 km on Earth, over which the sun sinks by 0.06 deg."""

_GAUSS = 0.5 - 0.5 / math.sqrt(3.0)


def single_radiance(air: Air, sun: Direction, h: float, direction: Direction) -> float:
    """Radiance of order 1 from altitude `h` under the vertical (0, 0, 1).

    Two Gauss points, in transmittance, for every piece of the ray: pieces end
    where the ray crosses a shell or the planet's shadow.
    """
    room = np.empty(len(air.scattering))
    return float(_single_radiance(air, sun, h, direction, new_cuts(air), room))


@kernel
def _single_radiance(air, sun, h, direction, room, each):
    ray = trace(air, h, direction[2], room)
    if ray.segments == 0:
        return 0.0
    shadow = _shadow_crossings(air, ray, sun, h, direction)
    longest = LONGEST_PIECE * air.r_bottom
    radiance = 0.0
    depth = 0.0
    cuts = ray.cuts
    for i in range(ray.segments):
        k = cuts.shell[i]
        pieces = math.ceil((cuts.s[i + 1] - cuts.s[i]) / longest)
        s0, h0 = cuts.s[i], cuts.h[i]
        piece = 1
        while piece <= pieces:
            s1 = cuts.s[i] + (cuts.s[i + 1] - cuts.s[i]) * piece / pieces
            piece += 1
            for crossing in shadow:
                if s0 < crossing < s1:
                    s1 = crossing
                    piece -= 1
            h1 = altitude_on_ray(air.r_bottom, ray.h_tangent, s1)
            before = node_value(air.altitude, air.extinction, k, h0)
            after = node_value(air.altitude, air.extinction, k, h1)
            piece_depth = column(air, ray.h_tangent, k, s0, before, s1, after)
            opacity = -math.expm1(-piece_depth)
            for u in (_GAUSS, 1.0 - _GAUSS):
                if opacity <= 0.0:
                    break
                target = -math.log1p(-u * opacity)
                s = place_at_depth(air, ray.h_tangent, k, s0, h0, s1, h1, target)
                source = _source(air, ray, sun, h, direction, k, s, each)
                radiance += 0.5 * math.exp(-depth) * opacity * source
            depth += piece_depth
            s0, h0 = s1, h1
    if ray.reaches_ground:
        up = advance((0.0, 0.0, 1.0), air.r_bottom + h, direction, cuts.s[ray.segments] - ray.start)
        mu_s = max(0.0, dot(up, sun))
        sunlight = mu_s * transmittance_to_space(air, 0.0, mu_s)
        radiance += math.exp(-depth) * air.albedo / math.pi * sunlight
    return radiance


@kernel
def _source(air, ray, sun, h, direction, k, s, each):
    """Light that extinction at `s` turns toward the observer, per unit of extinction."""
    h_there = max(0.0, altitude_on_ray(air.r_bottom, ray.h_tangent, s))
    total = scattering_at(air, k, h_there, each)
    if total <= 0.0:
        return 0.0
    up = advance((0.0, 0.0, 1.0), air.r_bottom + h, direction, s - ray.start)
    phase, _ = phase_and_lobe(air, each, total, direction, sun)
    albedo = total / node_value(air.altitude, air.extinction, k, h_there)
    return albedo * phase * transmittance_to_space(air, h_there, dot(up, sun))


@kernel
def _shadow_crossings(air, ray, sun, h, direction):
    """Where the ray meets the cylinder that the planet's shadow fills, as distances `s`."""
    r = air.r_bottom + h
    nu = dot(direction, sun)
    a = 1.0 - nu * nu
    b = r * (direction[2] - sun[2] * nu)
    c = (h * (2.0 * air.r_bottom + h)) - (r * sun[2]) ** 2
    if a <= 0.0 or b * b <= a * c:
        return ray.start, ray.start
    root = math.sqrt(b * b - a * c)
    return ray.start + (-b - root) / a, ray.start + (-b + root) / a
