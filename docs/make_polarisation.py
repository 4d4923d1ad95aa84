"""Makes the pictures of polarisation.md: ``python docs/make_polarisation.py``.

In some minutes; names of sheets may follow, if not all are to be made. Needs Pillow.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import skybake
from skybake.colour.observer import load_observer
from skybake.image.picture import code_values, picture_ev
from skybake.image.picture_settings import PictureSettings
from skybake.image.polarisation_picture import (
    angle_colours,
    degree_colours,
    polarisation_picture,
)
from skybake.image.polarised import through_filter
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.projection import Fisheye, Perspective
from skybake.sky.sky import Sky

IMAGES = Path(__file__).parent / "images"
GAP, LINE = 6, 22
PAPER, INK = (255, 255, 255), (40, 40, 40)
LOSSY = 88

SUNS = (30.0, 5.0, 0.0)
DISC = 330
"""Width of a fisheye. [pixel]"""

SHOT = (328, 246)
FILTERS = (None, 0.0, 30.0, 60.0, 90.0, 120.0)

CROSSED = 30.0
"""Angle of the filter before clouds. [deg]"""

MOST = 12.0
"""Difference that the map of differences shows at most. [%]"""

_PIPELINE = skybake.Pipeline()


def scene(sun: float, projection: object, preset: str = "earth", **values: object) -> Scene:
    """Return the sky of a preset at an elevation of the sun. [deg]"""
    settings = skybake.map_settings(projection, sun_elevation=math.radians(sun), **values)
    return _PIPELINE.scene(preset, settings)


def fisheye() -> Fisheye:
    """All of the sky, the sun at the bottom."""
    return Fisheye(DISC, fov=math.pi)


def page(tiles: list[list[tuple[str, Image.Image]]], foot: Image.Image | None) -> Image.Image:
    """Return rows of tiles with their labels below them, and a legend at the end."""
    width, height = tiles[0][0][1].size
    columns = len(tiles[0])
    below = 0 if foot is None else foot.height + GAP
    sheet = Image.new(
        "RGB",
        (columns * (width + GAP) + GAP, len(tiles) * (height + LINE + GAP) + GAP + below),
        PAPER,
    )
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(14)
    for i, row in enumerate(tiles):
        for j, (label, tile) in enumerate(row):
            x, y = GAP + j * (width + GAP), GAP + i * (height + LINE + GAP)
            sheet.paste(tile, (x, y))
            draw.text((x + 2, y + height + 3), label, INK, font)
    if foot is not None:
        sheet.paste(foot, (GAP, sheet.height - foot.height - GAP))
    return sheet


def save(name: str, sheet: Image.Image) -> None:
    """Write a sheet."""
    sheet.save(IMAGES / f"{name}.jpg", quality=LOSSY, optimize=True)


def legend(ramps: list[tuple[np.ndarray, str, str, str]], width: int) -> Image.Image:
    """Return bars of colours side by side, with what they mean from end to end."""
    each = (width - GAP * (len(ramps) - 1)) // len(ramps)
    sheet = Image.new("RGB", (width, 14 + LINE), PAPER)
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(14)
    for i, (colours, first, middle, last) in enumerate(ramps):
        bar = Image.fromarray(np.repeat(colours[None], 14, axis=0)).resize((each, 14))
        x = i * (each + GAP)
        sheet.paste(bar, (x, 0))
        draw.text((x + 2, 16), first, INK, font)
        draw.text((x + each // 2, 16), middle, INK, font, anchor="ma")
        draw.text((x + each - 2, 16), last, INK, font, anchor="ra")
    return sheet


def neutral_points(sun: float) -> dict[str, float]:
    """Elevations in the sun's vertical where light is unpolarised, beyond 90 deg behind the zenith.

    Of luminance, by names, above the horizon. [deg]
    """
    sky = Sky("earth", math.radians(sun))
    elevation = np.radians(np.arange(0.3, 179.8, 0.1))
    # The sun is in the south, +Z.
    views = np.stack([0.0 * elevation, np.sin(elevation), np.cos(elevation)], axis=-1)
    nodes, xyz_bar = load_observer()
    weights = np.interp(sky.wavelengths, nodes, xyz_bar[:, 1])
    even = (sky.stokes(views) @ weights)[:, 1]
    changes = np.flatnonzero(np.diff(np.sign(even)))
    found: dict[str, float] = {}
    for i in changes:
        share = even[i] / (even[i] - even[i + 1])
        place = math.degrees(elevation[i] + share * (elevation[i + 1] - elevation[i]))
        name = "Arago" if place > 90.0 else "Babinet" if place > sun else "Brewster"
        found[name] = place
    return found


def marked(tile: Image.Image, points: dict[str, float]) -> Image.Image:
    """Return a fisheye with rings around places in the sun's vertical, by their initials."""
    draw, font = ImageDraw.Draw(tile), ImageFont.load_default(13)
    for name, place in points.items():
        x, y = 0.5 * DISC, 0.5 * DISC + (90.0 - place) / 180.0 * DISC
        draw.ellipse((x - 5, y - 5, x + 5, y + 5), outline=(255, 255, 255), width=2)
        draw.text((x + 10, y - 8), name, (255, 255, 255), font)
    return tile


def skies() -> None:
    """Show light, degree and angle, with neutral points."""
    rows = []
    for sun in SUNS:
        sky = scene(sun, fisheye())
        points = neutral_points(sun)
        print(sun, {name: round(place, 1) for name, place in points.items()}, flush=True)
        (canvas,) = fisheye().canvases()
        pixels = Raster(sky, canvas).rows(0, DISC)
        ev = picture_ev(sky, PictureSettings())
        light = Image.fromarray(code_values(pixels, sky.settings.encoding, ev))
        degree, angle = (
            Image.fromarray(polarisation_picture(sky, fisheye(), show)) for show in ("dop", "aop")
        )
        rows.append(
            [
                (f"sun at {sun:g}°: light", light),
                ("degree of polarisation", marked(degree, points)),
                ("angle of polarisation", angle),
            ]
        )
    x = np.linspace(0.0, 1.0, 256)
    turn = math.pi * (0.5 - x)
    ramps = [
        (degree_colours(x), "0", "degree", "1"),
        (angle_colours(turn, np.ones_like(x)), "horizontal", "vertical", "horizontal"),
    ]
    save("polarisation-skies", page(rows, legend(ramps, 3 * (DISC + GAP) - GAP)))


def filters() -> None:
    """Show a view at right angles to the sun through a filter that is turned."""
    view = Perspective(*SHOT, fov=math.radians(75.0), azimuth=math.radians(275.0), elevation=0.45)
    sky = scene(20.0, view, sun_azimuth=math.pi)
    (canvas,) = view.canvases()
    raster = Raster(sky, canvas)
    light, stokes = raster.rows(0, SHOT[1]), raster.band("stokes", 0, SHOT[1])
    ev = picture_ev(sky, PictureSettings())
    tiles = []
    for angle in FILTERS:
        label = "no filter" if angle is None else f"filter at {angle:g}°"
        # A photographer opens the lens by the stop that a filter takes.
        shown = light if angle is None else 2.0 * through_filter(light, stokes, math.radians(angle))
        tiles.append((label, Image.fromarray(code_values(shown, sky.settings.encoding, ev))))
    save("polarisation-filter", page([tiles[:3], tiles[3:]], None))


def clouds() -> None:
    """Show cumuli without a filter and with one that darkens the sky between them."""
    view = Perspective(*SHOT, fov=math.radians(75.0), azimuth=math.radians(275.0), elevation=0.35)
    sky = scene(25.0, view, "earth-fair", sun_azimuth=math.pi)
    (canvas,) = view.canvases()
    raster = Raster(sky, canvas)
    light, stokes = raster.rows(0, SHOT[1]), raster.band("stokes", 0, SHOT[1])
    encoding, ev = sky.settings.encoding, picture_ev(sky, PictureSettings())
    even, odd, whole = (each @ sky.luminance for each in (stokes[..., :3], stokes[..., 3:], light))
    through = 2.0 * through_filter(light, stokes, math.radians(CROSSED))
    tiles = [
        ("no filter", Image.fromarray(code_values(light, encoding, ev))),
        (f"filter at {CROSSED:g}°", Image.fromarray(code_values(through, encoding, ev))),
        ("degree of polarisation", Image.fromarray(degree_colours(np.hypot(even, odd) / whole))),
    ]
    save("polarisation-clouds", page([tiles], None))


def scalar() -> None:
    """Show what light that is not followed as polarised is wrong by."""
    (canvas,) = fisheye().canvases()
    tiles = []
    for sun in (*SUNS, -3.0):
        light = {}
        for method in ("full", "scalar"):
            sky = scene(sun, fisheye(), method=method, sun_disc="exclude")
            light[method] = Raster(sky, canvas).rows(0, DISC) @ sky.luminance
        is_lit = light["full"] > 0.0
        percent = np.zeros_like(light["full"])
        np.divide(light["scalar"], light["full"], out=percent, where=is_lit)
        percent = np.where(is_lit, 100.0 * (percent - 1.0), 0.0)
        low, high = percent[is_lit].min(), percent[is_lit].max()
        print(f"sun {sun:g}: scalar over vector {low:+.1f} to {high:+.1f} %", flush=True)
        colours = difference_colours(percent)
        colours[~is_lit] = PAPER
        label = f"sun at {sun:g}°: {low:+.1f} to {high:+.1f} %"
        tiles.append((label, Image.fromarray(colours)))
    ramp = difference_colours(np.linspace(-MOST, MOST, 256))
    texts = f"{MOST:g} % too dark", "right", f"{MOST:g} % too bright"
    foot = legend([(ramp, *texts)], 2 * (DISC + GAP) - GAP)
    save("polarisation-scalar", page([tiles[:2], tiles[2:]], foot))


def difference_colours(percent: np.ndarray) -> np.ndarray:
    """Blue where too dark, red where too bright, white between; code values of sRGB."""
    share = np.clip(percent / MOST, -1.0, 1.0)[..., None]
    blue, red = np.array([33.0, 102.0, 172.0]), np.array([178.0, 24.0, 43.0])
    end = np.where(share < 0.0, blue, red)
    return np.rint(250.0 + np.abs(share) * (end - 250.0)).astype(np.uint8)


SHEETS = {
    "skies": skies,
    "filters": filters,
    "clouds": clouds,
    "scalar": scalar,
}


def main(names: list[str]) -> None:
    """Make the named sheets, or all."""
    for name, make in SHEETS.items():
        if not names or name in names:
            make()


if __name__ == "__main__":
    main(sys.argv[1:])
