"""Radiance in given directions, of each light of the sky apart, as a table."""

from __future__ import annotations

import csv
import io
import math

import numpy as np

from skybake.ephemeris.moon import Moon
from skybake.errors import InputError
from skybake.image.moonlight import Moonlight
from skybake.image.night import Night
from skybake.image.night_figures import surface_magnitude
from skybake.image.scene import Scene
from skybake.image.settings import Lighting, MapSettings, View
from skybake.inspect.component_lights import COMPONENTS, Component, Probed
from skybake.inspect.probe import COLUMNS, Directions
from skybake.night.air import NightAir
from skybake.preset import Planet


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
