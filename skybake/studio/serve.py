"""Serves the studio on this machine alone: in the foreground, or in a thread of a notebook."""

from __future__ import annotations

import asyncio
import os
import secrets
import socket
from collections.abc import Callable
from pathlib import Path
from threading import Event, Thread

from aiohttp import web

from skybake.errors import InputError
from skybake.studio.guard import Guard
from skybake.studio.reader import Reader
from skybake.studio.server import Studio

ADDRESS = "127.0.0.1"
TOKEN_VARIABLE = "SKYBAKE_STUDIO_TOKEN"  # noqa: S105 - the name of a variable
SHORTEST_TOKEN = 16

_ENDS_WITHIN = 2.0


def token_of_environment() -> str:
    """Return the token of the environment, by which an address survives a restart, or a new one.

    Raises
    ------
    InputError
        If it is too short to be secret, or does not fit into an address.
    """
    token = os.environ.get(TOKEN_VARIABLE)
    if token is None:
        return secrets.token_urlsafe(24)
    is_plain = token.isascii() and token.replace("-", "").replace("_", "").isalnum()
    if len(token) < SHORTEST_TOKEN or not is_plain:
        raise InputError(
            f"{TOKEN_VARIABLE}: must be at least {SHORTEST_TOKEN} letters, digits, _ and -, "
            f"got {len(token)} characters"
        )
    return token


def bound_socket(port: int) -> socket.socket:
    """Return a socket of this machine alone.

    Parameters
    ----------
    port : int
        0 takes a free one.

    Raises
    ------
    InputError
        If the port cannot be used.
    """
    bound = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if os.name == "posix":
        # A server that was just ended leaves its port in a state that others could take.
        bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        bound.bind((ADDRESS, port))
    except OSError as error:
        bound.close()
        raise InputError(f"--port: cannot be used ({port}: {error.strerror or error})") from error
    return bound


class Server:
    """A server of the studio that has a port and an address, and serves when it is run.

    Parameters
    ----------
    reader : Reader
        Reads knobs.
    folder : Path
        Where maps are baked.
    preset : str
        With which the page opens.
    port : int, optional
        0 takes a free one.
    in_frame : bool, optional
        Whether the page of a notebook may show it in a frame.

    Raises
    ------
    InputError
        If the port or the token cannot be used.
    """

    def __init__(
        self, reader: Reader, folder: Path, preset: str, port: int = 0, *, in_frame: bool = False
    ) -> None:
        self._token = token_of_environment()
        self._socket = bound_socket(port)
        self._studio = Studio(reader, folder, preset)
        self._in_frame = in_frame

    @property
    def url(self) -> str:
        """Address of the page, with its token."""
        return f"http://{ADDRESS}:{self._port}/?token={self._token}"

    @property
    def _port(self) -> int:
        port: int = self._socket.getsockname()[1]
        return port

    def run(self, ready: Callable[[], None]) -> None:
        """Serve until the process is interrupted.

        Parameters
        ----------
        ready : callable
            Called when requests are answered.
        """
        try:
            asyncio.run(self._serve(ready))
        except KeyboardInterrupt:
            # This is how it ends.
            return

    def start(self) -> None:
        """Serve in a thread, as long as the process lives."""
        is_ready = Event()
        work = Thread(
            target=lambda: asyncio.run(self._serve(is_ready.set)), name="studio", daemon=True
        )
        work.start()
        is_ready.wait()

    async def _serve(self, ready: Callable[[], None]) -> None:
        guard = Guard(self._token, self._port)
        application = self._studio.application(guard, in_frame=self._in_frame)
        runner = web.AppRunner(application, access_log=None, shutdown_timeout=_ENDS_WITHIN)
        await runner.setup()
        try:
            await web.SockSite(runner, self._socket).start()
            ready()
            await asyncio.Event().wait()
        finally:
            await runner.cleanup()
