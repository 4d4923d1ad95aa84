"""The studio in a cell of a notebook."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape

from skybake.commands.studio_server import studio_server


@dataclass(frozen=True)
class StudioFrame:
    """The page of a running studio, which a notebook shows in a frame.

    Attributes
    ----------
    url : str
        Address of the page, with its token.
    height : int
        Of the frame. [pixel]
    """

    url: str
    height: int

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        return (
            f'<iframe src="{escape(self.url)}" width="100%" height="{self.height}" '
            'style="border: 0" allow="clipboard-write; fullscreen"></iframe>'
        )


def studio(preset: str = "earth", *, port: int = 0, height: int = 720) -> StudioFrame:
    """Start the studio, and return what shows its page in a cell of a notebook.

    Parameters
    ----------
    preset : str, optional
        Name or path of the world with which it opens.
    port : int, optional
        Of the page, on the machine of the notebook's kernel alone; 0 takes a free one.
    height : int, optional
        Of the frame. [pixel]

    Returns
    -------
    StudioFrame
        Its `url` opens in a browser of that machine as well. The server runs as long as the
        process does.

    Raises
    ------
    InputError
        If aiohttp is missing, or the port cannot be used.
    PresetError
        If the preset cannot be used.
    """
    from skybake.preset import load_preset

    load_preset(preset)
    server = studio_server(preset, port, in_frame=True)
    server.start()
    return StudioFrame(server.url, height)
