"""The studio's page in Chromium: what is turned is seen, and what is copied is what was seen."""

import shlex
import signal

import numpy as np
import pytest

from skybake.colour.exposure import luminance_from_units
from tests.cli.runs import invoke
from tests.peers.files import read_pixels
from tests.studio.browser import Tab, chromium, needs_browser
from tests.studio.servers import serving

pytestmark = needs_browser

SMALL = "size=512x256"


@pytest.fixture(scope="module")
def browser():
    with chromium() as one:
        yield one


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with serving(tmp_path_factory.mktemp("studio")) as one:
        yield one


@pytest.fixture
def tab(browser, server):
    opened = Tab(browser, server.url, fragment=SMALL)
    opened.page.select_option("#detail", "512")
    opened.settle()
    yield opened
    opened.close()
    assert opened.complaints == []


def test_a_knob_changes_the_picture_and_undo_brings_it_back(tab):
    before = tab.texels()
    tab.turn("sun", "5deg")
    assert tab.page.text_content("#figures").count("5.0°") == 1
    assert not np.array_equal(tab.texels(), before)
    tab.page.click("#undo")
    tab.settle()
    np.testing.assert_array_equal(tab.texels(), before)


def test_the_copied_command_bakes_the_pixels_of_the_view(tab, tmp_path):
    tab.turn("sun", "4deg")
    tab.turn("altitude", "1500m")
    command = shlex.split(tab.command())
    assert command[:2] == ["skybake", "render"]
    result = invoke(*command[1:], "--pixel", "float", "-o", tmp_path / "sky.exr")
    assert result.exit_code == 0, result.stderr
    # Scales differ by a power of two, which moves no digit of a float.
    baked = read_pixels(tmp_path / "sky.exr") * (luminance_from_units("ev15") / tab.scale())
    np.testing.assert_array_equal(baked.astype("<f2"), tab.texels())


def test_the_link_restores_the_state_and_the_view(tab, browser):
    tab.turn("sun", "-3deg")
    tab.page.click("#view-kinds [data-value=fisheye]")
    tab.settle()
    tab.page.wait_for_url("**view.kind=fisheye**")
    address, _, fragment = tab.page.url.partition("#")
    other = Tab(browser, address, fragment=fragment)
    other.page.wait_for_selector("#view-kinds [data-value=fisheye][aria-checked=true]")
    other.settle()
    assert other.page.input_value("#groups [data-knob=sun] .value") == "-3deg"
    assert other.page.evaluate("studio.store.state") == tab.page.evaluate("studio.store.state")
    other.close()
    assert other.complaints == []


def test_cancel_keeps_the_last_picture_and_the_page_goes_on(tab):
    before = tab.texels()
    tab.type("visibility", "17.3km")
    tab.page.click("#cancel")
    tab.page.wait_for_selector("#frame[data-state=cancelled]")
    np.testing.assert_array_equal(tab.texels(), before)
    tab.turn("visibility", "")
    tab.turn("sun", "31deg")
    assert not np.array_equal(tab.texels(), before)


@pytest.mark.parametrize(("knob", "text"), [("sun", "95deg"), ("altitude", "high"), ("size", "7")])
def test_a_bad_value_shows_the_message_of_the_command_line(tab, knob, text):
    before = tab.texels()
    tab.type(knob, text)
    fault = tab.fault(knob)
    assert text in fault
    assert fault in invoke("render", f"--{knob}={text}").stderr
    np.testing.assert_array_equal(tab.texels(), before)


def test_two_tabs_show_their_own_skies(tab, browser, server):
    other = Tab(browser, server.url, fragment="sun=60deg")
    tab.turn("sun", "10deg")
    other.settle()
    assert "60.0°" in other.page.text_content("#figures")
    assert "10.0°" in tab.page.text_content("#figures")
    other.close()
    assert other.complaints == []


def test_the_page_says_that_the_server_was_killed_and_finds_it_again(browser, tmp_path):
    with serving(tmp_path) as first:
        tab = Tab(browser, first.url)
        tab.settle()
        first.end(signal.SIGKILL)
        tab.page.wait_for_selector("#connection.lost")
        assert "does not answer" in tab.page.text_content("#connection")
        before = tab.texels()
        with serving(tmp_path, port=first.port):
            tab.page.wait_for_selector("#connection:not(.lost)", state="attached")
            tab.turn("sun", "12deg")
            assert not np.array_equal(tab.texels(), before)
        tab.close()
    # What the browser itself says of connections that are refused is no fault of the page.
    assert [text for text in tab.complaints if "ERR_CONNECTION" not in text] == []


def test_a_kept_sky_is_compared_with_that_of_now(tab):
    tab.page.click("#keep-a")
    tab.turn("sun", "-5deg")
    tab.page.click("#wipe")
    tab.page.wait_for_selector("#wipe-handle:not([hidden])")
    tab.page.wait_for_timeout(200)
    left, right = (
        tab.page.evaluate(
            """share => {
              const gl = document.getElementById("sky").getContext("webgl2");
              const [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
              const pixel = new Uint8Array(4);
              gl.readPixels(share * w, 0.97 * h, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
              return Array.from(pixel);
            }""",
            share,
        )
        for share in (0.45, 0.55)
    )
    assert max(abs(one - other) for one, other in zip(left, right, strict=True)) > 10


def test_a_map_is_baked_into_the_folder(tab, server):
    tab.page.click("#bake")
    tab.page.fill("#bake-name", "evening.exr")
    tab.page.click("#bake-form button[type=submit]")
    tab.page.get_by_text("evening.exr in").first.wait_for()
    tab.page.click("#bake-dialog header button")
    assert tab.page.locator("#bake-dialog[open]").count() == 0


def turn_at_random(tab, rng, sequences):
    """Turn five knobs each time, as fast as a hand."""
    for _ in range(sequences):
        places = rng.random((5, 2)).tolist()
        tab.page.evaluate(
            """places => {
              const sliders = [...document.querySelectorAll("#groups .slider input")];
              const choices = [...document.querySelectorAll("#groups select.value")];
              for (const [which, place] of places) {
                const knobs = which < 0.8 ? sliders : choices;
                const knob = knobs[Math.floor(which * 1e4) % knobs.length];
                if (knob.type === "range") knob.value = place;
                else knob.selectedIndex = Math.floor(place * knob.options.length);
                const type = knob.type === "range" ? "input" : "change";
                knob.dispatchEvent(new Event(type, { bubbles: true }));
              }
            }""",
            places,
        )
        tab.page.wait_for_timeout(20)
    tab.page.click("#reset")
    tab.settle()


def test_knobs_at_random_leave_no_error(tab):
    turn_at_random(tab, np.random.default_rng(19), 20)


@pytest.mark.slow
def test_many_knobs_at_random_leave_no_error(tab):
    turn_at_random(tab, np.random.default_rng(20), 200)
