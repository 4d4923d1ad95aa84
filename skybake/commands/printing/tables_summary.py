"""What ``skybake luts`` prints of tables that are written."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from skybake.image.settings import MapSettings
    from skybake.luts.bake import BakedTables
    from skybake.luts.settings import TableSettings


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
        "seconds": round(seconds, 3),
    }
    click.echo(json.dumps(summary))
