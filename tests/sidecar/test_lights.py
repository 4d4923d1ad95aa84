"""The lights beside a map light a scene as the map with the sun's disc does."""

import ast
import json
import math

import numpy as np
import OpenImageIO
import pytest
from pxr import Gf, Usd, UsdGeom, UsdLux

from skybake.baking import bake
from skybake.colour.space import COLOUR_SPACES, find_colour_space, rgb_from_xyz
from skybake.colour.temperature import correlated_temperature
from skybake.ephemeris.lit_moon import moon_by_hand
from skybake.errors import InputError, OutputError
from skybake.image.moonlight import Moonlight
from skybake.image.settings import map_settings
from tests.baking.maps import pixels

NORMALS, CHUNK = 100, 8192
SUN = {"sun_elevation": math.radians(28.0), "sun_azimuth": math.radians(281.0)}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A full map of 512x256, and one without the disc with all files of lights."""
    folder = tmp_path_factory.mktemp("lights")
    turned = {"rotation": math.radians(25.0), "colorspace": "acescg", "pixel": "float"}
    settings = {"size": 512, **SUN, **turned}
    full = bake("earth", folder / "full.exr", map_settings(**settings))
    names = [folder / name for name in ("sky.usda", "sky.light.json", "sky.py")]
    baked = bake(
        "earth", folder / "sky.exr", map_settings(sun_disc="exclude", **settings), lights=names
    )
    assert baked.light_files == tuple(names)
    assert (full.map_light, full.light_files) == (None, ())
    return folder


def read_json(folder):
    return json.loads((folder / "sky.light.json").read_text("utf-8"))


def normals():
    """Unit vectors, all over the sphere."""
    vectors = np.random.default_rng(7).normal(size=(NORMALS, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def texels(height, world_from_local=None):
    """Directions and solid angles of a lat-long texture by the rule of UsdLuxDomeLight.

    Longitude goes from pi at the left edge to -pi; 0 is +Z and pi/2 is +X.
    """
    longitude = math.pi - math.pi * (np.arange(2 * height) + 0.5) / height
    latitude = math.pi / 2.0 - math.pi * (np.arange(height)[:, None] + 0.5) / height
    longitude, latitude = np.broadcast_arrays(longitude, latitude)
    around = np.sin(longitude) * np.cos(latitude), np.cos(longitude) * np.cos(latitude)
    vectors = np.stack([around[0], np.sin(latitude), around[1]], axis=-1)
    if world_from_local is not None:
        vectors = vectors @ np.array(world_from_local)[:3, :3]
    edges = np.sin(math.pi / 2.0 - math.pi * np.arange(height + 1) / height)
    size = np.broadcast_to((edges[:-1] - edges[1:])[:, None] * math.pi / height, latitude.shape)
    return vectors.reshape(-1, 3), size.ravel()


def irradiance(radiance, vectors, size, facing):
    """Irradiance of planes by texels, shape (normal, 3)."""
    flux = radiance.reshape(-1, 3) * size[:, None]
    total = np.zeros((len(facing), 3))
    for first in range(0, len(flux), CHUNK):
        part = slice(first, first + CHUNK)
        cosine = np.maximum(facing.astype(np.float32) @ vectors[part].astype(np.float32).T, 0.0)
        total += cosine @ flux[part].astype(np.float32)
    return total


def rec709_from(name):
    to_xyz = np.linalg.inv(rgb_from_xyz(find_colour_space(name)))
    return rgb_from_xyz(COLOUR_SPACES["lin_rec709"]) @ to_xyz


def of_dome(stage, facing):
    """Irradiance by a DomeLight, linear Rec. 709."""
    light = UsdLux.DomeLight(stage.GetPrimAtPath("/World/Sky"))
    lux = UsdLux.LightAPI(light)
    texture = light.GetTextureFileAttr()
    assert light.GetTextureFormatAttr().Get() == "latlong"
    assert not lux.GetNormalizeAttr().Get()
    theirs = Gf.ColorSpace(texture.GetColorSpace())
    units = np.eye(3).tolist()
    rec709 = Gf.ColorSpace("lin_rec709_scene")
    matrix = np.array([rec709.Convert(theirs, Gf.Vec3f(*unit)).GetRGB() for unit in units])
    radiance = pixels(texture.Get().resolvedPath) @ matrix
    radiance = radiance * lux.GetIntensityAttr().Get() * 2.0 ** lux.GetExposureAttr().Get()
    world = UsdGeom.Xformable(light.GetPrim()).ComputeLocalToWorldTransform(0)
    return irradiance(radiance, *texels(radiance.shape[0], world), facing)


def of_distant(stage, facing, rings=40, spokes=40):
    """Irradiance by a DistantLight, its disc in cells of equal solid angle."""
    light = UsdLux.DistantLight(stage.GetPrimAtPath("/World/Sun"))
    lux = UsdLux.LightAPI(light)
    half = math.radians(light.GetAngleAttr().Get()) / 2.0
    # The radiance of a light, divided by the size factor of a distant one if it is normalised.
    radiance = np.array(lux.GetColorAttr().Get()) * lux.GetIntensityAttr().Get()
    radiance *= 2.0 ** lux.GetExposureAttr().Get()
    assert lux.GetNormalizeAttr().Get()
    radiance /= math.pi * math.sin(half) ** 2
    cosine = 1.0 - (1.0 - math.cos(half)) * (np.arange(rings)[:, None] + 0.5) / rings
    angle = 2.0 * math.pi * (np.arange(spokes) + 0.5) / spokes
    sine = np.sqrt(1.0 - cosine**2)
    parts = np.broadcast_arrays(sine * np.cos(angle), sine * np.sin(angle), cosine)
    world = UsdGeom.Xformable(light.GetPrim()).ComputeLocalToWorldTransform(0)
    vectors = np.stack(parts, axis=-1).reshape(-1, 3) @ np.array(world)[:3, :3]
    size = np.full(len(vectors), 2.0 * math.pi * (1.0 - math.cos(half)) / len(vectors))
    return irradiance(np.tile(radiance, (len(vectors), 1)), vectors, size, facing)


def test_dome_and_sun_light_planes_as_the_full_map_does(folder):
    facing = normals()
    stage = Usd.Stage.Open(str(folder / "sky.usda"))
    full = pixels(folder / "full.exr") @ rec709_from("acescg").T
    expected = irradiance(full, *texels(256), facing)
    got = of_dome(stage, facing) + of_distant(stage, facing)
    np.testing.assert_allclose(got, expected, rtol=5e-3)
    # Either light alone is far off.
    assert np.abs(of_dome(stage, facing) / expected - 1.0).max() > 0.5


def test_map_and_sun_of_the_json_light_planes_as_the_full_map_does(folder):
    facing = normals()
    document = read_json(folder)
    sun = np.array(document["sun"]["direction"])
    vectors, size = texels(256)
    sky = irradiance(pixels(folder / document["map"]["files"][0]), vectors, size, facing)
    direct = np.maximum(facing @ sun, 0.0)[:, None] * document["sun"]["irradiance"]
    expected = irradiance(pixels(folder / "full.exr"), vectors, size, facing)
    np.testing.assert_allclose(sky + direct, expected, rtol=5e-3)


def test_the_json_agrees_with_the_file_of_the_map(folder):
    document = read_json(folder)
    sun, spec = document["sun"], OpenImageIO.ImageBuf(str(folder / "sky.exr")).spec()
    assert sun["direction"] == pytest.approx(spec["skybake:sunDirection"], rel=1e-6)
    assert sun["illuminance_lux"] == pytest.approx(spec["skybake:directNormalIlluminance"])
    assert sun["horizontal_illuminance_lux"] == pytest.approx(spec["skybake:directIlluminance"])
    sky = document["sky"]["horizontal_illuminance_lux"]
    assert sky == pytest.approx(spec["skybake:skyIlluminance"])
    assert document["map"]["white_luminance_cd_m2"] == pytest.approx(spec["whiteLuminance"])
    assert document["map"] == {
        "files": ["sky.exr"],
        "projection": "equirect",
        "rotate_deg": 25.0,
        "target": None,
        "colorspace": "acescg",
        "white_luminance_cd_m2": pytest.approx(39321.6),
        "sun_disc": "exclude",
    }
    assert (document["schema"], document["preset"], document["time"]) == (1, "earth", None)
    assert 12.0 < document["exposure_ev"] < 14.0


def test_the_json_tells_the_suns_colour_in_the_space_of_the_map(folder):
    sun = read_json(folder)["sun"]
    to_xyz = np.linalg.inv(rgb_from_xyz(find_colour_space("acescg")))
    xyz = to_xyz @ np.array(sun["colour"])
    assert xyz[1] == pytest.approx(1.0, abs=1e-9)
    assert sun["colour_temperature_k"] == pytest.approx(correlated_temperature(xyz), rel=1e-6)
    in_rec709 = OpenImageIO.ImageBuf(str(folder / "sky.exr")).spec()["skybake:sunColour"]
    assert rec709_from("acescg") @ sun["colour"] == pytest.approx(in_rec709, rel=1e-5)
    assert sun["angular_diameter_deg"] == pytest.approx(0.5329, abs=1e-4)
    assert (sun["azimuth_deg"], sun["elevation_deg"]) == (281.0, 28.0)


def values_of(script):
    """What a script for Blender assigns to names in capitals."""
    lines = [line.partition("#")[0] for line in script.splitlines() if line[:1].isupper()]
    return {
        name.strip(): ast.literal_eval(value.strip())
        for name, equals, value in (line.partition(" = ") for line in lines)
        if equals
    }


def test_in_blender_north_is_y_but_of_a_map_that_is_turned(folder):
    script = values_of((folder / "sky.py").read_text("utf-8"))
    x, y, z = read_json(folder)["sun"]["direction"]
    assert script["SUN_DIRECTION"] == pytest.approx((x, -z, y), abs=1e-8)
    assert (script["MAP"], script["COLOUR_SPACE"], script["TURN"]) == ("sky.exr", "ACEScg", 90.0)


@pytest.mark.parametrize(("target", "turn"), [("blender", 0.0), ("usd", 90.0)])
def test_a_map_that_is_turned_for_blender_needs_no_turn_there(tmp_path, target, turn):
    settings = map_settings(size=64, target=target, **SUN)
    names = [tmp_path / "a.json", tmp_path / "a.py"]
    bake("earth", tmp_path / "a.exr", settings, lights=names)
    script, sun = values_of(names[1].read_text()), json.loads(names[0].read_text())["sun"]
    east_north_up = (
        math.sin(SUN["sun_azimuth"]) * math.cos(SUN["sun_elevation"]),
        math.cos(SUN["sun_azimuth"]) * math.cos(SUN["sun_elevation"]),
        math.sin(SUN["sun_elevation"]),
    )
    assert script["TURN"] == pytest.approx(turn, abs=1e-9)
    assert script["SUN_DIRECTION"] == pytest.approx(east_north_up, abs=1e-8)
    if target == "blender":
        assert sun["target_direction"] == pytest.approx(east_north_up, abs=1e-8)


def test_a_soft_disc_is_told_in_the_size_that_it_is_drawn_in(tmp_path):
    settings = map_settings(size=64, sun_soft=True)
    light = bake("earth", tmp_path / "a.exr", settings, lights=()).map_light
    assert 1.0 < math.degrees(light.sun_angular_diameter) < 1.2


def test_a_sun_below_the_horizon_is_a_light_without_light(tmp_path):
    settings = map_settings(size=64, sun_elevation=-0.1, sun_disc="exclude")
    names = [tmp_path / "a.json", tmp_path / "a.usda", tmp_path / "a.py"]
    bake("earth", tmp_path / "a.exr", settings, lights=names)
    sun = json.loads(names[0].read_text())["sun"]
    assert (sun["illuminance_lux"], sun["irradiance"]) == (0.0, [0.0, 0.0, 0.0])
    assert (sun["colour"], sun["colour_temperature_k"]) == ([1.0, 1.0, 1.0], None)
    assert "SUN_STRENGTH = 0.0\n" in names[2].read_text()


def test_a_sun_that_the_map_holds_is_off_in_every_file(tmp_path):
    settings = map_settings(size=64)
    names = [tmp_path / "a.json", tmp_path / "a.usda", tmp_path / "a.py"]
    bake("earth", tmp_path / "a.exr", settings, lights=names)
    assert json.loads(names[0].read_text())["sun"]["is_in_map"] is True
    assert not Usd.Stage.Open(str(names[1])).GetPrimAtPath("/World/Sun").IsActive()
    assert "SUN_IS_IN_MAP = True\n" in names[2].read_text()


def test_files_of_lights_find_the_map_from_their_own_folder(tmp_path):
    (tmp_path / "lights").mkdir()
    settings = map_settings("cubemap", 16)
    path = tmp_path / "lights" / "sky.json"
    bake("earth", tmp_path / "sky.exr", settings, lights=[path])
    files = json.loads(path.read_text())["map"]["files"]
    assert files == [f"../sky_{face}.exr" for face in ("px", "nx", "py", "ny", "pz", "nz")]


def test_a_file_of_lights_that_is_named_twice_is_written_once(tmp_path):
    name = tmp_path / "a.json"
    baked = bake("earth", tmp_path / "a.exr", map_settings(size=64), lights=[name, str(name)])
    assert baked.light_files == (name,)
    assert json.loads(name.read_text())["map"]["files"] == ["a.exr"]


def test_lights_and_map_appear_together_or_not_at_all(small_disk):
    full = small_disk / "filler"
    full.write_bytes(bytes(60 * 1024))
    settings = map_settings(size=16)
    with pytest.raises(OutputError, match=r"a\.json: must be writable, got No space"):
        bake("earth", small_disk / "a.exr", settings, lights=[small_disk / "a.json"])
    assert list(small_disk.iterdir()) == [full]


@pytest.mark.parametrize(
    ("name", "projection", "fault", "reason"),
    [
        ("a.usda", "cubemap", InputError, "needs maps of the projection equirect, got cubemap"),
        ("a.py", "octahedral", InputError, "needs maps of the projection equirect, got octa"),
        ("a.txt", "equirect", InputError, "must be one of .json, .usda, .py, got '.txt'"),
        ("absent/a.json", "equirect", OutputError, "folder must exist"),
    ],
)
def test_what_cannot_be_written_is_said_before_anything_is(
    tmp_path, name, projection, fault, reason
):
    settings = map_settings(projection, 16)
    with pytest.raises(fault, match=reason):
        bake("earth", tmp_path / "a.exr", settings, lights=[tmp_path / name])
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".usda", ".py"])
def test_a_dome_is_refused_a_map_whose_first_and_last_rows_are_the_poles(tmp_path, suffix):
    settings = map_settings(size=16, rows="poles")
    with pytest.raises(
        InputError, match=r"needs maps with centred rows, got equirect rows 'poles'"
    ):
        bake("earth", tmp_path / "a.exr", settings, lights=[tmp_path / f"a{suffix}"])
    assert list(tmp_path.iterdir()) == []


@pytest.fixture(scope="module")
def moonlit(tmp_path_factory):
    """A map at the first quarter without discs, and all files of lights."""
    folder = tmp_path_factory.mktemp("moonlit")
    moon = moon_by_hand(math.radians(130.0), math.radians(35.0), math.radians(90.0), 4.2, -0.4)
    settings = map_settings(
        size=64,
        sun_elevation=-0.4,
        sun_azimuth=4.2,
        sun_disc="exclude",
        rotation=math.radians(25.0),
        units="nits",
        moonlight=Moonlight(moon),
    )
    names = [folder / name for name in ("sky.usda", "sky.light.json", "sky.py")]
    bake("earth", folder / "sky.exr", settings, lights=names)
    return folder


def test_the_moon_is_a_second_light_in_every_file(moonlit):
    told = read_json(moonlit)["moon"]
    flat = math.cos(math.radians(35.0))
    bearing = math.radians(130.0 - 25.0)
    toward = flat * math.sin(bearing), math.sin(math.radians(35.0)), -flat * math.cos(bearing)
    assert told["direction"] == pytest.approx(toward, abs=1e-6)
    assert (told["azimuth_deg"], told["elevation_deg"]) == (130.0, 35.0)
    assert told["angular_diameter_deg"] == pytest.approx(0.518, abs=1e-3)
    assert told["phase_angle_deg"] == pytest.approx(90.0)
    assert 0.010 < told["illuminance_lux"] < 0.03
    assert (told["is_in_map"], told["eclipsed"]) == (False, 0.0)

    stage = Usd.Stage.Open(str(moonlit / "sky.usda"))
    moon = UsdLux.DistantLight(stage.GetPrimAtPath("/World/Moon"))
    assert moon.GetPrim().IsActive()
    assert moon.GetIntensityAttr().Get() == pytest.approx(told["illuminance_lux"], rel=1e-5)
    assert moon.GetAngleAttr().Get() == pytest.approx(told["angular_diameter_deg"], rel=1e-5)
    to_world = UsdGeom.Xformable(moon).ComputeLocalToWorldTransform(Usd.TimeCode.Default())
    assert tuple(to_world.TransformDir(Gf.Vec3d(0.0, 0.0, 1.0))) == pytest.approx(toward, abs=1e-6)

    script = values_of((moonlit / "sky.py").read_text("utf-8"))
    x, y, z = toward
    assert script["MOON_DIRECTION"] == pytest.approx((x, -z, y), abs=1e-6)
    assert script["MOON_IS_IN_MAP"] is False
    assert script["MOON_STRENGTH"] == pytest.approx(
        told["illuminance_lux"] * max(told["colour"]), rel=1e-4
    )
    assert "MOON_ANGLE,\n" in (moonlit / "sky.py").read_text("utf-8")


def test_a_map_without_a_moon_has_no_light_for_it(folder):
    assert read_json(folder)["moon"] is None
    assert not Usd.Stage.Open(str(folder / "sky.usda")).GetPrimAtPath("/World/Moon")
    assert "MOON" not in (folder / "sky.py").read_text("utf-8")
