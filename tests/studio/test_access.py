"""The page without a mouse: by keyboard, by finger, and as a screen reader finds it."""

import os
from pathlib import Path

import pytest

from tests.studio.browser import Tab, needs_browser

pytestmark = needs_browser

SKY = "size=512x256&sun=20deg"
DIALOGS = {"gallery": "#world", "out": "#more-out", "bake-dialog": "#bake", "keys": "#help"}
INTERACTIVE = {"button", "checkbox", "combobox", "link", "radio", "searchbox", "slider", "textbox"}
VALUED = {"slider", "combobox"}
STATED = {"radio": "checked", "checkbox": "checked"}

OPENED = "document.querySelectorAll('details').forEach(one => { one.open = true; })"
FOCUSED = """() => {
  const one = document.activeElement;
  const { outlineStyle, outlineWidth } = getComputedStyle(one);
  const name = one.id || one.getAttribute("aria-label") || one.textContent.trim();
  const { width, height } = one.getBoundingClientRect();
  return { name, isOutlined: outlineStyle !== "none" && outlineWidth !== "0px",
    isSeen: width > 0 && height > 0 };
}"""
FAULTS = """async () => {
  const { violations } = await axe.run(document, { resultTypes: ["violations"] });
  return violations.flatMap(({ id, nodes }) =>
    nodes.map(({ target, failureSummary }) => [id, target.join(" "), failureSummary].join(": ")));
}"""


@pytest.fixture(scope="module")
def tab(browser, server):
    opened = Tab(browser, server.url, fragment=SKY, reduced_motion="reduce")
    opened.settle()
    opened.page.evaluate(OPENED)
    yield opened
    opened.close()
    assert opened.complaints == []


@pytest.fixture(params=["dark", "light"])
def themed(tab, request):
    if tab.page.get_attribute("html", "data-theme") != request.param:
        tab.page.click("#theme")
    return tab


@pytest.fixture(scope="module")
def axe():
    folders = [one for one in os.environ.get("NODE_PATH", "").split(os.pathsep) if one]
    found = [Path(one) / "axe-core" / "axe.min.js" for one in folders]
    for path in found:
        if path.is_file():
            return path.read_text()
    return pytest.skip("axe-core in a folder of NODE_PATH is not installed")


def nodes_of(tab):
    """Nodes that a screen reader finds, as (role, name, value, properties)."""
    session = tab.context.new_cdp_session(tab.page)
    found = session.send("Accessibility.getFullAXTree")["nodes"]
    session.detach()
    return [
        (
            node["role"]["value"],
            node.get("name", {}).get("value", ""),
            node.get("value", {}).get("value"),
            {one["name"]: one["value"].get("value") for one in node.get("properties", [])},
        )
        for node in found
        if not node.get("ignored")
    ]


def spoken(tab, role):
    """What the live regions of a role hold."""
    return tab.page.locator(f"[role={role}]").all_text_contents()


def test_axe_finds_no_fault_in_the_page(themed, axe):
    themed.page.evaluate(axe)
    assert themed.page.evaluate(FAULTS) == []
    themed.page.click("#stops")
    try:
        assert themed.page.evaluate(FAULTS) == []
    finally:
        themed.page.click("#stops")


@pytest.mark.parametrize("dialog", DIALOGS)
def test_axe_finds_no_fault_in_a_dialog(themed, axe, dialog):
    themed.page.evaluate(axe)
    themed.page.click(DIALOGS[dialog])
    themed.page.wait_for_selector(f"#{dialog} :is(li, pre, input, kbd)")
    try:
        assert themed.page.evaluate(FAULTS) == []
    finally:
        themed.page.keyboard.press("Escape")


def test_a_screen_reader_finds_name_and_value_of_every_control(tab):
    nodes = nodes_of(tab)
    controls = [node for node in nodes if node[0] in INTERACTIVE]
    assert len(controls) > 100
    assert [node for node in controls if not node[1].strip()] == []
    assert [node for node in controls if node[0] in VALUED and node[2] in {None, ""}] == []
    assert [one for one in controls if one[0] in STATED and STATED[one[0]] not in one[3]] == []
    texts = """Object.fromEntries([...document.querySelectorAll("input[type=range]")]
      .map(one => [one.getAttribute("aria-label"), one.getAttribute("aria-valuetext")]))"""
    spoken_values = tab.page.evaluate(texts)
    assert all(spoken_values.values())
    assert spoken_values["Sun, slider"] == "20deg"
    assert spoken_values["Exposure value at ISO 100"].startswith("EV ")
    # Names are as they are shown, some in capitals.
    parts = {(role, name.lower()) for role, name, *_ in nodes}
    assert {("main", "sky"), ("form", "knobs"), ("complementary", "light")} <= parts
    assert {("heading", "skybake studio"), ("heading", "light")} <= parts


def test_what_happens_is_announced(tab):
    tab.command()
    assert "Command copied" in spoken(tab, "status")
    before = spoken(tab, "alert")
    tab.type("sun", "95deg")
    fault = tab.fault("sun")
    assert fault in spoken(tab, "alert")
    assert fault not in before
    assert tab.page.get_attribute("#groups [data-knob=sun] .value", "aria-invalid") == "true"
    tab.turn("sun", "20deg")


def test_the_keyboard_reaches_everything_and_shows_where_it_is(tab):
    page = tab.page
    page.focus(".skip")
    page.keyboard.press("Shift+Tab")
    page.keyboard.press("Tab")
    seen = []
    while (now := page.evaluate(FOCUSED)) not in seen[:1]:
        seen.append(now)
        page.keyboard.press("Tab")
        assert len(seen) < 400
    assert [one["name"] for one in seen if not (one["isOutlined"] and one["isSeen"])] == []
    names = [one["name"] for one in seen]
    order = ["Skip to the sky", "reset", "world", "search", "exposure", "sky", "detail", "command"]
    assert [name for name in names if name in order] == order
    assert names[-1] == "bake"
    sliders = page.locator("#groups input[type=range]:visible").count()
    assert sum(name.endswith(", slider") for name in names) == sliders > 20


def test_the_keyboard_turns_knobs_and_the_view(tab):
    page = tab.page
    page.focus("#groups [data-knob=sun] input[type=range]")
    page.keyboard.press("ArrowRight")
    assert page.evaluate("studio.store.option('sun')") == "20.5deg"
    page.focus(".skip")
    page.keyboard.press("Enter")
    before = page.text_content("#look")
    page.keyboard.press("ArrowLeft")
    assert page.text_content("#look") != before
    tab.turn("sun", "20deg")


@pytest.mark.parametrize("dialog", DIALOGS)
def test_a_dialog_keeps_the_keyboard_and_gives_it_back(tab, dialog):
    page, opener = tab.page, DIALOGS[dialog]
    page.focus(opener)
    page.keyboard.press("Enter")
    page.wait_for_selector(f"#{dialog}[open] :is(li, pre, input, kbd)")
    is_inside = f"document.getElementById('{dialog}').contains(document.activeElement)"
    assert page.evaluate(is_inside)
    page.keyboard.press("Tab")
    assert page.evaluate(f"{is_inside} || document.activeElement === document.body")
    page.keyboard.press("Escape")
    page.wait_for_selector(f"#{dialog}", state="hidden")
    assert page.evaluate("'#' + document.activeElement.id") == opener


class Fingers:
    """Touches of a page's screen."""

    def __init__(self, tab):
        self._session = tab.context.new_cdp_session(tab.page)

    def move(self, *paths):
        """Put down a finger for each path of places, move them along, and lift them."""
        for turn, places in enumerate(zip(*paths, strict=True)):
            points = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(places)]
            self._touch("touchMove" if turn else "touchStart", points)
        self._touch("touchEnd", [])

    def _touch(self, kind, points):
        self._session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})


@pytest.fixture(scope="module")
def tablet(browser, server):
    opened = Tab(browser, server.url, fragment=SKY, size=(820, 1180), has_touch=True)
    opened.settle()
    yield opened
    opened.close()
    assert opened.complaints == []


def test_a_finger_looks_around_and_two_zoom(tablet):
    fingers = Fingers(tablet)
    box = tablet.page.locator("#sky").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 3
    camera = "({ ...studio.views.camera })"
    before = tablet.page.evaluate(camera)
    fingers.move([(x, y), (x - 40, y + 10), (x - 80, y + 20)])
    turned = tablet.page.evaluate(camera)
    degrees = before["fov"] / box["width"]
    assert turned["azimuth"] - before["azimuth"] == pytest.approx(80 * degrees)
    assert turned["elevation"] - before["elevation"] == pytest.approx(20 * degrees)
    fingers.move([(x - 50, y), (x - 100, y)], [(x + 50, y), (x + 100, y)])
    zoomed = tablet.page.evaluate(camera)
    assert zoomed["fov"] == pytest.approx(turned["fov"] / 2, rel=0.01)
    assert tablet.page.evaluate("scrollX + scrollY + visualViewport.scale") == 1


def test_a_finger_turns_a_knob(tablet):
    slider = tablet.page.locator("#groups [data-knob=sun] input[type=range]")
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    y = box["y"] + box["height"] / 2
    places = [(box["x"] + share * box["width"], y) for share in (0.62, 0.7, 0.78)]
    Fingers(tablet).move(places)
    tablet.settle()
    elevation = tablet.page.evaluate("parseFloat(studio.store.option('sun'))")
    assert elevation == pytest.approx(0.28 * 180, abs=5.0)


@pytest.mark.parametrize("dialog", DIALOGS)
def test_a_tap_opens_and_closes_a_dialog(tablet, dialog):
    tablet.page.tap(DIALOGS[dialog])
    tablet.page.wait_for_selector(f"#{dialog}[open]")
    tablet.page.tap(f"#{dialog} header button")
    tablet.page.wait_for_selector(f"#{dialog}", state="hidden")


def test_controls_are_as_large_as_a_fingertip(tablet):
    tablet.page.evaluate(OPENED)
    small = """() => [...document.querySelectorAll("button, select, summary, input")]
      .filter(element => element.checkVisibility({ visibilityProperty: true }))
      .map(element => [element.outerHTML.slice(0, 90), element.getBoundingClientRect()])
      .filter(([, { height, width }]) => Math.min(height, width) < 24)"""
    assert tablet.page.evaluate(small) == []
