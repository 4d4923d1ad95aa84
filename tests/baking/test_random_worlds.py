"""Every world within the documented ranges has light that is finite and at least 0, or is refused
in a line."""

import math
import warnings

import numpy as np
import pytest

from skybake.errors import PresetWarning, SkybakeError
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.preset.toml import toml_text
from skybake.projection.equirect import column_bearings, row_zeniths
from tests.baking.random_worlds import random_world

ROWS = 16
ELEVATIONS = (60.0, 5.0, -6.0)

QUICK = (0, 3, 5, 7, 8)
"""Thin ones, which are solved in a second or two: with asymmetries at both ends of their range, in
the planet's shadow, and beside its edge."""


def sky(planet, elevation):
    """Luminance of a small map [cd/m2] and the illuminance by the sky [lx]."""
    settings = map_settings(sun_elevation=math.radians(elevation), colorspace="xyz", units="nits")
    scene = Scene(planet, settings)
    zenith, azimuth = row_zeniths(ROWS)[:, None], column_bearings(2 * ROWS)[None]
    pixels = scene.evaluate(zenith, azimuth, math.pi / ROWS)
    assert np.isfinite(pixels).all()
    return pixels @ scene.luminance, scene.sky_illuminance()


def check_light(folder, seed):
    path = folder / "world.toml"
    path.write_text(toml_text(random_world(seed)), encoding="utf-8")
    refusal = None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PresetWarning)
        try:
            planet = load_preset(path)
            light = [sky(planet, elevation) for elevation in ELEVATIONS]
        except SkybakeError as error:
            refusal = str(error)
    if refusal is not None:
        assert len(refusal.splitlines()) == 1
        return
    for luminance, illuminance in light:
        assert luminance.min() >= -1e-6 * luminance.max()
        assert illuminance >= 0.0


@pytest.mark.parametrize("seed", QUICK)
def test_a_random_world_has_good_light_or_is_refused_in_a_line(tmp_path, seed):
    check_light(tmp_path, seed)


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(200))
def test_each_of_two_hundred_random_worlds_has_good_light_or_is_refused(tmp_path, seed):
    check_light(tmp_path, seed)
