"""Makes the pictures of moon.md: ``python docs/make_moon.py``. Needs Pillow."""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image

import skybake
from skybake.image.image import image_of_scene

IMAGES = Path(__file__).parent / "images"
SIZE = 640, 400
DISC = 210
GAP = 8
LOSSY = 88


class View(NamedTuple):
    """A place, a time and where the camera looks.

    Attributes
    ----------
    place : tuple of float
        Latitude and longitude. [deg]
    time : str
        In UTC.
    look : tuple of float
        Bearing and elevation less those of the Moon, and width of the view. [deg]
    ev : float
        Exposure value.
    size : tuple of int
        [pixel]
    preset, ground : str
        World and what covers it.
    """

    place: tuple[float, float]
    time: str
    look: tuple[float, float, float]
    ev: float
    size: tuple[int, int] = SIZE
    preset: str = "earth"
    ground: str = "grassland"


ALPS, PARIS, PERTH = (46.5, 8.0), (48.86, 2.35), (-32.0, 116.0)
VIEWS = (
    View(ALPS, "2026-02-01T18:45Z", (14.0, -20.0, 70.0), -3.3, preset="earth-clear", ground="snow"),
    View(PARIS, "2026-04-19T19:42Z", (0.4, 0.2, 2.4), 0.1),
    View(PERTH, "2025-09-07T18:12Z", (4.0, -3.0, 24.0), -6.5),
    View(PARIS, "2026-04-23T20:00Z", (0.0, 0.0, 0.9), 11.0),
)
ECLIPSE = (
    ("2025-09-07T16:20Z", 13.0),
    ("2025-09-07T16:55Z", 12.0),
    ("2025-09-07T17:20Z", 7.0),
    ("2025-09-07T17:31Z", 1.0),
    ("2025-09-07T18:12Z", -1.0),
    ("2025-09-07T18:52Z", 1.0),
)
"""Times of a total eclipse, and what shows the Moon best."""


def main() -> None:
    """Draw the views, two by two, and the eclipse in a row."""
    save("moon.jpg", [picture(view) for view in VIEWS], columns=2)
    discs = [picture(View(PERTH, time, (0.0, 0.0, 0.7), ev, (DISC, DISC))) for time, ev in ECLIPSE]
    save("moon-eclipse.jpg", discs, columns=len(discs))


def save(name: str, pictures: list[np.ndarray], *, columns: int) -> None:
    """Write pictures of one size side by side."""
    height, width, _ = pictures[0].shape
    rows = -(-len(pictures) // columns)
    shape = rows * (height + GAP) - GAP, columns * (width + GAP) - GAP, 3
    sheet = np.full(shape, 255, np.uint8)
    for i, each in enumerate(pictures):
        row, column = (height + GAP) * (i // columns), (width + GAP) * (i % columns)
        sheet[row : row + height, column : column + width] = each
    Image.fromarray(sheet).save(IMAGES / name, quality=LOSSY)


def picture(view: View) -> np.ndarray:
    """Return code values of a view, shape (height, width, 3)."""
    latitude, longitude = map(math.radians, view.place)
    place = skybake.find_place(latitude=latitude, longitude=longitude)
    moment = skybake.sun_at(view.time, place, refraction=True)
    moon = moment.lit_moon
    bearing, elevation, width = map(math.radians, view.look)
    settings = skybake.map_settings(
        skybake.Perspective(*view.size, width, moon.azimuth + bearing, moon.elevation + elevation),
        sun_elevation=moment.sun_elevation,
        sun_azimuth=moment.sun_azimuth,
        night=skybake.Night(moment.celestial, is_refracted=moment.is_refracted),
        moonlight=skybake.Moonlight(moon),
    )
    changes = skybake.PresetChanges(ground_albedo=view.ground)
    scene = skybake.Scene(changes.load(view.preset), settings)
    return image_of_scene(scene).picture(view.ev)


if __name__ == "__main__":
    main()
