"""Exposures of pictures: the same for a scene, however it is laid out."""

import math

import numpy as np
import pytest

from skybake.baking import bake
from skybake.baking.preview import preview_file
from skybake.colour.exposure import luminance_from_ev
from skybake.colour.space import find_colour_space, luminance_weights
from skybake.errors import InputError
from skybake.formats.reader import read_attributes
from skybake.image.meter import scene_ev
from skybake.image.picture_settings import PictureSettings, shot
from skybake.image.settings import map_settings
from skybake.pipeline import Pipeline
from skybake.projection.equirect import solid_angles
from tests.baking.maps import pixels
from tests.formats.maps import write_map

REC709 = find_colour_space("lin_rec709")

SCENES = [
    ("earth", 5.0, 0.0),
    ("earth", 30.0, 400.0),
    ("mars", 0.0, 0.0),
]

WAYS = {
    "poles": {"size": 256, "rows": "poles"},
    "angular": {"projection": "angular", "size": 256},
    "octahedral": {"projection": "octahedral", "size": 256},
    "upright": {"projection": "cubemap", "size": 64, "layout": "vertical-cross"},
    "equirect": {"size": 256},
    "cross": {"projection": "cubemap", "size": 64, "layout": "cross"},
    "column": {"projection": "cubemap", "size": 64, "layout": "exr"},
    "faces": {"projection": "cubemap", "size": 32},
}


@pytest.mark.slow
@pytest.mark.parametrize(("preset", "elevation", "altitude"), SCENES)
def test_one_scene_has_one_exposure_in_all_projections(tmp_path, preset, elevation, altitude):
    found = {}
    for way, options in WAYS.items():
        settings = map_settings(
            sun_elevation=math.radians(elevation), altitude=altitude, pixel="float", **options
        )
        path = tmp_path / f"{way}.exr"
        found[way] = bake(preset, path, settings, preview=path.with_suffix(".png")).preview_ev
        if path.exists():
            later = preview_file(path, tmp_path / "later.png").ev
            assert later == pytest.approx(found[way], abs=0.05)
    assert len(set(found.values())) == 1


FIGURES = [
    *(("earth", *pair) for pair in ((60, 13.3), (30, 13.1), (15, 12.7), (5, 11.7), (0, 9.5))),
    *(("mars", *pair) for pair in ((60, 12.7), (30, 12.3), (15, 11.8), (5, 10.6), (0, 9.2))),
]


@pytest.mark.parametrize(("preset", "elevation", "ev"), FIGURES)
def test_daylight_is_exposed_as_photographers_do(tmp_path, preset, elevation, ev):
    assert show(tmp_path, preset, elevation).preview_ev == pytest.approx(ev, abs=0.25)


LOOKS = [(preset, sun) for preset in ("earth", "mars") for sun in (60, 30, 3, 0, -4, -9)]


@pytest.mark.parametrize(("preset", "elevation"), LOOKS)
def test_the_sky_on_screen_is_as_bright_as_on_photographs(tmp_path, preset, elevation):
    """The median over solid angle above the horizon, of what a screen emits of white."""
    show(tmp_path, preset, elevation)
    emitted = on_screen(tmp_path / "a.png")[:64]
    weights = np.repeat(solid_angles(256, 128)[:64, None], 256, axis=1)

    order = np.argsort(emitted, axis=None)
    below = np.cumsum(weights.ravel()[order]) / weights.sum()
    median = emitted.ravel()[order][np.searchsorted(below, 0.5)]
    assert 0.15 < median < 0.30


def test_the_ground_is_seen_at_low_sun_on_mars(tmp_path):
    show(tmp_path, "mars", 5)

    assert np.median(on_screen(tmp_path / "a.png")[64:]) > 0.02


@pytest.mark.parametrize("elevation", [30, 0, -10])
def test_the_lit_planet_from_orbit_is_neither_white_nor_black(tmp_path, elevation):
    show(tmp_path, "earth", elevation, altitude=400.0)
    emitted = on_screen(tmp_path / "a.png")[64:]
    # Of what is emitted, half by places darker than this.
    ascending = np.sort(emitted, axis=None)
    middle = ascending[np.searchsorted(np.cumsum(ascending), 0.5 * ascending.sum())]

    assert 0.15 < middle < 0.6
    assert (emitted > 0.95).mean() < 0.01


@pytest.mark.slow
def test_the_exposure_follows_the_sun_smoothly():
    """From -12 to 12 deg in steps of half a degree: no step among changes of up to a stop."""
    pipeline = Pipeline()
    evs = [
        scene_ev(pipeline.scene("mars", map_settings(sun_elevation=math.radians(0.5 * sun))))
        for sun in range(-24, 25)
    ]

    assert np.abs(np.diff(evs, 2)).max() < 0.15


def test_light_around_the_sun_of_mars_is_blue_beside_its_sky_if_it_is_balanced(tmp_path):
    """Seen toward a sun of 3 deg; the light that falls on the ground is white."""
    west = shot(math.pi, math.radians(10.0), math.radians(60.0))
    show(tmp_path, "mars", 3, picture=PictureSettings(shot=west))
    balanced = pixels(tmp_path / "a.png")
    show(tmp_path, "mars", 3, picture=PictureSettings(shot=west, white_balance="none"))
    plain = pixels(tmp_path / "a.png")
    # Two degrees below the sun, which stands 7 deg below the middle.
    below_sun = (288 + round(576 * 9 / 36), 512)

    assert balanced[below_sun][2] > balanced[below_sun][0] + 0.02
    assert plain[0, 0][0] > plain[0, 0][2] + 0.05
    assert abs(balanced[0, 0][0] - balanced[0, 0][2]) < 0.05


@pytest.mark.parametrize(
    ("preset", "wanted", "is_balanced"),
    [
        ("earth", None, False),
        pytest.param("earth-desert-dust", None, False, marks=pytest.mark.slow),
        ("mars", None, True),
        pytest.param("exo-m-dwarf", None, True, marks=pytest.mark.slow),
        ("earth", "auto", True),
        ("mars", "none", False),
        ("earth", 4000.0, True),
    ],
)
def test_other_worlds_are_balanced_and_earth_if_asked(tmp_path, preset, wanted, is_balanced):
    """In a file's preview as in that of the map, whose pixels stay as they are."""
    picture = PictureSettings(white_balance=wanted)
    baked = show(tmp_path, preset, 20, picture=picture)
    later = preview_file(tmp_path / "a.exr", tmp_path / "later.png", picture)

    assert (baked.preview_white is not None) == is_balanced
    assert (later.white is not None) == is_balanced
    if is_balanced:
        np.testing.assert_allclose(later.white, baked.preview_white, atol=2e-3)
    before = pixels(tmp_path / "a.exr")
    show(tmp_path, preset, 20)
    np.testing.assert_array_equal(pixels(tmp_path / "a.exr"), before)


@pytest.mark.parametrize(
    ("projection", "disc"),
    [
        ("equirect", "include"),
        ("fisheye", "exclude"),
        ("perspective", "include"),
        *(
            pytest.param(*pair, marks=pytest.mark.slow)
            for pair in (
                ("equirect", "exclude"),
                ("fisheye", "include"),
                ("perspective", "exclude"),
            )
        ),
    ],
)
def test_the_white_of_a_file_is_that_of_its_scene(tmp_path, projection, disc):
    """Of a part of the sky only nearly: the rest is taken to have its colour."""
    options = {"projection": projection, "sun_disc": disc, "size": 256}
    if projection == "perspective":
        options["size"] = (256, 128)
    baked = show(tmp_path, "mars", 20, **options)
    later = preview_file(tmp_path / "a.exr", tmp_path / "later.png")

    tolerance = 0.02 if projection == "perspective" else 2e-3
    np.testing.assert_allclose(later.white, baked.preview_white, atol=tolerance)


@pytest.mark.parametrize(
    "size",
    [
        (256, 128),
        pytest.param((128, 96), marks=pytest.mark.slow),
        pytest.param((96, 128), marks=pytest.mark.slow),
        (32, 192),
        (100, 100),
    ],
)
def test_a_perspective_picture_of_any_shape_is_metered_as_one(tmp_path, size):
    """Also one that has the shape of a map of the whole sphere."""
    options = {"projection": "perspective", "size": size, "elevation": 0.3, "sun_azimuth": 0.0}
    baked = show(tmp_path, "earth", 10, **options)

    assert preview_file(tmp_path / "a.exr", tmp_path / "b.png").ev == pytest.approx(
        baked.preview_ev, abs=0.05
    )


@pytest.mark.parametrize(
    ("way", "suffix"),
    [
        ("equirect", ".exr"),
        ("octahedral", ".exr"),
        ("upright", ".exr"),
        ("cross", ".hdr"),
        *(
            pytest.param(way, ".exr", marks=pytest.mark.slow)
            for way in ("poles", "angular", "cross", "column")
        ),
        *(
            pytest.param(way, ".hdr", marks=pytest.mark.slow)
            for way in WAYS
            if way not in {"faces", "column", "cross"}  # no Radiance picture holds these
        ),
    ],
)
def test_a_shot_of_a_file_is_that_of_its_scene(tmp_path, way, suffix):
    size = 256 if way in {"cross", "column", "upright"} else 1024
    options = WAYS[way] | {"size": size, "sun_disc": "exclude"}
    south_west = shot(math.radians(225.0), math.radians(10.0), math.radians(50.0))
    picture = PictureSettings(ev=12.0, shot=south_west)
    settings = map_settings(sun_elevation=math.radians(10.0), **options)
    bake("earth", tmp_path / f"a{suffix}", settings, preview=tmp_path / "a.png", picture=picture)
    preview_file(tmp_path / f"a{suffix}", tmp_path / "b.png", picture)
    at_once, later = pixels(tmp_path / "a.png"), pixels(tmp_path / "b.png")

    assert at_once.shape == (576, 1024, 3)
    differing = np.abs(at_once - later).max(axis=-1)
    # The horizon is as wide in the map as one of its texels, and some pixels in the view.
    assert np.quantile(differing, 0.95) < 0.02


def test_a_shot_looks_to_its_bearing_however_the_map_is_turned(tmp_path):
    south_west = shot(math.radians(225.0), math.radians(10.0), math.radians(50.0))
    picture = PictureSettings(ev=12.0, shot=south_west)
    for name, rotation in (("north", 0.0), ("east", math.pi / 2.0)):
        settings = map_settings(size=(256, 128), sun_elevation=0.2, rotation=rotation)
        source = tmp_path / f"{name}.exr"
        bake("earth", source, settings, preview=tmp_path / f"{name}.png", picture=picture)
        preview_file(source, tmp_path / f"{name}_later.png", picture)
    at_once, later = (
        [pixels(tmp_path / f"{name}{end}.png") for name in ("north", "east")]
        for end in ("", "_later")
    )

    for north, east in (at_once, later):
        np.testing.assert_allclose(east, north, atol=2.5 / 255)
    assert np.ptp(at_once[0].mean(axis=(0, 2))) > 0.05


def test_a_shot_where_the_map_shows_nothing_is_refused(tmp_path):
    options = {"projection": "perspective", "size": (64, 36)}
    show(tmp_path, "earth", 10, **options)
    north = PictureSettings(shot=shot(0.0, 0.0, math.radians(40.0)))
    with pytest.raises(InputError, match=r"a.exr: shot: must look where the map shows something"):
        preview_file(tmp_path / "a.exr", tmp_path / "b.png", north)


def test_what_a_fisheye_does_not_show_is_black_in_a_shot(tmp_path):
    show(tmp_path, "earth", 40, projection="fisheye", size=128)
    level = PictureSettings(shot=shot(math.pi, 0.0, math.radians(40.0)))
    preview_file(tmp_path / "a.exr", tmp_path / "b.png", level)
    shown = pixels(tmp_path / "b.png")

    assert shown[:280].min() > 0.1
    # But for the dither.
    assert shown[300:].max() < 1.5 / 255


def test_a_preview_says_how_it_shows_the_map(tmp_path):
    picture = PictureSettings(white_balance=5500.0, shot=shot(math.pi, 0.1, 1.0), view="aces2")
    show(tmp_path, "earth", 40, picture=picture)
    preview_file(tmp_path / "a.exr", tmp_path / "b.png", picture)
    for name in ("a.png", "b.png"):
        texts = read_attributes(tmp_path / name)
        assert texts["skybake:whiteBalance"] == "5500K"
        assert texts["skybake:view"] == "aces2"
        assert texts["skybake:shot"] == "180,5.729577951,57.29577951"
        assert 13.0 < float(texts["skybake:exposureValue"]) < 16.0


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"ev": "bright"}, "ev: must be a number or auto or adapt, got 'bright'"),
        ({"view": "film"}, "view: must be one of aces1, aces2, got 'film'"),
        ({"white_balance": "warm"}, "white balance: must be auto, none or from 1000 to 25000 K"),
        ({"white_balance": 500.0}, "white balance: must be auto, none or from 1000 to 25000 K"),
        ({"white_balance": math.nan}, "white balance: must be auto, none or from 1000 to 25000 K"),
    ],
)
def test_settings_out_of_range_are_refused(values, message):
    with pytest.raises(InputError, match=message):
        PictureSettings(**values)


@pytest.mark.parametrize(
    "shape",
    [(1, 1), (1, 2), (2, 4), (96, 16), (6, 1), (30, 5), (3, 4), (96, 128), (513, 1026), (48, 48)],
)
def test_pictures_of_any_shape_are_exposed(tmp_path, shape):
    grey = np.full((*shape, 3), 0.5, np.float32)
    write_map(tmp_path / "a.exr", grey, white_luminance=140.0)
    ev = preview_file(tmp_path / "a.exr", tmp_path / "a.png").ev
    # All of a map of one row is on the horizon.
    assert 70.0 / luminance_from_ev(ev) == pytest.approx(0.36, rel=1e-6)


def show(folder, preset, sun, picture=None, **options):
    """Bake a small map and its preview, a.exr and a.png."""
    settings = map_settings(sun_elevation=math.radians(sun), **{"size": 256} | options)
    return bake(preset, folder / "a.exr", settings, preview=folder / "a.png", picture=picture)


def on_screen(path):
    """What a screen emits, of white: the luminance of the code values of a picture."""
    codes = pixels(path).astype(float)
    linear = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    return linear @ luminance_weights(REC709)
