"""Radiance in given directions, of each light of the sky apart."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from skybake.angles import cosine_between, direction_from_angles
from skybake.ephemeris.moon import Moon
from skybake.errors import InputError
from skybake.image.luminous import luminous_weights
from skybake.image.moonlight import Moonlight
from skybake.image.moonlit import Moonlit
from skybake.image.night import Night
from skybake.image.night_figures import surface_magnitude
from skybake.image.scene import Scene
from skybake.image.settings import Lighting, MapSettings, View
from skybake.inspect.probe import COLUMNS, Directions
from skybake.night.air import NightAir, lines_xyz
from skybake.night.airglow import airglow_layers
from skybake.night.city import ground_response, lamp_channels, toward_city
from skybake.night.dome import MEAN_AIRGLOW
from skybake.night.glows import Glow, faint_stars, zodiacal_glow
from skybake.optics.medium import Array
from skybake.preset import Planet
from skybake.sky.extended import STEPS
from skybake.sky.sky import Sky


class Component(NamedTuple):
    """Light of one origin.

    Attributes
    ----------
    radiance : ndarray of float64, shape (direction, wavelength)
        [W m⁻² sr⁻¹ nm⁻¹]
    xyz : ndarray of float64, shape (direction, 3)
        [cd m⁻²]
    """

    radiance: Array
    xyz: Array


class Probed(NamedTuple):
    """What is looked at.

    Attributes
    ----------
    sky : Sky
        The observer, the air and the sun.
    night : Night
        Which lights of the night there are.
    air : NightAir or None
        How the air passes them; None without a night.
    moonlit : Moonlit or None
        The Moon as a light.
    zenith, azimuth : ndarray of float64, shape (direction,)
        Zenith angles and compass bearings. [rad]
    """

    sky: Sky
    night: Night
    air: NightAir | None
    moonlit: Moonlit | None
    zenith: Array
    azimuth: Array

    @property
    def vectors(self) -> Array:
        """Unit vectors in the axes of maps, shape (direction, 3)."""
        return direction_from_angles(self.azimuth, 0.5 * math.pi - self.zenith)


Evaluator = Callable[[Probed], Component | None]
"""Returns a component, or None where there is no such light."""


def sunlight(probed: Probed) -> Component | None:
    """Light of the sun that the air and the ground scatter: by night, twilight."""
    sky = probed.sky
    light = _scattered(sky, probed)
    return Component(light * sky.irradiance, light @ luminous_weights(sky))


def moonlight(probed: Probed) -> Component | None:
    """Light of the Moon that the air and the ground scatter."""
    moonlit = probed.moonlit
    if moonlit is None:
        return None
    light = _scattered(moonlit.sky, probed)
    return Component(light * moonlit.irradiance, light @ moonlit.air_weights)


def airglow(probed: Probed) -> Component | None:
    """Light of the upper air of Earth; radiances are means of its lines between wavelengths."""
    night, air, sky = probed.night, probed.air, probed.sky
    frame = night.frame
    if air is None or frame is None or frame.planet != "earth" or night.airglow == 0.0:
        return None
    mu, theta = np.cos(probed.zenith), np.linspace(0.0, 0.5 * math.pi, STEPS)
    factor, passing = MEAN_AIRGLOW * night.airglow, air.sources.passing(mu)
    radiance, xyz = np.zeros((mu.size, sky.wavelengths.size)), np.zeros((mu.size, 3))
    for layer in airglow_layers():
        seen = air.layer_directly(layer, probed.zenith, passing)
        seen += air.sources.scattered(mu, air.layer_from_ground(layer, theta), sky.workers)
        xyz += factor * lines_xyz(layer, air.channels, seen)
        per_nanometre = _spread(layer.wavelengths, layer.radiance, sky.wavelengths)
        radiance += factor * seen * per_nanometre
    return Component(radiance, xyz)


def zodiacal(probed: Probed) -> Component | None:
    """Sunlight that dust between the planets scatters."""
    night = probed.night
    if night.frame is None or probed.air is None or night.zodiacal == 0.0:
        return None
    glow = zodiacal_glow(night.frame, probed.sky, probed.air.channels)
    return _of_glow(probed, probed.air, glow, night.zodiacal)


def starlight(probed: Probed) -> Component | None:
    """Light of stars that are not drawn singly."""
    if probed.night.frame is None or probed.air is None:
        return None
    glow = faint_stars(probed.night.frame, probed.air.channels)
    return _of_glow(probed, probed.air, glow, 1.0)


def city(probed: Probed) -> Component | None:
    """Light of lamps that the air scatters; none below the horizon."""
    night, air, sky = probed.night, probed.air, probed.sky
    if air is None or night.city == 0.0:
        return None
    zenith = np.concatenate([[0.0], probed.zenith])
    glow = ground_response(sky, zenith, sky.workers)
    glow = glow * lamp_channels(air.channels)
    glow = glow / (glow[0] @ air.weights[:, 1])
    around = toward_city(probed.vectors, night.city_azimuth)
    around = np.where(probed.zenith <= air.zenith_horizon, around, 0.0)
    radiance = night.city * glow[1:] * around[:, None]
    return Component(radiance, radiance @ air.weights)


COMPONENTS: dict[str, Evaluator] = {
    "sun": sunlight,
    "moon": moonlight,
    "airglow": airglow,
    "zodiacal": zodiacal,
    "stars": starlight,
    "city": city,
}
"""Lights that a sky may have, by name."""


def probe_components(
    planet: Planet,
    directions: Directions,
    night: Night,
    *,
    sun_elevation: float,
    sun_azimuth: float = math.pi,
    altitude: float = 0.0,
    sun_distance: float | None = None,
    moon: Moon | None = None,
    moonlight: Moonlight | None = None,
) -> str:
    """Light of each origin as CSV, in the renderer's own wavelengths, without clouds and discs.

    Parameters
    ----------
    planet : Planet
        The world.
    directions : Directions
        Where to look, azimuths from that of the sun.
    night : Night
        Which lights of the night there are; none without a frame.
    sun_elevation, sun_azimuth : float
        [rad]
    altitude : float, optional
        Of the observer. [km]
    sun_distance : float, optional
        Of the sun; default the preset's. [au]
    moon : Moon, optional
        What may be in front of the sun.
    moonlight : Moonlight, optional
        The Moon as a light.

    Returns
    -------
    str
        A line for each direction and light, and for all together: the direction,
        ``component``, luminance [cd m⁻²], magnitude V of a square arcsecond, CIE 1931
        chromaticity, and ``radiance_380nm`` and so on [W m⁻² sr⁻¹ nm⁻¹].

    Raises
    ------
    SkybakeError
        If a value is out of range, an atmosphere cannot be solved, or there are clouds or an
        eclipse.
    """
    lighting = Lighting(
        sun_elevation, sun_azimuth=sun_azimuth, sun_distance=sun_distance, moon=moon
    )
    settings = MapSettings(
        View(altitude), lighting, night=night, moonlight=moonlight or Moonlight()
    )
    scene = Scene(planet, settings)
    sky = scene.sky
    if planet.rendering != "spectral":
        raise InputError("components: must be of a world in wavelengths, got one in RGB")
    if planet.clouds:
        raise InputError("components: must be of a world without clouds")
    if sky.eclipse is not None:
        raise InputError("components: must be probed without an eclipse")
    air = NightAir(sky, has_airglow=False) if night.is_lit else None
    night = night if night.is_lit else Night()
    azimuth = directions.azimuth + sun_azimuth
    probed = Probed(sky, night, air, scene.moonlit, directions.zenith, azimuth)
    found = {name: evaluate(probed) for name, evaluate in COMPONENTS.items()}
    lights = {name: light for name, light in found.items() if light is not None}
    lights["all"] = Component(
        np.sum([each.radiance for each in lights.values()], axis=0),
        np.sum([each.xyz for each in lights.values()], axis=0),
    )
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    radiances = [f"radiance_{wavelength:g}nm" for wavelength in sky.wavelengths]
    colour = ("luminance_cd_m2", "mag_arcsec2", "chromaticity_x", "chromaticity_y")
    writer.writerow([*COLUMNS, "component", *colour, *radiances])
    for i, text in enumerate(directions.text):
        for name, light in lights.items():
            x, y, z = light.xyz[i].tolist()
            total = x + y + z if x + y + z > 0.0 else math.nan
            numbers = (y, surface_magnitude(y), x / total, y / total, *light.radiance[i].tolist())
            writer.writerow([*text, name, *(f"{number:.7g}" for number in numbers)])
    return out.getvalue()


def _scattered(sky: Sky, probed: Probed) -> Array:
    """Radiance per unit irradiance of the source of a sky, (direction, wavelength). [sr⁻¹]"""
    source = sky.source
    mu, sine = np.cos(probed.zenith), np.sin(probed.zenith)
    relative = probed.azimuth - sky.sun_azimuth
    nu = cosine_between(mu, sine, source.mu, math.sin(source.zenith), relative)
    light: Array = np.maximum(sky.radiance_per_irradiance(mu, nu), 0.0)
    return light


def _of_glow(probed: Probed, air: NightAir, glow: Glow, factor: float) -> Component:
    mu = np.cos(probed.zenith)
    here = np.einsum("pd,pw->dw", glow.brightness(probed.vectors), glow.spectra)
    rings = air.rings(glow.brightness(air.vectors), glow.spectra)
    around = air.sources.scattered(mu, rings, probed.sky.workers)
    radiance = factor * (here * air.sources.passing(mu) + around)
    return Component(radiance, radiance @ air.weights)


def _spread(lines: Array, radiance: Array, wavelengths: Array) -> Array:
    """Radiance of lines per nanometre, shared between the wavelengths beside each."""
    sums = np.zeros_like(wavelengths)
    at = np.clip(np.searchsorted(wavelengths, lines, side="right") - 1, 0, len(wavelengths) - 2)
    share = (lines - wavelengths[at]) / (wavelengths[at + 1] - wavelengths[at])
    is_inside = (share >= 0.0) & (share <= 1.0)
    np.add.at(sums, at, np.where(is_inside, (1.0 - share) * radiance, 0.0))
    np.add.at(sums, at + 1, np.where(is_inside, share * radiance, 0.0))
    spread: Array = sums / np.gradient(wavelengths)
    return spread
