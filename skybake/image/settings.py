"""What is looked at, what lights it, and how it is stored: all of a map but its world."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from skybake.colour.exposure import luminance_from_ev, luminance_from_units
from skybake.colour.space import ColourSpace, find_colour_space
from skybake.ephemeris.moon import Moon
from skybake.errors import InputError
from skybake.formats.compression import parse_compression
from skybake.image.moonlight import Moonlight
from skybake.image.night import Night
from skybake.image.sensor import Sensor
from skybake.projection import Equirect, Projection, find_projection
from skybake.sky.sky import METHODS
from skybake.units import degrees, metres

SUN_DISCS = ("include", "exclude", "only", "separate")
BELOW_HORIZON = ("ground", "extend", "black")
LARGEST_SUN = math.radians(20.0)
"""Largest diameter of a sun's disc that is drawn in another size than its own. [rad]"""

STRONGEST_SUN = 1e6
CLOUD_QUALITIES = ("draft", "normal", "high")
PIXELS = ("auto", "half", "float", "rgb9e5", "r11g11b10")

_CLOUDS = {"cloud_time": "time", "clouds_quality": "quality"}


@dataclass(frozen=True)
class View:
    """Where the observer is, and which part of the sky is shown.

    Attributes
    ----------
    altitude : float
        Of the observer above the ground. [km]
    projection : Projection
        Kind and size of the map.
    rotation : float
        Compass bearing that the map's -Z looks to instead of north. [rad]
    below_horizon : {"ground", "extend", "black"}
        What is shown below the true horizon: the ground, the horizon's light softly extended
        downward, or nothing.
    """

    altitude: float = 0.0
    projection: Projection = field(default_factory=Equirect)
    rotation: float = 0.0
    below_horizon: str = "ground"

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        if not math.isfinite(self.rotation):
            raise InputError(f"rotation: must be finite, got {self.rotation}")
        _check_known("below horizon", self.below_horizon, BELOW_HORIZON)


@dataclass(frozen=True)
class Lighting:
    """What lights the sky, and whether its disc is shown.

    Attributes
    ----------
    sun_elevation : float
        Geometric elevation of the sun's centre at the observer. [rad]
    sun_azimuth : float
        Compass bearing of the sun: 0 = north, clockwise. [rad]
    sun_distance : float or None
        Of the sun; None leaves it where the preset has it. [au]
    sun_disc : {"include", "exclude", "only", "separate"}
        Whether the map holds the sun's disc, or nothing else, or each in a part of the file.
    sun_size : float or None
        Angular diameter of the disc as it is drawn, with the light of the true one, at most
        `LARGEST_SUN`; None for its own, or for what a soft one needs. [rad]
    sun_soft : bool
        Draw the disc without an edge, see `skybake.sky.drawn_disc.DrawnDisc`.
    sun_strength : float
        Factor of the disc's light, greater than 0; the sky keeps its own.
    method : {"full", "scalar", "hillaire", "march"}
        How light is transported, see `skybake.sky.sky.Sky`.
    moon : Moon or None
        What may be in front of the sun.
    """

    sun_elevation: float = math.radians(30.0)
    sun_azimuth: float = math.pi
    sun_distance: float | None = None
    sun_disc: str = "include"
    sun_size: float | None = None
    sun_soft: bool = False
    sun_strength: float = 1.0
    method: str = "full"
    moon: Moon | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        _check_known("sun disc", self.sun_disc, SUN_DISCS)
        _check_known("method", self.method, METHODS)
        if self.sun_size is not None and not 0.0 < self.sun_size <= LARGEST_SUN + 1e-9:
            raise InputError(
                f"sun size: must be greater than 0deg and at most "
                f"{math.degrees(LARGEST_SUN):g}deg, got {math.degrees(self.sun_size):g}deg"
            )
        if not 0.0 < self.sun_strength <= STRONGEST_SUN:
            raise InputError(
                f"sun strength: must be greater than 0 and at most {STRONGEST_SUN:g}, "
                f"got {self.sun_strength:g}"
            )


@dataclass(frozen=True)
class Clouds:
    """When clouds are seen, and how finely their light is solved for.

    Attributes
    ----------
    time : float
        For which they have drifted and changed, at least 0. [s]
    quality : {"draft", "normal", "high"}
        Of the light's grid and of the march through clouds.
    """

    time: float = 0.0
    quality: str = "normal"

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        _check_known("clouds quality", self.quality, CLOUD_QUALITIES)
        if not 0.0 <= self.time < math.inf:
            raise InputError(f"cloud time: must be at least 0s and finite, got {self.time}s")

    def recipe(self) -> dict[str, Any]:
        """All that decides the pixels, in human-readable units, fit for JSON."""
        return {"cloud_time_s": self.time, "clouds_quality": self.quality}


@dataclass(frozen=True)
class Encoding:
    """What the numbers of a map mean and how they are stored.

    Attributes
    ----------
    colorspace : str
        A name of `skybake.colour.space.COLOUR_SPACES`.
    units : {"ev15", "nits"}
        What 1.0 stands for: 1.2 * 2**15 cd/m2, or 1 cd/m2.
    ev : float or None
        If given, 1.0 stands for 1.2 * 2**ev cd/m2 instead.
    pixel : {"auto", "half", "float", "rgb9e5", "r11g11b10"}
        Type of stored values; auto takes half where no value is lost in it. The last two, of 32
        bits for three colours, are of KTX alone.
    compression : str
        EXR compression, see `skybake.formats.compression`.
    clamp_negative : bool
        Set negative values of colours outside the space to 0.
    omit_exposure : bool
        Leave EXPOSURE, by which some programs divide, out of a Radiance picture.
    mips : bool
        Write smaller copies with the map, down to one pixel, for programs that filter textures.
    layers : bool
        Keep sky, clouds and sun in parts of the file that add up to the map.
    target : str or None
        Program that the map is for, a name of `skybake.image.target.TARGETS`. It is stated in
        files, and they must be of a format that it takes; `map_settings` sets what it needs.
    """

    colorspace: str = "lin_rec709"
    units: str = "ev15"
    ev: float | None = None
    pixel: str = "auto"
    compression: str = "zip"
    clamp_negative: bool = False
    omit_exposure: bool = False
    mips: bool = False
    layers: bool = False
    target: str | None = None

    def __post_init__(self) -> None:
        """Refuse what cannot be stored."""
        _check_known("pixel", self.pixel, PIXELS)
        _ = self.space, self.white_luminance, parse_compression(self.compression)
        if self.target is not None:
            from skybake.image.target import find_target

            find_target(self.target)

    @property
    def space(self) -> ColourSpace:
        """The colour space of the pixels."""
        return find_colour_space(self.colorspace)

    @property
    def white_luminance(self) -> float:
        """Luminance that RGB (1, 1, 1) stands for. [cd m⁻²]"""
        if self.ev is not None:
            return luminance_from_ev(self.ev)
        return luminance_from_units(self.units)


@dataclass(frozen=True)
class MapSettings:
    """Everything that decides a map but the planet.

    Attributes
    ----------
    view : View
        What is looked at.
    lighting : Lighting
        What lights it.
    encoding : Encoding
        How it is stored.
    clouds : Clouds
        When clouds are seen, if the world has any.
    night : Night
        Which stars are shown.
    moonlight : Moonlight
        Where the Moon stands as a light.
    sensor : Sensor
        What is recorded besides what an eye sees, or instead.
    """

    view: View = field(default_factory=View)
    lighting: Lighting = field(default_factory=Lighting)
    encoding: Encoding = field(default_factory=Encoding)
    clouds: Clouds = field(default_factory=Clouds)
    night: Night = field(default_factory=Night)
    moonlight: Moonlight = field(default_factory=Moonlight)
    sensor: Sensor = field(default_factory=Sensor)

    def recipe(self, *, has_clouds: bool = False) -> dict[str, Any]:
        """All that decides the pixels, in human-readable units, fit for JSON.

        Parameters
        ----------
        has_clouds : bool, optional
            Whether the world has any, whose settings count then.
        """
        lighting, encoding, below = self.lighting, self.encoding, self.view.below_horizon
        return {
            "sun_elevation_deg": degrees(lighting.sun_elevation),
            "sun_azimuth_deg": degrees(lighting.sun_azimuth),
            **({} if lighting.sun_distance is None else {"sun_distance_au": lighting.sun_distance}),
            "altitude_m": metres(self.view.altitude),
            **self.view.projection.recipe(),
            "rotate_deg": degrees(self.view.rotation),
            **({} if below == "ground" else {"below_horizon": below}),
            "colorspace": encoding.colorspace,
            "white_luminance_cd_m2": encoding.white_luminance,
            "pixel": encoding.pixel,
            "compression": encoding.compression,
            "sun_disc": lighting.sun_disc,
            "sun_size_deg": None if lighting.sun_size is None else degrees(lighting.sun_size),
            "sun_soft": lighting.sun_soft,
            "sun_strength": lighting.sun_strength,
            "clamp_negative": encoding.clamp_negative,
            "omit_exposure": encoding.omit_exposure,
            "method": lighting.method,
            **({"mips": True} if encoding.mips else {}),
            **({"layers": True} if encoding.layers else {}),
            **({} if encoding.target is None else {"target": encoding.target}),
            **({} if lighting.moon is None else lighting.moon.recipe()),
            **(self.clouds.recipe() if has_clouds else {}),
            **self.night.recipe(),
            **self.moonlight.recipe(),
            **self.sensor.recipe(),
        }


def map_settings(
    projection: Projection | str | None = None,
    size: tuple[int, ...] | int | None = None,
    **values: Any,
) -> MapSettings:
    """Return the settings of a map from values by name.

    Parameters
    ----------
    projection : Projection or str, optional
        A projection, or a name of `skybake.projection.PROJECTIONS`; by default that of the
        target, or else ``"equirect"``.
    size : tuple of int, or int, optional
        Of a projection that is given by name: width and height, or edge. [pixel]
    **values
        Attributes of `View`, `Lighting` and `Encoding`, such as ``sun_elevation=0.1``, of the
        named projection, such as ``layout="cross"``, ``cloud_time`` [s] and
        ``clouds_quality``, see `Clouds`, ``night``, a `Night`, ``moonlight``, a `Moonlight`, and
        ``sensor``, a `Sensor`. With ``target="blender"`` what is not given is as that program
        needs it, and a rotation turns what it takes for north.

    Raises
    ------
    InputError
        If a value is out of its range, or there is no such attribute.
    """
    if values.get("target") is not None:
        projection, values = _for_target(values["target"], projection, values)
    projection = projection or "equirect"
    parts = {}
    for name, kind in (("view", View), ("lighting", Lighting), ("encoding", Encoding)):
        names = {one.name for one in fields(kind)}
        parts[name] = {key: values.pop(key) for key in names & values.keys()}
    night, sensor = values.pop("night", Night()), values.pop("sensor", Sensor())
    moonlight = values.pop("moonlight", Moonlight())
    clouds = {own: values.pop(name) for name, own in _CLOUDS.items() if name in values}
    if isinstance(projection, str):
        size = (size,) if isinstance(size, int) else size
        projection = find_projection(projection, size, values)
    elif size is not None or values:
        given = sorted({*values, *(() if size is None else ("size",))})
        raise InputError(f"settings: {', '.join(given)} must be given by the projection itself")
    view = View(projection=projection, **parts["view"])
    lighting, encoding = Lighting(**parts["lighting"]), Encoding(**parts["encoding"])
    return MapSettings(view, lighting, encoding, Clouds(**clouds), night, moonlight, sensor)


def _for_target(
    name: str, projection: Projection | str | None, values: Mapping[str, Any]
) -> tuple[Projection | str, dict[str, Any]]:
    """Return the projection, and values by name, with what a target needs besides."""
    from skybake.image.target import find_target

    target = find_target(name)
    projection = projection or target.projection
    if isinstance(projection, str):
        return projection, target.with_defaults(projection, values)
    shape = vars(projection)
    needed = target.with_defaults(projection.name, {**shape, **values})
    return projection, {
        key: value for key, value in needed.items() if key in values or key not in shape
    }


def _check_known(name: str, value: str, known: tuple[str, ...]) -> None:
    if value not in known:
        raise InputError(f"{name}: must be one of {', '.join(known)}, got {value!r}")
