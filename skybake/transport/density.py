"""Density of the constituents at an altitude, and columns along a ray."""

from __future__ import annotations

import math

from skybake.jit.kernel import kernel
from skybake.transport.geometry import radius_at

# Gauss-Legendre collocation with two points (Butcher tableau of the Gauss
# method of order 4): points at GAUSS_LOW and 1 - GAUSS_LOW of a step, and the
# integral from the step's start to a point as a sum over both points' values.
GAUSS_LOW = 0.5 - math.sqrt(3.0) / 6.0
GAUSS_SELF = 0.25
GAUSS_FAR = 0.25 - math.sqrt(3.0) / 6.0
GAUSS_NEAR = 0.25 + math.sqrt(3.0) / 6.0


@kernel
def fill_density(density, r_bottom, r_top, h, out):
    """Write the relative density of every constituent at altitude `h` [km] to `out`."""
    last = density.shape[0] - 1
    x = math.sqrt(min(max(h / (r_top - r_bottom), 0.0), 1.0)) * last
    i = min(int(x), last - 1)
    weight = x - i
    for c in range(out.size):
        out[c] = density[i, c] + weight * (density[i + 1, c] - density[i, c])


@kernel
def fill_column(medium, r, mu, length, steps, scratch, out):
    """Write the columns along a ray to `out`, by plain Gauss-Legendre steps.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    r, mu, length : float
        Start, zenith cosine and length of the ray. [km]
    steps : int
        Steps, growing with the square of the distance from the start.
    scratch, out : ndarray of float64, shape (constituent,)
        Work space, and the integral of relative density over the ray. [km]
    """
    for c in range(out.size):
        out[c] = 0.0
    add_column(medium, r, mu, length, steps, scratch, out)


@kernel
def add_column(medium, r, mu, length, steps, scratch, out):
    """Add the columns along a ray to `out`; parameters are those of `fill_column`."""
    for k in range(steps):
        start = length * (k / steps) ** 2
        step = length * ((k + 1) / steps) ** 2 - start
        for point in (GAUSS_LOW, 1.0 - GAUSS_LOW):
            h = radius_at(r, mu, start + point * step) - medium.r_bottom
            fill_density(medium.density, medium.r_bottom, medium.r_top, h, scratch)
            for c in range(out.size):
                out[c] += 0.5 * step * scratch[c]
