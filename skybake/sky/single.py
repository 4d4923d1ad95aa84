"""Single scattering alone, to check the tables against."""

from __future__ import annotations

from skybake.errors import InputError
from skybake.optics.medium import Array
from skybake.optics.phase_basis import PhaseBasis, build_phase_basis
from skybake.reference.single import trace_single
from skybake.scattering.ray import RayLight
from skybake.sky.skylight import Segments, Skylight
from skybake.sky.source import Source

STEPS = 128
SUN_STEPS = 32
"""Steps with which light is within 1e-3 of what the reference's own steps give."""


class SingleSkylight(Skylight):
    """Light that is scattered or reflected once, by direct quadrature along each ray.

    Of the atmosphere it needs the medium alone; a source's disc is seen through the
    atmosphere's tables all the same.
    """

    @property
    def phase(self) -> Array:
        """The constituents' own phase functions, (constituent, angle, wavelength). [sr⁻¹]"""
        return self.atmosphere.medium.phase

    @property
    def basis(self) -> PhaseBasis:
        """Curves that the phase functions are sums of."""
        return build_phase_basis(self.phase, [[c] for c in range(len(self.phase))])

    def segments(self, directions: Array, distances: Array) -> Segments:
        """Refuse: the light up to a distance needs the tables of all orders.

        Raises
        ------
        InputError
            Always.
        """
        del directions, distances
        raise InputError("segments: method must not be march, which has single scattering alone")

    def _light(self, source: Source, mu: Array, nu: Array) -> RayLight:
        rays = self._rays(source, mu, nu)
        medium = self.atmosphere.medium
        light = trace_single(medium, *rays, steps=STEPS, sun_steps=SUN_STEPS, workers=self.workers)
        return RayLight(light.single, light.ground)
