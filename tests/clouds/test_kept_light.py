"""The light of clouds on disk."""

import math
import weakref

import numpy as np
import pytest

from skybake.clouds import cloudscape, layer
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.image.stages import Stages
from skybake.jit import tables
from skybake.jit.arguments import flatten
from skybake.jit.cache import cache_folder, cache_usage
from skybake.preset import load_preset
from tests.clouds.tile_worlds import one_cloud, tile_world

ZENITH, AZIMUTH = np.radians([[20.0], [60.0], [85.0], [95.0]]), np.radians([[0.0, 100.0, 230.0]])


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    return load_preset(tile_world(tmp_path_factory.mktemp("world"), *one_cloud(3)))


@pytest.fixture(autouse=True)
def kept(tmp_path, monkeypatch):
    """Numbers of lights in a cache of its own, whose kernels are those of other tests."""
    above = cache_folder()
    folder = above.within(f"lights-{tmp_path.name}")
    monkeypatch.setattr(tables, "_folder", lambda: folder)
    yield lambda: sum(name.startswith("cloudlight-") for name in folder.names())
    for name in folder.names():
        folder.remove(name)
    (above.path / f"lights-{tmp_path.name}").rmdir()


def scene_of(world, *, sun=25.0, stages=None, **settings):
    given = map_settings(
        size=(64, 32),
        sun_elevation=math.radians(sun),
        method="hillaire",
        clouds_quality="draft",
        **settings,
    )
    return Scene(world, given, stages=stages)


def pixels(scene):
    return scene.evaluate(ZENITH, AZIMUTH, 0.02)


def test_light_that_is_kept_gives_the_same_pixels_and_is_not_solved_for_again(
    world, kept, monkeypatch
):
    first = scene_of(world)
    made = pixels(first)
    assert kept() == 1
    monkeypatch.setattr(cloudscape, "solve_layers", lambda *_: pytest.fail("solved for again"))
    monkeypatch.setattr(cloudscape, "build_table", lambda *_: pytest.fail("traced again"))
    again = scene_of(world)
    assert pixels(again).tobytes() == made.tobytes()
    for old, new in zip(first.cloudscape.solved, again.cloudscape.solved, strict=True):
        assert flatten(new.light).kinds == flatten(old.light).kinds


def test_another_exposure_and_colour_space_have_the_same_light(world, kept):
    made = pixels(scene_of(world))
    brighter = scene_of(world, units="nits")
    usual = scene_of(world).settings.encoding.white_luminance
    np.testing.assert_allclose(pixels(brighter), made * usual, rtol=1e-5)
    pixels(scene_of(world, colorspace="acescg"))
    assert kept() == 1


def test_what_is_seen_once_is_not_kept(world, kept):
    pixels(scene_of(world, stages=Stages(keeps_light_of_clouds=False)))
    assert kept() == 0


def test_another_sun_has_light_of_its_own_and_no_room_beside_it_for_older(world, kept, monkeypatch):
    tables.write_tables("atmosphere", {"values": np.zeros(1000)})
    pixels(scene_of(world))
    folder = tables._folder()
    (name,) = (each for each in folder.names() if each.startswith("cloudlight-"))
    monkeypatch.setattr(tables, "LARGEST_LIGHTS", int(1.5 * folder.used_at(name)[1]))
    pixels(scene_of(world, sun=26.0))
    assert kept() == 1
    assert not folder.has(name)
    assert folder.has("atmosphere.tables")


def test_light_on_disk_is_counted_apart(tmp_path, monkeypatch):
    monkeypatch.setenv("SKYBAKE_CACHE_DIR", str(tmp_path))
    folder = tmp_path / "kernels-0" / "atmospheres"
    folder.mkdir(parents=True)
    for name in ("a", "clouds-b", "cloudlight-c"):
        (folder / f"{name}.tables").write_bytes(b"123")
    (usage,) = cache_usage()
    assert (usage.atmospheres, usage.cloud_tiles, usage.cloud_lights) == (1, 1, 1)
    assert usage.total_bytes == 9


def test_light_of_one_sun_is_not_held_while_that_of_another_is_solved_for(world, monkeypatch):
    solve, before = layer.solve_diffuse, []

    def alone(*given):
        assert [each for each in before if each() is not None] == []
        solved = solve(*given)
        before.append(weakref.ref(solved.moments))
        return solved

    monkeypatch.setattr(layer, "solve_diffuse", alone)
    assert scene_of(world, sun=4.0).cloudscape.solved
    assert len(before) > 2
