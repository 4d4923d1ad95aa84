"""Makes the pictures of night.md: ``python docs/make_night.py``. Needs Pillow."""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image

import skybake
from skybake.image.image import image_of_scene
from skybake.image.moonlight import Moonlight
from skybake.image.picture import code_values

IMAGES = Path(__file__).parent / "images"
SIZE = 640, 400
GAP = 8
LOSSY = 90

TILE = 128, 64
COLUMNS, FRAMES = 8, 48


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
    preset : str
        World.
    city : float
        Luminance of the zenith by lamps. [cd m⁻²]
    vision : str
        As of `skybake.image.vision`.
    size : tuple of int
        [pixel]
    """

    latitude: float
    longitude: float
    time: str
    look: tuple[float, float, float]
    altitude: float
    ev: float
    preset: str = "earth"
    city: float = 0.0
    vision: str = "camera"
    size: tuple[int, int] = SIZE


PARIS = View(48.86, 2.35, "2026-08-12T23:30Z", (60.0, 28.0, 80.0), 0.0, -5.5, city=3e-3)

VIEWS = (
    View(-24.6, -70.4, "2026-06-17T01:30Z", (140.0, 35.0, 95.0), 2.6, -9.5),
    View(20.6, -156.4, "2026-03-17T05:40Z", (275.0, 25.0, 80.0), 0.0, -8.9),
    View(0.0, -60.0, "2026-06-17T04:00Z", (180.0, -18.0, 40.0), 400.0, -8.2),
    View(-33.0, 18.4, "2026-05-20T18:30Z", (175.0, 42.0, 60.0), 0.0, -8.5),
    PARIS,
    PARIS._replace(vision="eye"),
)

SMALL = 440, 300
CLOUDY = (
    View(46.5, 8.0, "2026-02-01T18:45Z", (95.0, 22.0, 75.0), 0.0, -3.6, "earth-broken", size=SMALL),
    View(
        -24.6, -70.4, "2026-06-17T01:30Z", (140.0, 32.0, 85.0), 0.0, -9.5, "earth-fair", size=SMALL
    ),
    View(
        48.86,
        2.35,
        "2026-08-12T23:30Z",
        (60.0, 28.0, 80.0),
        0.0,
        -3.2,
        "earth-broken",
        3e-3,
        size=SMALL,
    ),
)
"""Clouds in the light of the Moon, before the Milky Way, and over a city."""

MARS = View(-4.59, 137.44, "2026-11-26T05:20Z", (284.0, 27.0, 58.0), 0.0, -0.2, "mars")

NOON_TO_NOON = (-24.6, -70.4, "2026-08-21T16:40Z", "2026-08-22T16:10Z")
"""Latitude, longitude [deg] and the first and the last time of the contact sheet."""


def main() -> None:
    """Draw the views, two by two, that from Mars, and a day."""
    width, height = SIZE
    rows = len(VIEWS) // 2
    sheet = np.full(((height + GAP) * rows - GAP, 2 * width + GAP, 3), 255, np.uint8)
    for i, view in enumerate(VIEWS):
        row, column = (height + GAP) * (i // 2), (width + GAP) * (i % 2)
        sheet[row : row + height, column : column + width] = picture(view)
    Image.fromarray(sheet).save(IMAGES / "night.jpg", quality=LOSSY)
    row = [
        np.pad(picture(each), ((0, 0), (0, GAP), (0, 0)), constant_values=255) for each in CLOUDY
    ]
    Image.fromarray(np.hstack(row)[:, :-GAP]).save(IMAGES / "night-clouds.jpg", quality=LOSSY)
    Image.fromarray(picture(MARS)).save(IMAGES / "night-mars.jpg", quality=LOSSY)
    Image.fromarray(contact_sheet()).save(IMAGES / "night-day.jpg", quality=LOSSY)


def picture(view: View) -> np.ndarray:
    """Return code values of a view, shape (height, width, 3)."""
    planet = "mars" if view.preset == "mars" else "earth"
    place = skybake.Place(math.radians(view.latitude), math.radians(view.longitude), planet)
    moment = skybake.sun_at(view.time, place)
    bearing, elevation, width = map(math.radians, view.look)
    settings = skybake.map_settings(
        skybake.Perspective(*view.size, width, bearing, elevation),
        altitude=view.altitude,
        sun_elevation=moment.sun_elevation,
        sun_azimuth=moment.sun_azimuth,
        night=skybake.Night(moment.celestial, is_refracted=moment.is_refracted, city=view.city),
        moonlight=Moonlight(moment.lit_moon if view in CLOUDY else None),
        clouds_quality="draft",
    )
    image = image_of_scene(skybake.Scene(skybake.load_preset(view.preset), settings))
    values: np.ndarray = code_values(image.pixels, image.encoding, view.ev, vision=view.vision)
    return values


def contact_sheet() -> np.ndarray:
    """Return a day from noon to noon, each map exposed for itself."""
    latitude, longitude, start, end = NOON_TO_NOON
    place = skybake.find_place(latitude=math.radians(latitude), longitude=math.radians(longitude))
    moments = skybake.TimeSpan(start, end, place).moments(FRAMES)
    pipeline = skybake.Pipeline()
    width, height = TILE
    sheet = np.zeros((height * (FRAMES // COLUMNS), width * COLUMNS, 3), np.uint8)
    for i, moment in enumerate(moments):
        settings = skybake.map_settings(
            "equirect",
            TILE,
            sun_elevation=moment.sun_elevation,
            sun_azimuth=moment.sun_azimuth,
            night=skybake.Night(moment.celestial),
            moonlight=Moonlight(moment.lit_moon),
        )
        row, column = height * (i // COLUMNS), width * (i % COLUMNS)
        tile = pipeline.image("earth", settings).picture()
        sheet[row : row + height, column : column + width] = tile
    return sheet


if __name__ == "__main__":
    main()
