"""The socket of a page: requests come in, pictures and progress go out."""

from __future__ import annotations

import asyncio
import json
from concurrent.futures import Executor
from functools import partial
from typing import Any

from aiohttp import WSCloseCode, WSMsgType, web

from skybake.errors import InputError, SkybakeError
from skybake.studio.bakes import Bakes
from skybake.studio.guard import LARGEST_BODY
from skybake.studio.reader import Reader
from skybake.studio.scenes import Scenes
from skybake.studio.views import ViewRequest, answer, view_request

MOST_TAGS = 8
"""Pictures that one page shows beside each other."""

Answer = dict[str, Any] | bytes


class Live:
    """One page's socket.

    Parameters
    ----------
    reader : Reader
        Reads knobs.
    scenes : Scenes
        Which all pages share.
    bakes : Bakes
        Which the page may cancel.
    executor : concurrent.futures.Executor
        Threads that make pictures.
    """

    def __init__(self, reader: Reader, scenes: Scenes, bakes: Bakes, executor: Executor) -> None:
        self._reader, self._scenes, self._bakes = reader, scenes, bakes
        self._executor = executor
        self._answers: asyncio.Queue[Answer] = asyncio.Queue()
        self._running: dict[str, ViewRequest] = {}
        self._waiting: dict[str, ViewRequest] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._loop = asyncio.get_running_loop()
        self._socket: web.WebSocketResponse | None = None

    async def serve(self, request: web.Request) -> web.WebSocketResponse:
        """Serve the socket until the page closes it."""
        # Nothing leaves this machine, and to compress takes longer than to send.
        socket = web.WebSocketResponse(max_msg_size=LARGEST_BODY, heartbeat=30.0, compress=False)
        await socket.prepare(request)
        sender = asyncio.create_task(self._send_all(socket))
        self._socket = socket
        try:
            async for message in socket:
                if message.type is WSMsgType.TEXT:
                    self._take(message.data)
        finally:
            self._waiting.clear()
            for view in self._running.values():
                view.cancel.set()
            for task in (sender, *self._tasks):
                task.cancel()
        return socket

    async def close(self) -> None:
        """Close the socket, since the server ends."""
        if self._socket is not None:
            await self._socket.close(code=WSCloseCode.GOING_AWAY)

    def tell(self, message: Answer) -> None:
        """Send a message, from any thread."""
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._answers.put_nowait, message)

    def _take(self, text: str) -> None:
        number = None
        try:
            data = _read(text)
            if "cancel" in data:
                self._bakes.cancel(data["cancel"])
                return
            if "stop" in data:
                self._stop(str(data["stop"]))
                return
            number = data.get("id")
            if type(number) is not int:
                raise InputError(f"id: must be a whole number, got {number!r}")
            self._begin(str(data.get("tag", "")), view_request(data, number))
        except SkybakeError as error:
            self.tell({"id": number, "error": str(error), "option": None})

    def _begin(self, tag: str, view: ViewRequest) -> None:
        running = self._running.get(tag)
        if running is None:
            if len(self._running) >= MOST_TAGS:
                raise InputError(f"tag: must be at most {MOST_TAGS} at once, got {tag!r}")
            self._running[tag] = view
            task = asyncio.create_task(self._run(tag))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)
            return
        overtaken = self._waiting.get(tag)
        if overtaken is not None:
            self.tell({"id": overtaken.number, "cancelled": True})
        self._waiting[tag] = view
        is_same = self._reader.is_same_world(running.state, view.state)
        running.supersede(has_same_world=is_same)

    def _stop(self, tag: str) -> None:
        """Stop the work on a tag's picture, and forget the request that waits for it."""
        waiting = self._waiting.pop(tag, None)
        if waiting is not None:
            self.tell({"id": waiting.number, "cancelled": True})
        if tag in self._running:
            self._running[tag].cancel.set()

    async def _run(self, tag: str) -> None:
        """Answer the requests of a tag, as long as there are any."""
        while True:
            view = self._running[tag]
            work = partial(answer, view, self._reader, self._scenes, self.tell)
            await self._loop.run_in_executor(self._executor, work)
            # A page that takes pictures slower than they are made gets the newest alone.
            await self._answers.join()
            if tag not in self._waiting:
                del self._running[tag]
                return
            self._running[tag] = self._waiting.pop(tag)

    async def _send_all(self, socket: web.WebSocketResponse) -> None:
        while True:
            message = await self._answers.get()
            try:
                if isinstance(message, bytes):
                    await socket.send_bytes(message)
                else:
                    await socket.send_json(message)
            except ConnectionError:
                return
            self._answers.task_done()


def _read(text: str) -> dict[str, Any]:
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"message: must be JSON, got {text[:40]!r}") from error
    if not isinstance(data, dict):
        raise InputError(f"message: must be an object, got {text[:40]!r}")
    return data
