"""Makes the pictures of the studio: ``python docs/make_studio.py [FOLDER]``, in some minutes.

Opens the page in Chromium, for five worlds on a screen and on a tablet; those that the documents
show go into docs/images, or all of them into a folder. Needs Pillow, playwright and the program
chromium.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

IMAGES = Path(__file__).parent / "images"
SCREEN, TABLET = (1280, 720), (820, 1180)
LONGEST = 300_000  # ms
QUALITY = 88
PROBE = (0.62, 0.3)


@dataclass(frozen=True)
class Shown:
    """One world as the page shows it."""

    name: str
    fragment: str
    scheme: str = "dark"
    pressed: tuple[str, ...] = ()
    documented: tuple[tuple[int, int], ...] = ()


WORLDS = (
    Shown(
        "earth",
        "clouds=cumulus:0.35&sun=14deg&clouds-quality=draft&view.azimuth=208&view.elevation=12&view.fov=84",
        documented=(SCREEN,),
    ),
    Shown(
        "mars",
        "preset=mars&site=gale&ls=180&time=sunset-25min&altitude=2km&preview-ev=12&view.azimuth=262&view.elevation=8&view.fov=80",
        documented=(TABLET,),
    ),
    Shown(
        "orbit",
        "sun=-15deg&altitude=400km&view.azimuth=185&view.elevation=-17&view.fov=70",
    ),
    Shown(
        "night",
        "lat=28.76&lon=-17.88&tz=Atlantic/Canary&time=2026-07-15T23:30&altitude=2.4km"
        "&view.azimuth=180&view.elevation=32&view.fov=100",
        pressed=("#balls",),
    ),
    Shown(
        "titan",
        "preset=titan&sun=40deg&view.kind=equirect",
        scheme="light",
        pressed=("#stops",),
    ),
)


def main() -> None:
    """Take the pictures of all worlds in both sizes."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    with _served() as url, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
        )
        for world in WORLDS:
            for size in (SCREEN, TABLET):
                if folder is None and size not in world.documented:
                    continue
                target = (folder or IMAGES) / f"studio-{world.name}-{_kind(size)}.jpg"
                _save(_taken(browser, url, world, size), target)
                print(target, flush=True)
        browser.close()


def _kind(size: tuple[int, int]) -> str:
    return "screen" if size == SCREEN else "tablet"


@contextmanager
def _served() -> Iterator[str]:
    with tempfile.TemporaryDirectory() as folder:
        process = subprocess.Popen(
            [sys.executable, "-m", "skybake", "studio", "--no-browser"],
            cwd=folder,
            env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])},
            stdout=subprocess.PIPE,
            text=True,
        )
        try:
            yield (process.stdout or sys.stdin).readline().strip()
        finally:
            process.terminate()
            process.wait()


def _taken(browser: Browser, url: str, world: Shown, size: tuple[int, int]) -> bytes:
    width, height = size
    context = browser.new_context(
        viewport={"width": width, "height": height}, color_scheme=world.scheme
    )
    page = context.new_page()
    page.set_default_timeout(LONGEST)
    page.goto(f"{url}#{world.fragment}")
    _settle(page)
    for control in world.pressed:
        page.click(control)
    box = page.locator("#sky").bounding_box()
    if box is None:
        raise RuntimeError("the page must have a sky")
    page.mouse.move(box["x"] + PROBE[0] * box["width"], box["y"] + PROBE[1] * box["height"])
    page.wait_for_timeout(700)
    taken = page.screenshot()
    context.close()
    return taken


def _settle(page: Page) -> None:
    page.wait_for_selector("#frame[data-state=settled]")
    page.wait_for_function("document.getElementById('world-picture').complete")


def _save(taken: bytes, target: Path) -> None:
    with Image.open(BytesIO(taken)) as picture:
        picture.convert("RGB").save(target, quality=QUALITY, optimize=True)


if __name__ == "__main__":
    main()
