"""A planet's sky: a preset, an observer and a sun together."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from skybake.ephemeris.moon import Moon
from skybake.errors import InputError
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Array, build_medium
from skybake.optics.spectrum import limb_darkening, star_at, star_irradiance
from skybake.preset import Planet, Star, load_preset
from skybake.scattering.atmosphere import atmosphere_key, is_stored, load_atmosphere
from skybake.scattering.tables import Atmosphere
from skybake.sky.closure import check_closure
from skybake.sky.observer import Observer
from skybake.sky.single import SingleSkylight
from skybake.sky.skylight import Skylight
from skybake.sky.source import Source, check_direction

if TYPE_CHECKING:
    from skybake.sky.eclipse import Eclipse

METHODS = ("full", "scalar", "hillaire", "march")
WAVELENGTHS = np.linspace(380.0, 720.0, 16)
"""Default sampling of the visible spectrum; radiance is taken as linear between. [nm]"""


class Sky:
    """Radiance from any direction, for one observer and one sun.

    Parameters
    ----------
    preset : Planet, str or Path
        A loaded planet, the name of a preset, or the path of a preset's file.
    sun_elevation : float
        Geometric elevation of the sun's centre at the observer, in [-pi/2, pi/2]. [rad]
    altitude : float, optional
        Of the observer above the ground, at least 0. [km]
    sun_azimuth : float, optional
        Compass bearing of the sun, 0 = north, clockwise; default south. [rad]
    sun_distance : float, optional
        Of the sun; default the preset's. [au]
    moon : Moon, optional
        What may be in front of the sun.
    wavelengths : array_like, optional
        Ascending; default 16 from 380 to 720 nm, or the preset's own. [nm]
    method : {"full", "scalar", "hillaire", "march"}, optional
        All orders of scattering with polarised light, or as if light were not polarised, Hillaire's
        closure, or single scattering alone, by direct quadrature: a check.
    workers : Workers, optional
        Threads that do the work.

    Raises
    ------
    InputError
        If a value is not finite or out of its range.
    PresetError
        If the preset cannot be used, or does not cover a wavelength.
    """

    def __init__(
        self,
        preset: Planet | str | Path,
        sun_elevation: float,
        altitude: float = 0.0,
        *,
        sun_azimuth: float = math.pi,
        sun_distance: float | None = None,
        moon: Moon | None = None,
        wavelengths: Array | None = None,
        method: str = "full",
        workers: Workers = ALL_CPUS,
    ) -> None:
        self.planet = preset if isinstance(preset, Planet) else load_preset(preset)
        check_direction("sun", sun_azimuth, sun_elevation)
        self._observer = Observer(altitude)
        if method not in METHODS:
            raise InputError(f"method: must be one of {', '.join(METHODS)}, got {method!r}")
        if wavelengths is None:
            wavelengths = np.array(self.planet.wavelengths or WAVELENGTHS, dtype=float)
        self.wavelengths = np.asarray(wavelengths, dtype=float)
        self.sun_elevation = sun_elevation
        self.sun_azimuth = sun_azimuth
        self.sun_distance = sun_distance
        self.moon = moon
        self.altitude = altitude
        self.method = method
        self.workers = workers
        self.medium = build_medium(self.planet, self.wavelengths)

    def check_clouds(self) -> None:
        """Refuse a method that has single scattering alone in a world with clouds.

        Raises
        ------
        InputError
            That names the method.
        """
        if self.method == "march" and not all(layer.is_empty for layer in self.planet.clouds):
            raise InputError("clouds: method must be full or hillaire, got march")

    @cached_property
    def star(self) -> Star:
        """The star, as far away as it is."""
        return star_at(self.planet.star, self.sun_distance)

    @cached_property
    def irradiance(self) -> Array:
        """The star's irradiance above the atmosphere, shape (wavelength,). [W m⁻² nm⁻¹]"""
        return star_irradiance(self.star, self.wavelengths)

    @cached_property
    def eclipse(self) -> Eclipse | None:
        """The eclipse by the moon, or None where its shadow is nowhere that can be seen.

        Raises
        ------
        InputError
            If the method has single scattering alone.
        """
        if self.moon is None:
            return None
        from skybake.sky.eclipse import find_eclipse

        return find_eclipse(self, self._whole_sun, self.moon)

    @cached_property
    def source(self) -> Source:
        """The sun, as a source of light."""
        if self.eclipse is None:
            return self._whole_sun
        return replace(self._whole_sun, occluder=self.eclipse.occluder)

    @cached_property
    def _whole_sun(self) -> Source:
        return Source(
            azimuth=self.sun_azimuth,
            elevation=self.sun_elevation,
            irradiance=self.irradiance,
            angular_radius=self.star.angular_radius,
            limb_darkening=limb_darkening(self.star, self.wavelengths),
        )

    @property
    def sun_direction(self) -> Array:
        """Unit vector toward the sun: right-handed, +Y up, -Z north, +X east."""
        return self.source.direction

    def radiance(self, directions: Array) -> Array:
        """Radiance of atmosphere and ground, without the sun's own disc.

        Parameters
        ----------
        directions : array_like, shape (..., 3)
            Away from the observer, of any length; axes as in `sun_direction`.

        Returns
        -------
        ndarray of float64, shape (..., wavelength)
            Each integrated along its own ray. [W m⁻² sr⁻¹ nm⁻¹]

        Raises
        ------
        InputError
            If a direction has no length or is not finite.
        """
        return (self.eclipse or self.skylight).radiance(directions)

    def stokes(self, directions: Array) -> Array:
        """Stokes vectors of atmosphere and ground, without the sun's own disc.

        Parameters, result and errors are those of `Skylight.stokes`.

        Raises
        ------
        InputError
            If the sun is in eclipse, or the method knows no polarisation.
        """
        if self.eclipse is not None:
            raise InputError("eclipse: polarisation must be asked for without a moon in front")
        return self.skylight.stokes(directions)

    def radiance_per_irradiance(self, mu: Array, nu: Array) -> Array:
        """Radiance per unit irradiance of the sun, see `Skylight.radiance_per_irradiance`.

        Without an eclipse, whose light depends on more than two angles.
        """
        return self.skylight.radiance_per_irradiance(self.source, mu, nu)

    @cached_property
    def skylight(self) -> Skylight:
        """The light of the sky that reaches the observer."""
        kind = SingleSkylight if self.method == "march" else Skylight
        return kind(self.atmosphere, self._observer, (self.source,), workers=self.workers)

    @cached_property
    def atmosphere_key(self) -> str:
        """Name of the tables of this atmosphere, see `skybake.scattering.atmosphere`."""
        return atmosphere_key(self.medium, self.table_method)

    @property
    def is_solved(self) -> bool:
        """Whether the tables of this atmosphere are stored on disk."""
        return is_stored(self.medium, self.table_method)

    @property
    def table_method(self) -> str:
        """Method of the tables that are looked up."""
        # Single scattering needs none, but the sun's disc looks up the columns of them all.
        return "hillaire" if self.method == "march" else self.method

    @cached_property
    def atmosphere(self) -> Atmosphere:
        """The tables of the atmosphere, which depend neither on the observer nor on the sun.

        Raises
        ------
        UnsolvableError
            If the atmosphere is beyond what the method can do.
        """
        if self.method == "hillaire":
            check_closure(self.medium)
        return load_atmosphere(self.medium, self.table_method, self.workers)
