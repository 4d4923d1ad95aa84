"""Shots by name, and that what they show from orbit is what paths of light bring."""

import functools
import math

import numpy as np
import pytest

from skybake.angles import direction_from_angles
from skybake.errors import InputError
from skybake.image.aim import Aim, Lookout, aimed
from skybake.image.raster import Raster
from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.jit.arguments import flatten
from skybake.preset import load_preset
from skybake.projection import Perspective
from skybake.sky.pixels import allocate_pixels, fill_directions
from skybake.sky.spectral_table import fold_table
from skybake.sky.table import horizon_angles
from tests.skies import truth_skylight
from tests.truth import TRUTH_WAVELENGTHS, load_truth

ORBIT = 400.0


def looked(name, azimuth=None, *, altitude=ORBIT, elevation=-0.3, size=(160, 90), **options):
    lookout = Lookout(load_preset("earth"), altitude, 1.0, elevation)
    return aimed(Aim(name, azimuth), lookout, size, **options)


def pixels(picture, altitude, **settings):
    (canvas,) = picture.canvases()
    made = map_settings(picture, altitude=altitude, **settings)
    return Raster(Scene(load_preset("earth"), made), canvas).rows(0, picture.height)


@pytest.mark.parametrize(
    "sun",
    [
        pytest.param(60.0, marks=pytest.mark.slow),
        pytest.param(30.0, marks=pytest.mark.slow),
        10.0,
        2.0,
        0.0,
    ],
)
def test_pixels_from_orbit_are_those_of_the_path_tracer(sun):
    """Within 1 % beyond three standard errors, over the disc and at the limb, except in its night.

    That is darker than a ten thousandth of the brightest place.
    """
    truth = load_truth("EARTH_A")
    rows = truth[(truth["altitude_km"] == ORBIT) & (truth["sun_elevation_deg"] == sun)]
    rows = rows[rows["radiance"] > 1e-4 * rows["radiance"].max()]
    skylight = truth_skylight("EARTH_A", sun, ORBIT)
    (source,) = skylight.sources
    table = fold_table(skylight.spectral_table(source), skylight.basis, np.eye(3))

    @functools.cache
    def pixel(azimuth, elevation):
        (canvas,) = Perspective(3, 3, math.radians(0.03), azimuth, elevation).canvases()
        (part,) = canvas.parts
        zenith, around = part.chart.angles(1, 2)
        out = np.empty((1, 1, 3), np.float32)
        middle = [flatten(each[:, 1:2].copy()) for each in (zenith, around)]
        extent = flatten(part.chart.footprints(1, 2)[:, 1:2].copy())
        fill_directions(flatten(table), *middle, extent, 0, 1, allocate_pixels(table, 1), out)
        return out[0, 0]

    errors = np.empty(len(rows))
    for k, row in enumerate(rows):
        azimuth = math.radians(row["relative_azimuth_deg"])
        elevation = math.radians(90.0 - row["view_zenith_deg"])
        channel = int(np.argmin(np.abs(TRUTH_WAVELENGTHS - row["wavelength_nm"])))
        noise = 3.0 * row["stderr"] / row["radiance"]
        errors[k] = abs(pixel(azimuth, elevation)[channel] / row["radiance"] - 1.0) - noise
    assert len(errors) > 10
    assert errors.max() < 0.01


def test_the_middle_is_what_a_name_says():
    zenith_first, horizon = horizon_angles(6371.0 + ORBIT, 6371.0, 6471.0)
    assert looked("sun").azimuth == 1.0
    assert looked("sun").elevation == -0.3
    edge = looked("limb", 2.0)
    assert edge.azimuth == 2.0
    assert edge.elevation == pytest.approx(math.pi / 2 - horizon, abs=1e-3)
    assert looked("horizon").azimuth == 1.0
    assert looked("horizon", altitude=0.0).elevation == pytest.approx(0.0, abs=1e-4)
    assert looked("planet").elevation == -math.pi / 2
    assert zenith_first < horizon


@pytest.mark.parametrize("size", [(160, 90), (90, 160), (100, 100)])
@pytest.mark.parametrize("altitude", [2000.0, 36_000.0])
def test_all_of_the_planet_is_in_its_picture_and_fills_it(size, altitude):
    picture = looked("planet", size=size, altitude=altitude)
    first, _ = horizon_angles(6371.0 + altitude, 6371.0, 6471.0)
    (canvas,) = picture.canvases()
    (part,) = canvas.parts
    row, column = part.chart.places(
        direction_from_angles(np.radians([0, 90, 180]), math.pi / 2 - first)
    )
    assert np.isfinite(row).all()
    reach = max(
        abs(row - 0.5 * size[1]).max() / size[1], abs(column - 0.5 * size[0]).max() / size[0]
    )
    assert 0.45 < reach < 0.5


def test_the_sun_in_the_east_lights_the_right_half_of_a_planet_with_north_up():
    picture = looked("planet", altitude=36_000.0)
    light = pixels(picture, 36_000.0, sun_elevation=0.0, sun_azimuth=math.pi / 2).sum(axis=(0, 2))
    assert light[80:].sum() > 50.0 * light[:80].sum()


@pytest.mark.parametrize(
    ("name", "altitude", "problem"),
    [
        ("limb", 2.0, "look: limb needs a camera above the atmosphere, 100 km, got 2 km"),
        ("planet", 0.0, "look: planet needs a camera above the atmosphere"),
        ("planet", 120.0, "must fit into a picture 170 deg wide"),
    ],
)
def test_what_is_not_to_be_seen_from_below_is_refused(name, altitude, problem):
    with pytest.raises(InputError, match=problem):
        looked(name, altitude=altitude)


def test_limb_and_terminator_are_as_smooth_as_pixels_of_finer_pictures_are_on_average():
    """No stairs: each pixel is the mean of the 25 of a finer picture in its place."""
    picture = looked("limb", elevation=math.radians(-5), fov=math.radians(8), altitude=36_000.0)
    light = {"sun_elevation": math.radians(-5), "sun_azimuth": 1.0 + math.pi / 3}
    coarse = pixels(picture, 36_000.0, **light)
    fine = pixels(picture.finer(5), 36_000.0, **light)
    mean = fine.reshape(90, 5, 160, 5, 3).mean(axis=(1, 3))
    assert np.abs(coarse - mean).max() < 0.02 * mean.max()
