"""The light of a map in figures, and the attributes of files that hold them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from skybake.angles import direction_from_angles
from skybake.colour.space import find_colour_space, rgb_from_xyz
from skybake.formats.spec import Attribute
from skybake.image.scene import Scene

Triple = tuple[float, float, float]

_ATTRIBUTES = {
    "sun_direction": "skybake:sunDirection",
    "sun_colour": "skybake:sunColour",
    "direct_normal_illuminance": "skybake:directNormalIlluminance",
    "direct_illuminance": "skybake:directIlluminance",
    "sky_illuminance": "skybake:skyIlluminance",
}


@dataclass(frozen=True, kw_only=True)
class Light:
    """What light a map holds.

    Attributes
    ----------
    sun_direction : tuple of float
        Unit vector toward the sun in the map's axes: +Y up and, of a map that is not rotated,
        -Z north, +X east.
    sun_colour : tuple of float
        Of the disc as the observer sees it: linear Rec. 709 of luminance 1, without
        negative components; white if no sunlight arrives.
    direct_normal_illuminance, direct_illuminance : float
        By the sun's disc, on a plane that faces it and on a horizontal one. [lx]
    sky_illuminance : float
        By the sky, on a horizontal plane. [lx]
    """

    sun_direction: Triple
    sun_colour: Triple
    direct_normal_illuminance: float
    direct_illuminance: float
    sky_illuminance: float


def light_of_scene(scene: Scene) -> Light:
    """Return the light of a scene."""
    normal, horizontal = scene.sun_xyz()
    elevation = scene.settings.lighting.sun_elevation
    x, y, z = direction_from_angles(scene.sun_bearing, elevation).tolist()
    return Light(
        sun_direction=(x, y, z),
        sun_colour=_colour(normal),
        direct_normal_illuminance=float(normal[1]),
        direct_illuminance=float(horizontal[1]),
        sky_illuminance=scene.sky_illuminance(),
    )


def attributes_from_light(light: Light) -> dict[str, Attribute]:
    """Return the attributes of a map's files."""
    return {name: getattr(light, field) for field, name in _ATTRIBUTES.items()}


def eclipse_attributes(scene: Scene) -> dict[str, Attribute]:
    """Return the attributes of a map's files that tell of an eclipse, none without one."""
    eclipse = scene.sky.eclipse
    if eclipse is None:
        return {}
    return {
        "skybake:eclipse": eclipse.phase.name,
        "skybake:eclipseMagnitude": eclipse.phase.magnitude,
        "skybake:eclipseObscuration": eclipse.phase.obscuration,
    }


def night_attributes(scene: Scene) -> dict[str, Attribute]:
    """Return the attributes of a map's files that tell of its night, none by day."""
    if scene.stars is None and scene.night_glow is None:
        return {}
    from skybake.image import night_figures

    return night_figures.night_attributes(scene)


def moon_attributes(scene: Scene) -> dict[str, Attribute]:
    """Return the attributes of a map's files that tell of its Moon, none without one."""
    if scene.moonlit is None:
        return {}
    from skybake.image.moon_figures import moon_figures

    return moon_figures(scene, scene.moonlit).attributes()


def light_from_attributes(attributes: Mapping[str, Any]) -> Light:
    """Return the light that the attributes of a map's file state.

    All numbers are of single precision, as files hold them, in their shortest decimals:
    attributes that have been in a file, of any format, give the same light as before.

    Raises
    ------
    KeyError, ValueError
        If one of them is missing, or is not what `attributes_from_light` made.
    """
    values = {field: numbers_of(attributes[name]) for field, name in _ATTRIBUTES.items()}
    direction, colour = values.pop("sun_direction"), values.pop("sun_colour")
    (dx, dy, dz), (red, green, blue) = direction, colour
    figures = {field: value for field, (value,) in values.items()}
    return Light(sun_direction=(dx, dy, dz), sun_colour=(red, green, blue), **figures)


def numbers_of(value: Any) -> list[float]:
    """Return the numbers of an attribute, which a Radiance picture holds as text."""
    values = value.split() if isinstance(value, str) else np.atleast_1d(value)
    # What str prints of a number, a program can change.
    return [float(np.format_float_scientific(np.float32(number))) for number in values]


def _colour(xyz: np.ndarray) -> Triple:
    rgb = np.maximum(rgb_from_xyz(find_colour_space("lin_rec709")) @ xyz, 0.0)
    if not xyz[1] > 0.0:
        return 1.0, 1.0, 1.0
    red, green, blue = (rgb / xyz[1]).tolist()
    return red, green, blue
