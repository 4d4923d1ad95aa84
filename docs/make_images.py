"""Makes the pictures of the README: ``python docs/make_images.py``.

One equirect map a world and sun elevation, each exposed by itself and shown through ACES 2.0.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import OpenImageIO

import skybake

WORLDS = ("earth", "mars")
ELEVATIONS = (60.0, 30.0, 5.0, 0.0, -4.0)
WIDTH = 384
GAP = 4
TARGET = Path(__file__).parent / "images" / "worlds.png"


def main() -> None:
    """Bake the maps, and paste their previews into one picture."""
    columns, rows = len(ELEVATIONS), len(WORLDS)
    height = WIDTH // 2
    size = (columns * (WIDTH + GAP) - GAP, rows * (height + GAP) - GAP)
    strip = OpenImageIO.ImageBuf(OpenImageIO.ImageSpec(*size, 3, "uint8"))
    OpenImageIO.ImageBufAlgo.fill(strip, (1.0, 1.0, 1.0))
    with tempfile.TemporaryDirectory() as folder:
        for row, world in enumerate(WORLDS):
            for column, elevation in enumerate(ELEVATIONS):
                picture = Path(folder) / f"{world}{elevation}.png"
                settings = skybake.MapSettings(math.radians(elevation), width=WIDTH)
                skybake.bake(world, picture.with_suffix(".exr"), settings, preview=picture)
                tile = OpenImageIO.ImageBuf(str(picture))
                corner = (column * (WIDTH + GAP), row * (height + GAP), 0, 0)
                OpenImageIO.ImageBufAlgo.paste(strip, *corner, tile)
    strip.specmod()["png:compressionLevel"] = 9
    if not strip.write(str(TARGET)):
        raise SystemExit(strip.geterror())


if __name__ == "__main__":
    main()
