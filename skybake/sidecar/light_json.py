"""The light of a map as JSON, for programs and scripts that have a reader of no other format."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

from skybake.image.moon_figures import MoonFigures
from skybake.sidecar.map_light import MapLight
from skybake.units import degrees
from skybake.version import __version__

SCHEMA = 1
"""Incremented when a key changes its meaning or is removed."""


def moon_document(moon: MoonFigures) -> dict[str, Any]:
    """Return the light of a Moon, fit for JSON."""
    return {
        "is_in_map": moon.is_in_map,
        "direction": list(moon.direction),
        "azimuth_deg": degrees(moon.azimuth),
        "elevation_deg": degrees(moon.elevation),
        "angular_diameter_deg": math.degrees(moon.angular_diameter),
        "phase_angle_deg": math.degrees(moon.phase_angle),
        "illuminated_fraction": moon.illuminated_fraction,
        "illuminance_lux": moon.normal_illuminance,
        "horizontal_illuminance_lux": moon.illuminance,
        "colour": list(moon.colour_in_map),
        "eclipsed": moon.eclipsed,
    }


def light_json(light: MapLight, files: Sequence[str], time: str | None = None) -> str:
    """Return the light of a map as JSON, see docs/formats.md.

    Parameters
    ----------
    light : MapLight
        Of a map of any kind.
    files : sequence of str
        The map, one file or six, as seen from the folder of the JSON.
    time : str, optional
        ISO 8601 in UTC.
    """
    document = {
        "schema": SCHEMA,
        "skybake": __version__,
        "preset": light.preset,
        "time": time,
        "map": {
            "files": list(files),
            "projection": light.projection,
            "rotate_deg": degrees(light.rotation),
            "target": light.target,
            "colorspace": light.colorspace,
            "white_luminance_cd_m2": light.white_luminance,
            "sun_disc": light.sun_disc,
        },
        "sun": {
            "is_in_map": light.sun_is_in_map,
            "direction": light.sun_direction,
            "target_direction": light.target_sun_direction,
            "azimuth_deg": degrees(light.sun_azimuth),
            "elevation_deg": degrees(light.sun_elevation),
            "distance_au": light.sun_distance,
            "angular_diameter_deg": math.degrees(light.sun_angular_diameter),
            "illuminance_lux": light.direct_normal_illuminance,
            "horizontal_illuminance_lux": light.direct_illuminance,
            "colour": light.sun_colour_in_map,
            "colour_temperature_k": light.sun_temperature,
            "irradiance": light.sun_irradiance,
        },
        "moon": None if light.moon is None else moon_document(light.moon),
        "sky": {"horizontal_illuminance_lux": light.sky_illuminance},
        "exposure_ev": light.exposure_ev,
    }
    return json.dumps(document, indent=2, allow_nan=False) + "\n"
