"""The options of the night: its lights, and how the stars stand without a time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.options import celestial, values
from skybake.commands.options.rules import Needs, options_together
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment
    from skybake.image.night import Night
    from skybake.image.settings import MapSettings

night_options = options_together(
    click.option(
        "--night",
        type=click.Choice(("auto", "off")),
        show_default="auto",
        help="Whether a map with a time has the lights of the night: stars, Milky Way, zodiacal "
        "light and, on Earth, airglow.",
    ),
    click.option(
        "--stars",
        metavar="include|exclude|only|MAGNITUDE",
        type=celestial.stars,
        show_default="include, with a time",
        help="Whether the map holds the stars, or nothing else, or those up to a magnitude; where "
        "they stand is known with a time, or with --lst.",
    ),
    click.option(
        "--airglow",
        metavar="SCALE",
        type=values.scale,
        show_default="1",
        help="Airglow of Earth over that at a mean solar flux; 0.75 at a low one, 1.25 at a high "
        "one.",
    ),
    click.option(
        "--zodiacal",
        metavar="SCALE",
        type=values.scale,
        show_default="1",
        help="Zodiacal light over what it is.",
    ),
    click.option(
        "--light-pollution",
        metavar="off|LEVEL[,AZIMUTH]",
        type=celestial.light_pollution,
        show_default="off",
        help="Glow of cities: the zenith as bright as 20mag per square arcsecond, with a natural "
        "sky of 22, or by 1.5mcd/m2 of lamps alone; brighter toward a bearing such as 20mag,90deg.",
    ),
)

lst_option = click.option(
    "--lst",
    "sidereal_time",
    metavar="HOURS|ANGLE",
    type=celestial.sidereal_time,
    help="Local sidereal time, such as 18.6h, 18:36 or 279deg, with --lat: how the stars of J2000 "
    "stand, wherever the sun is; over Mars in its worlds, over Earth in all others.",
)


def night_needs(options: Mapping[str, Any], *, is_timed: bool, time: str) -> Needs:
    """Return what the options of the night need: `time`, the option or options of a time."""
    sidereal = options.get("sidereal_time")
    is_known = is_timed or sidereal is not None
    needs = f"needs {time}" + (" or --lst" if "sidereal_time" in options else "")
    is_off = options["night"] == "off"
    lights = [
        name for name in ("stars", "airglow", "zodiacal", "light_pollution") if name in options
    ]
    return {
        "night": (is_known, needs),
        **dict.fromkeys(
            lights,
            (is_known and not is_off, "cannot be combined with --night off" if is_off else needs),
        ),
        "sidereal_time": (
            not is_timed and options["latitude"] is not None,
            f"cannot be combined with {time}" if is_timed else "needs --lat",
        ),
    }


def is_scale_open(options: Mapping[str, Any]) -> bool:
    """Whether no option says what 1.0 stands for, so that a night may have a scale of its own."""
    return all(options.get(name) is None for name in ("units", "ev", "target"))


def scaled_for_night(options: Mapping[str, Any], settings: MapSettings) -> MapSettings:
    """Return the settings of a map at the scale of a night, if it is of one and none is given."""
    if not is_scale_open(options):
        return settings
    from skybake.image.night_scale import night_scaled

    (scaled,) = night_scaled([settings])
    return scaled


def night_from_options(options: Mapping[str, Any], moment: Moment | None = None) -> Night:
    """Return what of the night a map shows.

    Parameters
    ----------
    options : mapping
        With the values of `night_options`, and of ``--lst`` and ``--lat`` if there are any.
    moment : Moment, optional
        When.

    Raises
    ------
    click.UsageError
        If a value is out of its range.
    PresetError
        If the preset cannot be read.
    """
    from skybake.image.night import Night, night_at, night_of

    shown: dict[str, Any] = {
        name: options[name] for name in ("airglow", "zodiacal") if options[name] is not None
    }
    if options["light_pollution"] is not None:
        shown["city"], shown["city_azimuth"] = options["light_pollution"]
    wanted = options.get("stars")
    if wanted is not None:
        shown["faintest_star" if isinstance(wanted, float) else "stars"] = wanted
    try:
        night = Night(is_shown=options["night"] != "off", **shown)
    except InputError as error:
        where, colon, problem = str(error).partition(":")
        raise click.UsageError(f"--{where.replace(' ', '-')}{colon}{problem}") from error
    if moment is not None:
        return night_at(night, moment)
    if options.get("sidereal_time") is None:
        return night

    from skybake.ephemeris.celestial import CelestialFrame
    from skybake.preset import planet_name

    planet = planet_name(options["preset"])
    # Elsewhere than on Mars the stars stand as over Earth.
    over = "mars" if planet == "mars" else "earth"
    frame = CelestialFrame(over, options["sidereal_time"], options["latitude"])
    return night_of(night, frame, planet)
