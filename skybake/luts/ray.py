"""Radiance along many rays, with the phase functions still to be applied."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skybake.luts.field import (
    DiffuseField,
    add_diffuse,
    allocate_scratch,
    fill_ground_irradiance,
)
from skybake.luts.single import add_ground, add_single_scattering
from skybake.optics.legendre import PEAK_NODES, Truncation
from skybake.optics.medium import Array
from skybake.transport.geometry import shadow_interval
from skybake.transport.kernel import kernel, run_rows
from skybake.transport.trace import MAX_ARC, allocate_samples, ray_limits, trace


class RayLight(NamedTuple):
    """Light along rays, per unit irradiance of the sun above the air.

    Attributes
    ----------
    single : ndarray of float64, shape (ray, channel, wavelength)
        Sunlight scattered once toward the observer, before the phase functions of
        the channels are applied.
    diffuse : ndarray of float64, shape (ray, wavelength)
        The rest: scattered twice or more, and from the ground. [sr⁻¹]
    """

    single: Array
    diffuse: Array


def trace_rays(
    cut: Truncation,
    shells: Array,
    columns: Array,
    field: DiffuseField,
    r: Array,
    mu: Array,
    mu_s: Array,
    nu: Array,
    *,
    max_arc: float = MAX_ARC,
) -> RayLight:
    """Integrate the light along rays, in parallel.

    Parameters
    ----------
    cut, shells, columns, field
        The atmosphere without forward peaks, its `altitude_shells`, its table of
        `build_columns` and its diffuse light.
    r, mu : ndarray of float64, shape (ray,)
        Starts of the rays [km] and cosines of their zenith angles.
    mu_s, nu : ndarray of float64, shape (ray,)
        Cosines of the sun's zenith angle at the starts and of the angles
        between rays and sun.
    max_arc : float, optional
        Largest angle of a step, see `trace`. [rad]

    Returns
    -------
    RayLight
        Rays that miss the air and the ground hold 0.

    Notes
    -----
    Neighbours with the same r and mu share their samples as long as neither
    meets the planet's shadow, so rays are best ordered by direction first.
    """
    channels, wavelengths = cut.phase.shape[0], cut.phase.shape[2]
    light = RayLight(np.zeros((r.size, channels, wavelengths)), np.zeros((r.size, wavelengths)))
    rays = np.stack([r, mu, mu_s, nu], axis=1)

    def work(first: int, last: int) -> None:
        samples, scratch = allocate_samples(cut.medium), allocate_scratch(field)
        _trace_rays(
            cut,
            PEAK_NODES,
            shells,
            max_arc,
            columns,
            field,
            rays,
            samples,
            scratch,
            first,
            last,
            *light,
        )

    run_rows(r.size, work, chunk=max(64, r.size // 64))
    return light


@kernel
def _trace_rays(
    cut,
    nodes,
    shells,
    max_arc,
    columns,
    field,
    rays,
    samples,
    scratch,
    first,
    last,
    single,
    diffuse,
):
    medium = cut.medium
    sky = np.empty(diffuse.shape[1])
    spectra = np.empty((3, diffuse.shape[1]))
    shared_r = shared_mu = -2.0
    count = 0
    length = 0.0
    hits_ground = False
    for i in range(first, last):
        r, mu, mu_s, nu = rays[i, 0], rays[i, 1], rays[i, 2], rays[i, 3]
        t_first, t_last, _ = ray_limits(medium, r, mu)
        dark_first, _ = shadow_interval(r, mu, mu_s, nu, medium.r_bottom, t_first, t_last)
        is_lit = dark_first > t_last
        if not (is_lit and r == shared_r and mu == shared_mu):
            count, length, hits_ground = trace(medium, shells, max_arc, r, mu, mu_s, nu, samples)
            shared_r = r if is_lit else -2.0
            shared_mu = mu
        add_single_scattering(cut, columns, nodes, r, mu_s, nu, samples, count, spectra, single[i])
        # A field on less than two altitudes is none.
        if field.altitude.size > 1:
            add_diffuse(
                field, medium.r_bottom, r, mu, mu_s, nu, samples, count, scratch, diffuse[i]
            )
        if hits_ground:
            mu_s_ground = (r * mu_s + length * nu) / medium.r_bottom
            fill_ground_irradiance(field, mu_s_ground, scratch.weights, sky)
            add_ground(medium, columns, sky, r, mu_s, nu, length, samples, diffuse[i])
