"""The samples of a ray that the sun reaches."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.luts.transmittance import fill_sun_column
from skybake.transport.density import GAUSS_FAR, GAUSS_LOW, GAUSS_SELF, fill_density
from skybake.transport.exponential import fast_exp
from skybake.transport.geometry import radius_at, shadow_interval
from skybake.transport.kernel import inner_kernel

SPARE = 4
"""Samples by which a ray can outgrow its fan: the shadow cuts two steps at most."""


class Sunlit(NamedTuple):
    """Work space for the sunlit samples of one ray.

    Unlike in `Samples` each constituent and wavelength has its samples side by side,
    and in single precision: loops over them are several times as fast.

    Attributes
    ----------
    sunward, backward : ndarray of float32, shape (constituent, sample)
        Columns to the sun and to the observer. [km]
    density : ndarray of float32, shape (constituent, sample)
        Relative densities.
    weight : ndarray of float32, shape (wavelength, sample)
        As in `Samples`. [km]
    column, mixture : ndarray of float64, shape (constituent,)
        A column toward the sun [km], and densities; scratch.
    """

    sunward: npt.NDArray[np.float32]
    backward: npt.NDArray[np.float32]
    density: npt.NDArray[np.float32]
    weight: npt.NDArray[np.float32]
    column: npt.NDArray[np.floating[Any]]
    mixture: npt.NDArray[np.floating[Any]]


@inner_kernel
def gather_sunlit(medium, columns, ray, samples, first, last, length, out):
    """Collect what of a fan's samples the sun reaches along one of its rays.

    Parameters
    ----------
    medium, columns : Medium, ndarray
        The atmosphere and its table of `build_columns`.
    ray : ndarray of float64, shape (4,)
        A row of `Fans.rays`.
    samples, first, last, length
        Result of `trace`, the fan's samples in it and its rays' length.
    out : Sunlit
        Receives the samples; of a step that the shadow's edge cuts, new ones.

    Returns
    -------
    int
        How many there are.
    """
    r, mu, mu_s, nu = ray[0], ray[1], ray[2], ray[3]
    dark_first, dark_last = shadow_interval(r, mu, mu_s, nu, medium.r_bottom, 0.0, length)
    count = np.int64(0)
    for n in range(first, last, 2):
        step = (samples.distance[n + 1] - samples.distance[n]) / (1.0 - 2.0 * GAUSS_LOW)
        start = samples.distance[n] - GAUSS_LOW * step
        if dark_last <= start or dark_first >= start + step:
            for i in range(n, n + 2):
                if _find_sun(
                    medium, columns, ray, samples.distance[i], samples.radius[i], out.column
                ):
                    for c in range(out.column.size):
                        out.sunward[c, count] = out.column[c]
                        out.backward[c, count] = samples.column_to[i, c]
                        out.density[c, count] = samples.density[i, c]
                    for k in range(out.weight.shape[0]):
                        out.weight[k, count] = samples.weight[i, k]
                    count += 1
            continue
        if dark_first > start:
            count = _cut_step(
                medium, columns, ray, samples, n, start, step, start, dark_first, count, out
            )
        if dark_last < start + step:
            count = _cut_step(
                medium, columns, ray, samples, n, start, step, dark_last, start + step, count, out
            )
    return count


@inner_kernel
def _find_sun(medium, columns, ray, distance, radius, out):
    """Write the columns from a point of a ray toward the sun, unless the planet blocks it."""
    mu_s = (ray[0] * ray[2] + distance * ray[3]) / radius
    return fill_sun_column(columns, medium.r_bottom, medium.r_top, radius, mu_s, out)


@inner_kernel
def _cut_step(medium, columns, ray, samples, n, start, step, begin, end, count, out):
    """Add two samples for the part of a step between two distances; returns how many there are.

    Columns follow from the density as linear through the step's own two points, which
    is what these integrate.
    """
    for i in range(2):
        distance = begin + (end - begin) * (GAUSS_LOW if i == 0 else 1.0 - GAUSS_LOW)
        radius = radius_at(ray[0], ray[1], distance)
        if not _find_sun(medium, columns, ray, distance, radius, out.column):
            continue
        h = radius - medium.r_bottom
        fill_density(medium.density, medium.r_bottom, medium.r_top, h, out.mixture)
        x = (distance - start) / step
        bend = x * (0.5 * x - GAUSS_LOW) / (1.0 - 2.0 * GAUSS_LOW)
        for c in range(out.column.size):
            low, high = samples.density[n, c], samples.density[n + 1, c]
            to_start = samples.column_to[n, c] - step * (GAUSS_SELF * low + GAUSS_FAR * high)
            out.sunward[c, count] = out.column[c]
            out.backward[c, count] = to_start + step * (x * low + bend * (high - low))
            out.density[c, count] = out.mixture[c]
        for k in range(out.weight.shape[0]):
            depth = 0.0
            for c in range(out.column.size):
                depth += medium.extinction[c, k] * out.backward[c, count]
            out.weight[k, count] = 0.5 * (end - begin) * fast_exp(-depth)
        count += 1
    return count
