"""Makes the picture of night.md: ``python docs/make_night.py``. Needs Pillow."""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image

import skybake
from skybake.image.image import image_of_scene

IMAGE = Path(__file__).parent / "images" / "night.jpg"
SIZE = 640, 400
GAP = 8
LOSSY = 88


class View(NamedTuple):
    """A place, a time and where the camera looks.

    Attributes
    ----------
    latitude, longitude : float
        [deg]
    time : str
        In UTC.
    look : tuple of float
        Bearing, elevation and width of the view. [deg]
    altitude : float
        [km]
    ev : float
        Exposure value.
    """

    latitude: float
    longitude: float
    time: str
    look: tuple[float, float, float]
    altitude: float
    ev: float


VIEWS = (
    View(-24.6, -70.4, "2026-06-17T01:30Z", (140.0, 35.0, 95.0), 2.6, -9.5),
    View(20.6, -156.4, "2026-03-17T05:40Z", (275.0, 25.0, 80.0), 0.0, -8.9),
    View(0.0, -60.0, "2026-06-17T04:00Z", (180.0, -18.0, 40.0), 400.0, -8.2),
    View(-33.0, 18.4, "2026-05-20T18:30Z", (175.0, 42.0, 60.0), 0.0, -8.5),
)


def main() -> None:
    """Draw the views, two by two."""
    width, height = SIZE
    sheet = np.full((2 * height + GAP, 2 * width + GAP, 3), 255, np.uint8)
    for i, view in enumerate(VIEWS):
        row, column = (height + GAP) * (i // 2), (width + GAP) * (i % 2)
        sheet[row : row + height, column : column + width] = picture(view)
    Image.fromarray(sheet).save(IMAGE, quality=LOSSY)


def picture(view: View) -> np.ndarray:
    """Return code values of a view, shape (height, width, 3)."""
    place = skybake.find_place(
        latitude=math.radians(view.latitude), longitude=math.radians(view.longitude)
    )
    moment = skybake.sun_at(view.time, place)
    bearing, elevation, width = map(math.radians, view.look)
    settings = skybake.map_settings(
        skybake.Perspective(*SIZE, width, bearing, elevation),
        altitude=view.altitude,
        sun_elevation=moment.sun_elevation,
        sun_azimuth=moment.sun_azimuth,
        night=skybake.Night(moment.celestial, is_refracted=moment.is_refracted),
    )
    scene = skybake.Scene(skybake.load_preset("earth"), settings)
    return image_of_scene(scene).picture(view.ev)


if __name__ == "__main__":
    main()
