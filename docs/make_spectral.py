"""Makes the picture of spectral.md, in some minutes: ``python docs/make_spectral.py``.

Needs Pillow and Mitsuba.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import mitsuba
import numpy as np
from make_polarisation import page, save
from PIL import Image

import skybake
from skybake.colour.camera import load_d65
from skybake.colour.observer import LUMINOUS_EFFICACY, load_observer
from skybake.colour.space import find_colour_space, rgb_from_xyz
from skybake.formats.exr_layers import read_exr
from skybake.formats.preview import display_values
from skybake.image.sensor import DEFAULT_WAVELENGTHS, Sensor

SPHERES = (256, 192)
SAMPLES = 64


def spheres() -> None:
    """Show two paints that look alike by day, rendered by a spectrum and by three colours."""
    mitsuba.set_variant("scalar_rgb")
    wavelengths = np.array(DEFAULT_WAVELENGTHS[::2])
    grey, twin = metamers(wavelengths)
    tiles = []
    for sun in (40.0, 1.5):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "sky.exr"
            settings = skybake.map_settings(
                size=512,
                sun_elevation=math.radians(sun),
                sun_size=math.radians(4.0),
                target="mitsuba",
                sun_disc="include",
                sensor=Sensor(wavelengths=DEFAULT_WAVELENGTHS),
                pixel="float",
            )
            skybake.bake("earth", path, settings)
            (part,) = read_exr(path)
        spectrum = np.stack(
            [part.plane(f"S0.{each:.0f},0nm") for each in wavelengths], axis=-1
        ).astype(float)
        rendered = np.zeros((SPHERES[1], SPHERES[0], len(wavelengths)))
        for first in range(0, len(wavelengths), 3):
            some = slice(first, first + 3)
            rendered[..., some] = picture(spectrum[..., some], grey[some], twin[some])
        nodes, xyz_bar = load_observer()
        curves = np.stack([np.interp(wavelengths, nodes, each) for each in xyz_bar.T], axis=1)
        xyz = LUMINOUS_EFFICACY * 20.0 * rendered @ curves
        space = find_colour_space("lin_rec709")
        by_spectrum = xyz @ rgb_from_xyz(space).T
        colours = np.stack([part.plane(name) for name in "RGB"], axis=-1).astype(float)
        half = np.full(3, 0.5)
        # The reddest of sunsets is outside of Rec. 709, and a renderer of colours takes it as so.
        colours = np.maximum(colours, 0.0) * part.attributes["whiteLuminance"]
        by_three = picture(colours, half, half)
        gain = 0.32 / np.median(by_spectrum @ np.array([0.2126, 0.7152, 0.0722]))
        for name, light in (("spectrum", by_spectrum), ("R, G and B", by_three)):
            codes = display_values((gain * light).astype(np.float32), space, "aces1")
            shown = Image.fromarray(np.rint(255.0 * codes).astype(np.uint8))
            tiles.append((f"sun at {sun:g}°, by {name}", shown))
    save("spectral-mitsuba", page([tiles[:2], tiles[2:]], None))


def metamers(wavelengths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a grey paint, and one of another spectrum that looks the same under D65."""
    nodes, xyz_bar = load_observer()
    curves = np.stack([np.interp(wavelengths, nodes, each) for each in xyz_bar.T], axis=1)
    seen = curves * np.interp(wavelengths, nodes, load_d65())[:, None]
    # What most differs in the light of a low sun, of which that is left out which D65 shows.
    low = seen * np.exp(-2.2 * (550.0 / wavelengths[:, None]) ** 4)
    wanted = low[:, 1] - low[:, 0]
    unseen = wanted - seen @ np.linalg.lstsq(seen, wanted, rcond=None)[0]
    grey = np.full(wavelengths.size, 0.5)
    return grey, grey + 0.48 * unseen / np.abs(unseen).max()


def picture(light: np.ndarray, grey: np.ndarray, twin: np.ndarray) -> np.ndarray:
    """Render two spheres in three channels, which do not mix, shape (row, column, channel)."""
    count = light.shape[-1]

    def three(values: np.ndarray) -> list[float]:
        return [*values.tolist(), *[0.0] * (3 - count)]

    padded = np.zeros((*light.shape[:2], 3), np.float32)
    padded[..., :count] = light
    transform = mitsuba.ScalarTransform4f()
    found = mitsuba.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 4},
            "sensor": {
                "type": "perspective",
                "fov": 34,
                "to_world": transform.look_at([0, 1.5, 7.5], [0, 0.85, 0], [0, 1, 0]),
                "film": {
                    "type": "hdrfilm",
                    "width": SPHERES[0],
                    "height": SPHERES[1],
                    "pixel_format": "rgb",
                },
                "sampler": {"type": "multijitter", "sample_count": SAMPLES},
            },
            "sky": {"type": "envmap", "bitmap": mitsuba.Bitmap(padded)},
            "floor": {
                "type": "disk",
                "to_world": transform.rotate([1, 0, 0], -90).scale(40),
                "bsdf": _paint(three(0.4 * np.ones(count))),
            },
            "grey": {
                "type": "sphere",
                "center": [1.15, 1, 0],
                "bsdf": _paint(three(grey)),
            },
            "twin": {"type": "sphere", "center": [-1.15, 1, 0], "bsdf": _paint(three(twin))},
        }
    )
    return np.array(mitsuba.render(found))[..., :count]


def _paint(reflectance: list[float]) -> dict[str, object]:
    return {"type": "diffuse", "reflectance": {"type": "rgb", "value": reflectance}}


if __name__ == "__main__":
    spheres()
