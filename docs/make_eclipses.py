"""Makes the pictures of eclipses.md: ``python docs/make_eclipses.py``.

In some minutes; names of sheets may follow, if not all are to be made. Needs Pillow.
"""

from __future__ import annotations

import math
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import skybake
from skybake.ephemeris.moment import Moment, sun_at
from skybake.ephemeris.moon import Moon
from skybake.ephemeris.place import SITES, Place
from skybake.image.eclipsing_moon import eclipsing_moon
from skybake.image.picture import picture_ev, thumbnail
from skybake.image.picture_settings import PictureSettings
from skybake.image.scene import Scene
from skybake.image.sun_distance import sun_distance
from skybake.preset import load_preset

IMAGES = Path(__file__).parent / "images"
GAP, LINE = 6, 22
PAPER, INK = (255, 255, 255), (40, 40, 40)
LOSSY = 88

CORUNA = Place(math.radians(43.3713), math.radians(-8.3960))
GREATEST = datetime(2026, 8, 12, 17, 45, 51, tzinfo=UTC)
TOTALITY = datetime(2026, 8, 12, 18, 28, 19, tzinfo=UTC)
SUN_EV = 29.0
"""Exposure at which the sun's disc is neither white nor black."""

MINUTES = (-40.0, -20.0, -8.0, -2.0, -0.9, -0.6, 0.0, 0.6, 0.9, 2.0, 8.0, 20.0)


def at(moment: Moment, preset: str = "earth", altitude: float = 0.0, **values: object) -> Scene:
    """Return the scene of a moment."""
    planet = load_preset(preset)
    distance = sun_distance(planet, moment)
    moon = eclipsing_moon(planet, moment, distance, altitude)
    return skybake_scene(
        preset,
        sun_elevation=moment.sun_elevation,
        sun_azimuth=moment.sun_azimuth,
        sun_distance=distance,
        altitude=altitude,
        moon=moon,
        **values,
    )


def skybake_scene(preset: str, **values: object) -> Scene:
    """Return a scene by values of `skybake.map_settings`."""
    return skybake.Pipeline().scene(preset, skybake.map_settings(**values))


def camera(
    azimuth: float, elevation: float, fov: float, size: tuple[int, int]
) -> dict[str, object]:
    """Return what `skybake.map_settings` takes of a perspective picture."""
    return {
        "projection": "perspective",
        "size": size,
        "azimuth": azimuth,
        "elevation": elevation,
        "fov": fov,
    }


def shown(scene: Scene, width: int, ev: float | None = None) -> Image.Image:
    """Return a scene as a screen shows it, exposed by itself unless `ev` says how."""
    settings = PictureSettings()
    ev = picture_ev(scene, settings) if ev is None else ev
    return Image.fromarray(np.asarray(thumbnail(scene, ev, settings, width)))


def sheet(name: str, tiles: list[tuple[str, Image.Image]], columns: int) -> None:
    """Write tiles with their labels below them."""
    width, height = tiles[0][1].size
    rows = -(-len(tiles) // columns)
    page = Image.new(
        "RGB",
        (columns * (width + GAP) + GAP, rows * (height + LINE + GAP) + GAP),
        PAPER,
    )
    draw, font = ImageDraw.Draw(page), ImageFont.load_default(14)
    for i, (label, tile) in enumerate(tiles):
        x = GAP + i % columns * (width + GAP)
        y = GAP + i // columns * (height + LINE + GAP)
        page.paste(tile, (x, y))
        draw.text((x + 2, y + height + 3), label, INK, font)
    page.save(IMAGES / f"{name}.jpg", quality=LOSSY, optimize=True)


def discs() -> None:
    """Show what telescopes see: partial, annular, the last crescent, and Phobos."""
    sun = math.radians(35.0)
    tiles = []
    for label, moon in (
        ("partial", Moon(math.radians(180.17), sun + math.radians(0.16))),
        ("annular", Moon(math.pi, sun + math.radians(0.008), math.radians(0.497))),
        ("1 % left", Moon(math.radians(180.012), sun + math.radians(0.008), math.radians(0.55))),
    ):
        scene = skybake_scene(
            "earth",
            sun_elevation=sun,
            moon=moon,
            **camera(math.pi, sun, math.radians(0.9), (248, 248)),
        )
        tiles.append((label, shown(scene, 248, SUN_EV)))
    moment = sun_at("2013-08-20T07:14:14Z", SITES["gale"])
    view = camera(moment.sun_azimuth, moment.sun_elevation, math.radians(0.6), (248, 248))
    tiles.append(("Phobos, Gale, 2013-08-20", shown(at(moment, "mars", **view), 248, SUN_EV - 1.0)))
    sheet("eclipse-discs", tiles, 4)


def totality() -> None:
    """Show the sky of totality over A Coruña, all around."""
    scene = at(sun_at(TOTALITY, CORUNA), projection="equirect", size=1024)
    sheet("eclipse-total", [("43.4 N, 8.4 W, 2026-08-12 18:28:19 UTC", shown(scene, 1000))], 1)


def from_space() -> None:
    """Show the shadow on Earth, from low and from high."""
    low = Place(math.radians(60.5), math.radians(-22.0))
    moment = sun_at(GREATEST, low, altitude=400.0)
    north = math.radians(-14.0)
    tiles = [
        (
            "400 km above 60.5 N, 22 W, to the north",
            shown(
                at(moment, altitude=400.0, **camera(north, math.radians(-30.0), 1.2, (496, 496))),
                496,
            ),
        )
    ]
    high = Place(math.radians(50.0), math.radians(-35.0))
    moment = sun_at(GREATEST, high, altitude=36_000.0)
    down = camera(0.0, math.radians(-90.0), math.radians(19.5), (496, 496))
    tiles.append(("36,000 km above 50 N, 35 W", shown(at(moment, altitude=36_000.0, **down), 496)))
    sheet("eclipse-space", tiles, 2)


def sequence() -> None:
    """Show the eclipse of 2026-08-12 over A Coruña, to the west."""
    tiles = []
    for minutes in MINUTES:
        time = TOTALITY + timedelta(minutes=minutes)
        moment = sun_at(time, CORUNA)
        view = camera(math.radians(279.0), math.radians(14.0), math.radians(70.0), (328, 196))
        scene = at(moment, **view)
        eclipse = scene.sky.eclipse
        covered = 0.0 if eclipse is None else eclipse.phase.obscuration
        settings = PictureSettings()
        label = f"{time:%H:%M:%S} UTC  {covered:.1%}  EV {picture_ev(scene, settings):.1f}"
        tiles.append((label, shown(scene, 328)))
    sheet("eclipse-sequence", tiles, 3)


SHEETS = {
    "discs": discs,
    "total": totality,
    "space": from_space,
    "sequence": sequence,
}


def main(names: list[str]) -> None:
    """Make the sheets."""
    for name in names or SHEETS:
        SHEETS[name]()


if __name__ == "__main__":
    main(sys.argv[1:])
