"""Times the pictures of the studio: from a knob's move to its coarse and to its full picture.

Usage: ``python -m benchmarks.studio [--moves 30] [--size 1024] [--json FILE]``. A server in a
process of its own is asked by a client as a page asks; each move waits for the full picture of the
one before, and none needs a new solution. Wall time counts here, since someone waits.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import aiohttp

from benchmarks.processes import machine

COMMAND = [sys.executable, "-m", "skybake", "studio", "--no-browser"]
WORLDS = {"earth": {}, "mars": {"preset": "mars"}}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--moves", type=int, default=30)
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    with served() as url:
        measured = asyncio.run(measure(url, arguments.moves, arguments.size))
    for name, seconds in measured.items():
        middle, late = statistics.median(seconds), percentile(seconds, 95.0)
        print(f"{name:28} {1e3 * middle:6.0f} ms median {1e3 * late:6.0f} ms p95")
    if arguments.json is not None:
        figures = {
            name: {"median": statistics.median(seconds), "p95": percentile(seconds, 95.0)}
            for name, seconds in measured.items()
        }
        result = {"machine": machine(), "load": os.getloadavg()[0], "seconds": figures}
        arguments.json.write_text(json.dumps(result, indent=1) + "\n")


@contextmanager
def served() -> Iterator[str]:
    """Run a server in an empty folder; yields the address of its socket."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")]
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, paths))}
        process = subprocess.Popen(
            COMMAND, cwd=folder, env=environment, stdout=subprocess.PIPE, text=True
        )
        try:
            yield process.stdout.readline().strip().replace("/?", "/api/live?")
        finally:
            process.terminate()
            process.wait()


def moves(world: str, count: int) -> Iterator[tuple[str, dict[str, str]]]:
    """Yield kinds of moves, and the options after each."""
    for i in range(count):
        share = i / max(count - 1, 1)
        yield f"{world}: sun by day", {"sun": f"{60.0 - 55.0 * share:.2f}deg"}
    for i in range(count):
        share = i / max(count - 1, 1)
        yield f"{world}: sun in twilight", {"sun": f"{2.0 - 14.0 * share:.2f}deg"}
    for i in range(count):
        share = i / max(count - 1, 1)
        yield f"{world}: altitude", {"sun": "20deg", "altitude": f"{10.0 ** (4.0 * share):.0f}m"}
    for i in range(count):
        yield f"{world}: azimuth and disc", {"sun": "20deg", "sun-azimuth": f"{3 * i}deg"}
    for i in range(count):
        yield f"{world}: exposure", {"sun": "20deg", "preview-ev": f"{8.0 + 0.1 * i:.1f}"}


async def measure(url: str, count: int, width: int) -> dict[str, list[float]]:
    """Return times to coarse and to full pictures by kinds of moves. [s]"""
    found: dict[str, list[float]] = {}
    async with (
        aiohttp.ClientSession() as session,
        session.ws_connect(url, max_msg_size=0) as socket,
    ):
        number = 0
        for world, options in WORLDS.items():
            await ask(socket, number := number + 1, options, width)  # solves
            for kind, changed in moves(world, count):
                coarse, full = await ask(socket, number := number + 1, options | changed, width)
                found.setdefault(f"{kind}, coarse", []).append(coarse)
                found.setdefault(f"{kind}, full", []).append(full)
    return found


async def ask(
    socket: aiohttp.ClientWebSocketResponse, number: int, options: dict[str, str], width: int
) -> tuple[float, float]:
    """Return the times until the first picture and the last one are there. [s]"""
    view = {"kind": "equirect", "size": [width, width // 2]}
    started = time.perf_counter()
    await socket.send_json({"id": number, "state": {"options": options}, "view": view})
    times = []
    while True:
        message = await socket.receive()
        if message.type is aiohttp.WSMsgType.TEXT:
            answer = json.loads(message.data)
            if "error" in answer:
                raise SystemExit(answer["error"])
            continue
        times.append(time.perf_counter() - started)
        length = int.from_bytes(message.data[:4], "little")
        if json.loads(message.data[4 : 4 + length])["final"]:
            return times[0], times[-1]


def percentile(values: list[float], share: float) -> float:
    """Return the value below which a share of all lies. [%]"""
    return sorted(values)[min(int(len(values) * share / 100.0), len(values) - 1)]


if __name__ == "__main__":
    main()
