"""A sky: one planet, one observer, one sun."""

from __future__ import annotations

import math
from functools import cached_property
from pathlib import Path

import numpy as np

from skybake.errors import InputError
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.lobes import Lobes, pad_lobes, split_phase
from skybake.optics.medium import Array, build_medium
from skybake.optics.phase import eval_phase
from skybake.optics.spectrum import star_irradiance
from skybake.preset import Planet, load_preset
from skybake.scattering.atmosphere import Atmosphere, is_stored, load_atmosphere
from skybake.scattering.ray import RayLight, trace_rays
from skybake.sky.view import (
    AZIMUTHS,
    AZIMUTHS_FROM_SPACE,
    SkyView,
    horizon_angles,
    ray_azimuths,
    resample_azimuths,
    table_directions,
)
from skybake.transport.march import march_rays

METHODS = ("full", "hillaire", "march")
WAVELENGTHS = np.linspace(380.0, 720.0, 16)
"""Default sampling of the visible spectrum; radiance is taken as linear between. [nm]"""

LOWEST_EYE = 1e-8
"""Altitude of an observer on the ground: ten micrometres, so that a horizon exists. [km]"""


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
    wavelengths : array_like, optional
        Ascending; default 16 from 380 to 720 nm, or the preset's own. [nm]
    method : {"full", "hillaire", "march"}, optional
        All orders of scattering, Hillaire's closure, or single scattering by nested
        marching without tables.
    workers : Workers, optional
        Who does the work.

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
        wavelengths: Array | None = None,
        method: str = "full",
        workers: Workers = ALL_CPUS,
    ) -> None:
        self.planet = preset if isinstance(preset, Planet) else load_preset(preset)
        if not abs(sun_elevation) <= math.pi / 2.0 + 1e-9:
            raise InputError(
                "sun elevation: must be from -90 to 90 deg, got "
                f"{math.degrees(sun_elevation):g} deg"
            )
        if not 0.0 <= altitude < math.inf:
            raise InputError(f"altitude: must be at least 0 m, got {altitude * 1e3:g} m")
        if not math.isfinite(sun_azimuth):
            raise InputError(f"sun azimuth: must be finite, got {sun_azimuth}")
        if method not in METHODS:
            raise InputError(f"method: must be one of {', '.join(METHODS)}, got {method!r}")
        if wavelengths is None:
            wavelengths = np.array(self.planet.wavelengths or WAVELENGTHS, dtype=float)
        self.wavelengths = np.asarray(wavelengths, dtype=float)
        self.sun_elevation = sun_elevation
        self.sun_azimuth = sun_azimuth
        self.altitude = altitude
        self.method = method
        self.workers = workers
        self.medium = build_medium(self.planet, self.wavelengths)
        self.r = self.medium.r_bottom + max(altitude, LOWEST_EYE)

    @cached_property
    def irradiance(self) -> Array:
        """The star's irradiance above the air, shape (wavelength,). [W m⁻² nm⁻¹]"""
        return star_irradiance(self.planet.star, self.wavelengths)

    @property
    def sun_direction(self) -> Array:
        """Unit vector toward the sun: right-handed, +Y up, -Z north, +X east."""
        horizontal = math.cos(self.sun_elevation)
        return np.array(
            [
                horizontal * math.sin(self.sun_azimuth),
                math.sin(self.sun_elevation),
                -horizontal * math.cos(self.sun_azimuth),
            ]
        )

    def radiance(self, directions: Array) -> Array:
        """Radiance of air and ground, without the sun's own disc.

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
        directions = np.asarray(directions, dtype=float)
        length = np.linalg.norm(directions, axis=-1, keepdims=True)
        if not (np.isfinite(length).all() and (length > 0.0).all()):
            raise InputError("directions: must be finite and longer than 0")
        unit = directions / length
        mu = unit[..., 1]
        nu = unit @ self.sun_direction
        radiance: Array = self.radiance_per_irradiance(mu, nu) * self.irradiance
        return radiance

    def radiance_per_irradiance(self, mu: Array, nu: Array) -> Array:
        """Radiance per unit irradiance of the sun above the air.

        Parameters
        ----------
        mu, nu : ndarray of float64, of the same shape
            Cosines of the zenith angle of the view and of its angle to the sun.

        Returns
        -------
        ndarray of float64, shape (..., wavelength)
            [sr⁻¹]
        """
        light = self._light(mu.ravel(), nu.ravel())
        phase = eval_phase(self._phase, nu.ravel())
        radiance: Array = (light.single * phase).sum(axis=1) + light.diffuse
        return radiance.reshape(*mu.shape, -1)

    def view(self, rgb_weights: Array) -> SkyView:
        """Tabulate the sky around the observer in a colour space.

        Parameters
        ----------
        rgb_weights : ndarray of float64, shape (wavelength, 3)
            RGB is the radiance per unit irradiance times these.

        Returns
        -------
        SkyView
            For `skybake.sky.pixels.fill_directions`.
        """
        zenith_first, zenith_horizon = horizon_angles(
            self.r, self.medium.r_bottom, self.medium.r_top
        )
        is_inside = zenith_first == 0.0
        sun_zenith = math.pi / 2.0 - self.sun_elevation
        azimuths = AZIMUTHS_FROM_SPACE
        if is_inside:
            azimuths = ray_azimuths(self.sun_elevation, zenith_horizon)
        zenith, phi = table_directions(sun_zenith, zenith_first, zenith_horizon, azimuths)
        theta = np.broadcast_to(zenith[:, :, None], phi.shape)
        mu = np.cos(theta)
        nu = mu * math.cos(sun_zenith) + np.sin(theta) * math.sin(sun_zenith) * np.cos(phi)
        light = self._light(mu.ravel(), nu.ravel())
        lobes = pad_lobes(self._lobes)
        fold = np.einsum("cwq,wk->cwkq", lobes.weights, rgb_weights)
        table = np.tensordot(light.single, fold, axes=2)
        table[:, :, 0] += light.diffuse @ rgb_weights
        table = table.reshape(*theta.shape, -1)
        if is_inside:
            table = resample_azimuths(table, AZIMUTHS)
        return SkyView(
            zenith_first=zenith_first,
            zenith_horizon=zenith_horizon,
            sun_zenith=sun_zenith,
            table=table.astype(np.float32).reshape(*table.shape[:2], -1),
            curves=np.ascontiguousarray(lobes.curves.T, dtype=np.float32),
        )

    def _light(self, mu: Array, nu: Array) -> RayLight:
        r = np.full(mu.shape, self.r)
        mu_s = np.full(mu.shape, math.sin(self.sun_elevation))
        nu = np.clip(nu, -1.0, 1.0)
        if self.method == "march":
            return RayLight(*march_rays(self.medium, r, mu, mu_s, nu, workers=self.workers))
        light = trace_rays(*self.atmosphere[:4], r, mu, mu_s, nu, workers=self.workers)
        count = self.medium.ground_albedo.size
        return RayLight(light.single[..., :count], light.diffuse[..., :count])

    @property
    def is_solved(self) -> bool:
        """Whether the tables of this atmosphere lie on disk."""
        return is_stored(self.medium, self.table_method)

    @property
    def table_method(self) -> str:
        """Method of the tables that are looked up."""
        # Marching needs no tables; its sun disc looks up the columns that all methods share.
        return "full" if self.method == "full" else "hillaire"

    @cached_property
    def atmosphere(self) -> Atmosphere:
        """The tables of the air, which depend neither on the observer nor on the sun."""
        return load_atmosphere(self.medium, self.table_method, self.workers)

    @property
    def _phase(self) -> Array:
        """Phase functions of the channels of `_light`, (channel, angle, wavelength)."""
        if self.method == "march":
            return self.medium.phase
        return self.atmosphere.cut.phase[..., : self.medium.ground_albedo.size]

    @property
    def _lobes(self) -> Lobes:
        """Curves that the phase functions of `_phase` are sums of."""
        if self.method == "march":
            return split_phase(self.medium.phase, [[c] for c in range(len(self.medium.phase))])
        return self.atmosphere.lobes
