"""Makes the pictures of docs/aerial.md: ``python docs/make_aerial.py``, in five minutes.

A mountain range is drawn without any air, as a renderer does, and ``skybake aerial`` puts the air
into it. Needs Pillow.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenImageIO
from PIL import Image

from skybake.image.light import light_of_scene
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.projection import Perspective

FOLDER = Path(__file__).parent / "images"
WIDTH, HEIGHT = 1280, 720
EYE = 1200.0
"""Height of the camera. [m]"""

FOV, LOOK = math.radians(45.0), (math.radians(0.0), math.radians(-2.0))
NEAREST, FARTHEST = 300.0, 90_000.0
SUN = {"evening": (7.0, 70.0), "noon": (50.0, 150.0)}
"""Elevation and azimuth of suns. [deg]"""


def terrain(east: np.ndarray, north: np.ndarray) -> np.ndarray:
    """Heights of ridges that rise with the distance. [m]"""
    generator = np.random.default_rng(7)
    height = np.zeros(east.shape)
    size, amplitude = 14_000.0, 1500.0
    for _ in range(8):
        angle, shift = generator.uniform(0.0, math.pi, 3), generator.uniform(0.0, 1.0, 3)
        folds = 1.0
        for a, s in zip(angle, shift, strict=True):
            along = (east * math.cos(a) + north * math.sin(a)) / size + s
            folds = folds * (1.0 - np.abs(2.0 * (along - np.floor(along)) - 1.0))
        height += amplitude * np.sqrt(folds) * (1.0 if size > 9000 else height / 1500.0 + 0.25)
        size, amplitude = 0.5 * size, 0.48 * amplitude
    return height - 500.0 + 0.012 * np.minimum(north, 60_000.0)


def draw(sun: tuple[float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Light, coverage and planar depth [m] of the terrain, whose rays are marched."""
    camera = Perspective(WIDTH, HEIGHT, FOV, *LOOK)
    rays = camera.vectors()
    axis = np.array([0.0, math.sin(LOOK[1]), -math.cos(LOOK[1])])
    t = np.full((HEIGHT, WIDTH), NEAREST)
    hit = np.zeros(t.shape, bool)
    x, y, z = np.moveaxis(rays, -1, 0)
    for _ in range(420):
        above = EYE + t * y - terrain(t * x, -t * z)
        hit |= above <= 0.0
        t = np.where(hit | (t > FARTHEST), t, t + np.maximum(0.35 * above, 0.0012 * t))
    hit &= t < FARTHEST
    for _ in range(8):  # back to the surface
        above = EYE + t * y - terrain(t * x, -t * z)
        t = np.where(hit, t + 0.5 * above, t)
    east, north = t * x, -t * z
    step = np.maximum(0.0015 * t, 4.0)
    slope_east = (terrain(east + step, north) - terrain(east - step, north)) / (2.0 * step)
    slope_north = (terrain(east, north + step) - terrain(east, north - step)) / (2.0 * step)
    normal = np.stack([-slope_east, np.ones_like(t), slope_north], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    return shade(normal, terrain(east, north), sun) * hit[..., None], hit, t * (rays @ axis)


def shade(normal: np.ndarray, height: np.ndarray, sun: tuple[float, float]) -> np.ndarray:
    """Light of grass, rock and snow under the sun and an even sky, in the scale of a map."""
    elevation, azimuth = np.radians(sun)
    settings = map_settings(sun_elevation=elevation, sun_azimuth=azimuth, altitude=EYE / 1000.0)
    light = light_of_scene(Scene(load_preset("earth"), settings))
    white = settings.encoding.white_luminance
    facing = np.maximum(normal @ np.array(light.sun_direction), 0.0)[..., None]
    snow = np.clip((height - 1250.0) / 250.0, 0.0, 1.0) * (normal[..., 1] > 0.72)
    rock = np.clip((0.86 - normal[..., 1]) / 0.1, 0.0, 1.0)
    albedo = np.array([0.07, 0.09, 0.035]) * np.ones((*height.shape, 1))
    albedo = albedo + rock[..., None] * (np.array([0.2, 0.18, 0.16]) - albedo)
    albedo = albedo + snow[..., None] * (np.array([0.8, 0.82, 0.85]) - albedo)
    direct = facing * light.direct_normal_illuminance * np.array(light.sun_colour)
    blue = np.array([0.75, 1.0, 1.45])
    sky = (0.5 + 0.5 * normal[..., 1:2]) * light.sky_illuminance * blue
    return albedo * (direct + sky) / math.pi / white


def write(path: Path, light: np.ndarray, covered: np.ndarray, depth: np.ndarray) -> None:
    """Write what a renderer would: RGBA in half, Z in float."""
    spec = OpenImageIO.ImageSpec(WIDTH, HEIGHT, 5, "float")
    spec.channelnames = ("R", "G", "B", "A", "Z")
    spec.channelformats = (OpenImageIO.TypeDesc("half"),) * 4 + (OpenImageIO.TypeDesc("float"),)
    depth = np.where(covered, depth, np.inf)
    pixels = np.concatenate([light, covered[..., None], depth[..., None]], axis=2)
    output = OpenImageIO.ImageOutput.create(str(path))
    output.open(str(path), spec)
    output.write_image(pixels.astype(np.float32))
    output.close()


def main() -> None:
    """Draw the range in two lights, put the air into it, and show both."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        told = {
            "azimuth": 0,
            "elevation": math.degrees(LOOK[1]),
            "fov": math.degrees(FOV),
            "position": [0, EYE, 0],
        }
        (folder / "camera.json").write_text(json.dumps(told))
        for time, sun in SUN.items():
            write(folder / "in.exr", *draw(sun))
            command = [sys.executable, "-m", "skybake", "aerial", "-q", "--camera", "camera.json"]
            place = ["--sun", f"{sun[0]}deg", "--sun-azimuth", f"{sun[1]}deg"]
            files = ["--beauty", "in.exr", "--sky", "fill", "-o", "out.exr"]
            subprocess.run([*command, *place, *files], cwd=folder, check=True)
            for step, path in (("before", "in"), ("after", "out")):
                show = [sys.executable, "-m", "skybake", "preview", "-q", f"{path}.exr"]
                ev = {"evening": "12.2", "noon": "14.4"}[time]
                subprocess.run([*show, "--ev", ev], cwd=folder, check=True)
                picture = Image.open(folder / f"{path}.png").convert("RGB")
                picture.save(FOLDER / f"aerial_{time}_{step}.jpg", quality=88)


if __name__ == "__main__":
    main()
