"""Makes the pictures of clouds.md and the first of the README: ``python docs/make_clouds.py``.

Each sky as an equirect map and as a camera sees it, or in the README's strip as a camera sees it
alone, exposed by itself; in some minutes. Another quality than ``normal`` may follow, as ``draft``,
and names of sheets, if not all are to be made. Needs Pillow.
"""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from PIL import Image, ImageDraw, ImageFont

import skybake
from skybake.image.picture import picture_ev, thumbnail

IMAGES = Path(__file__).parent / "images"
HEIGHT, GAP, LINE = 216, 8, 24
SHOT = (384, HEIGHT)
COLUMNS = 2
PAPER, INK = (255, 255, 255), (40, 40, 40)
LOSSY = 86
"""Quality of JPEG, for which a sheet stays below 300 kB."""


class Shot(NamedTuple):
    """A sky and what is looked at.

    Attributes
    ----------
    preset : str
        What the world extends.
    sun : float
        Elevation. [deg]
    look : tuple of float
        Bearing, elevation and width of the view, the sun being in the south, 180. [deg]
    clouds : str
        Tables of a preset in place of its own layers.
    altitude : float
        Of the observer. [km]
    """

    preset: str
    sun: float
    look: tuple[float, float, float]
    clouds: str = ""
    altitude: float = 0.0


TWO = """
[clouds.low]
kind = "cumulus"
cover = 0.25
[clouds.high]
kind = "cirrus"
cover = 0.6
"""

SHEETS = {
    "clouds-cumulus": {
        "cumulus 0.4, sun at 60 deg": Shot("earth-fair", 60.0, (120.0, 20.0, 80.0)),
        "sun at 30 deg": Shot("earth-fair", 30.0, (130.0, 18.0, 80.0)),
        "sun at 10 deg": Shot("earth-fair", 10.0, (150.0, 15.0, 80.0)),
        "sun at 2 deg": Shot("earth-fair", 2.0, (165.0, 15.0, 80.0)),
        "sun at -3 deg": Shot("earth-fair", -3.0, (180.0, 15.0, 80.0)),
        "rays under broken cloud, sun at 10 deg": Shot("earth-broken", 10.0, (180.0, 12.0, 70.0)),
    },
    "clouds-kinds": {
        "overcast, sun at 40 deg": Shot("earth-overcast", 40.0, (140.0, 20.0, 80.0)),
        "broken stratocumulus, sun at 25 deg": Shot("earth-broken", 25.0, (150.0, 25.0, 80.0)),
        "cirrus, sun at 20 deg": Shot("earth-cirrus", 20.0, (170.0, 25.0, 80.0)),
        "cirrus, sun at -2 deg": Shot("earth-cirrus", -2.0, (180.0, 15.0, 80.0)),
        "cumulus under cirrus, sun at 15 deg": Shot("earth", 15.0, (160.0, 18.0, 80.0), TWO),
        "from 11 km, sun at 30 deg": Shot("earth-fair", 30.0, (150.0, -15.0, 70.0), altitude=11.0),
        "from 400 km, sun at 30 deg": Shot(
            "earth-broken", 30.0, (150.0, -30.0, 60.0), altitude=400.0
        ),
        "ice clouds of Mars, sun at 10 deg": Shot("mars-ice-clouds", 10.0, (160.0, 15.0, 80.0)),
    },
}


STRIP = "clouds-strip"
STRIP_SHOTS = {
    "earth-fair, sun at 20 deg": Shot("earth-fair", 20.0, (130.0, 14.0, 70.0)),
    "earth-cirrus, sun at 4 deg": Shot("earth-cirrus", 4.0, (170.0, 17.0, 75.0)),
    "mars, sun at 6 deg": Shot("mars", 6.0, (180.0, 12.0, 75.0)),
}


def main(quality: str = "normal", *names: str) -> None:
    """Draw each sheet and write it."""
    for name in names or (STRIP, *SHEETS):
        if name == STRIP:
            tiles = {title: pictures(shot, quality)[1:] for title, shot in STRIP_SHOTS.items()}
            sheet(tiles, len(tiles)).save(IMAGES / f"{name}.jpg", quality=LOSSY, optimize=True)
            continue
        tiles = {}
        for title, shot in SHEETS[name].items():
            tiles[title] = pictures(shot, quality)
            print(title, flush=True)
        sheet(tiles, COLUMNS).save(IMAGES / f"{name}.jpg", quality=LOSSY, optimize=True)


def pictures(shot: Shot, quality: str) -> tuple[Image.Image, ...]:
    """Return the map of a sky and a camera's view of it, of which light is solved for once."""
    bearing, elevation, width = map(math.radians, shot.look)
    view = skybake.Perspective(*SHOT, fov=width, azimuth=bearing, elevation=elevation)
    settings = skybake.map_settings(
        size=2 * HEIGHT,
        sun_elevation=math.radians(shot.sun),
        altitude=shot.altitude,
        clouds_quality=quality,
    )
    scene = skybake.Pipeline().scene(world(shot), settings)
    shown = []
    for look, columns in (
        (skybake.PictureSettings(), 2 * HEIGHT),
        (skybake.PictureSettings(shot=view), SHOT[0]),
    ):
        codes = thumbnail(scene, picture_ev(scene, look), look, columns)
        shown.append(Image.fromarray(codes))
    return tuple(shown)


def world(shot: Shot) -> skybake.Planet:
    """Return the world of a sky."""
    if not shot.clouds:
        return skybake.load_preset(shot.preset)
    with tempfile.TemporaryDirectory() as folder:
        preset = Path(folder) / "clouds.toml"
        preset.write_text(f'extends = "{shot.preset}"\n{shot.clouds}', "utf-8")
        return skybake.load_preset(preset)


def sheet(tiles: dict[str, tuple[Image.Image, ...]], columns: int) -> Image.Image:
    """Paste pictures in rows, each with all that belong together, below their titles."""
    width = max(sum(each.width + GAP for each in together) for together in tiles.values())
    width += GAP if len(next(iter(tiles.values()))) > 1 else 0
    rows = math.ceil(len(tiles) / columns)
    size = columns * width + GAP, rows * (HEIGHT + LINE + GAP) + GAP
    out = Image.new("RGB", size, PAPER)
    draw, font = ImageDraw.Draw(out), ImageFont.load_default(15)
    for number, (title, together) in enumerate(tiles.items()):
        row, column = divmod(number, columns)
        left, top = GAP + column * width, GAP + row * (HEIGHT + LINE + GAP)
        draw.text((left, top), title, INK, font)
        for tile in together:
            out.paste(tile, (left, top + LINE))
            left += tile.width + GAP
    return out


if __name__ == "__main__":
    main(*sys.argv[1:])
