"""Radiance along many rays, with the phase functions still to be applied."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.arguments import Flat, flatten
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.delta_m import PEAK_NODES
from skybake.optics.medium import Array
from skybake.scattering.aureole import add_aureole, allocate_aureole_scratch
from skybake.scattering.fans import Fans, group_rays
from skybake.scattering.multiple import add_diffuse, allocate_scratch, side_by_side
from skybake.scattering.single import add_single_scattering
from skybake.scattering.sunlit import allocate_sunlit
from skybake.scattering.tables import Atmosphere
from skybake.transport.samples import Samples, allocate_samples
from skybake.transport.trace import MAX_ARC, trace

LEAST_FANS = 3
"""Fans for which a work space per thread pays off."""


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
        Threads that do the work.

    Returns
    -------
    RayLight
        Rays that miss the atmosphere and the ground hold 0.

    Notes
    -----
    Neighbours with the same r and mu share samples, so rays are best ordered by
    direction first.
    """
    scaled = atmosphere.scaled
    phases, _, wavelengths = scaled.phase.shape
    single = np.zeros((r.size, phases, wavelengths))
    diffuse = np.zeros((r.size, wavelengths), np.float32)
    fans = group_rays(np.stack([r, mu, mu_s, nu], axis=1))
    light = LightOfFans(atmosphere, fans, single, diffuse)
    medium, starts = flatten(scaled.medium), flatten(fans.starts)

    def work(begin: int, end: int) -> None:
        samples = allocate_samples(scaled.medium)
        filled, scratch = flatten(samples), light.allocate()
        while begin < end:
            stop = trace(medium, atmosphere.shells, max_arc, starts, begin, end, filled)
            light.add(begin, stop, samples, filled, scratch)
            begin = stop

    workers.run_rows(len(fans.starts), work, chunk=chunk_of_fans(len(fans.starts), workers))
    return RayLight(single, diffuse)


def chunk_of_fans(fans: int, workers: Workers) -> int:
    """Fans that a thread takes at a time."""
    return max(LEAST_FANS, fans // workers.shares(32))


class LightOfFans:
    """Adds the light along traced fans to given arrays, from any thread.

    Parameters
    ----------
    atmosphere : Atmosphere
        What the fans pass through.
    fans : Fans
        The rays.
    single : ndarray of float64, shape (ray, phase function, wavelength)
        Receives light as of `RayLight`.
    diffuse : ndarray of float32, shape (ray, wavelength)
        Receives light as of `RayLight`.
    """

    def __init__(
        self,
        atmosphere: Atmosphere,
        fans: Fans,
        single: Array,
        diffuse: npt.NDArray[np.float32],
    ) -> None:
        scaled, field = atmosphere.scaled, atmosphere.field
        self._medium, self._field, self._fans = scaled.medium, field, fans
        self._scaled = scaled
        # A field on less than two altitudes holds no light.
        self._has_field = field.altitude.size > 1
        self._sources = [flatten(each) for each in (scaled, PEAK_NODES, atmosphere.columns)]
        self._moments = [
            flatten(each) for each in (field, side_by_side(field), atmosphere.horizon_peaks, scaled)
        ]
        # Only a medium with peaks that matter has an aureole.
        self._has_aureole = atmosphere.aureole.source.shape[2] > 0
        self._bent = flatten(atmosphere.aureole), self._moments[0], self._sources[0]
        self._rays, self._single, self._diffuse = map(flatten, (fans, single, diffuse))
        self._no_stokes = flatten(np.empty((0, 2 * diffuse.shape[1]), np.float32))

    def allocate(self) -> tuple[Flat | None, Flat | None]:
        """Make the work space that a thread needs for `add`."""
        return (
            flatten(allocate_scratch(self._field, self._fans)) if self._has_field else None,
            flatten(allocate_aureole_scratch(self._scaled)) if self._has_aureole else None,
        )

    def add(
        self,
        begin: int,
        end: int,
        samples: Samples,
        filled: Flat,
        scratch: tuple[Flat | None, Flat | None],
    ) -> None:
        """Add the light of fans `begin` to `end`, whose samples are given twice."""
        batch = self._rays, begin, end, filled
        most = int(samples.number[: end - begin].max())
        sunlit = allocate_sunlit(self._medium, most)
        add_single_scattering(*self._sources, *batch, sunlit, self._single, self._diffuse)
        if self._has_field:
            add_diffuse(*self._moments, *batch, scratch[0], self._diffuse, self._no_stokes)
        if self._has_aureole:
            add_aureole(*self._bent, *batch, scratch[1], self._diffuse)
