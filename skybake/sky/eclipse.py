"""The sun in eclipse around one observer."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from skybake.angles import cosine_between, zenith_azimuth
from skybake.eclipse.balance import balance_diffuse
from skybake.eclipse.diffuse import DiffuseShare
from skybake.eclipse.rays import trace_eclipsed
from skybake.eclipse.shadow import (
    Phase,
    Shadow,
    axis_on_ground,
    cast_shadow,
    phase_at_observer,
    shares_at,
)
from skybake.ephemeris.moon import Moon
from skybake.errors import InputError
from skybake.optics.medium import Array
from skybake.optics.phase import eval_phase
from skybake.sky.skylight import unit_directions
from skybake.sky.source import Occluder, Source

if TYPE_CHECKING:
    from skybake.sky.sky import Sky

SOFT_EDGE = 1.0 / 48.0
"""Width of the moon's edge over the radius of the sun: that of the cells of its disc."""


class MoonInFront:
    """A moon's disc in front of the sun's, see `skybake.sky.source.Occluder`.

    Parameters
    ----------
    moon : Moon
        What covers.
    source : Source
        What is covered.
    uncovered : ndarray of float64, shape (wavelength,)
        Share of the whole disc's light that passes.
    """

    def __init__(self, moon: Moon, source: Source, uncovered: Array) -> None:
        self._moon, self._source = moon, source
        self.uncovered = uncovered

    def visible_share(self, azimuth: Array, zenith: Array) -> Array:
        """Share of the light from points of the sun that passes by, from 0 to 1."""
        elevation = math.pi / 2.0 - zenith
        rise = np.sin(0.5 * (elevation - self._moon.elevation)) ** 2
        turn = np.sin(0.5 * (azimuth - self._moon.azimuth)) ** 2
        squared = rise + np.cos(elevation) * math.cos(self._moon.elevation) * turn
        distance = 2.0 * np.arcsin(np.minimum(np.sqrt(squared), 1.0))
        width = SOFT_EDGE * self._source.angular_radius
        share = np.clip((distance - 0.5 * self._moon.diameter) / width + 0.5, 0.0, 1.0)
        return share if self.uncovered.any() else np.zeros_like(share)


class Eclipse:
    """The light of a sun in eclipse, for one observer.

    Parameters
    ----------
    sky : Sky
        The observer, the sun, and the atmosphere, which is only used for light.
    source : Source
        The sun with nothing in front.
    moon : Moon
        What is in front of it.
    shadow : Shadow
        Of the moon.

    Attributes
    ----------
    phase : Phase
        What the observer sees.
    uncovered : ndarray of float64, shape (wavelength,)
        Share of the sun's light above the observer's air.
    radius, top : float
        Of the observer and of the top of the atmosphere. [km]
    horizon : float
        Zenith angle of the planet's horizon. [rad]
    """

    def __init__(self, sky: Sky, source: Source, moon: Moon, shadow: Shadow) -> None:
        self._sky, self._source, self._moon, self._shadow = sky, source, moon, shadow
        self.phase: Phase = phase_at_observer(shadow)
        self.uncovered: Array = shares_at(shadow, np.zeros(3))
        self.radius, self.top = sky.medium.r_bottom + sky.altitude, sky.medium.r_top
        self.horizon = math.pi - math.asin(min(1.0, sky.medium.r_bottom / self.radius))

    @property
    def occluder(self) -> Occluder | None:
        """What the observer sees in front of the sun, if there is anything."""
        if self.phase.name == "none":
            return None
        return MoonInFront(self._moon, self._source, self.uncovered)

    @property
    def axis(self) -> Array | None:
        """Where the shadow's axis meets the ground, from the observer, if it does. [km]

        In the axes of `skybake.eclipse.shadow.Shadow`.
        """
        place = axis_on_ground(self._shadow, self.radius, self._sky.medium.r_bottom)
        return None if place is None else place - np.array([0.0, 0.0, self.radius])

    def radiance_per_irradiance(self, mu: Array, azimuth: Array) -> tuple[Array, Array]:
        """Radiance per unit irradiance of the whole sun, with the eclipse and without it.

        Parameters
        ----------
        mu, azimuth : ndarray of float64, shape (ray,)
            Cosines of zenith angles, and azimuths clockwise from the sun's. [rad]

        Returns
        -------
        eclipsed, whole : ndarray of float64, shape (ray, wavelength)
            [sr⁻¹]
        """
        skylight = self._sky.skylight
        lights = trace_eclipsed(
            skylight.atmosphere,
            self.radius,
            mu,
            azimuth,
            self._source.mu,
            self._padded,
            self._diffuse,
            workers=skylight.workers,
        )
        sine, sine_s = np.sqrt(np.maximum(1.0 - mu * mu, 0.0)), math.sin(self._source.zenith)
        nu = np.clip(cosine_between(mu, sine, self._source.mu, sine_s, azimuth), -1.0, 1.0)
        phase = eval_phase(skylight.phase, nu)
        count = phase.shape[-1]
        eclipsed, whole = (
            (light.single[..., :count] * phase).sum(axis=1) + light.diffuse[..., :count]
            for light in lights
        )
        return eclipsed, whole

    def radiance(self, directions: Array) -> Array:
        """Radiance without the sun's own disc, as of `skybake.sky.sky.Sky.radiance`."""
        unit = unit_directions(directions)
        zenith, bearing = zenith_azimuth(unit.reshape(-1, 3))
        light, _ = self.radiance_per_irradiance(np.cos(zenith), bearing - self._source.azimuth)
        radiance: Array = light * self._source.irradiance
        return radiance.reshape(*unit.shape[:-1], -1)

    @cached_property
    def _padded(self) -> Shadow:
        """The shadow, for as many wavelengths as the tables of an atmosphere have."""
        missing = self._sky.atmosphere.scaled.mixture.size - self._shadow.powers.shape[1]
        return self._shadow._replace(
            powers=np.pad(self._shadow.powers, ((0, 0), (0, missing)), "edge")
        )

    @cached_property
    def _diffuse(self) -> DiffuseShare:
        sky = self._sky
        return balance_diffuse(sky.atmosphere, self._padded, self.radius, workers=sky.workers)


def find_eclipse(sky: Sky, source: Source, moon: Moon) -> Eclipse | None:
    """Return the eclipse by a moon whose shadow falls on what the observer can see.

    Parameters
    ----------
    sky, source, moon
        As of `Eclipse`.

    Raises
    ------
    InputError
        If the sky's method has single scattering alone.
    """
    medium = sky.medium
    radius = medium.r_bottom + sky.altitude
    reach = math.sqrt(max(radius**2 - medium.r_bottom**2, 0.0))
    reach += math.sqrt(max(medium.r_top**2 - medium.r_bottom**2, 0.0))
    shadow = cast_shadow(
        moon,
        source.azimuth,
        source.elevation,
        source.angular_radius,
        sky.star.distance,
        source.limb_darkening,
        reach,
    )
    if shadow is None:
        return None
    if sky.method == "march":
        raise InputError("eclipse: method must be full or hillaire, got march")
    return Eclipse(sky, source, moon, shadow)
