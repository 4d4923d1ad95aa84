"""``skybake convert``: a map in another layout, size, space, scale or format."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.options import choices, values
from skybake.commands.options.conversion import conversion_options
from skybake.commands.options.rules import check_needs
from skybake.commands.printing.notices import warn
from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.baking.convert import Converted
    from skybake.environment.environment import Environment
    from skybake.projection import Projection

_SHAPES = {
    "cube_layout": "layout",
    "cube_space": "space",
    "face_names": "face_names",
    "equirect_rows": "rows",
    "fov": "fov",
}
_INPUT_SHAPES = {"input_cube_space": "space", "input_fov": "fov"}


@click.command()
@click.argument("source", metavar="IN", type=click.Path(path_type=Path))
@click.argument(
    "output",
    metavar="OUT",
    type=click.Path(path_type=Path),
    callback=values.with_suffix(".exr", ".hdr", *choices.CUBE_SUFFIXES),
)
@conversion_options
@click.option("--json", "as_json", is_flag=True, help="Print the result as one JSON object.")
@click.option("-q", "--quiet", is_flag=True, help="Print no summary.")
def convert(source: Path, output: Path, **options: Any) -> None:
    """Write the map IN anew as OUT, with all of its light.

    IN is an EXR or Radiance picture of any program: an equirect map 2:1, a cube as cross, row,
    column or six files, of which any one is named, or what metadata say. What no option names
    stays as it is. OUT is .exr, .hdr or, of a cubemap, .ktx2 or .dds; {face} in it is replaced for
    six files.

    \b
    Examples:
      skybake convert sky.exr cube_{face}.exr --projection cubemap --size 512
      skybake convert cube_px.exr sky.hdr --projection equirect --size 2048
      skybake convert studio.hdr studio.exr --rotate 90deg --colorspace acescg
      skybake convert sky.exr small.exr --size 256x128
    """
    check_memory()
    check_needs(click.get_current_context(), _needs(options, output))

    from skybake.baking.convert import convert as convert_map
    from skybake.environment.load import load_environment

    if not source.name:
        raise InputError(f"{source}: must be an image file, got a folder")
    environment = load_environment(
        source,
        projection=_input_projection(options),
        rotation=options["input_rotate"],
        space=options["input_colorspace"],
        white_luminance=_white(options, "input_"),
    )
    converted = convert_map(
        environment,
        output,
        _projection(options, environment),
        rotation=options["rotate"],
        colorspace=options["colorspace"],
        white_luminance=_wanted_white(options, environment),
        pixel=options["pixel"] or "auto",
        compression=options["compression"] or "zip",
        clamp_negative=options["clamp_negative"],
        omit_exposure=options["omit_exposure"],
        mips=options["mips"],
    )
    for warning in converted.warnings:
        warn(warning)
    if options["as_json"]:
        click.echo(json.dumps(_result(converted)))
    elif not options["quiet"]:
        _print(converted)


def _needs(options: Mapping[str, Any], output: Path) -> dict[str, tuple[bool, str]]:
    suffix = output.suffix.lower()
    is_radiance = suffix == ".hdr"
    needed = {
        f"input_{name}": (
            options["input_projection"] in having,
            f"needs --input-projection {' or '.join(having)}",
        )
        for name, having in choices.PROJECTIONS_WITH.items()
    }
    return {
        **needed,
        "rotate": (
            options["projection"] not in choices.PROJECTIONS_WITH["look"],
            f"cannot be combined with --projection {options['projection']}, which has --look",
        ),
        "omit_exposure": (is_radiance, "needs an .hdr output"),
        "mips": (not is_radiance, "needs an .exr, .ktx2 or .dds output"),
        "pixel": (not is_radiance, "needs an .exr, .ktx2 or .dds output"),
        "compression": (suffix in {".exr", ".ktx2"}, "needs an .exr or .ktx2 output"),
        "units": (options["ev"] is None, "cannot be combined with --ev"),
        "input_units": (options["input_ev"] is None, "cannot be combined with --input-ev"),
    }


def _input_projection(options: Mapping[str, Any]) -> Projection | None:
    from skybake.projection import find_projection

    name = options["input_projection"]
    if name is None:
        return None
    given = {own: options[one] for one, own in _INPUT_SHAPES.items() if options[one] is not None}
    if options["input_look"] is not None:
        given["azimuth"], given["elevation"] = options["input_look"]
    try:
        return find_projection(name, None, given)
    except InputError as error:
        raise click.UsageError(f"--input-{error}") from error


def _projection(options: Mapping[str, Any], environment: Environment) -> Projection:
    from skybake.environment.sizes import find_similar

    given = {own: options[name] for name, own in _SHAPES.items() if options[name] is not None}
    if options["look"] is not None:
        given["azimuth"], given["elevation"] = options["look"]
    old = environment.projection
    name = options["projection"] or old.name
    if name in choices.PROJECTIONS_WITH["look"] and options["rotate"] is not None:
        raise click.UsageError(f"--rotate: cannot be combined with a {name} map, which has --look")
    for option, having in choices.PROJECTIONS_WITH.items():
        if options[option] is not None and name not in having:
            raise click.UsageError(
                f"--{option.replace('_', '-')}: needs --projection {' or '.join(having)}"
            )
    try:
        return find_similar(name, options["size"], given, old)
    except InputError as error:
        raise click.UsageError(f"--{error}") from error


def _white(options: Mapping[str, Any], before: str) -> float | None:
    from skybake.colour.exposure import luminance_from_ev, luminance_from_units

    if options[f"{before}ev"] is not None:
        return luminance_from_ev(options[f"{before}ev"])
    units = options[f"{before}units"]
    return None if units is None else luminance_from_units(units)


def _wanted_white(options: Mapping[str, Any], environment: Environment) -> float | None:
    white = _white(options, "")
    if white is not None and environment.white_luminance is None:
        raise click.UsageError(
            f"--{'units' if options['ev'] is None else 'ev'}: IN does not say what 1.0 stands for; "
            "give --input-units or --input-ev"
        )
    return white


def _print(converted: Converted) -> None:
    for path in converted.files:
        click.echo(path)
    shape = converted.projection.canvases()[0]
    white = converted.white_luminance
    scale = "scale unknown" if white is None else f"1.0 = {white:.6g} cd/m2"
    click.echo(
        f"{converted.projection.name} {shape.width}x{shape.height}, {converted.colorspace}, "
        f"{scale}; {converted.pixel}"
    )
    if converted.clamped:
        click.echo(f"{converted.clamped} negative values, out of gamut, were stored as 0")


def _result(converted: Converted) -> dict[str, Any]:
    shape = converted.projection.canvases()[0]
    return {
        "files": [str(path) for path in converted.files],
        "projection": converted.projection.name,
        "width": shape.width,
        "height": shape.height,
        "rotate_deg": math.degrees(converted.rotation),
        "colorspace": converted.colorspace,
        "white_luminance_cd_m2": converted.white_luminance,
        "pixel": converted.pixel,
        "clamped": converted.clamped,
        "warnings": list(converted.warnings),
    }
