"""What the options of lighting maps, and the program that they are for, come to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.ibl.files import FileForm
    from skybake.ibl.program import Program
    from skybake.ibl.settings import LightingMaps
    from skybake.image.settings import MapSettings

_SIZES = ("specular_size", "mips", "diffuse_size", "samples", "dfg_size")


def program_from_options(options: Mapping[str, Any]) -> Program:
    """Return how the target takes lighting maps.

    Raises
    ------
    click.UsageError
        If it takes none of the format or in the axes that are asked for.
    """
    from skybake.ibl.program import find_program

    with _as_usage():
        program = find_program(options["target"])
        if options["target"] is not None:
            _check("format", options["file_format"], program.formats, options["target"])
            _check("cube space", options["cube_space"], (program.space,), options["target"])
    return program


def lighting_from_options(
    options: Mapping[str, Any], program: Program
) -> tuple[LightingMaps, FileForm]:
    """Return which maps are made, and how they are stored.

    Raises
    ------
    click.UsageError
        If a value is out of range.
    """
    from skybake.ibl.files import FileForm
    from skybake.ibl.settings import LightingMaps

    sizes = {name: options[name] for name in _SIZES if options[name] is not None}
    if options["parts"] is not None:
        sizes["parts"] = options["parts"]
    with _as_usage():
        maps = LightingMaps(
            **{"mips": program.mips, **sizes},
            mapping=options["mip_roughness"] or program.mapping,
            dfg_multiscatter=options["dfg_multiscatter"] or program.dfg_multiscatter,
            dfg_upward=program.dfg_upward,
        )
        given = options["file_format"]
        form = FileForm(
            format=given or program.format,
            pixel=options["pixel"] or (program.pixel if given is None else "auto"),
            space=options["cube_space"] or program.space,
            face_names=options["face_names"] or program.face_names,
        )
    return maps, form


def sky_settings(
    options: Mapping[str, Any], program: Program, edge: int, **others: Any
) -> MapSettings:
    """Return the settings of the sky whose light is filtered.

    Parameters
    ----------
    options : mapping
        With the values of `lighting_options`.
    program : Program
        What it is for.
    edge : int
        Of the cube. [pixel]
    **others
        As of `skybake.commands.options.maps.map_settings`.

    Raises
    ------
    click.UsageError
        If a value is out of range.
    """
    from skybake.image import settings

    names = ("colorspace", "ev", "sun_size", "sun_soft", "sun_strength", "method")
    given = {name: options[name] for name in names if options[name] is not None}
    if options["rotate"] is not None:
        given["rotation"] = options["rotate"]
    with _as_usage():
        return settings.map_settings(
            "cubemap",
            edge,
            units=options["units"] or program.units,
            sun_disc=options["sun_disc"] or program.sun_disc,
            **given,
            **others,
        )


def _check(name: str, given: str | None, taken: tuple[str, ...], target: str) -> None:
    if given is not None and given not in taken:
        raise InputError(
            f"{name}: must be {' or '.join(taken)} for the target {target}, got {given!r}"
        )


@contextmanager
def _as_usage() -> Iterator[None]:
    try:
        yield
    except InputError as error:
        where, colon, problem = str(error).partition(":")
        raise click.UsageError(f"--{where.replace(' ', '-')}{colon}{problem}") from error
