"""Radiance along many rays, with the phase functions still to be applied."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.arguments import flatten
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.delta_m import PEAK_NODES
from skybake.optics.medium import Array
from skybake.scattering.fans import group_rays
from skybake.scattering.multiple import add_diffuse, allocate_scratch, side_by_side
from skybake.scattering.single import add_single_scattering
from skybake.scattering.sunlit import allocate_sunlit
from skybake.scattering.tables import Atmosphere
from skybake.transport.samples import allocate_samples
from skybake.transport.trace import MAX_ARC, trace

LEAST_FANS = 3
"""Fans for which a thread's work space is worth its making."""


class RayLight(NamedTuple):
    """Light along rays, per unit irradiance of the sun above the atmosphere.

    Attributes
    ----------
    single : ndarray of float64, shape (ray, phase function, wavelength)
        Sunlight scattered once toward the observer, before the phase functions
        `ScaledMedium.phase` are applied.
    diffuse : ndarray of float32, shape (ray, wavelength)
        The rest: scattered twice or more, and from the ground. [sr⁻¹]
    """

    single: Array
    diffuse: npt.NDArray[np.floating[Any]]


def trace_rays(
    atmosphere: Atmosphere,
    r: Array,
    mu: Array,
    mu_s: Array,
    nu: Array,
    *,
    max_arc: float = MAX_ARC,
    workers: Workers = ALL_CPUS,
) -> RayLight:
    """Integrate the light along rays, in parallel.

    Parameters
    ----------
    atmosphere : Atmosphere
        What the rays pass through.
    r, mu : ndarray of float64, shape (ray,)
        Starts of the rays [km] and cosines of their zenith angles.
    mu_s, nu : ndarray of float64, shape (ray,)
        Cosines of the sun's zenith angle at the starts and of the angles
        between rays and sun.
    max_arc : float, optional
        Largest angle of a step, see `trace`. [rad]
    workers : Workers, optional
        Who does the work.

    Returns
    -------
    RayLight
        Rays that miss the atmosphere and the ground hold 0.

    Notes
    -----
    Neighbours with the same r and mu share samples, so rays are best ordered by
    direction first.
    """
    scaled, field = atmosphere.scaled, atmosphere.field
    phases, _, wavelengths = scaled.phase.shape
    single = np.zeros((r.size, phases, wavelengths))
    diffuse = np.zeros((r.size, wavelengths), np.float32)
    fans = group_rays(np.stack([r, mu, mu_s, nu], axis=1))

    # A field on less than two altitudes is none.
    has_field = field.altitude.size > 1
    starts, light = flatten(fans.starts), flatten(diffuse)
    sources = [flatten(each) for each in (scaled, PEAK_NODES, atmosphere.columns)]
    medium, bundle, scattered = map(flatten, (scaled.medium, fans, single))
    moments = flatten(field), flatten(side_by_side(field))

    def work(begin: int, end: int) -> None:
        work_space = allocate_samples(scaled.medium)
        samples = flatten(work_space)
        scratch = flatten(allocate_scratch(field, fans)) if has_field else None
        while begin < end:
            stop = trace(medium, atmosphere.shells, max_arc, starts, begin, end, samples)
            batch = bundle, begin, stop, samples
            sunlit = allocate_sunlit(scaled.medium, int(work_space.number[: stop - begin].max()))
            add_single_scattering(*sources, *batch, sunlit, scattered, light)
            if has_field:
                add_diffuse(*moments, medium, *batch, scratch, light)
            begin = stop

    chunk = max(LEAST_FANS, len(fans.starts) // workers.shares(32))
    workers.run_rows(len(fans.starts), work, chunk=chunk)
    return RayLight(single, diffuse)
