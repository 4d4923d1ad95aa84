"""Makes the gallery of all presets: ``python docs/make_gallery.py``, in some minutes.

One equirect map a world and sun elevation, each exposed, and balanced, by itself; clouds at draft
quality. The studio's pictures of presets are cut out of them. Needs Pillow.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

import skybake
from skybake.preset import load_preset, preset_names

ELEVATIONS = (60.0, 20.0, 5.0, 0.0, -4.0, -8.0)
TILE = (512, 256)
GAP = 6
HEADER = 52
LINE = 42
FONT_SIZE = 30
PAPER, INK = (255, 255, 255), (40, 40, 40)
WIDTH, SMALL_WIDTH = 1250, 900
IMAGES = Path(__file__).parent / "images"
THUMBNAILS = Path(__file__).parents[1] / "skybake" / "studio" / "pictures"
THUMBNAIL_ELEVATION = 5.0
THUMBNAIL_SIZE = (240, 120)
SKY = (0.125, 0.0, 0.875, 0.75)
"""Part of a map that a thumbnail shows: the sky toward the sun, and a strip of the ground."""


def main() -> None:
    """Bake the maps, paste their previews into a sheet and write it in two sizes."""
    names = preset_names()
    columns = len(ELEVATIONS)
    size = (
        columns * (TILE[0] + GAP) + GAP,
        HEADER + len(names) * (TILE[1] + LINE + GAP),
    )
    sheet = Image.new("RGB", size, PAPER)
    draw = ImageDraw.Draw(sheet)
    font = ImageFont.load_default(FONT_SIZE)
    for column, elevation in enumerate(ELEVATIONS):
        draw.text((_left(column), 10), f"sun at {elevation:g} deg", INK, font)
    with tempfile.TemporaryDirectory() as folder:
        for row, name in enumerate(names):
            top = HEADER + row * (TILE[1] + LINE + GAP)
            draw.text((GAP, top), f"{name}   {load_preset(name).title}", INK, font)
            for column, elevation in enumerate(ELEVATIONS):
                picture = _bake(name, elevation, Path(folder))
                with Image.open(picture) as tile:
                    sheet.paste(tile.convert("RGB"), (_left(column), top + LINE))
                    if elevation == THUMBNAIL_ELEVATION:
                        _save_thumbnail(tile.convert("RGB"), name)
            print(name, flush=True)
    _reduced(sheet, WIDTH).save(IMAGES / "gallery.png", optimize=True)
    small = _reduced(sheet, SMALL_WIDTH)
    # Pillow dithers only toward a palette that it is given.
    indexed = small.quantize(palette=small.quantize(256), dither=Image.Dither.FLOYDSTEINBERG)
    indexed.save(IMAGES / "gallery-small.png", optimize=True)


def _save_thumbnail(tile: Image.Image, name: str) -> None:
    box = [round(share * tile.size[i % 2]) for i, share in enumerate(SKY)]
    thumbnail = tile.crop(box).resize(THUMBNAIL_SIZE, Image.Resampling.LANCZOS)
    thumbnail.save(THUMBNAILS / f"{name}.jpg", quality=90)


def _left(column: int) -> int:
    return GAP + column * (TILE[0] + GAP)


def _bake(name: str, elevation: float, folder: Path) -> Path:
    picture = folder / f"{name}{elevation:+g}.png"
    settings = skybake.map_settings(
        sun_elevation=math.radians(elevation), size=TILE[0], clouds_quality="draft"
    )
    skybake.bake(name, picture.with_suffix(".exr"), settings, preview=picture)
    return picture


def _reduced(sheet: Image.Image, width: int) -> Image.Image:
    height = round(sheet.height * width / sheet.width)
    return sheet.resize((width, height), Image.Resampling.LANCZOS)


if __name__ == "__main__":
    main()
