"""Makes the server of the studio, whose knobs are the options of ``skybake render``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from skybake.errors import InputError

if TYPE_CHECKING:
    from skybake.studio.serve import Server


def studio_server(preset: str, port: int = 0, *, in_frame: bool = False) -> Server:
    """Return a server whose maps are baked into the current folder.

    Parameters
    ----------
    preset : str
        With which the page opens.
    port, in_frame
        As of `skybake.studio.serve.Server`.

    Raises
    ------
    InputError
        If aiohttp is missing, or the port cannot be used.
    """
    try:
        import aiohttp  # noqa: F401 - only whether it is there
    except ImportError as error:
        raise InputError("studio: needs aiohttp; try pip install 'skybake[studio]'") from error
    from skybake.commands.render_reader import RenderReader
    from skybake.studio.serve import Server

    folder = Path.cwd()
    return Server(RenderReader(folder, preset), folder, preset, port, in_frame=in_frame)
