"""Exposures of pictures: the same for a scene, however it is laid out."""

import math

import numpy as np
import pytest

from skybake.baking import bake
from skybake.baking.preview import legible_ev, preview_file
from skybake.colour.exposure import luminance_from_ev
from skybake.colour.space import find_colour_space
from skybake.image.settings import map_settings
from tests.baking.maps import pixels

REC709 = find_colour_space("lin_rec709")

SCENES = [
    ("earth", 5.0, 0.0),
    ("earth", 30.0, 400.0),
    ("mars", 0.0, 0.0),
]

WAYS = {
    "equirect": {"size": 256},
    "cross": {"projection": "cubemap", "size": 64, "layout": "cross"},
    "column": {"projection": "cubemap", "size": 64, "layout": "exr"},
    "faces": {"projection": "cubemap", "size": 32},
}


@pytest.mark.parametrize(("preset", "elevation", "altitude"), SCENES)
def test_one_scene_has_one_exposure_in_all_projections(tmp_path, preset, elevation, altitude):
    found = {}
    for way, options in WAYS.items():
        settings = map_settings(
            sun_elevation=math.radians(elevation), altitude=altitude, pixel="float", **options
        )
        path = tmp_path / f"{way}.exr"
        found[way] = bake(preset, path, settings, preview=path.with_suffix(".png")).preview_ev
        if path.exists():
            later = preview_file(path, tmp_path / "later.png")
            assert later == pytest.approx(found[way], abs=0.05)
    assert len(set(found.values())) == 1


@pytest.mark.parametrize("elevation", [20.0, 5.0])
def test_the_light_around_the_sun_of_mars_is_neither_white_nor_red(tmp_path, elevation):
    path = tmp_path / "a.png"
    settings = map_settings(sun_elevation=math.radians(elevation), size=512)
    bake("mars", tmp_path / "a.exr", settings, preview=path)
    codes = 255.0 * pixels(path)
    white = (codes.min(axis=-1) >= 250).mean()
    row = min(int((90.0 - elevation) / 180.0 * 256), 127)
    near = codes[row, 256 + round(2.0 / 360.0 * 512)]
    assert white < 1e-3
    assert near[2] >= near[0]
    # What is far from the sun still has a colour of its own, that of dust.
    far = codes[64, 0]
    assert far[0] > far[2] + 10.0


@pytest.mark.parametrize(
    "shape",
    [(1, 1), (1, 2), (2, 4), (96, 16), (6, 1), (30, 5), (3, 4), (96, 128), (513, 1026), (48, 48)],
)
def test_pictures_of_any_shape_are_exposed(shape):
    grey = np.full((*shape, 3), 0.5, np.float32)
    ev = legible_ev(grey, REC709, 140.0)
    assert 70.0 / luminance_from_ev(ev) == pytest.approx(0.36, rel=1e-6)
