"""The samples of a ray that the sun reaches."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array, Medium
from skybake.scattering.transmittance import fill_sun_column
from skybake.transport.density import GAUSS_LOW, fill_density
from skybake.transport.geometry import radius_at, shadow_interval

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
    depth, light, filled : ndarray of float32, shape (sample,)
        Scratch for one wavelength.
    column, through : ndarray of float64, shape (constituent,) and (wavelength,)
        Scratch for one sample.
    """

    sunward: npt.NDArray[np.float32]
    backward: npt.NDArray[np.float32]
    density: npt.NDArray[np.float32]
    weight: npt.NDArray[np.float32]
    depth: npt.NDArray[np.float32]
    light: npt.NDArray[np.float32]
    filled: npt.NDArray[np.float32]
    column: Array
    through: Array


def allocate_sunlit(medium: Medium, samples: int) -> Sunlit:
    """Make the work space for rays of at most so many samples; each thread needs its own."""
    constituents, wavelengths = medium.extinction.shape
    most = samples + SPARE
    return Sunlit(
        sunward=np.empty((constituents, most), np.float32),
        backward=np.empty((constituents, most), np.float32),
        density=np.empty((constituents, most), np.float32),
        weight=np.empty((wavelengths, most), np.float32),
        depth=np.empty(most, np.float32),
        light=np.empty(most, np.float32),
        filled=np.empty(most, np.float32),
        column=np.empty(constituents),
        through=np.empty(wavelengths),
    )


@kernel
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

    Notes
    -----
    Within a step that is cut, transmittance to the observer is taken as linear: the
    atmosphere would have to be thick for that to show, and then no light comes by the planet's
    edge. Density may fall to a third within a step high up and is looked up.
    """
    r, mu, mu_s, nu = ray[0], ray[1], ray[2], ray[3]
    dark_first, dark_last = shadow_interval(r, mu, mu_s, nu, medium.r_bottom, 0.0, length)
    count = np.int64(0)
    for n in range(first, last, 2):
        step = (samples.distance[n + 1] - samples.distance[n]) / (1.0 - 2.0 * GAUSS_LOW)
        start = samples.distance[n] - GAUSS_LOW * step
        stop = start + step
        for part in range(2):
            # What is before the shadow, then what is behind it.
            begin = start if part == 0 else max(start, dark_last)
            end = min(stop, dark_first) if part == 0 else stop
            if end <= begin:
                continue
            is_whole = begin == start and end == stop
            for i in range(2):
                distance, radius, share = samples.distance[n + i], samples.radius[n + i], float(i)
                if not is_whole:
                    distance = begin + (end - begin) * (GAUSS_LOW if i == 0 else 1.0 - GAUSS_LOW)
                    radius = radius_at(r, mu, distance)
                    share = (distance - samples.distance[n]) / (step * (1.0 - 2.0 * GAUSS_LOW))
                mu_s_here = (r * mu_s + distance * nu) / radius
                if not fill_sun_column(
                    columns, medium.r_bottom, medium.r_top, radius, mu_s_here, out.column
                ):
                    continue
                for c in range(out.column.size):
                    low, high = samples.column_to[n, c], samples.column_to[n + 1, c]
                    out.sunward[c, count] = out.column[c]
                    out.backward[c, count] = low + share * (high - low)
                    out.density[c, count] = samples.density[n + i, c]
                scale = (end - begin) / step
                for k in range(out.weight.shape[0]):
                    low, high = samples.weight[n, k], samples.weight[n + 1, k]
                    out.weight[k, count] = scale * (low + share * (high - low))
                if not is_whole:
                    h = radius - medium.r_bottom
                    fill_density(medium.density, medium.r_bottom, medium.r_top, h, out.column)
                    for c in range(out.column.size):
                        out.density[c, count] = out.column[c]
                count += 1
    return count
