"""Pixar's own library reads the lights as they were meant."""

import dataclasses
import math

import numpy as np
import pytest
from pxr import Gf, Usd, UsdGeom, UsdLux, UsdValidation

import skybake
from skybake.colour.space import COLOUR_SPACES, rgb_from_xyz
from skybake.errors import InputError, OutputError
from skybake.formats.reader import read_image
from skybake.image.settings import map_settings
from skybake.projection import equirect
from skybake.sidecar.dome_and_sun import Common, DomeAndSun
from skybake.sidecar.usd import check_usd, usd_layer
from tests.sequence.records import direction

SUNS = [(-3.0, 250.0), (0.0, 359.0), (5.0, 2.0), (33.0, 90.0), (89.0, 200.0), (90.0, 180.0)]


COMMON = Common(preset="earth", colorspace="acescg", sun_is_in_maps=False)


def record(frame, elevation=30.0, azimuth=180.0, **changes):
    values = {
        "file": "sky.0001.exr",
        "frame": frame,
        "white_luminance_cd_m2": 39321.6,
        "sun_elevation_deg": elevation,
        "sun_azimuth_deg": azimuth,
        "sun_angular_diameter_deg": 0.533,
        "sun_colour": (1.2, 0.98, 0.61),
        "sun_illuminance_lux": 90000.0,
    }
    return DomeAndSun(**{**values, **changes})


@pytest.fixture
def written(tmp_path):
    def write(records, name="sky", **changes):
        path = tmp_path / f"{name}.usda"
        path.write_text(usd_layer(path, dataclasses.replace(COMMON, **changes), records))
        return Usd.Stage.Open(str(path))

    return write


def _world_from_local(stage, name, frame):
    prim = stage.GetPrimAtPath(f"/World/{name}")
    return UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(frame)


def _comes_from(stage, frame):
    """Direction that a distant light comes from: it shines along its own -Z."""
    return np.array(_world_from_local(stage, "Sun", frame).TransformDir(Gf.Vec3d(0.0, 0.0, 1.0)))


def _seen_at(stage, frame, u, v):
    """Direction of a point on the dome's texture by the rule of UsdLuxDomeLight.

    Longitude goes from pi at the left edge to -pi; 0 is +Z and pi/2 is +X. Latitude
    goes from pi/2 at the top to -pi/2.
    """
    longitude, latitude = math.pi - 2.0 * math.pi * u, math.pi / 2.0 - math.pi * v
    local = Gf.Vec3d(
        math.sin(longitude) * math.cos(latitude),
        math.sin(latitude),
        math.cos(longitude) * math.cos(latitude),
    )
    return np.array(_world_from_local(stage, "Sky", frame).TransformDir(local))


def test_the_stage_says_its_axes_units_and_time(written):
    stage = written([record(-3), record(5), record(12)])
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (-3.0, 12.0)
    assert stage.GetFramesPerSecond() == stage.GetTimeCodesPerSecond() == 24.0
    assert stage.GetDefaultPrim().GetPath() == "/World"


def test_every_attribute_is_one_that_the_schemas_know(written):
    stage = written([record(1)])
    for name in ("Sky", "Sun"):
        prim = stage.GetPrimAtPath(f"/World/{name}")
        known = set(prim.GetPrimDefinition().GetPropertyNames())
        own = {one.GetName() for one in prim.GetAuthoredProperties()}
        assert own <= known | {"xformOp:rotateXYZ"}
        for attribute in prim.GetAuthoredAttributes():
            if attribute.GetName() in known:
                fallback = prim.GetPrimDefinition().GetAttributeDefinition(attribute.GetName())
                assert attribute.GetTypeName() == fallback.GetTypeName()


@pytest.mark.parametrize(("elevation", "azimuth"), SUNS)
def test_light_comes_from_the_sun(written, elevation, azimuth):
    stage = written([record(7, elevation, azimuth)])
    np.testing.assert_allclose(_comes_from(stage, 7), direction(elevation, azimuth), atol=1e-6)


def test_light_comes_from_the_sun_of_a_map_that_is_turned(written):
    stage = written([record(7, 33.0, 90.0), record(8, 33.0, 20.0)], rotation_deg=40.0)
    np.testing.assert_allclose(_comes_from(stage, 7), direction(33.0, 50.0), atol=1e-6)
    np.testing.assert_allclose(_comes_from(stage, 8), direction(33.0, -20.0), atol=1e-6)


@pytest.mark.parametrize("width", [64, 512])
@pytest.mark.parametrize(("elevation", "azimuth"), SUNS)
def test_the_texel_that_looks_at_the_sun_lies_where_the_light_comes_from(
    written, elevation, azimuth, width
):
    stage = written([record(7, elevation, azimuth)])
    cosine = equirect.directions(width, width // 2) @ np.array(direction(elevation, azimuth))
    row, column = np.unravel_index(np.argmax(cosine), cosine.shape)
    seen = _seen_at(stage, 7, (column + 0.5) / width, (row + 0.5) / (width // 2))
    half_a_diagonal = math.pi / width * math.sqrt(2.0)
    assert math.acos(min(seen @ _comes_from(stage, 7), 1.0)) < half_a_diagonal * 1.001


def test_a_baked_sun_has_the_direction_and_the_flux_of_the_light(written, tmp_path):
    settings = map_settings(
        sun_elevation=math.radians(21.0),
        sun_azimuth=math.radians(312.0),
        size=128,
        sun_disc="only",
        pixel="float",
        method="march",
    )
    baked = skybake.bake("earth", tmp_path / "sun.exr", settings)
    stage = written(
        [
            record(
                1,
                21.0,
                312.0,
                sun_illuminance_lux=baked.direct_normal_illuminance,
                white_luminance_cd_m2=baked.white_luminance,
            )
        ]
    )
    pixels, _ = read_image(tmp_path / "sun.exr")
    luminance = pixels.astype(float) @ (0.2126, 0.7152, 0.0722)
    rows = (np.arange(64) + 0.5) / 64
    flux = luminance * (math.pi / 64 * 2.0 * math.pi / 128 * np.sin(math.pi * rows))[:, None]
    light = UsdLux.LightAPI(stage.GetPrimAtPath("/World/Sun"))
    assert light.GetIntensityAttr().Get(1) == pytest.approx(flux.sum(), rel=2e-3)
    assert light.GetNormalizeAttr().Get()
    seen = sum(
        flux[j, i] * _seen_at(stage, 1, (i + 0.5) / 128, rows[j]) for j, i in np.argwhere(flux)
    )
    assert seen / np.linalg.norm(seen) == pytest.approx(_comes_from(stage, 1), abs=2e-3)


def test_maps_are_sampled_by_frame_and_found_beside_the_file(written, tmp_path):
    (tmp_path / "maps").mkdir()
    files = {1: "maps/sky.0001.exr", 6: "maps/sky@half.0006.exr", 11: "maps/sky é.0011.exr"}
    for file in files.values():
        (tmp_path / file).touch()
    stage = written([record(frame, file=file) for frame, file in files.items()])
    texture = UsdLux.DomeLight(stage.GetPrimAtPath("/World/Sky")).GetTextureFileAttr()
    assert texture.GetTimeSamples() == [1.0, 6.0, 11.0]
    for frame, file in files.items():
        assert texture.Get(frame).resolvedPath == str(tmp_path / file)
    assert texture.Get(8).path == "./maps/sky@half.0006.exr"


@pytest.mark.parametrize("name", COLOUR_SPACES)
def test_usd_turns_the_space_of_the_maps_into_rec709_as_we_do(written, name):
    stage = written([record(1)], colorspace=name)
    texture = UsdLux.DomeLight(stage.GetPrimAtPath("/World/Sky")).GetTextureFileAttr()
    theirs = Gf.ColorSpace(texture.GetColorSpace())
    rec709 = Gf.ColorSpace("lin_rec709_scene")
    units = [rec709.Convert(theirs, Gf.Vec3f(*unit)).GetRGB() for unit in np.eye(3).tolist()]
    to_xyz = np.linalg.inv(rgb_from_xyz(COLOUR_SPACES[name]))
    ours = rgb_from_xyz(COLOUR_SPACES["lin_rec709"]) @ to_xyz
    np.testing.assert_allclose(np.array(units).T, ours, atol=5e-6)


def test_the_suns_light_is_its_illuminance_in_the_units_of_the_maps(written):
    stage = written([record(1), record(2, white_luminance_cd_m2=1.0), record(3, azimuth=181.0)])
    light = UsdLux.LightAPI(stage.GetPrimAtPath("/World/Sun"))
    assert light.GetIntensityAttr().GetTimeSamples() == [1.0, 2.0, 3.0]
    assert light.GetIntensityAttr().Get(1) == pytest.approx(90000.0 / 39321.6)
    assert light.GetIntensityAttr().Get(2) == pytest.approx(90000.0)
    assert light.GetColorAttr().Get(1) == Gf.Vec3f(1.2, 0.98, 0.61)
    assert light.GetColorAttr().GetColorSpace() == "lin_rec709_scene"
    sun = UsdLux.DistantLight(light)
    assert sun.GetAngleAttr().Get() == pytest.approx(0.533)
    assert light.GetNormalizeAttr().Get() is True
    white = stage.GetPrimAtPath("/World").GetAttribute("skybake:whiteLuminance")
    assert [white.Get(frame) for frame in (1, 2)] == pytest.approx([39321.6, 1.0])


def test_a_sun_that_gives_no_light_is_out(written):
    dark = {"sun_illuminance_lux": 0.0, "sun_colour": (0.0, 0.0, 0.0)}
    stage = written([record(1, -3.0, 290.0, **dark), record(2)])
    light = UsdLux.LightAPI(stage.GetPrimAtPath("/World/Sun"))
    assert light.GetIntensityAttr().Get(1) == 0.0
    assert light.GetColorAttr().Get(1) == Gf.Vec3f(1.0)


def test_between_frames_the_sun_crosses_north_on_the_shorter_way(written):
    stage = written([record(1, 10.0, 350.0), record(11, 10.0, 10.0), record(21, 10.0, 330.0)])
    np.testing.assert_allclose(_comes_from(stage, 6), direction(10.0, 0.0), atol=1e-6)
    np.testing.assert_allclose(_comes_from(stage, 16), direction(10.0, 350.0), atol=1e-6)


@pytest.mark.parametrize("frame", [1, None])
def test_a_sun_that_the_maps_hold_is_not_counted_twice(written, frame):
    stage = written([record(frame)], sun_is_in_maps=True)
    sun = stage.GetPrimAtPath("/World/Sun")
    assert not sun.IsActive()
    assert "hold the sun's disc already" in sun.GetMetadata("documentation")
    assert stage.GetPrimAtPath("/World/Sky").IsActive()
    sun.SetActive(True)
    light = UsdLux.LightAPI(stage.GetPrimAtPath("/World/Sun"))
    assert light.GetIntensityAttr().Get(1) == pytest.approx(90000.0 / 39321.6)
    assert written([record(frame)]).GetPrimAtPath("/World/Sun").IsActive()


def test_pixars_validators_find_no_fault(written, tmp_path):
    (tmp_path / "sky.0001.exr").touch()
    stage = written([record(1)])
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    faults = UsdValidation.ValidationContext(validators).Validate(stage)
    assert [fault.GetMessage() for fault in faults] == []
    (tmp_path / "sky.0001.exr").unlink()
    assert UsdValidation.ValidationContext(validators).Validate(stage)


def test_any_name_of_a_world_can_be_written(written):
    name = 'a "b" \\ \n é'
    assert name in written([record(1)], preset=name).GetRootLayer().documentation


@pytest.mark.parametrize(
    ("name", "projection", "fault", "reason"),
    [
        ("sky.usda", "cubemap", InputError, "needs maps of the projection equirect, got cubemap"),
        ("sky.usdc", "equirect", InputError, "suffix of a USD file must be .usda, got '.usdc'"),
        ("absent/sky.usda", "equirect", OutputError, "folder must exist"),
    ],
)
def test_what_usd_cannot_hold_is_said_up_front(tmp_path, name, projection, fault, reason):
    with pytest.raises(fault, match=reason):
        check_usd(tmp_path / name, map_settings(projection, 16).view.projection)


def test_a_name_that_usd_cannot_hold_is_refused(tmp_path):
    for name in ("a\nb.exr", "a\udcff.exr", "a@@@.exr"):
        with pytest.raises(InputError, match="USD must be able to hold"):
            usd_layer(tmp_path / "sky.usda", COMMON, [record(1, file=name)])


def test_a_map_without_a_frame_has_the_same_lights_at_every_time(written):
    sampled = written([record(7, 33.0, 90.0)])
    plain = written([record(None, 33.0, 90.0)], "plain")
    assert not plain.HasAuthoredTimeCodeRange()
    for prim in sampled.Traverse():
        twin = plain.GetPrimAtPath(prim.GetPath())
        assert twin.GetTypeName() == prim.GetTypeName()
        names = [one.GetName() for one in prim.GetAuthoredAttributes()]
        assert names == [one.GetName() for one in twin.GetAuthoredAttributes()]
        for name in names:
            one, other = prim.GetAttribute(name), twin.GetAttribute(name)
            assert other.GetTimeSamples() == []
            assert other.Get() == one.Get(7)
            assert other.GetColorSpace() == one.GetColorSpace()
