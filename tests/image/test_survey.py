"""Light that cannot be is refused before a file is written."""

import math
import warnings

import numpy as np
import pytest

from skybake.errors import PresetWarning, UnsolvableError
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.image.stages import Stages
from skybake.preset import load_preset
from skybake.preset.toml import toml_text
from tests.baking.maps import bake_map
from tests.baking.random_worlds import random_world

PRESET = "earth-hillaire2020"


@pytest.fixture
def spoil(monkeypatch):
    """Pass the table of every sky through a function of its values."""
    fold = Stages.folded_table

    def spoil(change):
        def folded(self, sky, rgb_weights, *, finely=False):
            table = fold(self, sky, rgb_weights, finely=finely)
            return table._replace(values=change(table.values))

        monkeypatch.setattr(Stages, "folded_table", folded)

    return spoil


def scene():
    settings = map_settings(sun_elevation=0.3, units="nits", method="hillaire")
    return Scene(load_preset(PRESET), settings)


def zenith(made):
    return made.evaluate(np.zeros((1, 1)), np.zeros((1, 1)), 1e-9)[0, 0]


@pytest.mark.parametrize(
    ("factor", "fault"), [(-1.0, r"luminance must be at least 0 .*got -\d"), (math.nan, "finite")]
)
def test_negative_or_undefined_light_is_refused_in_a_line_without_a_file(
    tmp_path, spoil, factor, fault
):
    spoil(lambda values: values * np.float32(factor))
    with pytest.raises(UnsolvableError, match=fault) as caught:
        bake_map(tmp_path / "a.exr", PRESET, method="hillaire")
    assert len(str(caught.value).splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_light_below_0_by_rounding_is_none(spoil):
    lit = zenith(scene())
    spoil(lambda values: values * np.float32(-1e-16))
    assert (lit > 0.0).all()
    np.testing.assert_array_equal(zenith(scene()), 0.0)
    assert scene().sky_illuminance() == 0.0


@pytest.mark.parametrize(
    "seed",
    [16, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (22, 24, 116))],
)
def test_a_sharp_shadow_in_thin_air_leaves_light_that_is_not_negative(tmp_path, seed):
    """Few azimuths ring there, and cubics swing below 0 between rays that are not: where they swing
    too far the table is linear."""
    path = tmp_path / "world.toml"
    path.write_text(toml_text(random_world(seed)), encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PresetWarning)
        planet = load_preset(path)
    settings = map_settings(sun_elevation=math.radians(-6.0), colorspace="xyz", units="nits")
    made = Scene(planet, settings)
    assert (made.survey[..., 1].min() < 0.0) == (seed in (16, 24))
    assert made.table.is_linear == (seed == 22)
    zenith = np.linspace(0.0, math.pi, 180)[:, None]
    shown = made.evaluate(zenith, np.linspace(0.0, math.pi, 90)[None], 1e-9)[..., 1]
    assert shown.min() >= 0.0
    assert made.sky_illuminance() > 0.0


def test_a_pixel_between_nodes_that_swings_below_0_beside_bright_ones_is_black(monkeypatch):
    """The survey sees only some of the pixels that a map has."""
    evaluate = Scene._evaluate

    def swing(self, table, zenith, azimuth, footprint):
        pixels = evaluate(self, table, zenith, azimuth, footprint)
        if pixels.shape[0] == 1:
            pixels *= -1.0
        return pixels

    monkeypatch.setattr(Scene, "_evaluate", swing)
    np.testing.assert_array_equal(zenith(scene()), 0.0)
