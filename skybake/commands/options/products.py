"""The options of files about a sequence: manifests, contact sheet, animated picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from skybake.commands.options import values
from skybake.commands.options.emit import HOW, command_from_options
from skybake.commands.options.rules import options_together

if TYPE_CHECKING:
    from skybake.sequence.plan import Plan
    from skybake.sequence.products import Products

product_options = options_together(
    click.option(
        "--manifest",
        "manifests",
        metavar="FILE",
        type=click.Path(path_type=Path),
        multiple=True,
        callback=values.with_suffix(".json", ".csv", ".usda"),
        show_default="NAME.sequence.json beside the maps, without --only",
        help="Write times, sun, light, files and digests of all frames as .json, .csv or .usda.",
    ),
    click.option(
        "--contact-sheet",
        metavar="FILE.png",
        type=click.Path(path_type=Path),
        callback=values.with_suffix(".png"),
        help="Write a picture of all frames side by side.",
    ),
    click.option(
        "--animate",
        metavar="FILE.webp",
        type=click.Path(path_type=Path),
        callback=values.with_suffix(".webp", ".gif"),
        help="Write an animated picture, .webp or .gif; needs pip install Pillow.",
    ),
    click.option(
        "--fps",
        metavar="N",
        type=values.frame_rate,
        default="24",
        show_default=True,
        help="Frames per second of the animated picture and of USD.",
    ),
)


def products_from_options(context: click.Context, plan: Plan) -> Products:
    """Return what is to be written about a sequence.

    A part of a sequence has no manifest by default, since it would replace that of another.
    """
    from skybake.sequence.products import Products, default_manifest

    options = context.params
    by_default = (default_manifest(plan),) if options["only"] is None else ()
    return Products(
        plan,
        manifests=options["manifests"] or by_default,
        contact_sheet=options["contact_sheet"],
        animation=options["animate"],
        fps=options["fps"],
        command=tuple(command_from_options(context, plan, leave_out=HOW)),
    )
