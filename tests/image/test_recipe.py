"""A file's recipe holds what was set, and makes the same map again."""

import json

import numpy as np

from skybake.baking import bake
from skybake.formats.reader import read_attributes
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.preset.toml import toml_text
from tests.baking.maps import pixels

SETTINGS = map_settings(size=32, method="hillaire", pixel="float")


def test_the_recipe_of_a_changed_world_makes_the_same_map_again(tmp_path):
    changes = {"aerosol.optical_depth": 0.3, "ozone": "none", "ground.albedo": "mars_arabia"}
    bake(load_preset("earth", changes), tmp_path / "a.exr", SETTINGS)
    recipe = json.loads(read_attributes(tmp_path / "a.exr")["skybake:recipe"])["preset"]
    assert recipe.pop("set") == {
        "constituents.aerosol.optical_depth": 0.3,
        "constituents.ozone": "none",
        "ground.albedo": "mars_arabia",
    }
    (tmp_path / "again.toml").write_text(toml_text(recipe), encoding="utf-8")
    bake(tmp_path / "again.toml", tmp_path / "b.exr", SETTINGS)
    bake("earth", tmp_path / "plain.exr", SETTINGS)
    first, again, plain = (pixels(tmp_path / f"{name}.exr") for name in ("a", "b", "plain"))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first / plain - 1.0).max() > 0.05
