"""The light of the sky that reaches an observer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from skybake.errors import InputError
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Array
from skybake.optics.phase import eval_phase
from skybake.optics.phase_basis import PhaseBasis
from skybake.scattering.ray import RayLight, trace_rays
from skybake.scattering.segments import trace_segments
from skybake.scattering.tables import Atmosphere
from skybake.sky.observer import Observer
from skybake.sky.source import Source
from skybake.sky.spectral_table import SpectralTable, TableGeometry, table_geometry


class Segments(NamedTuple):
    """Light between an observer and places at several distances.

    Attributes
    ----------
    radiance : ndarray of float64, shape (..., distance, wavelength)
        Gathered up to there. [W m⁻² sr⁻¹ nm⁻¹]
    transmittance : ndarray of float64, shape (..., distance, wavelength)
        Of light from there to the observer, see `SegmentLight`.
    """

    radiance: Array
    transmittance: Array


class Skylight:
    """Radiance of atmosphere and ground from any direction, for one observer and any sources.

    Parameters
    ----------
    atmosphere : Atmosphere
        What is lit.
    observer : Observer
        Who looks.
    sources : sequence of Source
        What lights it; the light of several adds up.
    workers : Workers, optional
        Threads that do the work.

    Attributes
    ----------
    atmosphere, observer, sources, workers
        As given.
    radius : float
        Distance of the observer from the planet's centre. [km]
    """

    def __init__(
        self,
        atmosphere: Atmosphere,
        observer: Observer,
        sources: Sequence[Source],
        *,
        workers: Workers = ALL_CPUS,
    ) -> None:
        self.atmosphere = atmosphere
        self.observer = observer
        self.sources = tuple(sources)
        self.workers = workers
        self.radius = observer.radius(atmosphere.medium)

    def radiance(self, directions: Array) -> Array:
        """Radiance by all sources, without their own discs.

        Parameters
        ----------
        directions : array_like, shape (..., 3)
            Away from the observer, of any length; +Y up, -Z north, +X east.

        Returns
        -------
        ndarray of float64, shape (..., wavelength)
            Each integrated along its own ray. [W m⁻² sr⁻¹ nm⁻¹]

        Raises
        ------
        InputError
            If a direction has no length or is not finite.
        """
        unit = unit_directions(directions)
        wavelengths = self.atmosphere.medium.ground_albedo.size
        radiance = np.zeros((*unit.shape[:-1], wavelengths))
        for source in self.sources:
            nu = unit @ source.direction
            radiance += self.radiance_per_irradiance(source, unit[..., 1], nu) * source.irradiance
        return radiance

    def radiance_per_irradiance(self, source: Source, mu: Array, nu: Array) -> Array:
        """Radiance per unit irradiance of one source above the atmosphere.

        Parameters
        ----------
        source : Source
            What lights the atmosphere.
        mu, nu : ndarray of float64, of the same shape
            Cosines of the zenith angle of a direction and of its angle to the source.

        Returns
        -------
        ndarray of float64, shape (..., wavelength)
            [sr⁻¹]
        """
        nu = np.clip(nu, -1.0, 1.0)
        light = self._light(source, mu.ravel(), nu.ravel())
        phase = eval_phase(self.phase, nu.ravel())
        radiance: Array = (light.single * phase).sum(axis=1) + light.diffuse
        return radiance.reshape(*mu.shape, -1)

    def stokes(self, directions: Array) -> Array:
        """Stokes vectors by all sources, without their own discs, which are not polarised.

        Parameters
        ----------
        directions : array_like, shape (..., 3)
            As of `radiance`.

        Returns
        -------
        ndarray of float64, shape (..., 4, wavelength)
            As `skybake.sky.stokes` defines them. [W m⁻² sr⁻¹ nm⁻¹]

        Raises
        ------
        InputError
            If a direction is invalid, or the atmosphere was solved for without polarisation.
        """
        from skybake.sky.stokes import stokes_of

        return stokes_of(self, unit_directions(directions))

    def segments(self, directions: Array, distances: Array) -> Segments:
        """Light gathered up to given distances, by all sources.

        Parameters
        ----------
        directions : array_like, shape (..., 3)
            As of `radiance`.
        distances : array_like, shape (distance,) or (..., distance)
            From the observer, ascending; may be infinite. [km]

        Returns
        -------
        Segments
            What is gathered, and what passes of the light behind. The ground counts as
            behind, but for distances beyond it.

        Raises
        ------
        InputError
            If a direction or a distance is invalid.
        """
        unit = unit_directions(directions)
        medium = self.atmosphere.medium
        count, shape = medium.ground_albedo.size, unit.shape[:-1]
        unit = unit.reshape(-1, 3)
        ends = np.asarray(distances, dtype=float)
        ends = np.broadcast_to(ends, (*shape, ends.shape[-1])).reshape(len(unit), -1)
        radiance, transmittance = np.zeros((*ends.shape, count)), np.ones((*ends.shape, count))
        for source in self.sources:
            nu = np.clip(unit @ source.direction, -1.0, 1.0)
            rays = self._rays(source, unit[:, 1], nu)
            light = trace_segments(self.atmosphere, *rays, ends, workers=self.workers)
            phase = eval_phase(self.phase, nu)[:, None]
            one = (light.single[..., :count] * phase).sum(axis=2) + light.diffuse[..., :count]
            radiance += one * source.irradiance
            transmittance = light.transmittance[..., :count]
        shape = *shape, ends.shape[-1], count
        return Segments(radiance.reshape(shape), transmittance.reshape(shape))

    def spectral_table(
        self, source: Source, *, finely: bool = False, coarsely: bool = False
    ) -> SpectralTable:
        """Trace the rays from which pixels get the light of one source.

        Parameters
        ----------
        source : Source
            What lights the atmosphere.
        finely, coarsely : bool, optional
            As of `table_geometry`.
        """
        geometry = self.table_geometry(source, finely=finely, coarsely=coarsely)
        return SpectralTable(
            geometry, self._light(source, geometry.mu.ravel(), geometry.nu.ravel())
        )

    def table_geometry(
        self, source: Source, *, finely: bool = False, coarsely: bool = False
    ) -> TableGeometry:
        """Return where the nodes of `spectral_table` are."""
        medium = self.atmosphere.medium
        return table_geometry(
            self.radius,
            medium.r_bottom,
            medium.r_top,
            source.zenith,
            has_aureole=self.atmosphere.aureole.source.shape[2] > 0,
            finely=finely,
            coarsely=coarsely,
        )

    @property
    def phase(self) -> Array:
        """Phase functions of the light that is scattered once, (phase function, angle, wavelength).

        At `skybake.optics.phase.scattering_angles`. [sr⁻¹]
        """
        return self.atmosphere.scaled.phase[..., : self.atmosphere.medium.ground_albedo.size]

    @property
    def basis(self) -> PhaseBasis:
        """Curves that the phase functions are sums of."""
        return self.atmosphere.basis

    def _light(self, source: Source, mu: Array, nu: Array) -> RayLight:
        """Light along rays per unit irradiance, of the medium's own wavelengths."""
        light = trace_rays(self.atmosphere, *self._rays(source, mu, nu), workers=self.workers)
        count = self.atmosphere.medium.ground_albedo.size
        return RayLight(light.single[..., :count], light.diffuse[..., :count])

    def _rays(self, source: Source, mu: Array, nu: Array) -> tuple[Array, Array, Array, Array]:
        return np.full(mu.shape, self.radius), mu, np.full(mu.shape, source.mu), nu


def unit_directions(directions: Array) -> Array:
    """Scale vectors to length 1, shape (..., 3).

    Raises
    ------
    InputError
        If one has no length or is not finite.
    """
    directions = np.asarray(directions, dtype=float)
    length = np.linalg.norm(directions, axis=-1, keepdims=True)
    if not (np.isfinite(length).all() and (length > 0.0).all()):
        raise InputError("directions: must be finite and longer than 0")
    unit: Array = directions / length
    return unit
