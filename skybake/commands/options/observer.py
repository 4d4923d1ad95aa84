"""The options of the sun by its angles, and of the observer's altitude; of sequences as ranges."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import celestial, values
from skybake.commands.options.rules import Decorator, Needs, options_together

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment
    from skybake.ephemeris.moon import Moon
    from skybake.preset import Planet


def sun_option(*, is_range: bool = False) -> Decorator:
    """Return ``--sun``, an elevation or a range of them."""
    text = "Geometric elevation of the sun's centre at the observer, "
    return click.option(
        "--sun",
        "sun_elevation",
        **quantity("ANGLE", values.elevation, is_range=is_range),
        default="30deg",
        show_default=True,
        help=text + ("from first to last frame." if is_range else "-90deg to 90deg."),
    )


def sun_azimuth_option(*, is_range: bool = False) -> Decorator:
    """Return ``--sun-azimuth``, a bearing or a range of them."""
    return click.option(
        "--sun-azimuth",
        **quantity("ANGLE", values.bearing, is_range=is_range),
        default="180deg",
        show_default=True,
        help="Compass bearing of the sun: 0deg is north, 90deg east.",
    )


def sun_distance_option() -> Decorator:
    """Return ``--sun-distance``."""
    return click.option(
        "--sun-distance",
        metavar="AU|mean|date",
        type=celestial.sun_distance,
        help="How far the sun is, which sets its light and the size of its disc: in au, the "
        "preset's mean, or as on the date, which is the default with a time.",
    )


def sun_distance_needs(options: Mapping[str, Any], *, is_timed: bool, time: str) -> Needs:
    """Return what `sun_distance_option` needs: `time`, the option or options of a time."""
    return {"sun_distance": (is_timed or options["sun_distance"] != "date", f"date needs {time}")}


def moon_options(times: str, *, is_light: bool = True) -> Decorator:
    """Return ``--moon`` and ``--eclipse``; `times` is the option or options of a time.

    With `is_light`, words of ``--moon`` say whether the Moon shines.
    """
    place = "AZIMUTH,ELEVATION[,DIAMETER[,DISTANCE]]"
    front = (
        "in front of the sun; by default as large and as far as Earth's on average, "
        "0.518deg and 384400km. A distance of inf is one without parallax."
    )
    words = f"Whether the map holds the Moon and its light, or no other; or a moon {front}"
    return options_together(
        click.option(
            "--moon",
            metavar=f"include|exclude|only|{place}" if is_light else place,
            type=celestial.moon if is_light else celestial.eclipsing_moon,
            show_default=f"include, with {times}" if is_light else None,
            help=words if is_light else f"Moon {front}",
        ),
        click.option(
            "--eclipse",
            type=click.Choice(("auto", "off")),
            show_default="auto",
            help=f"Whether {times} puts the Moon, Phobos or Deimos in front of the sun where it "
            "is then.",
        ),
    )


def moon_needs(options: Mapping[str, Any], *, is_timed: bool, time: str) -> Needs:
    """Return what `moon_options` need: `time`, the option or options of a time."""
    is_in_front = moon_by_place(options) is not None
    problem = "cannot be combined with --moon" if is_in_front else f"needs {time}"
    return {"eclipse": (is_timed and not is_in_front, problem)}


def moon_by_place(options: Mapping[str, Any]) -> Moon | None:
    """Return the moon that ``--moon`` puts in front of the sun, if it is not a word."""
    moon: Moon | str | None = options["moon"]
    return None if isinstance(moon, str) else moon


def moon_from_options(
    options: Mapping[str, Any],
    planet: Planet,
    moment: Moment | None,
    sun_distance: float | None,
) -> Moon | None:
    """Return the moon that may be in front of the sun.

    Parameters
    ----------
    options : mapping
        With the values of `moon_options` and of ``--altitude``.
    planet : Planet
        The world.
    moment : Moment or None
        When.
    sun_distance : float or None
        As of `skybake.image.settings.Lighting`. [au]
    """
    moon = moon_by_place(options)
    if moon is not None or options["eclipse"] == "off":
        return moon
    from skybake.image.eclipsing_moon import eclipsing_moon

    return eclipsing_moon(planet, moment, sun_distance, options["altitude"])


def altitude_option(*, is_range: bool = False) -> Decorator:
    """Return ``--altitude``, a length or a range of them."""
    return click.option(
        "--altitude",
        **quantity("LENGTH", values.altitude, is_range=is_range),
        default="0m",
        show_default=True,
        help="Of the observer above the ground.",
    )


def positions(options: Mapping[str, Any], moment: Moment | None) -> dict[str, Any]:
    """Return where sun, observer and clouds are, as `skybake.image.settings.map_settings` takes it.

    Parameters
    ----------
    options : mapping
        With the values of the options of this module and of clouds.
    moment : Moment or None
        Whose sun comes before that of the options.
    """
    return {
        "sun_elevation": options["sun_elevation"] if moment is None else moment.sun_elevation,
        "sun_azimuth": options["sun_azimuth"] if moment is None else moment.sun_azimuth,
        "altitude": options["altitude"],
        "cloud_time": options["cloud_time"] or 0.0,
        "clouds_quality": options["clouds_quality"],
    }


def quantity(metavar: str, read: Callable[[str], float], *, is_range: bool) -> dict[str, Any]:
    """Return how an option reads a value, or in sequences one that may change."""
    if is_range:
        return {"metavar": f"{metavar}[..{metavar}]", "type": values.ramp(read)}
    return {"metavar": metavar, "type": read}
