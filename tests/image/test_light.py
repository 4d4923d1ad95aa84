"""What light a map holds, summed over its texels."""

import math

import numpy as np
import pytest

from skybake.image.light import attributes_from_light, light_from_attributes, light_of_scene
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from tests.baking.maps import bake_map, illuminance, pixels, texels
from tests.kernels import fill_ground_irradiance, fill_sun_column


@pytest.mark.parametrize("elevation", [60.0, 5.0])
@pytest.mark.parametrize("width", [64, 256, 1024, pytest.param(4096, marks=pytest.mark.slow)])
def test_disc_on_an_equirect_map_gives_the_direct_illuminance(tmp_path, width, elevation):
    baked, settings = bake_map(
        tmp_path / "a.exr", elevation=elevation, size=width, sun_disc="only", pixel="float"
    )
    assert illuminance(baked, settings) == pytest.approx(baked.direct_illuminance, rel=1e-3)


@pytest.mark.parametrize("preset", ["earth", "mars", "earth-hillaire2020"])
@pytest.mark.parametrize("elevation", [90.0, 30.0, 4.5])
def test_disc_on_a_map_of_every_world_gives_the_direct_illuminance(tmp_path, preset, elevation):
    baked, settings = bake_map(tmp_path / "a.exr", preset, elevation, sun_disc="only")
    assert illuminance(baked, settings) == pytest.approx(baked.direct_illuminance, rel=1e-3)


@pytest.mark.parametrize("projection", ["equirect", "cubemap"])
@pytest.mark.parametrize("elevation", [80.0, 30.0])
def test_disc_gives_the_normal_illuminance_however_it_is_mapped(tmp_path, projection, elevation):
    baked, settings = bake_map(
        tmp_path / "a.exr",
        elevation=elevation,
        size=512,
        projection=projection,
        sun_azimuth=0.7,
        sun_disc="only",
    )
    _, size, values = texels(baked, settings)
    assert values @ size == pytest.approx(baked.direct_normal_illuminance, rel=1e-3)


@pytest.mark.parametrize("elevation", [60.0, 20.0])
def test_disc_on_a_cubemap_gives_the_direct_illuminance(tmp_path, elevation):
    """A texel shines from its centre, so within the tangent of its size."""
    baked, settings = bake_map(
        tmp_path / "a.exr", elevation=elevation, size=1024, projection="cubemap", sun_disc="only"
    )
    assert illuminance(baked, settings) == pytest.approx(baked.direct_illuminance, rel=2e-3)


@pytest.mark.parametrize("projection", ["equirect", "cubemap"])
@pytest.mark.parametrize(
    ("preset", "elevation"),
    [
        ("earth", 60.0),
        ("earth", 5.0),
        ("earth", -4.0),
        ("mars", 30.0),
        ("earth-hillaire2020", 30.0),
    ],
)
def test_sky_on_a_map_gives_the_sky_illuminance(tmp_path, preset, elevation, projection):
    baked, settings = bake_map(
        tmp_path / "a.exr", preset, elevation, size=256, projection=projection, sun_disc="exclude"
    )
    # Mars' aureole has a peak narrower than a texel, which its centre may miss or overrate.
    tolerance = 0.03 if preset == "mars" else 0.005
    assert illuminance(baked, settings) == pytest.approx(baked.sky_illuminance, rel=tolerance)


def test_a_map_is_its_sky_and_its_sun(tmp_path):
    parts = {
        disc: pixels(bake_map(tmp_path / f"{disc}.exr", sun_disc=disc, pixel="float")[0].files[0])
        for disc in ("include", "exclude", "only")
    }
    together = parts["exclude"] + parts["only"]
    np.testing.assert_allclose(parts["include"], together, rtol=1e-6)
    assert (parts["only"] > 0.0).any()


def test_a_sun_that_has_set_leaves_no_disc(tmp_path):
    baked, _ = bake_map(tmp_path / "a.exr", elevation=-2.0, sun_disc="only")
    assert baked.direct_illuminance == baked.direct_normal_illuminance == 0.0
    assert (pixels(baked.files[0]) == 0.0).all()


def test_marching_gives_the_same_sun_and_less_sky(tmp_path):
    full, _ = bake_map(tmp_path / "full.exr")
    march, _ = bake_map(tmp_path / "march.exr", size=32, method="march")
    assert march.direct_illuminance == pytest.approx(full.direct_illuminance, rel=1e-3)
    assert 0.5 < march.sky_illuminance / full.sky_illuminance < 0.95


def solved_illuminance(scene):
    """Illuminance of the ground by sun and sky as the solver has it, in lx.

    Light scattered within forward peaks counts as the sun's there, so only the sum of
    both is what a map holds.
    """
    air = scene.sky.atmosphere
    medium = air.scaled.medium
    mu_s = math.sin(scene.sky.sun_elevation)
    column, sky = np.zeros(air.columns.shape[2]), np.empty(medium.ground_albedo.size)
    fill_ground_irradiance(air.field, mu_s, np.empty(4), sky)
    sees_sun = mu_s > 0.0 and fill_sun_column(
        air.columns, medium.r_bottom, medium.r_top, medium.r_bottom, mu_s, column
    )
    direct = mu_s * np.exp(-column @ medium.extinction) if sees_sun else 0.0
    luminous = scene.xyz_weights[:, 1]
    return float((direct + sky)[: luminous.size] @ luminous)


@pytest.mark.parametrize(
    "elevation",
    [60.0, *(pytest.param(each, marks=pytest.mark.slow) for each in (10.0, -2.0, -6.0)), 2.0, -9.0],
)
@pytest.mark.parametrize("preset", ["earth", "mars"])
def test_light_of_a_map_is_the_solvers_own_within_half_a_percent(tmp_path, preset, elevation):
    baked, settings = bake_map(
        tmp_path / "a.exr", preset, elevation, size=512, units="nits", pixel="float"
    )
    scene = Scene(load_preset(preset), map_settings(sun_elevation=math.radians(elevation)))
    assert illuminance(baked, settings) == pytest.approx(solved_illuminance(scene), rel=0.005)


def test_light_of_a_file_is_the_same_however_numpy_prints_numbers():
    attributes = attributes_from_light(light_of_scene(Scene(load_preset("earth"), map_settings())))
    plain = light_from_attributes(attributes)
    with np.printoptions(legacy="1.13"):
        assert light_from_attributes(attributes) == plain
