"""Single scattering by two nested loops and no table: slow, and what tables are judged by."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Array, Medium
from skybake.transport.density import fill_density
from skybake.transport.geometry import distance_to_entry, distance_to_exit, radius_at
from skybake.transport.trace import ray_limits

VIEW_STEPS = 256
LIGHT_STEPS = 128


def march_rays(
    medium: Medium,
    r: Array,
    mu: Array,
    mu_s: Array,
    nu: Array,
    *,
    view_steps: int = VIEW_STEPS,
    light_steps: int = LIGHT_STEPS,
    workers: Workers = ALL_CPUS,
) -> tuple[Array, Array]:
    """March along rays and from each step toward the sun.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    r, mu, mu_s, nu : ndarray of float64, shape (ray,)
        Starts [km], cosines of the zenith angles of rays and sun there, and of the
        angles between rays and sun.
    view_steps, light_steps : int, optional
        Steps along the rays and toward the sun; midpoints, quadratic in
        the distance from the lowest point.
    workers : Workers, optional
        Who does the work.

    Returns
    -------
    single : ndarray of float64, shape (ray, constituent, wavelength)
        Light scattered once by each constituent per unit irradiance, before its
        phase function.
    ground : ndarray of float64, shape (ray, wavelength)
        Sunlight reflected by the ground at the rays' ends per unit irradiance. [sr⁻¹]
    """
    constituents, wavelengths = medium.extinction.shape
    single = np.zeros((r.size, constituents, wavelengths))
    ground = np.zeros((r.size, wavelengths))
    rays = np.stack([r, mu, mu_s, nu], axis=1)

    def work(first: int, last: int) -> None:
        steps = view_steps, light_steps
        scratch = np.empty((2, constituents)), np.empty((2, wavelengths))
        _march(medium, rays, *steps, first, last, *scratch, single, ground)

    workers.run_rows(r.size, work, chunk=32)
    return single, ground


@kernel
def _add_depth(medium, r, mu, length, steps, density, depth):
    """Add the optical depth along a ray to `depth`, by midpoints; `density` is scratch."""
    for i in range(steps):
        low, high = length * (i / steps) ** 2, length * ((i + 1) / steps) ** 2
        h = radius_at(r, mu, 0.5 * (low + high)) - medium.r_bottom
        fill_density(medium.density, medium.r_bottom, medium.r_top, h, density)
        for c in range(density.size):
            for k in range(depth.size):
                depth[k] += (high - low) * density[c] * medium.extinction[c, k]


@kernel
def _edge(begin, lowest, end, share):
    """Distance after a share of the steps, which crowd quadratically at the lowest point."""
    before, after = math.sqrt(lowest - begin), math.sqrt(end - lowest)
    x = share * (before + after) - before
    return lowest + x * abs(x)


@kernel
def _march(medium, rays, view_steps, light_steps, first, last, densities, depths, single, ground):
    constituents, wavelengths = medium.extinction.shape
    density, scratch = densities[0], densities[1]
    along, total = depths[0], depths[1]
    for ray in range(first, last):
        r, mu, mu_s, nu = rays[ray, 0], rays[ray, 1], rays[ray, 2], rays[ray, 3]
        begin, end, hits_ground = ray_limits(medium, r, mu)
        lowest = min(max(-r * mu, begin), end)
        along[:] = 0.0
        for i in range(view_steps):
            low = _edge(begin, lowest, end, i / view_steps)
            high = _edge(begin, lowest, end, (i + 1) / view_steps)
            t = 0.5 * (low + high)
            here = radius_at(r, mu, t)
            fill_density(
                medium.density, medium.r_bottom, medium.r_top, here - medium.r_bottom, density
            )
            mu_s_here = (r * mu_s + t * nu) / here
            for k in range(wavelengths):
                step_depth = 0.0
                for c in range(constituents):
                    step_depth += 0.5 * (high - low) * density[c] * medium.extinction[c, k]
                total[k] = along[k] + step_depth
                along[k] += 2.0 * step_depth
            if distance_to_entry(here, mu_s_here, medium.r_bottom) < math.inf:
                continue
            to_top = distance_to_exit(here, mu_s_here, medium.r_top)
            _add_depth(medium, here, mu_s_here, to_top, light_steps, scratch, total)
            for c in range(constituents):
                for k in range(wavelengths):
                    source = density[c] * medium.scattering[c, k]
                    single[ray, c, k] += (high - low) * source * math.exp(-total[k])
        mu_s_ground = (r * mu_s + end * nu) / medium.r_bottom
        if hits_ground and mu_s_ground > 0.0:
            for k in range(wavelengths):
                total[k] = along[k]
            to_top = distance_to_exit(medium.r_bottom, mu_s_ground, medium.r_top)
            _add_depth(medium, medium.r_bottom, mu_s_ground, to_top, light_steps, scratch, total)
            for k in range(wavelengths):
                reflected = medium.ground_albedo[k] / math.pi * mu_s_ground
                ground[ray, k] = reflected * math.exp(-total[k])
