"""``skybake preview``: a picture to look at of any map."""

from __future__ import annotations

from pathlib import Path

import click

from skybake.commands.memory import check_memory
from skybake.commands.options.values import VIEWS, exposure, with_suffix
from skybake.errors import InputError


@click.command()
@click.argument("source", metavar="IN", type=click.Path(path_type=Path))
@click.option(
    *("-o", "--output"),
    metavar="OUT.png",
    type=click.Path(path_type=Path),
    callback=with_suffix(".png"),
    show_default="IN with the suffix .png",
    help="Picture to write.",
)
@click.option(
    "--ev",
    metavar="auto|N",
    type=exposure,
    default="auto",
    show_default=True,
    help="Exposure value at ISO 100; auto finds one at which the sky is legible.",
)
@click.option(
    "--view",
    type=click.Choice(VIEWS),
    default=VIEWS[0],
    show_default=True,
    help="Display transform: ACES 2.0, or that of ACES 1.3.",
)
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
def preview(source: Path, output: Path | None, ev: float | None, view: str, quiet: bool) -> None:
    """Show the EXR or Radiance map IN as an sRGB picture, through ACES.

    Colour space and scale are read from the file. Without tags it is taken as linear Rec. 709,
    exposed for EV 15.

    \b
    Examples:
      skybake preview sky.exr
      skybake preview sky.exr -o dark.png --ev 12 --view aces1
    """
    check_memory()

    from skybake.baking.preview import preview_file

    if not source.name:
        raise InputError(f"{source}: must be an image file, got a folder")
    output = output or source.with_suffix(".png")
    ev = preview_file(source, output, ev=ev, view=view)
    if not quiet:
        click.echo(f"{output}  exposed for EV {ev:.2f}")
