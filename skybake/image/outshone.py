"""Whether the sky outshines the lights of the night, asked before any of them is loaded."""

from __future__ import annotations

from typing import TYPE_CHECKING

from skybake.image.night import BRIGHTEST_STAR

if TYPE_CHECKING:
    from skybake.image.scene import Scene

STAR_SHARE = 0.02
"""Share that the brightest star or planet must add to the darkest pixel; if not, none is shown."""

GLOW_SHARE = 1e-3
"""Share of the darkest light of the sky that the glow of the night must be to be seen."""

BRIGHTEST_GLOW = 1.5e-3
"""Of the sky between stars, away from the sun. [cd m⁻²]"""

BRIGHTEST_PLANET = -4.9
"""Venus, in V. [mag]"""

CITY_AT_HORIZON = 20.0
"""Brightness of the glow of cities at the horizon over that in the zenith."""

_VEGA = 2.55e-6
"""Illuminance by V = 0 above the air. [lx]"""

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
    return brightest < GLOW_SHARE * _darkest(scene)


def _darkest(scene: Scene) -> float:
    """Least luminance of the sky without lights of the night and clouds. [cd m⁻²]"""
    return float((scene.clear_survey @ scene.luminance).min())
