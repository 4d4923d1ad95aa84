"""``skybake presets``: the worlds that there are, and making new ones."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from skybake.commands.memory import check_memory
from skybake.commands.options.values import with_suffix
from skybake.commands.options.world import change_options, changes_from_options, is_changed
from skybake.errors import InputError, OutputError, PresetError


@click.group()
def presets() -> None:
    """List the worlds that come with skybake, show, check or draw one, or start your own."""


@presets.command("list")
def list_() -> None:
    """List the presets, one per line: name and title."""
    from skybake.preset import load_document, preset_names

    names = preset_names()
    width = max(map(len, names))
    for name in names:
        click.echo(f"{name:{width}}  {load_document(name).data['title']}")


@presets.command()
@click.argument("name", metavar="NAME|PATH")
@click.option(
    "--resolved",
    is_flag=True,
    help="Print it with what it extends and the origin of each key.",
)
@change_options
def show(name: str, resolved: bool, **_: Any) -> None:
    """Print the preset NAME as TOML: its own file, with the source of every value in it.

    With --resolved, or with a change, what it extends is merged into it, and each inherited key
    names the file that it comes from.

    \b
    Examples:
      skybake presets show mars
      skybake presets show mars --resolved --set dust.optical_depth=2
    """
    from skybake.preset import preset_text, resolved_text

    context = click.get_current_context()
    if is_changed(context):
        overrides = changes_from_options(context).overrides(name)
        click.echo(resolved_text(name, overrides), nl=False)
    elif resolved:
        click.echo(resolved_text(name), nl=False)
    else:
        click.echo(preset_text(name), nl=False)


@presets.command()
@click.argument("name", metavar="NAME|PATH")
@change_options
def check(name: str, **_: Any) -> None:
    """Report every error in a preset, or print figures that follow from it.

    Each error is one line with the file and the key; the exit status is then 1. Otherwise it prints
    optical depths, single scattering albedos, columns, visibility and the light of the sun, and
    warns if the atmosphere is too thick to render.

    \b
    Examples:
      skybake presets check earth
      skybake presets check own.toml
      skybake presets check earth --visibility 5km
    """
    check_memory()
    try:
        planet = changes_from_options(click.get_current_context()).load(name)

        from skybake.inspect.summary import summarise, summary_text

        summary = summarise(planet)
    except PresetError as error:
        for fault in error.faults:
            click.echo(f"skybake: {' '.join(fault.split())}", err=True)
        raise click.exceptions.Exit(1) from error
    click.echo(summary_text(planet, summary))


@presets.command()
@click.argument("name")
@click.option(
    "--from",
    "base",
    metavar="NAME|PATH",
    default="earth",
    show_default=True,
    help="Preset that it extends.",
)
def new(name: str, base: str) -> None:
    """Write NAME.toml, a world of your own that extends a preset.

    Everything that can be changed is listed in it as comments. An existing file is never
    overwritten.

    \b
    Examples:
      skybake presets new dusk --from earth
      skybake render --preset dusk.toml
    """
    from skybake.formats.targets import check_target
    from skybake.formats.whole_files import replace_when_whole
    from skybake.preset import preset_template

    name = name[: -len(".toml")] if name.lower().endswith(".toml") else name
    text = preset_template(name, base)
    path = Path(f"{name}.toml")
    check_target(path)
    if path.exists():
        raise OutputError(f"{path}: exists already")
    with replace_when_whole(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    click.echo(path)


@presets.command()
@click.argument("name", metavar="NAME|PATH")
@click.option(
    *("-o", "--output"),
    metavar="FILE.png",
    type=click.Path(path_type=Path),
    callback=with_suffix(".png", ".svg"),
    show_default="NAME.png",
    help="Picture to write, .png or .svg.",
)
@change_options
def plot(name: str, output: Path | None, **_: Any) -> None:
    """Draw the coefficients, profiles and phase functions of a preset.

    Needs matplotlib: pip install matplotlib.

    \b
    Examples:
      skybake presets plot mars
      skybake presets plot earth --set aerosol.optical_depth=0.3 -o haze.png
    """
    check_memory()
    planet = changes_from_options(click.get_current_context()).load(name)
    try:
        from skybake.baking.paths import world_name
        from skybake.inspect.plot import plot_planet
    except ImportError as error:
        raise InputError("plot: needs matplotlib; try pip install matplotlib") from error
    output = output or Path(f"{world_name(planet)}.png")
    plot_planet(planet, output)
    click.echo(output)
