"""The sun's disc in files, drawn larger, softer or stronger: its light by summing over texels."""

import math

import numpy as np
import pytest

from skybake.errors import InputError
from skybake.image.settings import Lighting
from tests.baking.maps import bake_map, luminance, pixels, texels

CUBE = {"projection": "cubemap", "size": 64, "sun_azimuth": 2.0}
SUNS = [
    (40.0, "exr", {"sun_size": math.radians(2.0)}),
    (3.0, "exr", {"sun_size": math.radians(12.0)}),
    (3.0, "hdr", {"sun_size": math.radians(2.0)}),
    (40.0, "exr", {"sun_soft": True}),
    (3.0, "exr", {"sun_soft": True, "ev": 10.0}),
    (40.0, "exr", {"sun_size": math.radians(0.1), "sun_strength": 0.5}),
    (40.0, "hdr", {"sun_soft": True, **CUBE}),
    (3.0, "exr", {"sun_size": math.radians(12.0), **CUBE}),
]


@pytest.mark.parametrize(("elevation", "suffix", "options"), SUNS)
def test_a_disc_of_any_size_has_the_light_of_the_sun(tmp_path, elevation, suffix, options):
    values = {"size": 512, "sun_disc": "only", "method": "hillaire"}
    true, _ = bake_map(tmp_path / f"true.{suffix}", elevation=elevation, **values)
    drawn, settings = bake_map(tmp_path / f"a.{suffix}", elevation=elevation, **values | options)
    _, size, light = texels(drawn, settings)
    expected = options.get("sun_strength", 1.0) * true.direct_normal_illuminance
    assert drawn.direct_normal_illuminance == pytest.approx(expected, rel=1e-9)
    # RGBE has steps of up to 1/128 of the largest channel, and these discs a few texels.
    assert size @ light == pytest.approx(expected, rel=2e-3 if suffix == "exr" else 1.0 / 256.0)


@pytest.mark.parametrize("ev", [15.0, 12.0, 8.0])
def test_a_soft_sun_fits_half_floats_with_its_light(tmp_path, ev):
    options = {"size": 2048, "ev": ev, "method": "hillaire", "sun_soft": True}
    baked, settings = bake_map(tmp_path / "a.exr", elevation=85.0, **options)
    assert baked.pixel == "half"
    assert pixels(baked.files[0]).max() <= 52000.0
    bare, _ = bake_map(tmp_path / "bare.exr", elevation=85.0, sun_disc="exclude", **options)
    _, size, light = texels(baked, settings)
    sky = luminance(bare.files[0], settings).ravel()
    assert size @ (light - sky) == pytest.approx(baked.direct_normal_illuminance, rel=2e-3)
    if ev < 15.0:
        hard, _ = bake_map(tmp_path / "hard.exr", elevation=85.0, **options | {"sun_soft": False})
        assert hard.pixel == "float"


def test_a_soft_sun_that_would_be_too_large_is_refused_before_anything_is_written(tmp_path):
    with pytest.raises(InputError, match="within 20deg, but would need more than all; let 1"):
        bake_map(tmp_path / "a.exr", units="nits", sun_soft=True)
    with pytest.raises(InputError, match=r"sun disc: a soft one must fit .* would need 6\ddeg"):
        bake_map(tmp_path / "a.exr", ev=3.0, sun_soft=True)
    assert list(tmp_path.iterdir()) == []


def test_strength_changes_the_sun_and_not_the_sky(tmp_path):
    options = {"size": 64, "method": "hillaire", "pixel": "float"}
    made = {}
    for name, values in {
        "plain": {},
        "weak": {"sun_strength": 0.25},
        "sky": {"sun_disc": "exclude"},
    }.items():
        baked, _ = bake_map(tmp_path / f"{name}.exr", **options | values)
        made[name] = pixels(baked.files[0]).astype(float)
    sun = made["plain"] - made["sky"]
    np.testing.assert_allclose(made["weak"] - made["sky"], 0.25 * sun, atol=1e-6 * sun.max())
    assert sun.max() > 100.0


@pytest.mark.parametrize(
    ("values", "fault"),
    [
        ({"sun_size": 0.0}, "sun size: .* got 0deg"),
        ({"sun_size": math.radians(20.5)}, "sun size: .* at most 20deg, got 20.5deg"),
        ({"sun_size": math.nan}, "sun size: .* got nandeg"),
        ({"sun_strength": 0.0}, "sun strength: .* got 0"),
        ({"sun_strength": math.inf}, "sun strength: .* got inf"),
    ],
)
def test_a_sun_that_cannot_be_is_refused(values, fault):
    with pytest.raises(InputError, match=fault):
        Lighting(**values)
