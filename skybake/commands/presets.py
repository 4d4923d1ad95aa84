"""``skybake presets``: what worlds there are."""

from __future__ import annotations

import tomllib

import click


@click.group()
def presets() -> None:
    """List the worlds that come with skybake, or show one as TOML."""


@presets.command("list")
def list_() -> None:
    """List the presets, one a line: name and title."""
    from skybake.preset import preset_names, preset_text

    names = preset_names()
    width = max(map(len, names))
    for name in names:
        title = tomllib.loads(preset_text(name))["title"]
        click.echo(f"{name:{width}}  {title}")


@presets.command()
@click.argument("name")
def show(name: str) -> None:
    """Print the preset NAME as TOML, with the source of every value.

    Start a world of your own from it:

    \b
      skybake presets show mars > dusty.toml
      skybake render --preset dusty.toml
    """
    from skybake.preset import preset_text

    click.echo(preset_text(name), nl=False)
