"""``skybake probe``: radiance in given directions as numbers."""

from __future__ import annotations

import io
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from skybake import input_files
from skybake.commands.memory import check_memory
from skybake.commands.options import choices, values
from skybake.commands.options.clouds import (
    check_clouds,
    clouds_from_options,
    clouds_options,
)
from skybake.commands.options.night import (
    lst_option,
    night_from_options,
    night_needs,
    night_options,
)
from skybake.commands.options.observer import (
    altitude_option,
    moon_from_options,
    moon_needs,
    moon_options,
    sun_azimuth_option,
    sun_distance_needs,
    sun_distance_option,
    sun_option,
)
from skybake.commands.options.rules import Needs, check_needs, options_together, some_of
from skybake.commands.options.times import moment_from_options, moment_needs, moment_options
from skybake.commands.options.world import world_from_options, world_options
from skybake.commands.printing.notices import warn

_MOST_WAVELENGTHS = 128


def _wavelengths(text: str) -> tuple[float, ...]:
    try:
        wavelengths = tuple(float(part) for part in text.split(","))
    except ValueError:
        wavelengths = ()
    if not wavelengths or not all(0.0 < value < 1e6 for value in wavelengths):
        raise click.BadParameter(f"must be wavelengths in nm such as 680,550,440, got {text!r}")
    if len(wavelengths) > _MOST_WAVELENGTHS:
        raise click.BadParameter(f"must be at most {_MOST_WAVELENGTHS}, got {len(wavelengths)}")
    return wavelengths


@click.command()
@world_options
@sun_option()
@sun_azimuth_option()
@moment_options
@sun_distance_option()
@moon_options("--time", is_light=False)
@altitude_option()
@clouds_options()
@lst_option
@options_together(*some_of(night_options, "night", "airglow", "zodiacal", "light_pollution"))
@click.option(
    "--components",
    is_flag=True,
    help="A line for each light of the sky apart: sun, moon, airglow, zodiacal, stars, city, and "
    "all, with magnitudes of a square arcsecond.",
)
@click.option(
    "--directions",
    metavar="FILE.csv|-",
    type=click.Path(path_type=Path, allow_dash=True),
    help="CSV with view_zenith_deg and relative_azimuth_deg; - reads standard input.",
)
@click.option(
    "--wavelengths",
    metavar="NM,NM,...",
    type=_wavelengths,
    show_default="the renderer's own",
    help="Wavelengths of the radiances.",
)
@click.option(
    "--per-irradiance",
    is_flag=True,
    help="Per unit of the star's irradiance above the atmosphere, in sr-1, without luminance and "
    "colour.",
)
@click.option("--illuminance", is_flag=True, help="Add illuminances by sun and sky, in lx.")
@click.option(
    "--stokes",
    is_flag=True,
    help="Add Stokes parameters I, Q, U and V, and the degree and angle of linear polarisation.",
)
@click.option(
    "--method",
    type=click.Choice((*choices.METHODS, "reference")),
    default="full",
    show_default=True,
    help="Light transport, as for render, or an unbiased path tracer with standard errors.",
)
@click.option(
    "--samples",
    type=click.IntRange(1, 10**9),
    default=10_000,
    show_default=True,
    help="Paths for each direction and wavelength of --method reference.",
)
@click.option(
    *("-o", "--output"),
    metavar="FILE.csv",
    type=click.Path(path_type=Path),
    callback=values.with_suffix(".csv"),
    show_default="standard output",
    help="CSV to write.",
)
def probe(**options: Any) -> None:
    """Print radiances in given directions as CSV.

    Without --directions it looks along the circle at the sun's elevation and along the sun's
    vertical plane. Azimuths count clockwise from the sun's; radiances are in W m-2 sr-1 nm-1 and
    leave the sun's own disc out.

    \b
    Examples:
      skybake probe --sun 5deg --preset mars
      skybake probe --altitude 10km --directions in.csv --wavelengths 680,550,440 --per-irradiance
      skybake probe --sun 10deg --method reference --samples 2000
      skybake probe --lat -24.6 --lon -70.4 --time 2026-06-17T04:00Z --components
    """
    check_memory()
    context = click.get_current_context()
    is_timed = options["time"] is not None
    check_needs(
        context,
        moment_needs(context),
        sun_distance_needs(options, is_timed=is_timed, time="--time"),
        moon_needs(options, is_timed=is_timed, time="--time"),
        night_needs(options, is_timed=is_timed, time="--time"),
        _components_needs(options),
    )
    moment = moment_from_options(context)

    import numpy as np

    from skybake.image.sun_distance import sun_distance
    from skybake.inspect.polarised import polarisation_warning
    from skybake.inspect.probe import default_directions, probe, read_directions
    from skybake.optics.medium import build_medium
    from skybake.sky.closure import closure_warning
    from skybake.sky.sky import WAVELENGTHS

    planet = world_from_options(context)
    check_clouds(context, planet)
    sun_elevation = options["sun_elevation"] if moment is None else moment.sun_elevation
    source: Path | None = options["directions"]
    if source is None:
        directions = default_directions(sun_elevation)
    elif str(source) == "-":
        where = "standard input"
        text = input_files.read_stream(sys.stdin, where, input_files.LARGEST_DIRECTIONS)
        directions = read_directions(where, io.StringIO(text, newline=""))
    else:
        text = input_files.read_text(source, str(source), input_files.LARGEST_DIRECTIONS)
        directions = read_directions(str(source), io.StringIO(text, newline=""))
    wavelengths = options["wavelengths"]
    if options["stokes"] and (warning := polarisation_warning(planet)) is not None:
        warn(warning)
    if options["method"] == "hillaire":
        warning = closure_warning(
            build_medium(planet, np.array(planet.wavelengths or WAVELENGTHS, dtype=float))
        )
        if warning is not None:
            warn(warning)
    distance = sun_distance(planet, moment, options["sun_distance"])
    seen_from: dict[str, Any] = {
        "sun_elevation": sun_elevation,
        "sun_azimuth": options["sun_azimuth"] if moment is None else moment.sun_azimuth,
        "sun_distance": distance,
        "moon": moon_from_options(options, planet, moment, distance),
        "altitude": options["altitude"],
    }
    if options["components"]:
        from skybake.image.moonlight import Moonlight
        from skybake.inspect.components import probe_components

        night = night_from_options(options, moment)
        moon = None if moment is None or not night.is_shown else moment.lit_moon
        text = probe_components(planet, directions, night, **seen_from, moonlight=Moonlight(moon))
    else:
        text = probe(
            planet,
            directions,
            **seen_from,
            wavelengths=None if wavelengths is None else np.array(wavelengths),
            per_irradiance=options["per_irradiance"],
            illuminance=options["illuminance"],
            with_stokes=options["stokes"],
            method=options["method"],
            samples=options["samples"],
            clouds=clouds_from_options(context),
        )
    _print(text, options["output"])


def _components_needs(options: Mapping[str, Any]) -> Needs:
    apart = options["components"]
    whole = ("wavelengths", "per_irradiance", "illuminance", "stokes", "method", "samples")
    return {
        **dict.fromkeys(
            ("sidereal_time", "night", "airglow", "zodiacal", "light_pollution"),
            (apart, "needs --components"),
        ),
        **dict.fromkeys(whole, (not apart, "cannot be combined with --components")),
    }


def _print(text: str, output: Path | None) -> None:
    if output is None:
        click.echo(text, nl=False)
        return
    from skybake.formats.whole_files import replace_when_whole

    with replace_when_whole(output) as temporary:
        temporary.write_text(text, encoding="utf-8")
