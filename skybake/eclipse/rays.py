"""Radiance along rays through a moon's shadow."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.angles import cosine_between
from skybake.eclipse.diffuse import (
    RINGS,
    DiffuseShare,
    fill_diffuse_share,
    fill_ground_share,
    new_corner,
)
from skybake.eclipse.shadow import Shadow, fill_share_at
from skybake.jit.arguments import flatten
from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.delta_m import PEAK_NODES
from skybake.optics.medium import Medium
from skybake.scattering.aureole import add_aureole, allocate_aureole_scratch
from skybake.scattering.fans import Fans, group_rays
from skybake.scattering.multiple import add_diffuse, allocate_scratch, side_by_side
from skybake.scattering.ray import RayLight
from skybake.scattering.single import add_single_scattering
from skybake.scattering.sunlit import allocate_sunlit
from skybake.scattering.tables import Atmosphere
from skybake.transport.samples import MAX_SAMPLES, Samples, allocate_samples
from skybake.transport.trace import trace

Array = npt.NDArray[np.float64]

SHADOW_ARC = math.radians(0.25)
"""Largest angle of a step, see `trace`: 28 km on Earth, a quarter of an ordinary umbra. [rad]"""

ROOM = 4 * MAX_SAMPLES
"""Samples that are dimmed together, each ray's own."""


def trace_eclipsed(
    atmosphere: Atmosphere,
    radius: float,
    mu: Array,
    azimuth: Array,
    mu_s: float,
    shadow: Shadow,
    diffuse: DiffuseShare,
    *,
    workers: Workers = ALL_CPUS,
) -> tuple[RayLight, RayLight]:
    """Integrate the light along rays of one observer, in parallel.

    Parameters
    ----------
    atmosphere : Atmosphere
        What the rays pass through.
    radius : float
        Distance of the observer from the planet's centre. [km]
    mu, azimuth : ndarray of float64, shape (ray,)
        Cosines of the rays' zenith angles, best in order, and azimuths clockwise from the sun's.
        [rad]
    mu_s : float
        Cosine of the sun's zenith angle.
    shadow, diffuse : Shadow, DiffuseShare
        What is left of sunlight and of diffuse light at each place.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    eclipsed, whole : RayLight
        With the eclipse and, by the same samples, without it. Wavelengths are as
        `pad_wavelengths` leaves them.
    """
    scaled = atmosphere.scaled
    sine, sine_s = np.sqrt(np.maximum(1.0 - mu * mu, 0.0)), math.sqrt(max(1.0 - mu_s**2, 0.0))
    nu = np.clip(cosine_between(mu, sine, mu_s, sine_s, azimuth), -1.0, 1.0)
    rays = np.stack([np.full(mu.shape, radius), mu, np.full(mu.shape, mu_s), nu], axis=1)
    fans = group_rays(rays)
    direction = np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), mu], axis=1)
    phases, _, wavelengths = scaled.phase.shape
    lights = [
        RayLight(
            np.zeros((mu.size, phases, wavelengths)), np.zeros((mu.size, wavelengths), np.float32)
        )
        for _ in range(2)
    ]
    medium, starts = flatten(scaled.medium), flatten(fans.starts)
    where = flatten(shadow), flatten(diffuse), flatten(RINGS)

    def work(begin: int, end: int) -> None:
        samples = allocate_samples(scaled.medium, 1)
        filled = flatten(samples)
        room = _Room(atmosphere, int(np.diff(fans.first).max()))
        for fan in range(begin, end):
            trace(medium, atmosphere.shells, SHADOW_ARC, starts, fan, fan + 1, filled)
            number = max(int(samples.number[0]), 1)
            most = max(1, ROOM // number)
            for first in range(int(fans.first[fan]), int(fans.first[fan + 1]), most):
                last = min(first + most, int(fans.first[fan + 1]))
                of_rays = rays[first:last]
                alone = Fans(of_rays, np.arange(len(of_rays) + 1), of_rays[:, :2].copy())
                for light, is_covered in zip(lights, (True, False), strict=True):
                    _dim(
                        *where, filled, direction[first:last],
                        is_covered, room.corner, room.share, room.sunlit, room.diffuse,
                    )  # fmt: skip
                    room.add(alone, light.single[first:last], light.diffuse[first:last])

    workers.run_rows(len(fans.starts), work, chunk=4)
    eclipsed, whole = lights
    return eclipsed, whole


class _Room:
    """Work space of one thread: samples that every ray has to itself, and what adds their light."""

    def __init__(self, atmosphere: Atmosphere, widest: int) -> None:
        scaled = atmosphere.scaled
        self._atmosphere = atmosphere
        self.corner = new_corner()
        self.share = np.empty((2, scaled.mixture.size))
        self.sunlit = _allocate(scaled.medium, widest)
        self.diffuse = self.sunlit._replace(
            weight=np.empty_like(self.sunlit.weight),
            transmittance=np.empty_like(self.sunlit.transmittance),
        )
        self._moments = flatten(side_by_side(atmosphere.field))

    def add(self, fans: Fans, single: Array, diffuse: npt.NDArray[np.float32]) -> None:
        """Add the light of the samples to rays, each a fan of its own."""
        one = self._atmosphere
        scaled, field, rays = one.scaled, one.field, len(fans.rays)
        lit = allocate_sunlit(scaled.medium, int(self.sunlit.number[:rays].max()))
        batch = fans, 0, rays
        add_single_scattering(
            scaled, PEAK_NODES, one.columns, *batch, self.sunlit, lit, single, diffuse
        )
        if field.altitude.size > 1:
            scratch = allocate_scratch(field, fans)
            peaks = one.horizon_peaks
            light = field, self._moments, peaks, scaled
            stokes = np.empty((0, 2 * diffuse.shape[1]), np.float32)
            add_diffuse(*light, *batch, self.diffuse, scratch, diffuse, stokes)
        if one.aureole.source.shape[2] > 0:
            aureole = allocate_aureole_scratch(scaled)
            add_aureole(one.aureole, field, scaled, *batch, self.sunlit, aureole, diffuse)


def _allocate(medium: Medium, rays: int) -> Samples:
    """Make room for the samples of rays; see `allocate_samples`."""
    constituents, wavelengths = medium.extinction.shape
    return allocate_samples(medium, rays)._replace(
        distance=np.empty(ROOM),
        radius=np.empty(ROOM),
        density=np.empty((ROOM, constituents)),
        column_to=np.empty((ROOM, constituents)),
        weight=np.empty((ROOM, wavelengths)),
    )


@kernel
def _dim(
    shadow, diffuse, rings, samples, directions, is_covered, corner, share,
    sunlit, scattered,
):  # fmt: skip
    """Give each ray the samples of its fan, as sunlight and diffuse light are dimmed there."""
    number = samples.number[0]
    local, mean = share[0], share[1]
    for q in range(directions.shape[0]):
        dx, dy, dz = directions[q, 0], directions[q, 1], directions[q, 2]
        first = q * number
        sunlit.first[q], sunlit.number[q] = first, number
        sunlit.length[q], sunlit.hits_ground[q] = samples.length[0], samples.hits_ground[0]
        for n in range(number):
            t, m = samples.distance[n], first + n
            sunlit.distance[m], sunlit.radius[m] = t, samples.radius[n]
            for c in range(samples.density.shape[1]):
                sunlit.density[m, c] = samples.density[n, c]
                sunlit.column_to[m, c] = samples.column_to[n, c]
            if is_covered:
                x, y, z = t * dx, t * dy, t * dz
                fill_share_at(shadow, x, y, z, local)
                up = z + diffuse.planet
                mu = (x * dx + y * dy + up * dz) / math.sqrt(x * x + y * y + up * up)
                fill_diffuse_share(shadow, diffuse, rings, corner, x, y, z, mu, mean)
            else:
                local[:] = 1.0
                mean[:] = 1.0
            for k in range(local.size):
                sunlit.weight[m, k] = samples.weight[n, k] * local[k]
                scattered.weight[m, k] = samples.weight[n, k] * mean[k]
        t = samples.length[0]
        if is_covered:
            fill_share_at(shadow, t * dx, t * dy, t * dz, local)
            fill_ground_share(shadow, diffuse, rings, corner, t * dx, t * dy, t * dz, mean)
        for k in range(local.size):
            sunlit.transmittance[q, k] = samples.transmittance[0, k] * (
                local[k] if is_covered else 1.0
            )
            scattered.transmittance[q, k] = samples.transmittance[0, k] * (
                mean[k] if is_covered else 1.0
            )
