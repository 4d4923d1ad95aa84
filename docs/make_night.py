"""Makes the picture of night.md: ``python docs/make_night.py``. Needs Pillow."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from PIL import Image

import skybake
from skybake.image.image import image_of_scene

IMAGE = Path(__file__).parent / "images" / "night-stars.jpg"
EXPOSURE = -5.5
GAP = 8
LOSSY = 88

# Right ascension of what culminates, latitude, and where the camera looks. [deg]
VIEWS = (
    (85.0, 31.0, (165.0, 37.0)),
    (187.0, -33.0, (180.0, 44.0)),
)


def main() -> None:
    """Draw both views side by side."""
    pictures = []
    for sidereal_time, latitude, look in VIEWS:
        frame = skybake.CelestialFrame("earth", math.radians(sidereal_time), math.radians(latitude))
        view = skybake.Perspective(640, 480, math.radians(75.0), *map(math.radians, look))
        settings = skybake.map_settings(
            view, sun_elevation=math.radians(-12.5), sun_azimuth=0.0, night=skybake.Night(frame)
        )
        scene = skybake.Scene(skybake.load_preset("earth"), settings)
        pictures.append(image_of_scene(scene).picture(EXPOSURE))
    height, width, _ = pictures[0].shape
    sheet = np.full((height, 2 * width + GAP, 3), 255, np.uint8)
    for i, picture in enumerate(pictures):
        sheet[:, i * (width + GAP) : i * (width + GAP) + width] = picture
    Image.fromarray(sheet).save(IMAGE, quality=LOSSY)


if __name__ == "__main__":
    main()
