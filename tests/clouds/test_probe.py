"""Radiances of single rays below, above and within clouds, as `probe` tells them."""

import math

import numpy as np
import pytest

from skybake.clouds.build import build_cloudscape
from skybake.clouds.cloudscape import unit_vectors
from skybake.image.luminous import luminous_weights
from skybake.jit.workers import Workers
from skybake.preset import load_preset
from skybake.sky.sky import Sky
from tests.cli.runs import run
from tests.clouds.tile_worlds import one_cloud, tile_world

VIEWS = ((0, 0), (40, 90), (40, -90), (60, 30), (60, 180), (80, 20), (75, -100), (95, -40))
OPTIONS = ("--sun", "40deg", "--sun-azimuth", "70deg")
FEW = ("--wavelengths", "550,440", "--per-irradiance")


@pytest.fixture
def views(tmp_path):
    path = tmp_path / "views.csv"
    rows = [f"{zenith},{azimuth}" for zenith, azimuth in VIEWS]
    path.write_text("\n".join(("view_zenith_deg,relative_azimuth_deg", *rows)) + "\n")
    return path


def probed(world, views, *arguments):
    """What `probe` prints, as text and as an array of its numbers."""
    status, output, errors = run(
        "probe", "--preset", world, *OPTIONS, "--directions", views, *arguments
    )
    assert (status, errors) == (0, "")
    return output, np.array([row.split(",") for row in output.splitlines()[1:]], float)


@pytest.fixture
def world(tmp_path):
    return tile_world(tmp_path, *one_cloud(), origin=(2.0, 2.0))


def test_it_tells_what_python_does_clockwise_from_the_suns_bearing(world, views):
    _, told = probed(world, views, *FEW, "--clouds-quality", "normal")
    planet = load_preset(world)
    wavelengths = np.array([550.0, 440.0])
    sun = math.radians(70.0)
    sky = Sky(planet, math.radians(40.0), 0.0, sun_azimuth=sun, wavelengths=wavelengths)
    cloudscape = build_cloudscape(planet.clouds, sky, np.eye(2), workers=Workers(1))
    zenith, azimuth = np.radians(VIEWS).T
    expected = cloudscape.radiance(unit_vectors(zenith, sun + azimuth))
    np.testing.assert_allclose(told[:, 2:], expected, rtol=2e-6)
    # Left and right differ.
    assert told[1, 2] != pytest.approx(told[2, 2], rel=0.02)


def test_a_layer_without_cover_leaves_the_clear_sky_to_the_byte(views):
    common = ("--illuminance", "--method", "hillaire")
    clear, _ = probed("earth-hillaire2020", views, *common)
    covered, _ = probed("earth-hillaire2020", views, *common, "--clouds", "cumulus:0")
    assert covered == clear


@pytest.mark.slow
def test_the_fast_method_agrees_with_the_path_tracer(world, views):
    _, fast = probed(world, views, *FEW)
    _, traced = probed(world, views, *FEW, "--method", "reference", "--samples", "6000")
    for fast_column, column in ((2, 2), (3, 4)):
        mean, stderr = traced[:, column], traced[:, column + 1]
        off = fast[:, fast_column] / mean - 1.0
        assert np.median(stderr / mean) < 0.02
        assert np.all(np.abs(off) < 0.06 + 4.0 * stderr / mean), off


def test_single_scattering_alone_is_refused_where_there_are_clouds(world, views):
    status, output, errors = run(
        "probe", "--preset", world, *OPTIONS, "--directions", views, "--method", "march"
    )
    assert (status, output) == (1, "")
    assert "clouds: method must be full or hillaire, got march" in errors
    assert errors.count("\n") == 1


def test_luminance_under_clouds_is_that_of_its_spectrum(tmp_path, views):
    world = tile_world(tmp_path, *one_cloud(1), extends="earth", origin=(2.0, 2.0))
    output, told = probed(world, views, "--method", "hillaire")
    names = output.splitlines()[0].split(",")
    planet = load_preset(world)
    sky = Sky(planet, math.radians(40.0), 0.0, method="hillaire")
    columns = [names.index(f"radiance_{each:g}nm") for each in sky.wavelengths]
    xyz = (told[:, columns] / sky.irradiance) @ luminous_weights(sky)
    # Voxels' light of all wavelengths is that of three channels, whose ground and air are means.
    np.testing.assert_allclose(told[:, names.index("luminance_cd_m2")], xyz[:, 1], rtol=5e-3)
    share = xyz[:, 0] / xyz.sum(axis=1)
    np.testing.assert_allclose(told[:, names.index("chromaticity_x")], share, atol=2e-3)
