"""Whether the sky outshines the lights of the night, asked before any of them is loaded."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from skybake.angles import cosine_between
from skybake.image.night import BRIGHTEST_STAR

if TYPE_CHECKING:
    from skybake.image.scene import Scene

STAR_SHARE = 0.02
"""Share that the brightest star or planet must add to the darkest pixel; if not, none is shown."""

GLOW_SHARE = 1e-3
"""Share of the darkest light of the sky that the glow of the night must be to be seen."""

LEFT_BY_CLOUDS = 0.1
"""Share of the light of the sky that comes through thick clouds."""

BRIGHTEST_GLOW = 1.5e-3
"""Of the sky between stars, away from the sun. [cd m⁻²]"""

BRIGHTEST_PLANET = -4.9
"""Venus, in V. [mag]"""

CITY_AT_HORIZON = 20.0
"""Brightness of the glow of cities at the horizon over that in the zenith."""

_VEGA = 2.55e-6
"""Illuminance by V = 0 above the air. [lx]"""

DEEP_NIGHT = math.radians(-20.0)
"""Elevation of the sun from which on other lights may outshine all of its own. [rad]"""

SUN_SHARE = 1e-4
"""Share of the darkest night's light that the sun's must be to be seen."""

DARKEST_GLOW = 1.5e-4
"""Of the sky between stars. [cd m⁻²]"""

SUNWARD = (89.9, 87.0, 80.0, 60.0)
"""Zenith angles toward the sun at which twilight is last seen. [deg]"""

_PEAK = 0.75**2
"""Of a star's light, what falls into the pixel in the middle of which it is."""


def stars_are_outshone(scene: Scene) -> bool:
    """Whether no star shows: by day even Venus is lost in its pixel, unless pixels are small."""
    frame = scene.settings.night.frame
    has_planets = frame is not None and frame.has_date
    brightest = BRIGHTEST_PLANET if has_planets else BRIGHTEST_STAR
    canvases = scene.settings.view.projection.canvases()
    charts = [part.chart for canvas in canvases for part in canvas.parts]
    smallest = min(float(chart.footprints(0, 1).min()) for chart in charts)
    peak = _VEGA * 10.0 ** (-0.4 * brightest) * _PEAK / smallest**2
    is_lost: bool = peak < STAR_SHARE * _darkest(scene)
    return is_lost


def glow_is_outshone(scene: Scene) -> bool:
    """Whether the sky is a thousand times as bright as that of a night."""
    night = scene.settings.night
    brightest = BRIGHTEST_GLOW * max(night.airglow, night.zodiacal, 1.0)
    brightest += CITY_AT_HORIZON * night.city
    # Clouds dim the sky more than what lamps send up to them.
    share = GLOW_SHARE * (LEFT_BY_CLOUDS if scene.planet.clouds else 1.0)
    return brightest < share * _darkest(scene)


def sun_is_outshone(scene: Scene) -> bool:
    """Whether the brightest light of a sun below the horizon is lost in that of the night.

    Asked of few rays, toward the sun. From space it is not: there the limb is in sunlight.
    """
    night, sky = scene.settings.night, scene.sky
    if sky.sun_elevation > DEEP_NIGHT:
        return False
    least = DARKEST_GLOW if night.frame is not None and night.shows_glow else 0.0
    if scene.moonlit is not None:
        least += scene.moonlit.least_luminance
    if least == 0.0 or sky.skylight.radius >= sky.medium.r_top:
        return False
    zenith = np.radians(SUNWARD)
    mu, sine = np.cos(zenith), np.sin(zenith)
    below = sky.source.zenith
    nu = cosine_between(mu, sine, math.cos(below), math.sin(below), 0.0)
    light = sky.radiance_per_irradiance(mu, nu) @ scene.xyz_weights[:, 1]
    return float(light.max()) < SUN_SHARE * least


def _darkest(scene: Scene) -> float:
    """Least luminance of the sky without lights of the night and clouds. [cd m⁻²]"""
    return float((scene.clear_survey @ scene.luminance).min())
