"""Light scattered or reflected exactly once, by quadrature along the ray and toward the sun.

Two nested integrals and no table: slow and simple, to check the tables against.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Array, Medium
from skybake.transport.density import (
    GAUSS_FAR,
    GAUSS_LOW,
    GAUSS_NEAR,
    GAUSS_SELF,
    add_column,
    fill_column,
    fill_density,
)
from skybake.transport.geometry import (
    distance_to_entry,
    distance_to_exit,
    radius_at,
    shadow_interval,
)
from skybake.transport.trace import ray_limits

STEPS = 512
SUN_STEPS = 128
"""Steps along a ray and toward the sun with which light is within 3e-4 of the limit."""


class SingleLight(NamedTuple):
    """Light of the first order along rays, per unit irradiance of the sun above the atmosphere.

    Attributes
    ----------
    single : ndarray of float64, shape (ray, constituent, wavelength)
        Light that each constituent scattered, before its phase function.
    ground : ndarray of float64, shape (ray, wavelength)
        Sunlight that the ground at the rays' ends reflects. [sr⁻¹]
    """

    single: Array
    ground: Array


def trace_single(
    medium: Medium,
    r: Array,
    mu: Array,
    mu_s: Array,
    nu: Array,
    *,
    steps: int = STEPS,
    sun_steps: int = SUN_STEPS,
    workers: Workers = ALL_CPUS,
) -> SingleLight:
    """Integrate along rays and, from each point of them, toward the sun.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    r, mu, mu_s, nu : ndarray of float64, shape (ray,)
        Starts [km], cosines of the zenith angles of rays and sun there, and of the
        angles between rays and sun.
    steps, sun_steps : int, optional
        Steps along the rays and toward the sun, which grow with the distance from the
        lowest point; each has two Gauss-Legendre points.
    workers : Workers, optional
        Threads that do the work.
    """
    constituents, wavelengths = medium.extinction.shape
    single = np.zeros((r.size, constituents, wavelengths))
    ground = np.zeros((r.size, wavelengths))
    rays = np.stack([r, mu, mu_s, nu], axis=1)

    def work(first: int, last: int) -> None:
        scratch, light = np.empty((5, constituents)), np.empty(wavelengths)
        _integrate(medium, rays, steps, sun_steps, first, last, scratch, light, single, ground)

    workers.run_rows(r.size, work, chunk=16)
    return SingleLight(single, ground)


@kernel
def _integrate(medium, rays, steps, sun_steps, first, last, scratch, light, single, ground):
    """Fill the rays `first` to `last`."""
    along, column = scratch[0], scratch[1]
    for ray in range(first, last):
        r, mu, mu_s, nu = rays[ray, 0], rays[ray, 1], rays[ray, 2], rays[ray, 3]
        begin, end, hits_ground = ray_limits(medium, r, mu)
        dark_first, dark_last = shadow_interval(r, mu, mu_s, nu, medium.r_bottom, begin, end)
        lowest = min(max(-r * mu, begin), end)
        along[:] = 0.0
        low = begin
        for i in range(steps):
            high = _edge(begin, lowest, end, (i + 1) / steps)
            # What is before the shadow, in it and behind it.
            for part in range(3):
                start = low if part == 0 else max(low, dark_first if part == 1 else dark_last)
                stop = high if part == 2 else min(high, dark_first if part == 0 else dark_last)
                if stop > start:
                    step, is_lit = stop - start, part != 1
                    _add_step(
                        medium,
                        rays[ray],
                        start,
                        step,
                        is_lit,
                        sun_steps,
                        scratch,
                        light,
                        single[ray],
                    )
            low = high
        mu_s_ground = (r * mu_s + end * nu) / medium.r_bottom
        if hits_ground and mu_s_ground > 0.0:
            _fill_sun_column(medium, medium.r_bottom, mu_s_ground, sun_steps, scratch[2:], column)
            _fill_light(medium, along, column, light)
            for k in range(light.size):
                ground[ray, k] = medium.ground_albedo[k] / math.pi * mu_s_ground * light[k]


@kernel
def _edge(begin, lowest, end, share):
    """Distance after a share of the steps, which crowd quadratically at the lowest point."""
    before, after = math.sqrt(lowest - begin), math.sqrt(end - lowest)
    x = share * (before + after) - before
    return lowest + x * abs(x)


@kernel
def _add_step(medium, ray, start, step, is_lit, sun_steps, scratch, light, single):
    """Add the light of a step to `single`, and its columns to the first row of `scratch`."""
    along, column, low, high = scratch[0], scratch[1], scratch[2], scratch[3]
    r, mu, mu_s, nu = ray[0], ray[1], ray[2], ray[3]
    t_low, t_high = start + GAUSS_LOW * step, start + (1.0 - GAUSS_LOW) * step
    for i in range(2):
        h = radius_at(r, mu, t_low if i == 0 else t_high) - medium.r_bottom
        fill_density(medium.density, medium.r_bottom, medium.r_top, h, low if i == 0 else high)
    for i in range(2):
        t = t_low if i == 0 else t_high
        here = radius_at(r, mu, t)
        mu_s_here = (r * mu_s + t * nu) / here
        if not is_lit or distance_to_entry(here, mu_s_here, medium.r_bottom) < math.inf:
            continue
        _fill_sun_column(medium, here, mu_s_here, sun_steps, scratch[4:], column)
        near, far = (GAUSS_SELF, GAUSS_FAR) if i == 0 else (GAUSS_NEAR, GAUSS_SELF)
        for c in range(along.size):
            column[c] += step * (near * low[c] + far * high[c])
        _fill_light(medium, along, column, light)
        for c in range(along.size):
            amount = 0.5 * step * (low[c] if i == 0 else high[c])
            for k in range(light.size):
                single[c, k] += amount * medium.scattering[c, k] * light[k]
    for c in range(along.size):
        along[c] += 0.5 * step * (low[c] + high[c])


@kernel
def _fill_sun_column(medium, r, mu_s, steps, scratch, out):
    """Write the columns from a point to space; `scratch` holds a row."""
    length = distance_to_exit(r, mu_s, medium.r_top)
    if mu_s >= 0.0:
        fill_column(medium, r, mu_s, length, steps, scratch[0], out)
        return
    # From the lowest point, which is between, both ways.
    r_lowest = r * math.sqrt(max(1.0 - mu_s * mu_s, 0.0))
    fill_column(medium, r_lowest, 0.0, length + r * mu_s, steps, scratch[0], out)
    add_column(medium, r_lowest, 0.0, -r * mu_s, steps, scratch[0], out)


@kernel
def _fill_light(medium, along, column, out):
    """Write the transmittance of two columns together to `out`, shape (wavelength,)."""
    out[:] = 0.0
    for c in range(along.size):
        for k in range(out.size):
            out[k] -= medium.extinction[c, k] * (along[c] + column[c])
    for k in range(out.size):
        out[k] = math.exp(out[k])
