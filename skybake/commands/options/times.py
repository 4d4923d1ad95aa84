"""The options that put the sun where it is at a time, or at many."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from skybake.commands.options import values
from skybake.commands.options.emit import remember
from skybake.commands.options.place import (
    day_from_options,
    place_from_options,
    place_needs,
    place_options,
)
from skybake.commands.options.rules import Needs, options_together, usage_faults

if TYPE_CHECKING:
    from skybake.ephemeris.moment import Moment, TimeSpan

_HOW = ("zone", "solar_longitude", "refraction")

moment_options = options_together(
    click.option(
        "--time",
        metavar="TIME",
        help="Put the sun where it is at --lat and --lon: 2026-06-21T04:00Z, or sunset+10min; "
        "on Mars at --site; with --ls 16:30 or sunset.",
    ),
    place_options,
)

span_options = options_together(
    click.option(
        "--from",
        "start",
        metavar="TIME",
        help="Put the sun where it is at --lat and --lon from here on: 2026-06-21T04:00Z, or "
        "sunrise-1h; on Mars at --site; with --ls 04:00 or sunrise.",
    ),
    click.option("--to", "end", metavar="TIME", help="Time of the last frame."),
    click.option(
        "--every",
        metavar="DURATION",
        type=values.duration,
        help="Time between frames, such as 10min; by default --frames are spread evenly.",
    ),
    place_options,
)


def moment_needs(context: click.Context) -> Needs:
    """Return what `moment_options` need to have an effect."""
    options = context.params
    return place_needs(
        is_timed=options["time"] is not None,
        time="--time",
        is_latitude_free=options.get("sidereal_time") is not None,
    )


def moment_from_options(context: click.Context) -> Moment | None:
    """Return the moment of ``--time``.

    Raises
    ------
    click.UsageError
        If there is no such time, or an option that would have no effect.
    PresetError
        If the preset cannot be read.
    """
    options = context.params
    if options["time"] is None:
        return None

    from skybake.ephemeris.moment import sun_at

    place = place_from_options(context, "--time")
    with usage_faults(context):
        return sun_at(
            options["time"],
            place,
            altitude=options["altitude"],
            day=day_from_options(context, place),
            **{name: options[name] for name in _HOW},
        )


def span_needs(context: click.Context) -> Needs:
    """Return what `span_options` need to have an effect."""
    start, end = context.params["start"], context.params["end"]
    is_timed = start is not None or end is not None
    return {
        "start": (end is not None, "needs --to as well"),
        "end": (start is not None, "needs --from as well"),
        "every": (is_timed, "needs --from and --to"),
        **place_needs(is_timed=is_timed, time="--from and --to"),
    }


def span_from_options(context: click.Context) -> TimeSpan | None:
    """Return the span of time of ``--from`` and ``--to``.

    Raises
    ------
    click.UsageError
        If its place is incomplete.
    PresetError
        If the preset cannot be read.
    """
    options = context.params
    if options["start"] is None:
        return None

    from skybake.ephemeris.moment import TimeSpan

    place = place_from_options(context, "--from")
    day = day_from_options(context, place)
    if day is not None:
        # Other machines shall bake the same day tomorrow.
        remember(context, "day", str(day))
    names = ("start", "end", "every", *_HOW)
    return TimeSpan(place=place, day=day, **{name: options[name] for name in names})
