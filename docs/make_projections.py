"""Makes the picture of all projections: ``python docs/make_projections.py``, in seconds.

One sky of Earth in every projection, and its limb from orbit, each exposed by itself. Needs Pillow.
"""

from __future__ import annotations

import math
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

import skybake

FOLDER = Path(__file__).parent / "images"
HEIGHT, GAP, LINE = 288, 8, 24
PAPER, INK = (255, 255, 255), (40, 40, 40)

LOW = skybake.Sky("earth", math.radians(8.0), sun_azimuth=math.radians(200.0))
ORBIT = skybake.Sky("earth", math.radians(-15.0), 400.0)
PICTURES = {
    "equirect": LOW.image("equirect", 2 * HEIGHT),
    "cubemap --cube-layout cross": LOW.image("cubemap", HEIGHT // 3, layout="cross"),
    "fisheye": LOW.image("fisheye", HEIGHT),
    "angular": LOW.image("angular", HEIGHT),
    "octahedral": LOW.image("octahedral", HEIGHT),
    "--cube-layout vertical-cross": LOW.image("cubemap", HEIGHT // 4, layout="vertical-cross"),
    "perspective --look 200,12 --fov 70deg": LOW.image(
        "perspective",
        (512, HEIGHT),
        fov=math.radians(70.0),
        azimuth=math.radians(200.0),
        elevation=math.radians(12.0),
    ),
    "perspective --altitude 400km --look 180,-18": ORBIT.image(
        "perspective", (512, HEIGHT), fov=math.radians(40.0), elevation=math.radians(-18.0)
    ),
}
ROWS = (
    ("equirect", "cubemap --cube-layout cross"),
    ("fisheye", "angular", "octahedral", "--cube-layout vertical-cross"),
    tuple(name for name in PICTURES if name.startswith("perspective")),
)


def main() -> None:
    """Paste the pictures in rows and write them."""
    rows = [[Image.fromarray(PICTURES[name].picture()) for name in names] for names in ROWS]
    width = max(sum(tile.width + GAP for tile in row) for row in rows) + GAP
    sheet = Image.new("RGB", (width, len(rows) * (HEIGHT + LINE + GAP) + GAP), PAPER)
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(15)
    for i, (names, row) in enumerate(zip(ROWS, rows, strict=True)):
        left, top = GAP, GAP + i * (HEIGHT + LINE + GAP)
        for name, tile in zip(names, row, strict=True):
            draw.text((left, top), name, INK, font)
            sheet.paste(tile, (left, top + LINE))
            left += tile.width + GAP
    sheet.save(FOLDER / "projections.png", optimize=True)


if __name__ == "__main__":
    main()
