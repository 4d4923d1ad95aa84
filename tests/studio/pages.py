"""Pages of the studio, without a browser."""

import asyncio
import json
from contextlib import asynccontextmanager

import aiohttp

from tests.studio.servers import read_frame

LONGEST = 600.0
"""Seconds, since the first picture may compile kernels."""

SMALL = {"kind": "equirect", "size": [64, 32]}
LARGE = {"kind": "equirect", "size": [512, 256]}


class Page:
    """The socket of one page."""

    def __init__(self, socket):
        self.socket = socket
        self.number = 0

    async def ask(self, options=(), changes=(), *, view=SMALL, tag="A"):
        """Ask for a view; returns its number."""
        self.number += 1
        state = {"options": dict(options), "set": dict(changes)}
        await self.socket.send_json({"id": self.number, "tag": tag, "state": state, "view": view})
        return self.number

    async def next(self):
        """Return the next message: JSON, or header and pixels of a picture."""
        message = await asyncio.wait_for(self.socket.receive(), LONGEST)
        if message.type is aiohttp.WSMsgType.TEXT:
            return json.loads(message.data), None
        assert message.type is aiohttp.WSMsgType.BINARY, message
        return read_frame(message.data)

    async def end(self, number):
        """Return all messages up to the last one about a request."""
        seen = []
        while True:
            answer, pixels = await self.next()
            if answer.get("id") == number:
                seen.append((answer, pixels))
                if answer.get("final") or "error" in answer or "cancelled" in answer:
                    return seen


@asynccontextmanager
async def page_of(server):
    async with (
        aiohttp.ClientSession() as session,
        session.ws_connect(
            f"http://127.0.0.1:{server.port}/api/live?token={server.token}", max_msg_size=0
        ) as socket,
    ):
        yield Page(socket)


def talk(server, conversation, pages=1):
    """Run a conversation with the sockets of some pages, and return what it returns."""

    async def run():
        if pages == 1:
            async with page_of(server) as page:
                return await conversation(page)
        async with page_of(server) as first, page_of(server) as second:
            return await conversation(first, second)

    return asyncio.run(run())


def view_of(server, options=(), changes=(), **keywords):
    """Return header and pixels of the full picture."""

    async def conversation(page):
        return (await page.end(await page.ask(options, changes, **keywords)))[-1]

    return talk(server, conversation)
