"""What the lights of maps hold, of one map or of many by time."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from skybake.errors import InputError
from skybake.projection.chart import Projection
from skybake.projection.equirect import Equirect


@dataclass(frozen=True, kw_only=True)
class Common:
    """What all maps of a layer have in common.

    Attributes
    ----------
    preset : str
        Name of the world.
    colorspace : str
        A name of `skybake.colour.space.COLOUR_SPACES`.
    sun_is_in_maps : bool
        Whether the maps hold the sun's disc, so that its light is to stay off.
    rotation_deg : float
        Compass bearing that the maps' -Z looks to. [deg]
    fps : float
        Frames per second.
    """

    preset: str
    colorspace: str
    sun_is_in_maps: bool
    rotation_deg: float = 0.0
    fps: float = 24.0


@dataclass(frozen=True, kw_only=True)
class DistantLight:
    """A disc as a light of its own: the sun or the Moon.

    Attributes
    ----------
    elevation_deg, azimuth_deg : float
        Of its centre, and its compass bearing. [deg]
    angular_diameter_deg : float
        [deg]
    colour : tuple of 3 float
        Linear Rec. 709 of luminance 1; any if it gives no light.
    illuminance_lux : float
        On a plane that faces it. [lx]
    """

    elevation_deg: float
    azimuth_deg: float
    angular_diameter_deg: float
    colour: tuple[float, float, float]
    illuminance_lux: float


@dataclass(frozen=True, kw_only=True)
class DomeAndSun:
    """The lights of one map.

    Attributes
    ----------
    file : str
        The map, as seen from the layer's folder.
    frame : int or None
        Its time code; None of a map that does not change.
    white_luminance_cd_m2 : float
        Luminance that a pixel value of 1 stands for. [cd m⁻²]
    sun_elevation_deg, sun_azimuth_deg : float
        Geometric elevation of the sun's centre, and its compass bearing. [deg]
    sun_angular_diameter_deg : float
        Of its disc. [deg]
    sun_colour : tuple of 3 float
        Of the sun's light, linear Rec. 709 of luminance 1; any if it gives none.
    sun_illuminance_lux : float
        On a plane that faces the sun. [lx]
    moon : DistantLight or None
        The Moon, if it is a light of the map.
    """

    file: str
    frame: int | None = None
    white_luminance_cd_m2: float
    sun_elevation_deg: float
    sun_azimuth_deg: float
    sun_angular_diameter_deg: float
    sun_colour: tuple[float, float, float]
    sun_illuminance_lux: float
    moon: DistantLight | None = None

    @property
    def sun(self) -> DistantLight:
        """The sun."""
        return DistantLight(
            elevation_deg=self.sun_elevation_deg,
            azimuth_deg=self.sun_azimuth_deg,
            angular_diameter_deg=self.sun_angular_diameter_deg,
            colour=self.sun_colour,
            illuminance_lux=self.sun_illuminance_lux,
        )


def check_dome(path: Path, dome: str, projection: Projection) -> None:
    """Refuse maps that a dome shows elsewhere than they are.

    Parameters
    ----------
    path : Path
        File with the dome.
    dome : str
        What shows the maps, for messages.
    projection : Projection
        Of the maps.

    Raises
    ------
    InputError
        If they are not equirect, which is the only kind that every dome takes, or their first
        and last rows are the poles.
    """
    if not isinstance(projection, Equirect):
        raise InputError(
            f"{path}: {dome} needs maps of the projection equirect, got {projection.name}"
        )
    if projection.rows != "centres":
        raise InputError(
            f"{path}: {dome} needs maps with centred rows, got equirect rows {projection.rows!r}"
        )
