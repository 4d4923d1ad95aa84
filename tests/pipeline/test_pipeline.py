"""What stays hot: a change computes only the stages that it touches."""

import math
import threading
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

import skybake
from skybake.errors import CancelledError
from skybake.jit.kernel import Kernel
from skybake.jit.workers import Workers
from skybake.projection import Cubemap, Equirect, Perspective
from tests.cli.cloudy import few_voxels

PLAIN = skybake.map_settings(size=64, sun_elevation=math.radians(20.0))


@pytest.fixture
def rays(monkeypatch):
    """Counts the calls of kernels, of which `trace` follows rays."""
    counts = Counter()
    call = Kernel.__call__

    def counted(kernel, *arguments):
        counts[kernel.py_func.__name__] += 1
        return call(kernel, *arguments)

    monkeypatch.setattr(Kernel, "__call__", counted)
    return counts


def changed(part, **values):
    return replace(PLAIN, **{part: replace(getattr(PLAIN, part), **values)})


@pytest.mark.parametrize(
    "settings",
    [
        changed("encoding", colorspace="acescg"),
        changed("encoding", units="nits"),
        changed("encoding", ev=9.0),
        changed("lighting", sun_disc="exclude"),
        changed("lighting", sun_azimuth=1.0),
        changed("view", projection=Cubemap(16)),
        changed("view", projection=Perspective(32, 16)),
    ],
)
def test_another_colour_scale_or_projection_takes_no_ray_from_a_hot_pipeline(rays, settings):
    pipeline = skybake.Pipeline()
    pipeline.image("earth", PLAIN)
    assert rays["trace"] > 0
    rays.clear()
    image = pipeline.image("earth", settings)
    assert rays["trace"] == 0
    cold = skybake.Pipeline().image("earth", settings)
    np.testing.assert_array_equal(image.pixels, cold.pixels)
    assert image.metadata == cold.metadata


def test_a_preview_of_another_exposure_takes_no_ray_and_no_new_table(rays):
    pipeline = skybake.Pipeline()
    pipeline.picture("earth", PLAIN, width=64)
    rays.clear()
    dark = pipeline.picture("earth", PLAIN, width=64, picture=skybake.PictureSettings(ev=16.0))
    bright = pipeline.picture("earth", PLAIN, width=64, picture=skybake.PictureSettings(ev=12.0))
    assert set(rays) == {"fill_directions", "fill_sight_columns"}
    assert dark.mean() < bright.mean()


def test_another_sun_traces_rays_and_solves_nothing(rays):
    pipeline = skybake.Pipeline()
    pipeline.image("earth", PLAIN)
    rays.clear()
    pipeline.image("earth", changed("lighting", sun_elevation=0.1))
    assert rays["trace"] > 0
    # Of the solver alone.
    assert rays["fill_each"] == 0


def test_what_was_not_asked_for_longest_is_forgotten_first(rays):
    pipeline = skybake.Pipeline(keep=2)
    suns = [changed("lighting", sun_elevation=angle) for angle in (0.1, 0.2, 0.3)]
    for settings in suns:
        pipeline.image("earth", settings)
    rays.clear()
    nits = replace(PLAIN.encoding, units="nits")
    for settings in suns[1:]:
        pipeline.image("earth", replace(settings, encoding=nits))
    assert rays["trace"] == 0
    pipeline.image("earth", replace(suns[0], encoding=nits))
    assert rays["trace"] > 0


def test_progress_names_the_stages_and_ends_each_at_one():
    heard = []
    skybake.Pipeline().image("earth", PLAIN, progress=lambda *news: heard.append(news))
    assert list(dict.fromkeys(stage for stage, _ in heard)) == ["atmosphere", "sky", "pixels"]
    for stage in ("atmosphere", "sky", "pixels"):
        shares = [share for name, share in heard if name == stage]
        assert shares == sorted(shares)
        assert shares[-1] == 1.0


def test_a_world_with_clouds_has_a_stage_more(tmp_path):
    few_voxels(tmp_path)
    heard = []
    world = tmp_path / "cloudy.toml"
    world.write_text('extends = "earth"\n[clouds.own]\ntile = "cloud.npz"\nbase_km = 1.0\n')
    skybake.Pipeline().image(world, PLAIN, progress=lambda *news: heard.append(news))
    assert list(dict.fromkeys(heard)) == [
        (stage, share)
        for stage in ("atmosphere", "sky", "clouds", "pixels")
        for share in (0.0, 1.0)
        if (stage, share) != ("pixels", 0.0)
    ]


@pytest.mark.parametrize("stage", ["atmosphere", "sky", "pixels"])
@pytest.mark.parametrize("count", [1, 2])
def test_work_is_cancelled_from_another_thread_and_can_be_asked_for_again(stage, count):
    pipeline = skybake.Pipeline(workers=Workers(count))
    large = changed("view", projection=Equirect(2048))
    cancel = threading.Event()

    def stop(now, _share):
        if now == stage:
            thread = threading.Thread(target=cancel.set)
            thread.start()
            thread.join()

    with pytest.raises(CancelledError):
        pipeline.image("earth", large, progress=stop, cancel=cancel)
    image = pipeline.image("earth", PLAIN)
    np.testing.assert_array_equal(image.pixels, skybake.Pipeline().image("earth", PLAIN).pixels)


def test_threads_that_ask_for_one_sky_share_its_rays(rays):
    pipeline = skybake.Pipeline(workers=Workers(1))
    images = []
    threads = [
        threading.Thread(target=lambda: images.append(pipeline.image("earth", PLAIN)))
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    shared = rays["trace"]
    rays.clear()
    skybake.Pipeline(workers=Workers(1)).image("earth", PLAIN)
    assert shared == rays["trace"]
    for image in images[1:]:
        np.testing.assert_array_equal(image.pixels, images[0].pixels)


def test_an_image_is_what_a_file_holds(tmp_path):
    from skybake.formats.reader import read_image

    settings = replace(PLAIN, encoding=replace(PLAIN.encoding, pixel="float"))
    skybake.bake("mars", tmp_path / "a.exr", settings)
    pixels, attributes = read_image(tmp_path / "a.exr")
    image = skybake.Pipeline().image("mars", settings)
    np.testing.assert_array_equal(np.asarray(image), pixels)
    for name in ("skybake:recipe", "skybake:preset", "skybake:recipeHash"):
        assert image.metadata[name] == attributes[name]
    name = "skybake:sunDirection"
    np.testing.assert_allclose(image.metadata[name], attributes[name], atol=1e-7)
