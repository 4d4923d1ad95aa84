"""Pictures follow the knobs, each page for itself."""

import asyncio
import math
import shlex
from contextlib import suppress
from pathlib import Path

import aiohttp
import numpy as np
import pytest

import skybake
from tests.cli.runs import invoke
from tests.studio.pages import LARGE, LONGEST, page_of, talk, view_of
from tests.studio.servers import HOLDING, RELEASED, STOPPED, serving, wait_until


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with serving(tmp_path_factory.mktemp("live")) as running:
        yield running


@pytest.fixture(scope="module")
def holding(tmp_path_factory):
    """A server whose solutions last as long as a test needs them to, see `HOLDING`."""
    folder = tmp_path_factory.mktemp("holding")
    with serving(folder, code=HOLDING) as running:
        running.released, running.stopped = folder / RELEASED, folder / STOPPED
        yield running


def test_a_coarse_picture_comes_before_the_full_one(server):
    async def conversation(page):
        return await page.end(await page.ask({"sun": "20deg"}, view=LARGE))

    pictures = [(one, pixels) for one, pixels in talk(server, conversation) if pixels is not None]
    assert [one["width"] for one, _ in pictures] == [256, 512]
    assert [one["final"] for one, _ in pictures] == [False, True]
    coarse, full = (one["scale"] * pixels[: len(pixels) // 2] for one, pixels in pictures)
    assert coarse[..., 1].mean() == pytest.approx(full[..., 1].mean(), rel=0.2)


@pytest.mark.parametrize(
    ("options", "changes"),
    [
        ({"sun": "7deg", "sun-azimuth": "120deg"}, {}),
        ({"sun": "-4deg", "altitude": "2km", "below-horizon": "black"}, {}),
        (
            {"preset": "earth-hazy", "method": "hillaire", "sun-disc": "exclude"},
            {"ozone.column_du": "200"},
        ),
    ],
)
def test_the_command_bakes_a_map_whose_pixels_equal_the_view(
    server, tmp_path, monkeypatch, options, changes
):
    monkeypatch.chdir(tmp_path)
    typed = options | {"size": "64x32", "pixel": "float"}
    header, pixels = view_of(server, typed, changes)
    result = invoke(*shlex.split(header["command"])[1:], "-o", "sky.exr")
    assert result.exit_code == 0, result.output
    baked = skybake.load_environment("sky.exr")
    expected = np.asarray(baked.pixels[0]) * baked.white_luminance / header["scale"]
    # Half a unit in the last place of half floats, of which the least is 2^-24.
    np.testing.assert_allclose(pixels, expected, rtol=2.0**-11, atol=2.0**-25)


def test_the_python_snippet_bakes_the_same_file(server, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    options = {"preset": "mars-clear", "size": "32x16", "method": "hillaire"}
    options |= {"time": "16:30", "site": "gale", "ls": "90", "white-balance": "5000K"}
    state = {"options": options, "set": {"dust.optical_depth": "0.1"}}
    made = server.json("/api/command", {"state": state, "output": "a.exr"})
    assert invoke(*shlex.split(made["command"])[1:]).exit_code == 0
    written = [Path(name).read_bytes() for name in ("a.exr", "a.png")]
    for name in ("a.exr", "a.png"):
        Path(name).unlink()
    exec(made["python"], {})  # noqa: S102
    assert [Path(name).read_bytes() for name in ("a.exr", "a.png")] == written


def test_the_preset_of_changes_makes_the_same_world(server, tmp_path):
    state = {
        "options": {"preset": "earth", "visibility": "9km", "clouds": ["cirrus:0.3"]},
        "set": {"aerosol.profile.scale_height_km": "1.5", "ozone": "none"},
    }
    text = server.json("/api/command", {"state": state})["toml"]
    own = tmp_path / "own.toml"
    own.write_text(text)
    changes = skybake.PresetChanges(
        values=(("aerosol.profile.scale_height_km", 1.5), ("ozone", "none")),
        visibility=9.0,
        clouds=({"kind": "cirrus", "cover": 0.3},),
    )
    loaded, expected = skybake.load_preset(own).recipe, changes.load("earth").recipe
    assert loaded == {key: value for key, value in expected.items() if key != "set"}
    assert text.startswith('extends = "earth"\n')


def test_figures_are_those_of_the_map(server):
    header, _ = view_of(server, {"sun": "20deg"})
    sky = skybake.Sky("earth", sun_elevation=math.radians(20.0))
    light = sky.image(width=64).light
    figures = header["figures"]
    assert figures["sun_illuminance_lx"] == pytest.approx(light.direct_normal_illuminance, rel=1e-6)
    assert figures["sky_illuminance_lx"] == pytest.approx(light.sky_illuminance, rel=1e-6)
    assert figures["sun_elevation_deg"] == pytest.approx(20.0)
    assert figures["visibility_km"] == pytest.approx(63.4, abs=0.1)
    assert 0.2 < figures["optical_depth_550"] < 0.25
    assert figures["white_balance"] == [1, 0, 0, 0, 1, 0, 0, 0, 1]


def test_a_night_keeps_its_light_in_half_floats(server):
    header, pixels = view_of(server, {"sun": "-16deg"})
    luminance = header["scale"] * pixels[:12].mean()
    assert 1e-5 < luminance < 1e-1
    assert pixels.max() > 1000.0


def test_the_planet_is_seen_from_afar(server):
    header, pixels = view_of(server, {"sun": "60deg"}, view={"kind": "planet", "size": [48, 48]})
    assert header["kind"] == "planet"
    assert pixels.shape == (48, 48, 3)
    assert pixels[24, 24].min() > 0.0
    assert not pixels[0, 0].any()


@pytest.mark.parametrize(
    ("options", "changes", "message", "option"),
    [
        (
            {"sun": "95deg"},
            {},
            "Invalid value for '--sun': must be from -90deg to 90deg, got 95deg",
            "sun",
        ),
        ({"lon": "3"}, {}, "--lon: needs --time", "lon"),
        ({"shine": "3"}, {}, "No such option: --shine", "shine"),
    ],
)
def test_a_bad_value_is_answered_like_the_command_line(server, options, changes, message, option):
    answer, _ = view_of(server, options, changes)
    assert (answer["error"], answer["option"]) == (message, option)


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[]",
        '"x"',
        '{"id": "one"}',
        '{"id": 1, "view": {"size": [8, 4]}}',
        '{"id": 1, "view": {"size": [1e9, 5]}}',
        '{"id": 1, "view": {"size": [100000, 50000]}}',
        '{"id": 1, "view": {"kind": "hologram"}}',
        '{"id": 1, "state": []}',
        "[" * 5000,
    ],
)
def test_nonsense_is_answered_in_one_line_and_the_socket_stays_open(server, text):
    async def conversation(page):
        await page.socket.send_str(text)
        answer, _ = await page.next()
        return answer, (await page.end(await page.ask()))[-1][0]

    answer, after = talk(server, conversation)
    assert "must be" in answer["error"]
    assert "\n" not in answer["error"]
    assert after.get("final"), after


def test_a_message_of_ten_megabytes_closes_its_socket_alone(server):
    async def conversation(page, other):
        with suppress(ConnectionError):  # hung up before all of it had come
            await page.socket.send_str("x" * 10_000_000)
        message = await asyncio.wait_for(page.socket.receive(), LONGEST)
        return message.type, (await other.end(await other.ask()))[-1][0]

    kind, after = talk(server, conversation, pages=2)
    assert kind in {aiohttp.WSMsgType.CLOSE, aiohttp.WSMsgType.CLOSED, aiohttp.WSMsgType.ERROR}
    assert after.get("final"), after


def test_a_newer_request_takes_the_place_of_those_that_wait(holding):
    air = {"visibility": "25km", "method": "hillaire"}

    async def conversation(page):
        await page.ask(air)
        assert (await page.next())[0]["stage"] == "solving atmosphere"
        assert (await page.next())[0]["progress"] == 0.25
        waiting = [await page.ask(air | {"sun": f"{20 + n}deg"}) for n in range(10)]
        newest = await page.ask(air | {"sun": "40deg"})
        overtaken = [(await page.next())[0] for _ in waiting]
        holding.released.touch()
        return overtaken == [{"id": one, "cancelled": True} for one in waiting], (
            await page.end(newest)
        )[-1][0]

    try:
        are_overtaken, end = talk(holding, conversation)
    finally:
        holding.released.unlink(missing_ok=True)
    assert are_overtaken
    assert end["figures"]["sun_elevation_deg"] == pytest.approx(40.0)


def test_requests_of_other_tags_are_not_disturbed(server):
    async def conversation(page):
        one = await page.ask({"sun": "31deg"}, tag="A")
        other = await page.ask({"sun": "32deg"}, tag="B")
        finals = {}
        while len(finals) < 2:
            answer, _ = await page.next()
            if "figures" in answer:
                finals[answer["id"]] = answer["figures"]["sun_elevation_deg"]
        return finals[one], finals[other]

    assert talk(server, conversation) == pytest.approx((31.0, 32.0))


def test_two_pages_are_independent(server):
    async def conversation(first, second):
        numbers = await first.ask({"sun": "33deg"}), await second.ask({"sun": "34deg"})
        ends = await asyncio.gather(first.end(numbers[0]), second.end(numbers[1]))
        return [end[-1][0]["figures"]["sun_elevation_deg"] for end in ends]

    assert talk(server, conversation, pages=2) == pytest.approx([33.0, 34.0])


def test_a_solution_says_so_and_gives_way_to_another_air(holding):
    """The server answers other requests meanwhile."""

    async def conversation(page):
        slow = await page.ask({"preset": "titan"})
        begun, _ = await page.next()
        answer, _ = await page.next()
        async with page_of(holding) as other:
            await other.end(await other.ask({"sun": "95deg"}))
        quick = await page.ask({"sun": "22deg"})
        cancelled = (await page.end(slow))[-1][0]
        return begun, answer, cancelled, (await page.end(quick))[-1][0]

    begun, answer, cancelled, after = talk(holding, conversation)
    assert (begun["stage"], begun["progress"]) == ("solving atmosphere", None)
    assert (answer["stage"], answer["progress"]) == ("solving atmosphere", 0.25)
    assert cancelled.get("cancelled"), "it was not at work any more"
    assert after.get("final"), after


def test_a_page_that_goes_away_stops_its_work(holding):
    holding.stopped.unlink(missing_ok=True)

    async def conversation(page):
        await page.ask({"preset": "titan"})
        assert (await page.next())[0]["stage"] == "solving atmosphere"

    talk(holding, conversation)
    wait_until(holding.stopped.exists)


def test_a_socket_without_the_token_is_refused(server):
    async def run(headers, token):
        async with aiohttp.ClientSession() as session:
            url = f"http://127.0.0.1:{server.port}/api/live?token={token}"
            with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
                await session.ws_connect(url, headers=headers)
            return caught.value.status

    assert asyncio.run(run({}, "wrong")) == 403
    assert asyncio.run(run({"Origin": "https://evil.example"}, server.token)) == 403


def test_a_first_glance_in_dust_looks_like_the_full_picture(server):
    async def conversation(page):
        return await page.end(await page.ask({"sun": "-4.5deg"}, view=LARGE))

    (first, coarse), (_, full) = talk(server, conversation)
    assert not first["final"]
    there = np.repeat(np.repeat(coarse[:60], 2, axis=0), 2, axis=1)
    difference = np.abs(there - full[:120])[..., 1]
    assert np.percentile(difference / full[:120, :, 1].mean(), 95.0) < 0.05


def test_a_page_that_goes_away_after_its_picture_leaves_it_to_others(server):
    """Its socket closes while the server still holds the finished request."""
    for _ in range(3):
        header, _ = view_of(server, {"sun": "24deg"})
        assert header.get("final"), header


def test_a_picture_is_stopped_when_asked(holding):
    async def conversation(page):
        slow = await page.ask({"preset": "titan"})
        answer, _ = await page.next()
        await page.socket.send_json({"stop": "A"})
        return answer, (await page.end(slow))[-1][0]

    answer, end = talk(holding, conversation)
    assert answer["stage"] == "solving atmosphere"
    assert end["cancelled"]


def test_every_knob_of_a_night_makes_another_picture(server):
    options = {"sun": "-30deg", "moon-elevation": "40deg"}
    (full, bright), (crescent, dark) = (
        view_of(server, {**options, "moon-phase": phase}) for phase in ("full", "crescent")
    )
    assert full["figures"]["moonlight"]["illuminance_lx"] > 0.1
    assert full["figures"]["moonlight"]["illuminated_fraction"] > 0.99
    assert full["scale"] * bright.mean() > 3.0 * crescent["scale"] * dark.mean()


def test_what_only_shows_a_finished_picture_otherwise_computes_nothing(server):
    async def conversation(page):
        first = await page.end(await page.ask({"sun": "27deg"}, view=LARGE))
        again = await page.end(await page.ask({"sun": "27deg", "preview-ev": "9"}, view=LARGE))
        return first[-1], again

    (before, pixels), again = talk(server, conversation)
    ((after, same),) = again  # the full picture at once
    np.testing.assert_array_equal(same, pixels)
    scales = [one["figures"]["exposure_scale"] for one in (before, after)]
    assert scales[1] / scales[0] == pytest.approx(2.0 ** (before["figures"]["ev_auto"] - 9.0))
