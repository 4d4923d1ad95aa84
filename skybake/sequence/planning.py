"""From what changes over time to the frames of a sequence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from skybake.baking.paths import preview_beside, usual_suffix, world_name
from skybake.ephemeris.moment import Moment, TimeSpan
from skybake.ephemeris.moon import Moon
from skybake.ephemeris.place import check_planet
from skybake.errors import ArgumentError, InputError
from skybake.image.eclipsing_moon import eclipsing_moon
from skybake.image.moonlight import Moonlight, moonlight_at
from skybake.image.night import Night, night_at
from skybake.image.night_scale import night_scaled
from skybake.image.settings import MapSettings
from skybake.image.sun_distance import sun_distance as distance_of_sun
from skybake.optics.changes import PresetChanges
from skybake.preset import Planet, planet_name
from skybake.sequence.exposure_curve import ExposureCurve
from skybake.sequence.frames import FramePattern, parse_frames
from skybake.sequence.moon_path import MoonPath
from skybake.sequence.plan import Frame, Plan
from skybake.sequence.ramp import Ramp, shares
from skybake.sequence.ramp import at_share as value_at


def plan_sequence(
    preset: str | Path = "earth",
    *,
    frames: str | Sequence[int] | None = None,
    times: TimeSpan | Sequence[Moment] | None = None,
    sun_elevation: float | Ramp | None = None,
    sun_azimuth: float | Ramp | None = None,
    altitude: float | Ramp | None = None,
    sun_distance: float | str | None = None,
    changes: PresetChanges | Mapping[str, Any] | None = None,
    settings: MapSettings | None = None,
    exposure_curve: ExposureCurve | str | Path | None = None,
    cloud_time: float | Ramp | None = None,
    moon_path: MoonPath | None = None,
    eclipses: bool = True,
    output: str | Path | None = None,
    preview: str | Path | bool = False,
    night_scale: bool = False,
) -> Plan:
    """Return all frames of a sequence; nothing is computed yet.

    A `Ramp` changes evenly from the first frame to the last.

    Parameters
    ----------
    preset : str or Path, optional
        Name of a preset, or the path of its file.
    frames : str or sequence of int, optional
        Frame numbers, as ``"1-96"``; needed unless `times` say how many there are, which
        are then counted from 1.
    times : TimeSpan or sequence of Moment, optional
        Put the sun where it is then; moments are one for each frame. A span without
        a step is spread over the frame numbers, so left out ones leave a gap in time.
    sun_elevation, sun_azimuth : float or Ramp, optional
        Where the sun is, if not by `times`; default as in `settings`. [rad]
    altitude : float or Ramp, optional
        Of the observer above the ground, at least 0; default as in `settings`. [km]
    sun_distance : float, "date" or "mean", optional
        Of the sun [au]; or as the times have it, which is the default with times; or as the
        preset has it. By default one in `settings`, or one set in the preset, comes first.
    changes : PresetChanges or mapping, optional
        Changes of the preset, or values by its dotted keys; values may be a `Ramp`.
    settings : MapSettings, optional
        All other settings of the maps.
    exposure_curve : ExposureCurve, str or Path, optional
        What 1.0 stands for in each frame, or its CSV file.
    cloud_time : float or Ramp, optional
        For which clouds have drifted; by default, with times of Earth's clock, as long as since
        the first of them, else as in `settings`. [s]
    moon_path : MoonPath, optional
        Where the Moon stands as a light, if not by `times`.
    eclipses : bool, optional
        Put the planet's moons in front of the sun where they are at the times, unless there is one
        in `settings`.
    output : str or Path, optional
        Pattern of the maps' files, as ``sky.####.exr``; by default named after the world.
    preview : str, Path or bool, optional
        Pattern of the pictures' files, ``.png``; True for pictures beside the maps.
    night_scale : bool, optional
        Let 1.0 stand for what suits a night, see `skybake.image.night_scale`, if all frames are
        of one.

    Raises
    ------
    ArgumentError
        If arguments contradict each other or leave the frames open.
    SkybakeError
        If a value, the preset, or a file cannot be used.
    """
    settings = settings or MapSettings()
    if times is not None:
        by_hand = {
            "sun_elevation": sun_elevation,
            "sun_azimuth": sun_azimuth,
            "moon_path": moon_path,
        }
        for name, value in by_hand.items():
            if value is not None:
                raise ArgumentError(f"{{{name}}}: cannot be combined with {{times}}")
    if isinstance(times, TimeSpan) and times.altitude is None:
        times = replace(times, altitude=_ends(altitude, settings.view.altitude))
    if sun_distance is None:
        sun_distance = settings.lighting.sun_distance
    numbers, moments = _numbers_and_moments(frames, times)
    if moments:
        check_planet(moments[0].place, planet_name(preset))
    along = shares(numbers)
    drift = _drift(moments)
    if cloud_time is not None:
        drift = [cast(float, _at(cloud_time, share)) for share in along]
    planets = _planets(preset, changes, along)
    output = Path(output or _default_output(planets, settings))
    maps = _pattern("output", output, numbers)
    pictures = None if isinstance(preview, bool) else _pattern("preview", preview, numbers)
    if isinstance(exposure_curve, str | Path):
        exposure_curve = ExposureCurve.read(Path(exposure_curve))
    planned = []
    for i, (number, share) in enumerate(zip(numbers, along, strict=True)):
        moment = moments[i] if moments else None
        path = maps.path(number)
        picture = preview_beside(path) if preview is True else None
        world = min(i, len(planets) - 1)
        distance = distance_of_sun(planets[world], moment, sun_distance)
        height = _at(altitude, share)
        moon = settings.lighting.moon
        if moon is None and eclipses:
            above = settings.view.altitude if height is None else height
            moon = eclipsing_moon(planets[world], moment, distance, above)
        at_share = _settings_at(
            settings,
            _at(sun_elevation, share) if moment is None else moment.sun_elevation,
            _at(sun_azimuth, share) if moment is None else moment.sun_azimuth,
            distance,
            height,
            None if exposure_curve is None else exposure_curve.at(number),
            None if drift is None or not planets[world].clouds else drift[i],
            moon,
            settings.night if moment is None else night_at(settings.night, moment),
            settings.moonlight if moment is None else moonlight_at(settings.moonlight, moment),
        )
        if moon_path is not None:
            at_share = _with_moon(at_share, moon_path, share)
        planned.append(
            Frame(
                number=number,
                world=world,
                settings=at_share,
                output=path,
                preview=picture if pictures is None else pictures.path(number),
                label=None if moment is None else moment.label,
                attributes={} if moment is None else moment.attributes,
            )
        )
    if night_scale:
        scaled = night_scaled([frame.settings for frame in planned])
        planned = [replace(frame, settings=own) for frame, own in zip(planned, scaled, strict=True)]
    return Plan(planets, tuple(planned), output, exposure_curve)


def _numbers_and_moments(
    frames: str | Sequence[int] | None, times: TimeSpan | Sequence[Moment] | None
) -> tuple[tuple[int, ...], Sequence[Moment]]:
    """Return the frames, ascending, and the moment of each, or none if there are no times."""
    numbers = None if frames is None else _numbers(frames)
    if times is None:
        if numbers is None:
            raise ArgumentError("{frames}: is required, such as 1-96")
        return numbers, ()
    if isinstance(times, TimeSpan) and times.every is None:
        if numbers is None:
            raise ArgumentError("{frames}: is required, or {every}")
        first, last = numbers[0], numbers[-1]
        moments = times.moments(last - first + 1)
        return numbers, [moments[number - first] for number in numbers]
    moments = times.moments() if isinstance(times, TimeSpan) else list(times)
    if not moments:
        raise ArgumentError("{times}: must hold at least one moment")
    if numbers is None:
        return tuple(range(1, len(moments) + 1)), moments
    if len(numbers) != len(moments):
        raise ArgumentError(
            "{frames}: must be as many as "
            + ("{every} makes" if isinstance(times, TimeSpan) else "{times} are")
            + ", which is {count}, got {found}",
            count=len(moments),
            found=len(numbers),
        )
    return numbers, moments


def _numbers(frames: str | Sequence[int]) -> tuple[int, ...]:
    numbers = parse_frames(frames) if isinstance(frames, str) else tuple(sorted(set(frames)))
    if not numbers:
        raise ArgumentError("{frames}: must hold at least one frame")
    return numbers


def _planets(
    preset: str | Path, changes: PresetChanges | Mapping[str, Any] | None, along: Sequence[float]
) -> tuple[Planet, ...]:
    """Worlds of the frames: one, or one for each if something of it changes."""
    if not isinstance(changes, PresetChanges):
        changes = PresetChanges(tuple((changes or {}).items()))
    if not any(isinstance(value, Ramp) for _, value in changes.values):
        return (changes.load(preset),)
    return tuple(
        replace(
            changes,
            values=tuple(
                (key, _plain(value.at(share)) if isinstance(value, Ramp) else value)
                for key, value in changes.values
            ),
        ).load(preset)
        for share in along
    )


def _plain(number: float) -> float:
    """Return a number as one would type it, since 2 and 2.0 make different recipes."""
    return int(number) if number.is_integer() else number


def _default_output(planets: Sequence[Planet], settings: MapSettings) -> str:
    """Name of the world, with what was set of it, unless that changes from frame to frame."""
    name = world_name(planets[0]) if len(planets) == 1 else planets[0].name
    return f"{name}.####{usual_suffix(settings)}"


def _pattern(argument: str, text: str | Path, numbers: Sequence[int]) -> FramePattern:
    try:
        pattern = FramePattern.parse(str(text))
        pattern.check(numbers)
    except InputError as error:
        raise ArgumentError(f"{{{argument}}}: {{cause}}", cause=error) from error
    return pattern


def _drift(moments: Sequence[Moment]) -> list[float] | None:
    """Return the times since the first moment, or None if there are none with a date. [s]"""
    first = moments[0].time if moments else None
    if first is None:
        return None
    return [(one.time - first).total_seconds() for one in moments if one.time is not None]


def _at(value: float | Ramp | None, share: float) -> float | None:
    return None if value is None else value_at(value, share)


def _with_moon(settings: MapSettings, path: MoonPath, share: float) -> MapSettings:
    lighting = settings.lighting
    moon = path.at(share, lighting.sun_azimuth, lighting.sun_elevation)
    return replace(settings, moonlight=replace(settings.moonlight, moon=moon))


def _ends(altitude: float | Ramp | None, default: float) -> tuple[float, float]:
    """Return the altitude at the first frame and at the last."""
    if isinstance(altitude, Ramp):
        return altitude.first, altitude.last
    return (default, default) if altitude is None else (altitude, altitude)


def _settings_at(
    settings: MapSettings,
    sun_elevation: float | None,
    sun_azimuth: float | None,
    sun_distance: float | None,
    altitude: float | None,
    ev: float | None,
    cloud_time: float | None,
    moon: Moon | None,
    night: Night,
    moonlight: Moonlight,
) -> MapSettings:
    """Return settings with what a frame has of its own; None leaves a value as it is.

    A distance of None is the preset's.
    """
    view, encoding = settings.view, settings.encoding
    lighting = replace(settings.lighting, sun_distance=sun_distance, moon=moon)
    if altitude is not None:
        view = replace(view, altitude=altitude)
    if sun_elevation is not None:
        lighting = replace(lighting, sun_elevation=sun_elevation)
    if sun_azimuth is not None:
        lighting = replace(lighting, sun_azimuth=sun_azimuth)
    if ev is not None:
        encoding = replace(encoding, ev=ev)
    clouds = settings.clouds if cloud_time is None else replace(settings.clouds, time=cloud_time)
    return MapSettings(view, lighting, encoding, clouds, night, moonlight, settings.sensor)
