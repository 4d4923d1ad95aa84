"""Light gathered along rays up to given distances, and what passes of the light behind."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError
from skybake.jit.arguments import flatten
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Array
from skybake.scattering.fans import Fans, group_rays
from skybake.scattering.ray import LightOfFans, chunk_of_fans
from skybake.scattering.tables import Atmosphere
from skybake.transport.samples import BATCH_RAYS, allocate_samples
from skybake.transport.trace import MAX_ARC, trace_spans

SHORTEST = 1e-9
"""To which distances are taken, so that no step is shorter. [km]"""

MAX_DISTANCES = 1024
"""Distances of one ray at most: each ends a step, and a ray's steps are limited."""


class SegmentLight(NamedTuple):
    """Light along the first parts of rays, per unit irradiance of the source.

    A ray ends at the ground or at the top of the atmosphere: beyond that nothing is
    gathered but the light of the ground itself, at the first distance that is longer.

    Attributes
    ----------
    single : ndarray of float64, shape (ray, distance, phase function, wavelength)
        As of `RayLight`, up to each distance.
    diffuse : ndarray of float32, shape (ray, distance, wavelength)
        As of `RayLight`, up to each distance. [sr⁻¹]
    transmittance : ndarray of float64, shape (ray, distance, wavelength)
        Share of the light behind that passes: all but what is scattered out of the forward
        peaks that `ScaledMedium` leaves out. It dims the ground, diffuse light and the
        single scattering of constituents alike.
    unscattered : ndarray of float64, shape (ray, distance, wavelength)
        What passes without being scattered at all: it dims a star, and of single scattering
        what the phase functions of peaks multiply.
    """

    single: Array
    diffuse: npt.NDArray[np.floating[Any]]
    transmittance: Array
    unscattered: Array


def trace_segments(
    atmosphere: Atmosphere,
    r: Array,
    mu: Array,
    mu_s: Array,
    nu: Array,
    distances: npt.ArrayLike,
    *,
    max_arc: float = MAX_ARC,
    workers: Workers = ALL_CPUS,
) -> SegmentLight:
    """Integrate the light along rays up to each of several distances, in parallel.

    Parameters
    ----------
    atmosphere, r, mu, mu_s, nu, max_arc, workers
        As of `trace_rays`.
    distances : array_like, shape (distance,) or (ray, distance)
        From the rays' starts, ascending; may be infinite. Taken to the micrometre. [km]

    Returns
    -------
    SegmentLight
        Wavelengths are as `pad_wavelengths` leaves them.

    Raises
    ------
    InputError
        If distances are negative, do not ascend, or are more than `MAX_DISTANCES`.

    Notes
    -----
    Steps end at the distances; samples and kernels are otherwise those of `trace_rays`, whose
    very result comes from an infinite distance.
    """
    scaled = atmosphere.scaled
    phases, _, wavelengths = scaled.phase.shape
    ends = _check_distances(distances, r.size)
    number = ends.shape[1]
    fans = group_rays(np.stack([r, mu, mu_s, nu], axis=1), ends)
    spans, ray, end = _spread(fans, number)
    single = np.zeros((len(ray), phases, wavelengths))
    diffuse = np.zeros((len(ray), wavelengths), np.float32)
    transmittance = np.empty((len(spans.starts), wavelengths))
    column = np.empty((len(spans.starts), len(scaled.medium.extinction)))
    light = LightOfFans(atmosphere, spans, single, diffuse)
    medium, starts, fan_ends = map(
        flatten, (scaled.medium, fans.starts, np.ascontiguousarray(ends[fans.first[:-1]]))
    )

    def work(begin: int, stop: int) -> None:
        samples = allocate_samples(scaled.medium, max(number, BATCH_RAYS))
        filled, scratch = flatten(samples), light.allocate()
        while begin < stop:
            behind = trace_spans(
                medium, atmosphere.shells, max_arc, starts, fan_ends, begin, stop, filled
            )
            first, last = begin * number, behind * number
            light.add(first, last, samples, filled, scratch)
            transmittance[first:last] = samples.transmittance[: last - first]
            column[first:last] = samples.column[: last - first]
            begin = behind

    workers.run_rows(len(fans.starts), work, chunk=chunk_of_fans(len(fans.starts), workers))
    fan = np.repeat(np.arange(len(fans.starts)), np.diff(fans.first))
    extinction = scaled.medium.extinction + scaled.fraction * scaled.scattering
    return SegmentLight(
        single=_sum_spans(single, ray, end, ends.shape),
        diffuse=_sum_spans(diffuse, ray, end, ends.shape),
        transmittance=transmittance.reshape(-1, number, wavelengths)[fan],
        unscattered=np.exp(-(column @ extinction)).reshape(-1, number, wavelengths)[fan],
    )


def _sum_spans(
    light: npt.NDArray[Any],
    ray: npt.NDArray[np.int64],
    end: npt.NDArray[np.int64],
    shape: tuple[int, ...],
) -> npt.NDArray[Any]:
    """Light of all spans up to each distance, shape (ray, distance, ...)."""
    ordered = np.empty(shape + light.shape[1:], light.dtype)
    ordered[ray, end] = light
    return np.cumsum(ordered, axis=1, out=ordered)


def _check_distances(distances: npt.ArrayLike, rays: int) -> Array:
    """Distances of each ray, shape (ray, distance)."""
    # Steps that are shorter would be lost among the roundings of their ends.
    ends = np.round(np.asarray(distances, dtype=float) / SHORTEST) * SHORTEST
    if ends.ndim not in (1, 2) or not 1 <= ends.shape[-1] <= MAX_DISTANCES:
        raise InputError(
            f"distances: must be 1 to {MAX_DISTANCES} for a ray, got an array of shape {ends.shape}"
        )
    if not ((ends >= 0.0).all() and (ends[..., 1:] >= ends[..., :-1]).all()):
        raise InputError("distances: must ascend from 0 km or more")
    return np.broadcast_to(ends, (rays, ends.shape[-1]))


def _spread(fans: Fans, number: int) -> tuple[Fans, npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Fans of the spans between so many distances; of each of their rays, which ray and span."""
    width = np.diff(fans.first)
    widths = np.repeat(width, number)
    first = np.concatenate([[0], np.cumsum(widths)]).astype(np.int64)
    inside = np.arange(first[-1]) - np.repeat(first[:-1], widths)
    ray = np.repeat(np.repeat(fans.first[:-1], number), widths) + inside
    end = np.repeat(np.tile(np.arange(number), len(width)), widths)
    return Fans(fans.rays[ray], first, np.repeat(fans.starts, number, axis=0)), ray, end
