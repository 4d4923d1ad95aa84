"""What lights a scene as a map does: the sky on it, and the sun as a light of its own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skybake.colour.space import rgb_from_xyz
from skybake.colour.temperature import correlated_temperature
from skybake.constants import ASTRONOMICAL_UNIT
from skybake.image.light import Light, Triple, light_of_scene
from skybake.image.meter import scene_ev
from skybake.image.moon_figures import MoonFigures, moon_figures
from skybake.image.scene import Scene
from skybake.image.settings import Lighting, MapSettings
from skybake.optics.spectrum import star_at
from skybake.preset import Planet


@dataclass(frozen=True, kw_only=True)
class MapLight(Light):
    """The light of a map, with all that another program needs to repeat it.

    Attributes
    ----------
    preset : str
        Name of the world.
    projection : str
        Kind of the map, a key of `skybake.projection.PROJECTIONS`.
    colorspace : str
        Of the map's pixels, a name of `skybake.colour.space.COLOUR_SPACES`.
    white_luminance : float
        Luminance that a pixel value of 1 stands for. [cd m⁻²]
    rotation : float
        Compass bearing that the map's -Z looks to. [rad]
    target : str or None
        Program that the map is for, a name of `skybake.image.target.TARGETS`.
    target_turn : float
        How far the map is turned for that program, which is a part of `rotation`. [rad]
    target_sun_direction : tuple of float or None
        Unit vector toward the sun in the axes of that program.
    sun_disc : str
        Which light the map holds, see `skybake.image.settings.Lighting`.
    sun_azimuth, sun_elevation : float
        Compass bearing of the sun, and geometric elevation of its centre. [rad]
    sun_distance : float
        [au]
    sun_angular_diameter : float
        Of the disc as it is drawn. [rad]
    sun_colour_in_map : tuple of float
        Of the sun's light in the space of the map, linear, of luminance 1 before negative
        components, of a colour that the space does not hold, were set to 0.
    sun_temperature : float or None
        Correlated colour temperature, see `correlated_temperature`. [K]
    exposure_ev : float
        Exposure value at ISO 100 that a camera would choose for the sky.
    moon : MoonFigures or None
        Of a map with a Moon.
    """

    preset: str
    projection: str
    colorspace: str
    white_luminance: float
    rotation: float
    target: str | None
    target_turn: float
    target_sun_direction: Triple | None
    sun_disc: str
    sun_azimuth: float
    sun_elevation: float
    sun_distance: float
    sun_angular_diameter: float
    sun_colour_in_map: Triple
    sun_temperature: float | None
    exposure_ev: float
    moon: MoonFigures | None = None

    @property
    def sun_is_in_map(self) -> bool:
        """Whether the map holds the disc, so that a light beside it would count twice."""
        return holds_sun(self.sun_disc)

    @property
    def sun_irradiance(self) -> Triple:
        """What the sun adds to a plane that faces it, as the sum of pixel value times solid angle.

        A white diffuse plane is this over pi, in the space and the unit of the map. [sr]
        """
        scale = self.direct_normal_illuminance / self.white_luminance
        red, green, blue = self.sun_colour_in_map
        return scale * red, scale * green, scale * blue


def map_light(scene: Scene, light: Light | None = None) -> MapLight:
    """Describe what a scene's map is lit by.

    Parameters
    ----------
    scene : Scene
        What the map shows.
    light : Light, optional
        Its light, if that is known.
    """
    settings, target = scene.settings, scene.settings.encoding.target
    turn, sun_direction = (0.0, None) if target is None else _in_target(settings, target)
    normal, _ = scene.sun_xyz()
    star = star_at(scene.planet.star, settings.lighting.sun_distance)
    return MapLight(
        **vars(light_of_scene(scene) if light is None else light),
        preset=scene.planet.name,
        projection=settings.view.projection.name,
        colorspace=settings.encoding.colorspace,
        white_luminance=settings.encoding.white_luminance,
        rotation=settings.view.rotation,
        target=target,
        target_turn=turn,
        target_sun_direction=sun_direction,
        sun_disc=settings.lighting.sun_disc,
        sun_azimuth=settings.lighting.sun_azimuth,
        sun_elevation=settings.lighting.sun_elevation,
        sun_distance=star.distance / ASTRONOMICAL_UNIT,
        sun_angular_diameter=2.0 * scene.sun.angular_radius,
        sun_colour_in_map=_colour(scene, normal),
        sun_temperature=correlated_temperature(normal),
        exposure_ev=scene_ev(scene),
        moon=None if scene.moonlit is None else moon_figures(scene, scene.moonlit),
    )


def holds_sun(sun_disc: str) -> bool:
    """Whether maps of `skybake.image.settings.Lighting.sun_disc` hold the disc."""
    return sun_disc in {"include", "only"}


def disc_diameter(planet: Planet, lighting: Lighting) -> float:
    """Angular diameter of the sun, or of the size that its disc is to be drawn in. [rad]"""
    star = star_at(planet.star, lighting.sun_distance)
    return lighting.sun_size or 2.0 * star.angular_radius


def _in_target(settings: MapSettings, name: str) -> tuple[float, Triple]:
    """Return how far a map is turned for a program, and where the sun is in it."""
    from skybake.image.target import find_target
    from skybake.image.target_sun import target_sun_direction

    turn = find_target(name).turn(settings.view.projection.name)
    return turn, target_sun_direction(settings, name)


def _colour(scene: Scene, xyz: np.ndarray) -> Triple:
    if not xyz[1] > 0.0:
        return 1.0, 1.0, 1.0
    to_rgb = rgb_from_xyz(scene.settings.encoding.space)
    red, green, blue = np.maximum(to_rgb @ (xyz / xyz[1]), 0.0).tolist()
    return red, green, blue
