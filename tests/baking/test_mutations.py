"""A preset that was tampered with is refused in one line, or becomes a map of finite numbers."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings

from skybake.errors import PresetWarning, SkybakeError
from skybake.preset import load_preset
from skybake.preset.toml import toml_text
from tests.baking.maps import bake_map, pixels
from tests.preset.test_mutations import mutants


def bakes_finite_map_or_refuses(folder, preset, method, clouds_quality):
    path = folder / "own.toml"
    path.write_text(toml_text(preset), encoding="utf-8")
    refusal = None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PresetWarning)
        try:
            planet = load_preset(path)
            options = {"pixel": "float", "method": method, "clouds_quality": clouds_quality}
            bake_map(folder / "a.exr", planet, 5.0, size=16, **options)
        except SkybakeError as error:
            refusal = str(error)
    if refusal is None:
        assert np.isfinite(pixels(folder / "a.exr")).all()
    else:
        assert len(refusal.splitlines()) == 1
        assert refusal.strip()
        assert not (folder / "a.exr").exists()


@settings(max_examples=5)
@given(mutants())
def test_a_mutated_preset_is_refused_in_a_line_or_becomes_a_finite_map(tmp_path_factory, preset):
    bakes_finite_map_or_refuses(tmp_path_factory.mktemp("mutant"), preset, "hillaire", "draft")


@pytest.mark.slow
@settings(max_examples=200)
@given(mutants())
def test_two_hundred_mutated_presets_are_refused_or_become_finite_maps(tmp_path_factory, preset):
    bakes_finite_map_or_refuses(tmp_path_factory.mktemp("mutant"), preset, "full", "normal")
