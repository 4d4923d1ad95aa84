"""``skybake chart``: whether a program opens maps the right way round."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.options import choices, values
from skybake.commands.options.maps import map_needs, map_options, map_settings
from skybake.commands.options.observer import sun_azimuth_option, sun_option
from skybake.commands.options.rules import check_needs
from skybake.commands.printing.render_summary import target_lines


@click.command()
@sun_option()
@sun_azimuth_option()
@map_options
@click.option(
    "--directions",
    is_flag=True,
    help="No letters and lines: only red, green, blue = 0.5 + 0.5 d of the direction d toward "
    "east, up and south, for programs to read.",
)
@click.option(
    *("-o", "--output"),
    metavar="FILE",
    type=click.Path(path_type=Path),
    callback=values.with_suffix(*choices.MAP_SUFFIXES),
    show_default="chart, the target and the projection",
    help="Chart to write, in the formats of a map; {face} in it is replaced for six files.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the result as one JSON object.")
@click.option("-q", "--quiet", is_flag=True, help="Print no summary.")
def chart(directions: bool, **options: Any) -> None:
    """Write a chart of directions instead of a map, in the same way.

    Points of the compass, the program's axes and the sun's place stand on it in letters that are
    mirrored or out of place wherever a program opens maps wrongly. Red grows to the east, green
    upward and blue to the south. It has the brightness of a bright sky, whatever 1.0 stands for.

    \b
    Examples:
      skybake chart --target blender -o chart.exr
      skybake chart --target three --projection cubemap --size 512
    """
    check_memory()
    context = click.get_current_context()
    check_needs(context, map_needs(options), {"layers": (False, "a chart has none")})
    settings = map_settings(
        options, sun_elevation=options["sun_elevation"], sun_azimuth=options["sun_azimuth"]
    )

    from skybake.baking.orientation_chart import bake_orientation_chart
    from skybake.baking.paths import usual_suffix

    names = ("chart", options["target"], settings.view.projection.label)
    output = options["output"] or Path("_".join(filter(None, names)) + usual_suffix(settings))
    files = bake_orientation_chart(output, settings, is_lettered=not directions)
    if options["as_json"]:
        click.echo(json.dumps({"files": [str(path) for path in files], **settings.recipe()}))
    elif not options["quiet"]:
        for line in (*map(str, files), *target_lines(settings)):
            click.echo(line)
