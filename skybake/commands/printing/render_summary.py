"""What ``skybake render`` prints of a map that is baked."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.printing.night import night_lines, night_result
from skybake.units import degrees

if TYPE_CHECKING:
    from skybake.baking import Baked
    from skybake.ephemeris.moment import Moment
    from skybake.image.settings import MapSettings
    from skybake.sidecar.map_light import MapLight


def print_summary(baked: Baked, settings: MapSettings, seconds: float) -> None:
    """Print files and illuminances, human-readable."""
    for path in (*baked.files, *baked.light_files):
        click.echo(path)
    if baked.preview is not None and baked.preview_ev is not None:
        from skybake.commands.printing.pictures import picture_line

        click.echo(picture_line(baked.preview, baked.preview_ev, baked.preview_white))
    click.echo(
        f"sun {baked.direct_illuminance:.5g} lx ({baked.direct_normal_illuminance:.5g} lx facing "
        f"it), sky {baked.sky_illuminance:.5g} lx on the horizontal; "
        f"1.0 = {baked.white_luminance:.6g} cd/m2{_scale(settings)}; {baked.pixel}; {seconds:.2f} s"
    )
    eclipse = _eclipse(baked)
    if eclipse is not None:
        click.echo(
            f"eclipse: {eclipse['phase']}, magnitude {eclipse['magnitude']:.4f}, "
            f"{eclipse['obscuration']:.2%} of the disc covered"
        )
    if baked.from_below is not None:
        by_map, by_ground = baked.from_below
        click.echo(f"from below {by_map:.5g} lx, instead of {by_ground:.5g} lx by the ground")
    if baked.moonlight:
        click.echo(_moon_line(baked))
    for line in night_lines(baked.night):
        click.echo(line)
    if baked.clamped:
        click.echo(f"{baked.clamped} negative values, out of gamut, were stored as 0")
    for line in target_lines(settings):
        click.echo(line)


def _scale(settings: MapSettings) -> str:
    from skybake.image.night_scale import NIGHT_EV, has_night_scale

    return f" (EV {NIGHT_EV:g}, of a night)" if has_night_scale(settings) else ""


def target_lines(settings: MapSettings) -> list[str]:
    """Return a line on where things are in the program that a map is for, if it is for one."""
    name = settings.encoding.target
    if name is None:
        return []
    from skybake.image.target import find_target
    from skybake.image.target_sun import target_sun_direction

    axes = find_target(name).axes
    x, y, z = target_sun_direction(settings, name)
    left_out = ", which needs a light of its own" if settings.lighting.sun_disc == "exclude" else ""
    return [
        f"{name}: {axes.east} is east, {axes.north} north, {axes.up} up; "
        f"toward the sun ({x:.4f}, {y:.4f}, {z:.4f}){left_out}"
    ]


def print_json(baked: Baked, settings: MapSettings, seconds: float, when: Moment | None) -> None:
    """Print one JSON object on one line, of a map whose `Baked.map_light` is known."""
    click.echo(json.dumps(result(baked, settings, seconds, when)))


def result(
    baked: Baked, settings: MapSettings, seconds: float, when: Moment | None
) -> dict[str, Any]:
    """Return what ``--json`` prints, see docs/cli.md.

    Raises
    ------
    ValueError
        If `Baked.map_light` is not known.
    """
    light = baked.map_light
    if light is None:
        raise ValueError("light: must be known, got None")
    return {
        "files": [str(path) for path in baked.files],
        "preset": light.preset,
        "time": None if when is None else when.attributes.get("skybake:time"),
        "sun_direction": list(baked.sun_direction),
        **_target(settings),
        "sun_azimuth_deg": degrees(light.sun_azimuth),
        "sun_elevation_deg": degrees(light.sun_elevation),
        "sun_distance_au": light.sun_distance,
        "sun_angular_diameter_deg": math.degrees(light.sun_angular_diameter),
        "sun_colour": list(light.sun_colour_in_map),
        "sun_colour_temperature_k": light.sun_temperature,
        "sun_irradiance": list(light.sun_irradiance),
        "direct_illuminance_lux": baked.direct_illuminance,
        "direct_normal_illuminance_lux": baked.direct_normal_illuminance,
        "sky_illuminance_lux": baked.sky_illuminance,
        "eclipse": _eclipse(baked),
        "moon": _moon(light),
        **night_result(baked.night),
        "white_luminance_cd_m2": baked.white_luminance,
        "exposure_ev": light.exposure_ev,
        "projection": light.projection,
        "colorspace": light.colorspace,
        "sun_disc": light.sun_disc,
        "pixel": baked.pixel,
        "clamped": baked.clamped,
        "from_below_lux": None if baked.from_below is None else list(baked.from_below),
        "warnings": list(baked.warnings),
        "lights": [str(path) for path in baked.light_files],
        "preview": None if baked.preview is None else str(baked.preview),
        "preview_ev": baked.preview_ev,
        "preview_white": None if baked.preview_white is None else list(baked.preview_white),
        "seconds": round(seconds, 3),
    }


def _moon(light: MapLight) -> dict[str, Any] | None:
    if light.moon is None:
        return None
    from skybake.sidecar.light_json import moon_document

    return moon_document(light.moon)


def _moon_line(baked: Baked) -> str:
    told = baked.moonlight
    eclipsed = told.get("skybake:moonEclipsed")
    dimmed = "" if eclipsed is None else f", {eclipsed:.3%} of it in the shadow of Earth"
    return (
        f"moon {told['skybake:moonIlluminance']:.3g} lx on the horizontal "
        f"({told['skybake:moonNormalIlluminance']:.3g} lx facing it), "
        f"{told['skybake:moonIlluminatedFraction']:.0%} lit{dimmed}"
    )


def _eclipse(baked: Baked) -> dict[str, Any] | None:
    if not baked.eclipse:
        return None
    phase, magnitude, obscuration = baked.eclipse.values()
    return {"phase": phase, "magnitude": magnitude, "obscuration": obscuration}


def _target(settings: MapSettings) -> dict[str, Any]:
    name = settings.encoding.target
    if name is None:
        return {"target": None, "target_sun_direction": None}
    from skybake.image.target_sun import target_sun_direction

    return {"target": name, "target_sun_direction": list(target_sun_direction(settings, name))}
