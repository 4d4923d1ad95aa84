"""The studio's page in a real browser."""

import base64
import shutil
from contextlib import contextmanager
from importlib.util import find_spec

import numpy as np
import pytest

SETTLED = "#frame[data-state=settled]"
LONGEST = 600_000  # ms, since the first picture may compile kernels

needs_browser = pytest.mark.skipif(
    shutil.which("chromium") is None or find_spec("playwright") is None,
    reason="needs the program chromium and the package playwright",
)

_AS_TEXT = """(bytes) => {
  let text = "";
  for (let at = 0; at < bytes.length; at += 8192) {
    text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  }
  return btoa(text);
}"""

_TEXELS = f"""() => {{
  const {{ texels, width, height }} = studio.live.frames.now;
  return [({_AS_TEXT})(new Uint8Array(texels.slice().buffer)), width, height];
}}"""

_DRAWN = f"""() => {{
  studio.views.draw();
  const {{ gl, canvas: {{ width, height }} }} = studio.views.renderer;
  const bytes = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  return [({_AS_TEXT})(bytes), width, height];
}}"""


@contextmanager
def chromium():
    """Run the system's browser as long as the block lasts."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
        )
        try:
            yield browser
        finally:
            browser.close()


class Tab:
    """A tab with the page; `complaints` are what its console and its scripts complained of.

    `keywords` are those of the browser's `new_context`.
    """

    def __init__(self, browser, url, *, fragment="", size=(1000, 700), **keywords):
        width, height = size
        viewport = {"width": width, "height": height}
        self.context = browser.new_context(viewport=viewport, **keywords)
        self.context.grant_permissions(["clipboard-read", "clipboard-write"])
        self.page = self.context.new_page()
        self.page.set_default_timeout(LONGEST)
        self.complaints = []
        self.page.on("console", self._said)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(f"{url}#{fragment}")

    def _said(self, message):
        if message.type in {"error", "warning"}:
            self.complaints.append(message.text)

    def settle(self):
        """Wait until the full picture of what the knobs are set to has been drawn."""
        self.page.wait_for_selector(SETTLED)

    def turn(self, knob, text):
        """Type a value that the command line takes, and wait until it is shown."""
        self.type(knob, text)
        self.page.wait_for_function(
            "([name, text]) => (studio.store.option(name) ?? '') === text", arg=[knob, text]
        )
        self.settle()

    def type(self, knob, text):
        """Type into a knob, as on the command line."""
        group = self.page.locator(f"#groups details:has([data-knob={knob}])")
        group.evaluate("element => { element.open = true; }")
        field = self.page.locator(f"#groups [data-knob={knob}] .value")
        field.fill(text)
        field.press("Enter")

    def fault(self, knob):
        """Return what the page says of a knob, once it does."""
        fault = self.page.locator(f"#groups [data-knob={knob}] .fault")
        fault.wait_for()
        return fault.text_content()

    def texels(self):
        """Return the picture of the sky as half floats, shape (row, column, channel).

        What 1 stands for is `scale`, in cd/m2.
        """
        text, width, height = self.page.evaluate(_TEXELS)
        return np.frombuffer(base64.b64decode(text), "<f2").reshape(height, width, 3)

    def drawn(self):
        """Draw and return what the page shows of the sky, bytes of shape (row, column, channel)."""
        text, width, height = self.page.evaluate(_DRAWN)
        return np.frombuffer(base64.b64decode(text), np.uint8).reshape(height, width, 4)[::-1]

    def scale(self):
        return self.page.evaluate("studio.live.frames.now.scale")

    def command(self):
        """Copy the command, and return what the clipboard holds."""
        self.page.click("#copy-command")
        self.page.get_by_text("Command copied").first.wait_for()
        return self.page.evaluate("navigator.clipboard.readText()")

    def close(self):
        self.context.close()
