"""What ``skybake render`` prints of a map that is baked."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from skybake.baking import Baked
    from skybake.ephemeris.moment import Moment
    from skybake.image.settings import MapSettings


def print_summary(baked: Baked, seconds: float) -> None:
    """Print files and illuminances, human-readable."""
    for path in baked.files:
        click.echo(path)
    if baked.preview is not None and baked.preview_ev is not None:
        from skybake.commands.printing.pictures import picture_line

        click.echo(picture_line(baked.preview, baked.preview_ev, baked.preview_white))
    click.echo(
        f"sun {baked.direct_illuminance:.5g} lx ({baked.direct_normal_illuminance:.5g} lx facing "
        f"it), sky {baked.sky_illuminance:.5g} lx on the horizontal; "
        f"1.0 = {baked.white_luminance:.6g} cd/m2; {baked.pixel}; {seconds:.2f} s"
    )
    if baked.clamped:
        click.echo(f"{baked.clamped} negative values, out of gamut, were stored as 0")


def print_json(
    baked: Baked, preset: str, settings: MapSettings, seconds: float, when: Moment | None
) -> None:
    """Print one JSON object on one line."""
    click.echo(json.dumps(result(baked, preset, settings, seconds, when)))


def result(
    baked: Baked, preset: str, settings: MapSettings, seconds: float, when: Moment | None
) -> dict[str, Any]:
    """Return what ``--json`` prints, see docs/cli.md."""
    return {
        "files": [str(path) for path in baked.files],
        "preset": preset,
        "time": None if when is None else when.attributes.get("skybake:time"),
        "sun_direction": list(baked.sun_direction),
        "direct_illuminance_lux": baked.direct_illuminance,
        "direct_normal_illuminance_lux": baked.direct_normal_illuminance,
        "sky_illuminance_lux": baked.sky_illuminance,
        "white_luminance_cd_m2": baked.white_luminance,
        "projection": settings.view.projection.name,
        "colorspace": settings.encoding.colorspace,
        "pixel": baked.pixel,
        "clamped": baked.clamped,
        "preview": None if baked.preview is None else str(baked.preview),
        "preview_ev": baked.preview_ev,
        "preview_white": None if baked.preview_white is None else list(baked.preview_white),
        "seconds": round(seconds, 3),
    }
