"""The server of the studio: the page, and what it asks for."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

from aiohttp import web

from skybake.errors import InputError, SkybakeError
from skybake.studio.bakes import Bakes
from skybake.studio.day import day_of
from skybake.studio.display import display_message
from skybake.studio.exports import exported
from skybake.studio.guard import LARGEST_BODY, Guard
from skybake.studio.live import Live
from skybake.studio.presets import preset_list, preset_picture
from skybake.studio.reader import OptionError, Reader
from skybake.studio.scenes import Scenes
from skybake.studio.state import state_from_json
from skybake.studio.world import world_of

PAGE = Path(__file__).parent / "page"
_TYPES = {
    ".html": "text/html",
    ".js": "text/javascript",
    ".css": "text/css",
    ".svg": "image/svg+xml",
}
_THREADS = 8
_BINARY = "application/octet-stream"


class Studio:
    """Answers the requests of all pages.

    Parameters
    ----------
    reader : Reader
        Reads knobs.
    folder : Path
        Where maps are baked.
    preset : str
        With which the page opens.
    """

    def __init__(self, reader: Reader, folder: Path, preset: str) -> None:
        self._reader, self._preset = reader, preset
        self._scenes = Scenes()
        self._bakes = Bakes(reader, self._scenes, folder)
        self._threads = ThreadPoolExecutor(_THREADS, thread_name_prefix="studio")
        self._pages: set[Live] = set()

    def application(self, guard: Guard, *, in_frame: bool = False) -> web.Application:
        """Return the application, whose every request the guard checks."""
        headers = guard.headers(in_frame=in_frame)

        @web.middleware
        async def guarded(
            request: web.Request,
            handler: Callable[[web.Request], Awaitable[web.StreamResponse]],
        ) -> web.StreamResponse:
            try:
                guard.check(request)
                return await handler(request)
            except web.HTTPException as error:
                error.headers.update(headers)
                raise
            except SkybakeError as error:
                option = error.option if isinstance(error, OptionError) else None
                answer = {"error": str(error), "option": option}
                return web.json_response(answer, status=400, headers=headers)
            except Exception as error:  # noqa: BLE001 - the page is told, the server goes on
                answer = {"error": f"studio: failed unexpectedly ({error!r})"}
                return web.json_response(answer, status=500, headers=headers)

        async def add_headers(_: web.Request, response: web.StreamResponse) -> None:
            response.headers.update(headers)

        application = web.Application(middlewares=[guarded], client_max_size=LARGEST_BODY)
        application.on_response_prepare.append(add_headers)
        application.on_shutdown.append(self._close)
        application.add_routes(self._routes())
        return application

    def _routes(self) -> list[web.RouteDef]:
        return [
            web.get("/", self._index),
            web.get("/page/{name}", self._static),
            web.get("/api/options", self._options),
            web.get("/api/world", self._world),
            web.get("/api/day", self._day),
            web.get("/api/parse", self._parse),
            web.get("/api/display", self._display),
            web.get("/api/preset-picture/{name}", self._preset_picture),
            web.get("/api/live", self._live),
            web.post("/api/command", self._command),
            web.post("/api/bake", self._bake),
        ]

    async def _index(self, _: web.Request) -> web.StreamResponse:
        return _file("index.html")

    async def _static(self, request: web.Request) -> web.StreamResponse:
        return _file(request.match_info["name"])

    async def _options(self, _: web.Request) -> web.StreamResponse:
        described = await self._in_thread(self._reader.described)
        presets = await self._in_thread(preset_list)
        return web.json_response({**described, "presets": presets, "preset": self._preset})

    async def _world(self, request: web.Request) -> web.StreamResponse:
        preset = request.query.get("preset", self._preset)
        self._reader.check_preset(preset)
        return web.json_response(await self._in_thread(world_of, preset))

    async def _day(self, request: web.Request) -> web.StreamResponse:
        asked = await self._in_thread(self._reader.day, dict(request.query))
        return web.json_response(await self._in_thread(day_of, asked))

    async def _parse(self, request: web.Request) -> web.StreamResponse:
        option, text = request.query.get("option", ""), request.query.get("text", "")
        try:
            return web.json_response(await self._in_thread(self._reader.read_one, option, text))
        except SkybakeError as error:
            return web.json_response({"error": str(error), "option": option})

    async def _display(self, request: web.Request) -> web.StreamResponse:
        view = request.query.get("view", "aces1")
        body = await self._in_thread(display_message, view)
        return web.Response(body=body, content_type=_BINARY)

    async def _preset_picture(self, request: web.Request) -> web.StreamResponse:
        name = request.match_info["name"]
        picture = preset_picture(name)
        if picture is None:
            raise web.HTTPNotFound
        return web.Response(body=picture, content_type="image/jpeg")

    async def _live(self, request: web.Request) -> web.StreamResponse:
        live = Live(self._reader, self._scenes, self._bakes, self._threads)
        self._pages.add(live)
        try:
            return await live.serve(request)
        finally:
            self._pages.discard(live)

    async def _command(self, request: web.Request) -> web.StreamResponse:
        data = await _json(request)
        state = state_from_json(data.get("state", {}))
        made = await self._in_thread(exported, self._reader, state, _output(data))
        return web.json_response(made)

    async def _bake(self, request: web.Request) -> web.StreamResponse:
        data = await _json(request)
        state = state_from_json(data.get("state", {}))
        work = partial(self._bakes.start, state, _output(data), self._tell_all)
        return web.json_response({"bake": await self._in_thread(work)})

    def _tell_all(self, message: dict[str, Any]) -> None:
        for live in tuple(self._pages):
            live.tell(message)

    async def _in_thread(self, work: Callable[..., Any], *arguments: Any) -> Any:
        # Not in the threads of pictures, which may all be at work.
        return await asyncio.to_thread(work, *arguments)

    async def _close(self, _: web.Application) -> None:
        for live in tuple(self._pages):
            await live.close()
        self._threads.shutdown(wait=False, cancel_futures=True)
        await asyncio.to_thread(self._bakes.close)


def _file(name: str) -> web.Response:
    """Return a part of the page; there are no others than the files of its folder."""
    files = {path.name: path for path in PAGE.glob("*.*") if path.suffix in _TYPES}
    if name not in files:
        raise web.HTTPNotFound
    path = files[name]
    body = path.read_bytes()
    return web.Response(body=body, content_type=_TYPES[path.suffix], charset="utf-8")


async def _json(request: web.Request) -> Mapping[str, Any]:
    try:
        data = json.loads(await request.text())
    except (ValueError, RecursionError) as error:
        raise InputError("body: must be JSON") from error
    if not isinstance(data, dict):
        raise InputError("body: must be an object")
    return data


def _output(data: Mapping[str, Any]) -> str | None:
    output = data.get("output")
    if output is not None and (not isinstance(output, str) or "\0" in output):
        raise InputError(f"output: must be the name of a file, got {output!r}")
    return output or None
