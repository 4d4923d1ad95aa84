"""``skybake targets``: what maps are like for which program."""

from __future__ import annotations

import json
import textwrap
from typing import TYPE_CHECKING

import click

from skybake.commands.options import choices

if TYPE_CHECKING:
    from skybake.image.target import Target

_WIDTH = 100


@click.command()
@click.argument("name", required=False, type=click.Choice(choices.TARGETS), metavar="[NAME]")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def targets(name: str | None, as_json: bool) -> None:
    """List the programs that maps can be made for, or what one of them needs and why.

    \b
    Examples:
      skybake targets
      skybake targets unreal
      skybake render --target unreal
    """
    from skybake.image.target import TARGETS, find_target

    chosen = list(TARGETS.values()) if name is None else [find_target(name)]
    if as_json:
        found = [target.summary() for target in chosen]
        click.echo(json.dumps(found if name is None else found[0]))
    elif name is None:
        for target in chosen:
            click.echo(f"{target.name:9} {target.title} ({target.verified})")
    else:
        for line in _lines(chosen[0]):
            click.echo(line)


def _cube(target: Target) -> str:
    names = f" --face-names {target.face_names}" if target.cube_layout == "faces" else ""
    return f"--cube-layout {target.cube_layout} --cube-space {target.cube_space}{names}"


def _lines(target: Target) -> list[str]:
    axes, given = target.axes, target.summary()
    maps = ", ".join(f"{name} ({' '.join(ends)})" for name, ends in target.maps.items())
    stated = {
        "maps": maps,
        "turn": f"--rotate {given['rotate_deg']:g}deg of an equirect map; "
        f"{axes.east} is east, {axes.north} north, {axes.up} up",
        "cube": _cube(target) if "cubemap" in target.maps else "none",
        "rows": f"--equirect-rows {target.equirect_rows}",
        "scale": f"--units {target.units}",
        "pixel": f"--pixel {target.pixel}" + (" --omit-exposure" * target.omit_exposure),
        "sun": f"--sun-disc {target.sun_disc}",
    }
    lines = [f"{target.name}: {target.title}", f"verified  {target.verified}"]
    for subject, value in stated.items():
        reason = target.reasons[subject]
        lines.append(f"{subject:9} {value}")
        lines += textwrap.wrap(
            f"{reason.text} [{reason.source}]",
            _WIDTH,
            initial_indent=" " * 12,
            subsequent_indent=" " * 12,
            break_long_words=False,
            break_on_hyphens=False,
        )
    return lines
