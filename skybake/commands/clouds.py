"""``skybake clouds``: voxels of clouds, written to files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.options.world import change_options, changes_from_options
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.cloud_fields.light_grid import ExtinctionGrid
    from skybake.preset import CloudLayer, Planet

_SUFFIX = ".npz"

_output = click.option(
    "-o",
    "--output",
    metavar=f"FILE{_SUFFIX}",
    required=True,
    type=click.Path(path_type=Path),
    help="File to write.",
)


@click.group()
def clouds() -> None:
    """Write layers of clouds as tiles of voxels, or make tiles of other programs' files."""


@clouds.command()
@click.argument("name", metavar="NAME|PATH")
@click.option("--layer", metavar="NAME", help="Which, if the preset has several.")
@_output
@change_options
def tile(name: str, layer: str | None, output: Path, **_: Any) -> None:
    """Write the voxels of a layer of clouds of the preset NAME.

    The file holds what a layer of the kind tile reads: extinction_per_km along z, y and x, at 550
    nm, and spacing_km.

    \b
    Examples:
      skybake clouds tile earth-fair -o cloud.npz
      skybake clouds tile earth --clouds cumulus:0.3,seed=7 -o cloud.npz
    """
    check_memory()
    _check_suffix(output)
    from skybake.cloud_fields.build import build_field
    from skybake.cloud_fields.light_grid import light_grid

    planet = changes_from_options(click.get_current_context()).load(name)
    chosen = _layer(planet, name, layer)
    field = build_field(chosen)
    if not field.top > field.base:
        raise InputError(f"{name}: clouds.{chosen.name} must have clouds to write, got cover 0")
    grid = light_grid(field, field.spacing)
    _write(grid, output)
    click.echo(f"base {grid.base:.10g} km")


@clouds.command("import")
@click.argument("path", metavar="FILE.vdb", type=click.Path(path_type=Path))
@click.option("--grid", default="density", show_default=True, help="Name of the grid to read.")
@click.option(
    "--extinction",
    "scale",
    metavar="PER_KM",
    type=click.FloatRange(0.0, min_open=True),
    default=1.0,
    show_default=True,
    help="Extinction where the grid is 1, per km.",
)
@click.option(
    "--metres",
    metavar="M",
    type=click.FloatRange(0.0, min_open=True),
    default=1.0,
    show_default=True,
    help="Length of the file's unit.",
)
@click.option(
    "--up",
    type=click.Choice(["y", "z"]),
    default="y",
    show_default=True,
    help="The file's axis that points up.",
)
@_output
def import_(path: Path, grid: str, scale: float, metres: float, up: str, output: Path) -> None:
    """Make a tile of an OpenVDB file, which needs its Python module.

    \b
    Example:
      skybake clouds import cloud.vdb --extinction 60 -o cloud.npz
    """
    check_memory()
    _check_suffix(output)
    from skybake.cloud_fields.tiles import check_voxels
    from skybake.cloud_fields.vdb import read_vdb

    voxels = read_vdb(path, grid, scale, metres * 1e-3, up)
    check_voxels(voxels, str(path))
    _write(voxels, output)


def _layer(planet: Planet, preset: str, name: str | None) -> CloudLayer:
    layers = {layer.name: layer for layer in planet.clouds}
    names = ", ".join(layers)
    if not layers:
        raise InputError(f"{preset}: must have a layer of clouds, got none")
    if name is None and len(layers) > 1:
        raise click.UsageError(f"--layer must name one of {names}")
    if name is not None and name not in layers:
        raise click.BadParameter(f"must be one of {names}, got {name!r}", param_hint="--layer")
    return layers[name or names]


def _check_suffix(output: Path) -> None:
    if output.suffix != _SUFFIX:
        raise click.BadParameter(f"must end in {_SUFFIX}, got {output}", param_hint="--output")


def _write(grid: ExtinctionGrid, output: Path) -> None:
    from skybake.cloud_fields.tiles import tile_bytes
    from skybake.formats.whole_files import replace_when_whole

    with replace_when_whole(output) as temporary:
        temporary.write_bytes(tile_bytes(grid))
