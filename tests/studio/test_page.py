"""The studio's page in Chromium: what is turned is seen, and what is copied is what was seen."""

import shlex
import signal

import numpy as np
import pytest

from skybake.colour.exposure import luminance_from_units
from tests.cli.runs import invoke
from tests.peers.files import read_pixels
from tests.studio.browser import Tab, needs_browser
from tests.studio.servers import HOLDING, serving

pytestmark = needs_browser

SMALL = "size=512x256"


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


def test_cancel_keeps_the_last_picture_and_the_page_goes_on(browser, tmp_path):
    with serving(tmp_path, code=HOLDING) as server:
        tab = Tab(browser, server.url, fragment=SMALL)
        tab.settle()
        tab.type("visibility", "17.3km")
        tab.page.wait_for_function("() => studio.live.frames.now.command.includes('17.3km')")
        tab.page.wait_for_function("() => document.getElementById('progress-share').value === 0.25")
        before = tab.texels()
        tab.page.click("#cancel")
        tab.page.wait_for_selector("#frame[data-state=cancelled]")
        np.testing.assert_array_equal(tab.texels(), before)
        tab.turn("visibility", "")
        tab.turn("sun", "31deg")
        assert not np.array_equal(tab.texels(), before)
        tab.close()
    assert tab.complaints == []


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
    kept = tab.drawn()
    tab.page.click("#keep-a")
    tab.turn("sun", "-5deg")
    now = tab.drawn()
    tab.page.click("#wipe")
    left, right = np.array_split(tab.drawn(), 2, axis=1)
    middle = left.shape[1]
    np.testing.assert_array_equal(left, kept[:, :middle])
    np.testing.assert_array_equal(right, now[:, middle:])
    assert not np.array_equal(left, now[:, :middle])
    assert not np.array_equal(right, kept[:, middle:])


def test_a_map_is_baked_into_the_folder(tab, server):
    tab.page.click("#bake")
    tab.page.fill("#bake-name", "evening.exr")
    tab.page.click("#bake-form button[type=submit]")
    tab.page.get_by_text("evening.exr in").first.wait_for()
    tab.page.click("#bake-dialog header button")
    tab.page.wait_for_selector("#bake-dialog", state="hidden")


def test_a_knob_that_the_view_does_not_show_says_so(tab):
    before = tab.texels()
    note = tab.page.locator("#groups [data-knob=polarizer] .note")
    assert note.is_hidden()
    tab.turn("polarizer", "30deg")
    note.wait_for()
    assert note.text_content() == "Shown in what is baked, not in this view."
    np.testing.assert_array_equal(tab.texels(), before)


def test_numbers_are_signed_but_for_zero(tab):
    signed = """async () => {
      const { signed } = await import("/page/figures.js");
      return [-0.3, 0.3, 0, -0.7, 0.7].map(value => signed(value, 0));
    }"""
    assert tab.page.evaluate(signed) == ["0", "0", "0", "-1", "+1"]


def test_every_control_has_a_name(tab):
    nameless = """() => [...document.querySelectorAll("button, input, select, [role=slider]")]
      .filter(element => !(element.getAttribute("aria-label") || element.textContent.trim()
        || element.labels?.length))
      .map(element => element.outerHTML)"""
    assert tab.page.evaluate(nameless) == []


@pytest.mark.parametrize("size", [(1280, 720), (1024, 768), (820, 1180)])
def test_nothing_is_cut_off_on_screens_and_tablets(tab, size):
    width, height = size
    tab.page.set_viewport_size({"width": width, "height": height})
    tab.page.wait_for_function(
        "size => innerWidth === size[0] && innerHeight === size[1]", arg=size
    )
    outside = """() => [...document.querySelectorAll("header *, footer *, .toolbar *, #groups *")]
      .filter(element => element.getClientRects().length && !element.closest(".unseen"))
      .filter(element => element.getBoundingClientRect().right > innerWidth + 0.5)
      .map(element => element.outerHTML)"""
    assert tab.page.evaluate(outside) == []
    sky = tab.page.locator("#sky").bounding_box()
    assert sky["height"] > 0.35 * height


def turn_at_random(tab, rng, sequences):
    """Turn five knobs in each frame of the screen, faster than a hand."""
    for _ in range(sequences):
        places = rng.random((5, 2)).tolist()
        tab.page.evaluate(
            """async places => {
              await new Promise(requestAnimationFrame);
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
    tab.page.click("#reset")
    tab.settle()


def test_knobs_at_random_leave_no_error(tab):
    turn_at_random(tab, np.random.default_rng(19), 20)


@pytest.mark.slow
def test_many_knobs_at_random_leave_no_error(tab):
    turn_at_random(tab, np.random.default_rng(20), 200)
