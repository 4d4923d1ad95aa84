"""What ``skybake luts`` prints of tables that are written."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from skybake.image.settings import MapSettings
    from skybake.luts.bake import BakedTables
    from skybake.luts.settings import TableSettings

COARSE = 0.05
"""Relative error near the sun from which the summary tells of it."""


def print_summary(
    baked: BakedTables, view: MapSettings, settings: TableSettings, seconds: float
) -> None:
    """Print files and what they hold, human-readable."""
    for path in baked.files:
        click.echo(path)
    click.echo(
        f"{settings.parametrisation}; {view.encoding.space.name}; "
        f"a radiance of 1 is {view.encoding.white_luminance:.6g} cd/m2; {seconds:.2f} s"
    )
    near = baked.error_near_sun
    if near is not None and near["largest_relative"] > COARSE:
        width, height = settings.sky_view_size
        click.echo(
            f"sky_view errs by up to {near['largest_relative']:.0%} within {near['within_deg']:g} "
            f"degrees of the sun; --sky-view-size {2 * width}x{2 * height} by much less"
        )


def print_json(
    baked: BakedTables, view: MapSettings, settings: TableSettings, seconds: float
) -> None:
    """Print one JSON object."""
    summary = {
        "files": [str(path) for path in baked.files],
        "parametrisation": settings.parametrisation,
        "sizes": {name: list(size) for name, size in settings.sizes.items()},
        "method": view.lighting.method,
        "colorspace": view.encoding.space.name,
        "white_luminance_cd_m2": view.encoding.white_luminance,
        "recipe_hash": baked.recipe_hash,
        "error_near_sun": baked.error_near_sun,
        "seconds": round(seconds, 3),
    }
    click.echo(json.dumps(summary))
