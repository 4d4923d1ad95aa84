"""The light of a map's Moon in figures, and the attributes of files that hold them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from skybake.angles import direction_from_angles
from skybake.colour.space import ColourSpace, find_colour_space, rgb_from_xyz
from skybake.formats.spec import Attribute
from skybake.image.light import numbers_of

if TYPE_CHECKING:
    from skybake.image.moonlit import Moonlit
    from skybake.image.scene import Scene

Triple = tuple[float, float, float]
ColourAndLight = tuple[Triple, float]

MOON_ILLUMINANCE = "skybake:moonIlluminance"
"""Attribute of maps with a Moon: of the horizontal by its disc. [lx]"""


@dataclass(frozen=True, kw_only=True)
class MoonFigures:
    """The light of the Moon's disc as the observer sees it.

    Attributes
    ----------
    direction : tuple of 3 float
        Unit vector toward it in the map's axes, as of the sun.
    azimuth, elevation : float
        Compass bearing and elevation of its centre. [rad]
    angular_diameter : float
        [rad]
    phase_angle : float
        From 0 when full to pi when new. [rad]
    illuminated_fraction : float
        Share of the disc that the sun lights.
    colour, colour_in_map : tuple of 3 float
        Of luminance 1, linear Rec. 709 and of the map's space, without negative components; white
        if no light arrives.
    normal_illuminance, illuminance : float
        On a plane that faces it and on a horizontal one. [lx]
    eclipsed : float
        Share of its light that Earth's shadow takes, 0 outside of an eclipse.
    is_in_map : bool
        Whether the map holds the disc.
    """

    direction: Triple
    azimuth: float
    elevation: float
    angular_diameter: float
    phase_angle: float
    illuminated_fraction: float
    colour: Triple
    colour_in_map: Triple
    normal_illuminance: float
    illuminance: float
    eclipsed: float
    is_in_map: bool

    def attributes(self) -> dict[str, Attribute]:
        """Return the attributes of a map's files."""
        found: dict[str, Attribute] = {
            "skybake:moonDirection": self.direction,
            "skybake:moonColour": self.colour,
            "skybake:moonNormalIlluminance": self.normal_illuminance,
            MOON_ILLUMINANCE: self.illuminance,
            "skybake:moonPhaseAngle": math.degrees(self.phase_angle),
            "skybake:moonIlluminatedFraction": self.illuminated_fraction,
        }
        return found | ({"skybake:moonEclipsed": self.eclipsed} if self.eclipsed > 0.0 else {})


def moon_from_attributes(attributes: Mapping[str, Any]) -> ColourAndLight | None:
    """Return colour and normal illuminance of the Moon that a file states; None without one."""
    colour = numbers_of(attributes.get("skybake:moonColour", ()))
    normal = numbers_of(attributes.get("skybake:moonNormalIlluminance", ()))
    if len(colour) != 3 or len(normal) != 1:
        return None
    red, green, blue = colour
    return (red, green, blue), normal[0]


def moon_figures(scene: Scene, lit: Moonlit) -> MoonFigures:
    """Return the figures of a scene's Moon."""
    normal, horizontal = lit.xyz()
    moon = lit.moon
    x, y, z = direction_from_angles(lit.bearing, moon.elevation).tolist()
    return MoonFigures(
        direction=(x, y, z),
        azimuth=moon.azimuth,
        elevation=moon.elevation,
        angular_diameter=2.0 * moon.angular_radius,
        phase_angle=moon.phase_angle,
        illuminated_fraction=moon.illuminated_fraction,
        colour=_colour(normal, find_colour_space("lin_rec709")),
        colour_in_map=_colour(normal, scene.settings.encoding.space),
        normal_illuminance=float(normal[1]),
        illuminance=float(horizontal[1]),
        eclipsed=1.0 - lit.eclipsed_share,
        is_in_map="moon" in scene.layer_names,
    )


def _colour(xyz: np.ndarray, space: ColourSpace) -> Triple:
    if not xyz[1] > 0.0:
        return 1.0, 1.0, 1.0
    red, green, blue = np.maximum(rgb_from_xyz(space) @ (xyz / xyz[1]), 0.0).tolist()
    return red, green, blue
