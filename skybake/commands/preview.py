"""``skybake preview``: a picture to look at of any map."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.options.previews import look_options, picture_from_options, vision_option
from skybake.commands.options.values import exposure, with_suffix
from skybake.commands.printing.pictures import picture_line
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
    help="Exposure value at ISO 100; auto meters the sky as a camera does.",
)
@vision_option
@look_options
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
def preview(
    source: Path, output: Path | None, ev: float | None, quiet: bool, **options: Any
) -> None:
    """Show the EXR or Radiance map IN as an sRGB picture, through ACES.

    Colour space, scale and projection are read from the file. Without tags it is taken as linear
    Rec. 709, exposed for EV 15, in the projection of its shape.

    \b
    Examples:
      skybake preview sky.exr
      skybake preview sky.exr -o dark.png --ev 12 --view aces2
      skybake preview sky.exr -o west.png --shot 270,10,60deg --white-balance 5500K
    """
    check_memory()

    from skybake.baking.preview import preview_file

    if not source.name:
        raise InputError(f"{source}: must be an image file, got a folder")
    output = output or source.with_suffix(".png")
    shown = preview_file(source, output, picture_from_options(options, ev))
    if not quiet:
        click.echo(picture_line(output, shown.ev, shown.white))
