"""``skybake studio``: knobs, the sky that they make, and the command that bakes it."""

from __future__ import annotations

import webbrowser

import click

from skybake.commands.memory import check_memory
from skybake.commands.options.world import preset_option
from skybake.commands.printing.notices import announce_kernels


@click.command()
@preset_option
@click.option(
    "--port",
    metavar="N",
    type=click.IntRange(0, 65_535),
    default=0,
    show_default="a free one",
    help="Port of the page.",
)
@click.option("--no-browser", is_flag=True, help="Only print the address of the page.")
def studio(preset: str, port: int, no_browser: bool) -> None:
    """Turn knobs, see the light, and copy the command that bakes it.

    Opens a page in the browser that is served by this computer for itself alone. Maps are baked
    into the current folder. End it with Ctrl-C. Needs aiohttp: pip install 'skybake[studio]'.

    \b
    Examples:
      skybake studio
      skybake studio --preset mars
      skybake studio --port 8750 --no-browser
    """
    check_memory()
    from skybake.commands.studio_server import studio_server
    from skybake.preset import load_preset

    load_preset(preset)
    server = studio_server(preset, port)
    announce_kernels()

    def ready() -> None:
        click.echo(server.url)
        if not no_browser:
            webbrowser.open(server.url)

    server.run(ready)
