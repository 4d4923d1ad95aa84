"""Every world within the documented ranges has light that is finite and at least 0, or is refused
at once for a documented limit."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from skybake.errors import PresetWarning, SkybakeError
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.optics.delta_m import scale_medium
from skybake.optics.medium import build_medium
from skybake.preset import load_preset
from skybake.preset.toml import toml_text
from skybake.projection.equirect import column_bearings, row_zeniths
from skybake.scattering.grid import ORDER
from skybake.scattering.limits import check_medium
from tests.baking.random_worlds import random_world

ROWS = 16
WAVELENGTHS = np.array([450.0, 550.0, 650.0])
FEW_WAVELENGTHS = (380.0, 493.0, 607.0, 720.0)
ELEVATIONS = (60.0, 5.0, -6.0)

QUICK = (3, 8, 35)
"""Thin ones, which are solved in seconds: with asymmetries at both ends of their range, in the
planet's shadow, and beside its edge, with air as high as the planet's radius, and with air so
shallow that twilight is short and ends at once."""


def sky(planet, elevation):
    """Luminance of a small map [cd/m2] and the illuminance by the sky [lx]."""
    settings = map_settings(sun_elevation=math.radians(elevation), colorspace="xyz", units="nits")
    scene = Scene(planet, settings)
    zenith, azimuth = row_zeniths(ROWS)[:, None], column_bearings(2 * ROWS)[None]
    pixels = scene.evaluate(zenith, azimuth, math.pi / ROWS)
    assert np.isfinite(pixels).all()
    return pixels @ scene.luminance, scene.sky_illuminance()


def load_world(folder, seed):
    path = folder / "world.toml"
    path.write_text(toml_text(random_world(seed)), encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PresetWarning)
        return load_preset(path)


def refusal_at_once(planet):
    """What `skybake presets check` says of a world that cannot be rendered, or None."""
    try:
        medium = build_medium(planet, WAVELENGTHS)
        check_medium(scale_medium(medium, ORDER))
    except SkybakeError as error:
        return str(error)
    return None


def check_light(folder, seed, wavelengths=None):
    planet = replace(load_world(folder, seed), wavelengths=wavelengths)
    if refusal_at_once(planet) is not None:
        return
    for elevation in ELEVATIONS:
        luminance, illuminance = sky(planet, elevation)
        assert luminance.min() >= -1e-6 * luminance.max()
        assert illuminance >= 0.0


@pytest.mark.slow
def test_few_random_worlds_are_refused_and_at_once_for_their_optical_depth(tmp_path):
    refusals = [refusal_at_once(load_world(tmp_path, seed)) for seed in range(200)]
    told = [refusal for refusal in refusals if refusal is not None]
    assert 0 < len(told) <= 0.05 * len(refusals)
    assert [refusal for refusal in told if "optical depth of the atmosphere" not in refusal] == []


@pytest.mark.parametrize("seed", QUICK)
def test_a_random_world_has_good_light_unless_it_is_refused_at_once(tmp_path, seed):
    check_light(tmp_path, seed, FEW_WAVELENGTHS)


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(200))
def test_each_of_two_hundred_random_worlds_has_good_light_unless_it_is_refused_at_once(
    tmp_path, seed
):
    check_light(tmp_path, seed)
