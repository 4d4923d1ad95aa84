"""Maps of the sky's polarisation, as other programs read them, and the sky through a filter."""

import math
import warnings
from dataclasses import replace

import numpy as np
import OpenEXR
import pytest

import skybake
from skybake.image.polarisation_picture import angle_colours, degree_colours
from skybake.image.sensor import Sensor
from skybake.sky.sky import Sky
from tests.cli.runs import invoke, listing

SUN = math.radians(30.0)
WAVELENGTHS = (450.0, 550.0, 650.0)
LUMINANCE = np.array([0.2126390, 0.7151687, 0.0721923]) * 1.2 * 2**15


def settings(size=64, **values):
    sensor = Sensor(**values.pop("sensor", {"stokes": True}))
    given = {"size": size, "sun_elevation": SUN, "pixel": "float"}
    return skybake.map_settings(sensor=sensor, **(given | values))


def channels(path):
    file = OpenEXR.File(str(path), separate_channels=True)
    return {name: channel.pixels for name, channel in file.channels().items()}, file.header()


def components(path):
    """S0 to S3 in R, G and B, shape (4, row, column, 3)."""
    found, _ = channels(path)
    return np.array([[found[f"S{i}.{name}"] for name in "RGB"] for i in range(4)]).transpose(
        0, 2, 3, 1
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Maps with and without the disc, and through two filters that are crossed."""
    folder = tmp_path_factory.mktemp("stokes")
    skybake.bake("earth", folder / "sky.exr", settings())
    skybake.bake("earth", folder / "bare.exr", settings(sun_disc="exclude"))
    for angle in (20.0, 110.0):
        sensor = {"polarizer": math.radians(angle)}
        skybake.bake("earth", folder / f"{angle:g}.exr", settings(sensor=sensor))
    return folder


def test_s0_is_the_map_and_s3_is_none(folder):
    found, header = channels(folder / "sky.exr")
    stokes = components(folder / "sky.exr")
    for i, name in enumerate("RGB"):
        assert (stokes[0, ..., i] == found[name]).all()
    assert (stokes[3] == 0.0).all()
    assert header["skybake:stokesReference"].startswith("toward the zenith")


def test_the_disc_is_unpolarised(folder):
    whole, bare = components(folder / "sky.exr"), components(folder / "bare.exr")
    assert (whole[0] > 10.0 * bare[0]).any()
    assert (whole[1:] == bare[1:]).all()


def test_the_halves_mirror_each_other_with_the_sign_of_s2_reversed(folder):
    stokes = components(folder / "sky.exr")
    mirrored = stokes[:, :, ::-1]
    assert stokes[1] == pytest.approx(mirrored[1], abs=1e-5)
    assert stokes[2] == pytest.approx(-mirrored[2], abs=1e-5)
    # In the east the sun is to the right of the view.
    assert np.abs(stokes[2]).max() > 0.01


@pytest.mark.parametrize(
    ("projection", "size"), [("equirect", 64), ("fisheye", 32), ("cubemap", 16)]
)
def test_pixels_are_the_stokes_vectors_of_the_sky_in_their_directions(tmp_path, projection, size):
    shown = settings(size, projection=projection, sun_disc="exclude")
    skybake.bake("earth", tmp_path / "sky.exr", shown)
    sky = Sky("earth", SUN)
    canvases = shown.view.projection.canvases()
    names = listing(tmp_path) if len(canvases) == 1 else [f"sky_{c.face}.exr" for c in canvases]
    for name, canvas in zip(names, canvases, strict=True):
        stokes = components(tmp_path / name) @ LUMINANCE
        (part,) = canvas.parts
        zenith, bearing = part.chart.angles(0, canvas.height)
        places = [(3 * canvas.height // 8, canvas.width // 3), (canvas.height // 4, -5)]
        for row, column in places:
            theta = np.broadcast_to(zenith, stokes.shape[1:])[row, column]
            phi = np.broadcast_to(bearing, stokes.shape[1:])[row, column]
            if theta > 1.5:
                continue
            view = [math.sin(theta) * math.sin(phi), math.cos(theta)]
            view.append(-math.sin(theta) * math.cos(phi))
            from skybake.image.luminous import luminous_weights

            per_irradiance = sky.stokes(np.array(view)) / sky.irradiance
            wanted = per_irradiance @ luminous_weights(sky)[:, 1]
            found = stokes[:, row, column]
            assert found == pytest.approx(wanted, abs=3e-3 * wanted[0])


def test_light_from_aside_of_the_sun_is_polarised_across_the_plane_of_scattering(folder):
    stokes = components(folder / "sky.exr") @ LUMINANCE
    # 90 degrees from the sun, above the horizon opposite to it: the first column, 60 deg high.
    row, column = 5, 0
    degree = math.hypot(stokes[1, row, column], stokes[2, row, column]) / stokes[0, row, column]
    assert 0.6 < degree < 0.9
    assert stokes[1, row, column] < -0.6 * stokes[0, row, column]


def test_crossed_filters_share_the_light_by_the_law_of_malus(folder):
    stokes = components(folder / "sky.exr")
    passed = []
    for angle in (20.0, 110.0):
        found, header = channels(folder / f"{angle:g}.exr")
        assert header["skybake:polarizer"] == pytest.approx(angle)
        passed.append(np.stack([found[name] for name in "RGB"], axis=-1))
        turn = 2.0 * math.radians(angle)
        wanted = stokes[0] + math.cos(turn) * stokes[1] + math.sin(turn) * stokes[2]
        assert passed[-1] == pytest.approx(0.5 * wanted, rel=1e-5, abs=1e-6)
    assert sum(passed) == pytest.approx(stokes[0], rel=1e-5, abs=1e-6)
    assert invoke("check", folder / "20.exr").exit_code == 0
    assert invoke("check", folder / "sky.exr").exit_code == 0


@pytest.mark.slow
def test_a_polarised_spectrum_is_in_the_layout(tmp_path):
    sensor = {"stokes": True, "wavelengths": WAVELENGTHS}
    skybake.bake("earth", tmp_path / "a.exr", settings(32, sensor=sensor))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from colour import read_spectral_image_Fichet2021

        found, specification = read_spectral_image_Fichet2021(
            str(tmp_path / "a.exr"), additional_data=True
        )
    assert specification.is_polarised
    assert sorted(found) == ["S0", "S1", "S2", "S3"]
    sky = Sky("earth", SUN, wavelengths=np.array(WAVELENGTHS))
    row, column = 3, 5
    elevation, bearing = math.pi * (0.5 - (row + 0.5) / 16), 2.0 * math.pi * (column + 0.5) / 32
    view = [math.cos(elevation) * math.sin(bearing), math.sin(elevation)]
    wanted = sky.stokes(np.array([*view, -math.cos(elevation) * math.cos(bearing)]))
    for i in range(3):
        wavelengths, values = found[f"S{i}"]
        order = np.argsort(wavelengths)
        share = values[row, column][order] / found["S0"][1][row, column][order]
        assert share == pytest.approx(wanted[i] / wanted[0], abs=5e-3)


@pytest.mark.parametrize(
    ("preset", "values", "problem"),
    [
        ("earth", {"method": "hillaire"}, "stokes: needs the method full"),
        ("earth", {"below_horizon": "extend"}, "stokes: needs ground or black"),
        ("earth", {"mips": True}, "must be without mips"),
    ],
)
def test_polarisation_that_is_not_known_is_refused_in_a_line(tmp_path, preset, values, problem):
    with pytest.raises(skybake.InputError, match=problem):
        skybake.bake(preset, tmp_path / "a.exr", settings(**values))
    assert listing(tmp_path) == []


@pytest.mark.slow
def test_light_from_a_deck_is_unpolarised_and_the_sky_above_it_is_not(tmp_path):
    deck = skybake.load_preset("earth-overcast")
    degrees = {}
    for name, planet, altitude in (
        ("beneath", deck, 0.0),
        ("above", deck, 12.0),
        ("clear", replace(deck, clouds=()), 12.0),
    ):
        shown = settings(32, altitude=altitude, sun_disc="exclude")
        baked = skybake.bake(planet, tmp_path / "a.exr", shown)
        assert any("clouds scatter" in line for line in baked.warnings) is bool(planet.clouds)
        stokes = components(tmp_path / "a.exr") @ LUMINANCE
        degrees[name] = np.hypot(stokes[1], stokes[2]) / stokes[0]
        assert degrees[name].max() <= 1.0
    assert degrees["beneath"][:7].max() < 5e-3
    # Clouds below brighten the sky above by light without polarisation.
    ratio = degrees["above"][:7] / degrees["clear"][:7]
    assert ratio.max() < 1.02
    assert np.median(ratio) > 0.7
    # Of what is seen of the deck itself, only the air before it is polarised.
    assert (degrees["above"][9:] < degrees["clear"][9:]).all()


def test_a_filter_leaves_no_components():
    with pytest.raises(skybake.InputError, match="polarizer: must be without stokes"):
        Sensor(stokes=True, polarizer=0.0)


@pytest.mark.slow
def test_constituents_without_a_matrix_are_named(tmp_path):
    planet = skybake.load_preset("mars")
    baked = skybake.bake(planet, tmp_path / "a.exr", settings(16))
    assert any("counts as unpolarised" in line and "dust" in line for line in baked.warnings)


@pytest.mark.parametrize("show", ["dop", "aop"])
def test_a_picture_shows_degree_or_angle(tmp_path, show):
    picture = skybake.PictureSettings(show=show)
    shown = settings(64, sensor={})
    skybake.bake("earth", tmp_path / "a.exr", shown, preview=tmp_path / "a.png", picture=picture)
    from PIL import Image

    codes = np.asarray(Image.open(tmp_path / "a.png")).astype(int)
    # Toward the sun there is hardly any, 90 degrees from it much, and the sky is horizontal there.
    sun, aside = codes[10, 32], codes[5, 0]
    if show == "dop":
        assert sun.max() < 40
        assert aside.max() > 200
    else:
        assert np.ptp(sun) < 25
        assert aside[2] > aside[0] + 100


def test_colours_of_angles_return_after_half_a_turn_and_degrees_get_lighter():
    whole = np.ones(2)
    first, last = angle_colours(np.array([-math.pi / 2, math.pi / 2]), whole)
    assert (first == last).all()
    luma = degree_colours(np.linspace(0.0, 1.0, 50)) @ np.array([0.2126, 0.7152, 0.0722])
    assert (np.diff(luma) > 0.0).all()
