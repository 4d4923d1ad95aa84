"""Every preset becomes a map."""

import numpy as np
import pytest

from skybake.preset import preset_names
from tests.baking.maps import bake_map, pixels


@pytest.mark.slow
@pytest.mark.parametrize("preset", preset_names())
def test_every_preset_renders_by_day_and_in_twilight(tmp_path, preset):
    means = []
    for elevation in (5.0, -4.0):
        baked, _ = bake_map(tmp_path / "a.exr", preset, elevation, size=256, pixel="float")
        image = pixels(baked.files[0])
        assert np.isfinite(image).all()
        means.append(float(image[:64].mean()))
    assert means[0] > means[1] > 0.0
