"""What the light of a scene is in figures, beside its picture."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from skybake.colour.exposure import luminance_from_ev
from skybake.colour.space import find_colour_space
from skybake.colour.temperature import correlated_temperature
from skybake.colour.white_balance import balance
from skybake.errors import SkybakeError
from skybake.image.light import light_of_scene
from skybake.image.meter import scene_ev, scene_white
from skybake.image.moon_figures import moon_figures
from skybake.image.picture_settings import PictureSettings
from skybake.image.scene import Scene
from skybake.jit.kept import Kept
from skybake.optics.haze import HAZE_WAVELENGTH, visibility
from skybake.optics.medium import build_medium, vertical_optical_depth
from skybake.preset import Planet

_KEPT_WORLDS = 8
_IDENTITY = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]


_airs: Kept[str, dict[str, float | None]] = Kept(_KEPT_WORLDS)


def figures_of(scene: Scene, picture: PictureSettings) -> dict[str, Any]:
    """Return figures of a scene, fit for JSON.

    Parameters
    ----------
    scene : Scene
        In Rec. 709.
    picture : PictureSettings
        Whose white balance is taken.

    Returns
    -------
    dict
        Illuminances [lx], colour and temperature [K] of the sun, optical depth at 550 nm and
        visibility [km], exposure value, and the matrix of the white balance.
    """
    light = light_of_scene(scene)
    normal, _ = scene.sun_xyz()
    lighting = scene.settings.lighting
    moon = lighting.moon
    return {
        "sun_illuminance_lx": light.direct_normal_illuminance,
        "sun_horizontal_illuminance_lx": light.direct_illuminance,
        "sky_illuminance_lx": light.sky_illuminance,
        "sun_colour": list(light.sun_colour),
        "sun_temperature_k": correlated_temperature(normal),
        **air_figures(scene.planet),
        "ev_auto": scene_ev(scene),
        "white_balance": _white_matrix(scene, picture),
        "sun_elevation_deg": math.degrees(lighting.sun_elevation),
        "sun_azimuth_deg": math.degrees(lighting.sun_azimuth) % 360.0,
        "sun_radius_deg": math.degrees(scene.sky.source.angular_radius),
        "altitude_km": scene.settings.view.altitude,
        "moon": None
        if moon is None
        else {
            "elevation_deg": math.degrees(moon.elevation),
            "azimuth_deg": math.degrees(moon.azimuth) % 360.0,
            "diameter_deg": math.degrees(moon.diameter),
        },
        "moonlight": _moonlight(scene),
    }


def exposures(
    figures: Mapping[str, Any], picture: PictureSettings, scale: float
) -> dict[str, float]:
    """Return the factors from texels to the scene-linear values of ACES, fit for JSON.

    Parameters
    ----------
    figures : mapping
        As `figures_of` returns them.
    picture : PictureSettings
        Whose exposure value is taken if it has one.
    scale : float
        Luminance of a texel of 1. [cd m⁻²]

    Returns
    -------
    dict
        ``exposure_scale_auto`` as a camera meters, and ``exposure_scale`` as it is asked for.
    """
    metered = figures["ev_auto"]
    ev = metered if picture.fixed_ev is None else picture.fixed_ev
    return {
        "exposure_scale_auto": scale / luminance_from_ev(metered),
        "exposure_scale": scale / luminance_from_ev(ev),
    }


def world_key(planet: Planet) -> str:
    """Return a text that all worlds made alike share, and no others."""
    return json.dumps(planet.recipe, sort_keys=True, default=str)


def air_figures(planet: Planet) -> dict[str, float | None]:
    """Return the optical depth at 550 nm and the visibility [km] of a world; None where unknown."""
    return _airs.get(world_key(planet), lambda: _air_figures(planet))


def _air_figures(planet: Planet) -> dict[str, float | None]:
    try:
        medium = build_medium(planet, np.array([HAZE_WAVELENGTH]))
        depth = float(vertical_optical_depth(medium).sum())
        seen = visibility(planet)
    except (SkybakeError, ValueError):
        # A preset whose spectra do not reach this wavelength.
        return {"optical_depth_550": None, "visibility_km": None}
    return {
        "optical_depth_550": depth,
        "visibility_km": seen if math.isfinite(seen) else None,
    }


def _moonlight(scene: Scene) -> dict[str, float] | None:
    """Return figures of the Moon as a light, or None where there is none."""
    if scene.moonlit is None:
        return None
    figures = moon_figures(scene, scene.moonlit)
    return {
        "elevation_deg": math.degrees(figures.elevation),
        "azimuth_deg": math.degrees(figures.azimuth) % 360.0,
        "diameter_deg": math.degrees(figures.angular_diameter),
        "phase_angle_deg": math.degrees(figures.phase_angle),
        "illuminated_fraction": figures.illuminated_fraction,
        "illuminance_lx": figures.normal_illuminance,
        "horizontal_illuminance_lx": figures.illuminance,
    }


def _white_matrix(scene: Scene, picture: PictureSettings) -> list[float]:
    white = scene_white(scene, picture)
    if white is None:
        return _IDENTITY
    matrix: list[float] = balance(find_colour_space("lin_rec709"), white).ravel().tolist()
    return matrix
