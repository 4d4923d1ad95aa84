"""How much work is done, in counts, which no other load on the machine changes."""

import math
from collections import Counter

import pytest

import skybake
from skybake.jit.arguments import Flat
from skybake.jit.kernel import Kernel
from skybake.optics.medium import build_medium
from skybake.scattering.atmosphere import build_atmosphere
from skybake.sky.sky import WAVELENGTHS


@pytest.fixture
def work(monkeypatch):
    """Counts what kernels are asked for: calls by name, fans, their samples, and pixels."""
    counts = Counter()
    call = Kernel.__call__

    def counted(kernel, *arguments):
        result = call(kernel, *arguments)
        name = kernel.py_func.__name__
        counts[name] += 1
        if name == "trace":
            fans = result - arguments[4]
            counts["fans"] += fans
            counts["samples"] += int(_plain(arguments[6]).number[:fans].sum())
        elif name == "add_diffuse":
            counts["fans scattered"] += arguments[6] - arguments[5]
        elif name == "fill_directions":
            rows, columns, _ = arguments[-1].shape
            counts["pixels"] += rows * columns
        return result

    monkeypatch.setattr(Kernel, "__call__", counted)
    return counts


def _plain(argument):
    return argument.value if isinstance(argument, Flat) else argument


def baked(folder, preset="earth", sun=5.0, **settings):
    settings = skybake.map_settings(sun_elevation=math.radians(sun), **settings)
    skybake.bake(preset, folder / "sky.exr", settings)


@pytest.mark.parametrize(
    ("settings", "pixels"),
    [
        ({"size": 1024}, 1024 * 512),
        ({"size": 256, "projection": "cubemap"}, 6 * 256 * 256),
    ],
)
def test_each_pixel_is_evaluated_once(tmp_path, work, settings, pixels):
    """But for 180,000 by which illuminance and pixel type are found, of every map."""
    baked(tmp_path, **settings)
    assert pixels < work["pixels"] < pixels + 200_000
    assert work["fill_directions"] < 150


@pytest.mark.parametrize(
    ("preset", "sun", "altitude", "fans", "samples"),
    [
        ("earth", 5.0, 0.0, 240, 12_200),
        ("mars", 5.0, 0.0, 240, 12_000),
        ("earth", -12.0, 0.0, 240, 12_200),
        ("earth", 5.0, 400.0, 360, 37_200),
    ],
)
def test_a_sky_takes_few_rays(tmp_path, work, preset, sun, altitude, fans, samples):
    baked(tmp_path, preset, sun, size=64, altitude=altitude)
    work.clear()
    baked(tmp_path, preset, sun, size=64, altitude=altitude)
    assert work["fans"] <= 1.1 * fans
    assert work["samples"] <= 1.1 * samples
    assert sum(work[name] for name in ("trace", "add_single_scattering", "add_diffuse")) < 150


@pytest.mark.parametrize(
    ("preset", "scattered"), [("earth", 4900), pytest.param("mars", 6900, marks=pytest.mark.slow)]
)
def test_a_solution_takes_few_passes(work, preset, scattered):
    # The shortest and the longest take the most and the fewest passes.
    few = WAVELENGTHS[[0, 5, 10, 15]]
    build_atmosphere(build_medium(skybake.load_preset(preset), few), "full")
    assert work["fans scattered"] <= 1.1 * scattered
