"""The page bakes maps into the working folder and nowhere else."""

import asyncio

import aiohttp
import pytest

from tests.cli.runs import invoke, listing
from tests.studio.servers import serving
from tests.studio.test_live import page_of

SMALL = {"options": {"size": "32x16"}}


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bakes") / "work"
    folder.mkdir()
    with serving(folder) as server:
        server.folder = folder
        yield server


@pytest.fixture
def server(running):
    for path in running.folder.iterdir():
        path.unlink()
    return running


def bake(server, state, output, *, cancel=False):
    """Bake a map; returns the last message."""

    async def run():
        url = f"http://127.0.0.1:{server.port}/api/bake?token={server.token}"
        async with page_of(server) as page, aiohttp.ClientSession() as session:
            answer = await session.post(url, json={"state": state, "output": output})
            started = await answer.json()
            if "error" in started:
                return started
            while True:
                message, _ = await page.next()
                if cancel and message.get("progress"):
                    await page.socket.send_json({"cancel": started["bake"]})
                if {"done", "error", "cancelled"} & message.keys():
                    return message

    return asyncio.run(run())


def test_a_bake_writes_what_the_command_writes(server):
    message = bake(server, SMALL, "sky.exr")
    assert message["done"]
    assert message["files"] == ["sky.exr"]
    assert listing(server.folder) == ["sky.exr"]
    expected = server.folder / "command.exr"
    assert invoke("render", "--size", "32x16", "-o", expected).exit_code == 0
    assert (server.folder / "sky.exr").read_bytes() == expected.read_bytes()


def test_a_look_is_baked_as_a_preview_beside_the_map(server):
    state = {"options": {"size": "32x16", "preview-ev": "12", "view": "aces2"}}
    assert bake(server, state, "look.exr")["files"] == ["look.exr", "look.png"]
    expected = server.folder / "command.exr"
    arguments = ("--size", "32x16", "--preview-ev", "12", "--view", "aces2", "--preview")
    assert invoke("render", *arguments, "-o", expected).exit_code == 0
    made = (server.folder / "look.png").read_bytes()
    assert made == expected.with_suffix(".png").read_bytes()


def test_a_bake_without_a_name_takes_the_usual_one(server):
    message = bake(server, {"options": {"size": "32x16", "sun": "20deg"}}, None)
    assert message["files"] == ["earth_sun20.00deg_equirect.exr"]
    assert listing(server.folder) == message["files"]


def test_a_cancelled_bake_leaves_nothing(server):
    message = bake(server, {"options": {"size": "8192x4096"}}, "large.exr", cancel=True)
    assert message["cancelled"]
    assert listing(server.folder) == []


@pytest.mark.parametrize(
    "output",
    [
        "../sky.exr",
        "/root/sky.exr",
        "a/../../sky.exr",
        "C:\\sky.exr",
        "..\\sky.exr",
        "link/sky.exr",
        "linked.exr",
        "sky.png",
        "missing/sky.exr",
        "sky\0.exr",
        5,
    ],
)
def test_nothing_is_written_out_of_the_folder(server, tmp_path, output):
    outside = tmp_path / "outside"
    outside.mkdir()
    (server.folder / "link").symlink_to(outside)
    (server.folder / "linked.exr").symlink_to(tmp_path / "other.exr")
    message = bake(server, SMALL, output)
    assert message["error"]
    assert "\n" not in message["error"]
    assert listing(tmp_path) == ["outside"]
    assert listing(server.folder.parent) == ["work"]
    assert listing(outside) == []
    assert listing(server.folder) == ["link", "linked.exr"]


def test_a_bad_state_is_refused_before_the_bake_begins(server):
    message = bake(server, {"options": {"sun": "95deg"}}, "sky.exr")
    assert message["error"] == "Invalid value for '--sun': must be from -90deg to 90deg, got 95deg"
    assert listing(server.folder) == []
