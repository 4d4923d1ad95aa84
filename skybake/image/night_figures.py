"""The lights of a map's night in figures, and the attributes of files that hold them."""

from __future__ import annotations

import math

from skybake.formats.spec import Attribute
from skybake.image.scene import Scene
from skybake.image.starry import star_illuminance, turned

STAR_ILLUMINANCE = "skybake:starIlluminance"
"""Attribute of maps with stars: of the horizontal by them. [lx]"""

NIGHT_ILLUMINANCE = "skybake:nightSkyIlluminance"
"""Attribute of maps with a glow of the night: of the horizontal by it. [lx]"""

ZENITH_LUMINANCE = "skybake:nightZenithLuminance"
"""Attribute of the same maps: that of the glow in the zenith. [cd m⁻²]"""

AIRGLOW_SCALE = "skybake:airglowScale"
"""Attribute of the same maps, as of `Night.airglow`."""

ROTATION = "skybake:celestialRotation"
"""Attribute of maps with lights of the night: rows of the matrix from the axes of J2000 to those of
the map."""

_MAGNITUDE_OF_CANDELA = 12.58
"""Of a square arcsecond at 1 cd/m2, in V, of a spectrum like the sun's. [mag]"""


def night_attributes(scene: Scene) -> dict[str, Attribute]:
    """Return the attributes of a map's files that tell of its night, none by day."""
    found: dict[str, Attribute] = {}
    frame, glow, stars = scene.settings.night.frame, scene.night_glow, scene.stars
    if stars is not None:
        found[STAR_ILLUMINANCE] = star_illuminance(scene, stars)
    if glow is not None:
        found[NIGHT_ILLUMINANCE] = glow.illuminance
        found[ZENITH_LUMINANCE] = glow.zenith_luminance
        found[AIRGLOW_SCALE] = glow.airglow
    if frame is not None and found:
        columns = turned(frame.rotation.T, scene.settings.view.rotation)
        found[ROTATION] = tuple(columns.T.ravel().tolist())
    return found


def surface_magnitude(luminance: float) -> float:
    """Magnitude V of a square arcsecond of a luminance [cd m⁻²], infinite of none. [mag]"""
    if not luminance > 0.0:
        return math.inf
    return _MAGNITUDE_OF_CANDELA - 2.5 * math.log10(luminance)
