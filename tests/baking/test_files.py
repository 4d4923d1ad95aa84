"""What stands in the files, and when there are any."""

import json

import numpy as np
import OpenImageIO
import pytest

from skybake.baking import bake
from skybake.errors import OutputError
from skybake.formats.reader import read_attributes
from skybake.image.settings import map_settings
from skybake.jit import workers
from skybake.projection.cubemap import FACES
from tests.baking.maps import bake_map, pixels
from tests.formats.maps import listing


@pytest.mark.parametrize(
    ("elevation", "options", "pixel"),
    [
        (30.0, {}, "half"),
        (30.0, {"units": "nits"}, "float"),  # the disc would overflow
        (30.0, {"units": "nits", "sun_disc": "exclude"}, "float"),  # the aureole might
        (-2.0, {"units": "nits", "sun_disc": "exclude"}, "half"),
        (30.0, {"size": 4096, "sun_disc": "only"}, "half"),
        (-6.0, {}, "float"),  # twilight would be denormal
        (-6.0, {"ev": 0.0}, "half"),
        (-90.0, {}, "float"),
    ],
)
def test_half_is_taken_only_where_it_loses_nothing(tmp_path, elevation, options, pixel):
    baked, _ = bake_map(tmp_path / "a.exr", elevation=elevation, **options)
    spec = OpenImageIO.ImageInput.open(str(baked.files[0])).spec()
    assert baked.pixel == pixel
    assert str(spec.format) == pixel
    values = pixels(baked.files[0])
    assert np.isfinite(values).all()


@pytest.mark.parametrize("elevation", [60.0, 30.0, 5.0, 0.0, -2.0, -4.0, -8.0])
def test_no_sky_value_of_a_half_map_is_denormal(tmp_path, elevation):
    baked, _ = bake_map(tmp_path / "a.exr", elevation=elevation, size=256)
    if baked.pixel == "half":
        values = np.abs(pixels(baked.files[0]) @ [0.2126, 0.7152, 0.0722])
        assert values.min() >= 2.0**-14


@pytest.mark.parametrize("space", ["acescg", "lin_rec2020", "lin_p3d65", "aces2065-1", "xyz"])
def test_colour_spaces_are_those_of_opencolorio(tmp_path, space):
    """The studio configuration that OpenImageIO brings, from the same map in Rec. 709."""
    names = {
        "acescg": "lin_ap1_scene",
        "lin_rec2020": "lin_rec2020_scene",
        "lin_p3d65": "lin_p3d65_scene",
        "aces2065-1": "lin_ap0_scene",
        "xyz": "lin_ciexyzd65_scene",
    }
    rec709, _ = bake_map(tmp_path / "rec709.exr", pixel="float")
    ours, _ = bake_map(tmp_path / "ours.exr", pixel="float", colorspace=space)
    config = OpenImageIO.ColorConfig("ocio://default")
    source = OpenImageIO.ImageBuf(pixels(rec709.files[0]).copy())
    converted = OpenImageIO.ImageBufAlgo.colorconvert(
        source, "lin_rec709_scene", names[space], colorconfig="ocio://default"
    )
    assert not converted.has_error, converted.geterror()
    assert config.getNumColorSpaces() > 0
    expected = converted.get_pixels(OpenImageIO.FLOAT)
    scale = np.abs(expected).max(axis=-1, keepdims=True)
    assert (np.abs(pixels(ours.files[0]) - expected) / scale).max() < 1e-3


def test_units_only_scale(tmp_path):
    ev15, a = bake_map(tmp_path / "ev15.exr", pixel="float")
    nits, b = bake_map(tmp_path / "nits.exr", pixel="float", units="nits")
    ev9, c = bake_map(tmp_path / "ev9.exr", pixel="float", ev=9.0)
    assert (a.encoding.white_luminance, b.encoding.white_luminance) == (1.2 * 2**15, 1.0)
    assert c.encoding.white_luminance == 1.2 * 2**9
    np.testing.assert_allclose(
        pixels(nits.files[0]), pixels(ev15.files[0]) * 1.2 * 2**15, rtol=2e-6
    )
    np.testing.assert_allclose(pixels(ev9.files[0]), pixels(ev15.files[0]) * 2**6, rtol=2e-6)
    assert ev15.sky_illuminance == pytest.approx(nits.sky_illuminance, rel=1e-6)


def test_negative_values_stay_unless_clamped(tmp_path):
    """The red of a setting sun lies outside Rec. 709."""
    kept, _ = bake_map(tmp_path / "kept.exr", elevation=1.0, pixel="float")
    clamped, _ = bake_map(
        tmp_path / "clamped.exr", elevation=1.0, pixel="float", clamp_negative=True
    )
    values = pixels(kept.files[0])
    assert (values < 0.0).any()
    np.testing.assert_array_equal(pixels(clamped.files[0]), np.maximum(values, 0.0))


def test_radiance_files_tell_how_many_negative_values_they_lost(tmp_path):
    baked, _ = bake_map(tmp_path / "a.hdr", elevation=1.0)
    source, _ = bake_map(tmp_path / "a.exr", elevation=1.0, pixel="float")
    assert baked.pixel == "rgbe"
    assert baked.clamped == (pixels(source.files[0]) < 0.0).sum() > 0


def test_same_map_has_the_same_bytes_whatever_the_threads(tmp_path, monkeypatch):
    first, _ = bake_map(tmp_path / "first.exr", "mars", 5.0)
    second, _ = bake_map(tmp_path / "second.exr", "mars", 5.0)
    monkeypatch.setattr(workers, "cpu_count", lambda: 1)
    alone, _ = bake_map(tmp_path / "alone.exr", "mars", 5.0)
    assert first.files[0].read_bytes() == second.files[0].read_bytes()
    assert first.files[0].read_bytes() == alone.files[0].read_bytes()


def test_six_faces_appear(tmp_path):
    baked, _ = bake_map(tmp_path / "a.exr", projection="cubemap", size=16)
    assert listing(tmp_path) == sorted(f"a_{face}.exr" for face in FACES)
    assert [file.name for file in baked.files] == [f"a_{face}.exr" for face in FACES]


def test_faces_take_their_place_in_a_name(tmp_path):
    bake_map(tmp_path / "sky.{face}.exr", projection="cubemap", size=8)
    assert listing(tmp_path) == sorted(f"sky.{face}.exr" for face in FACES)


def test_no_face_appears_if_one_cannot(tmp_path):
    (tmp_path / "a_nz.exr").mkdir()
    with pytest.raises(OutputError):
        bake_map(tmp_path / "a.exr", projection="cubemap", size=16)
    assert listing(tmp_path) == ["a_nz.exr"]


def test_old_faces_stay_whole_if_a_new_one_cannot_appear(tmp_path):
    (tmp_path / "a_px.exr").write_bytes(b"old")
    (tmp_path / "a_ny.exr").mkdir()
    with pytest.raises(OutputError):
        bake_map(tmp_path / "a.exr", projection="cubemap", size=16)
    assert (tmp_path / "a_px.exr").read_bytes() == b"old"
    assert listing(tmp_path) == ["a_ny.exr", "a_px.exr"]


def test_a_value_beyond_half_is_an_error_and_no_file(tmp_path):
    with pytest.raises(OutputError, match="must be at most 65504"):
        bake_map(tmp_path / "a.exr", units="nits", pixel="half")
    assert listing(tmp_path) == []


def test_header_tells_sun_light_and_recipe(tmp_path):
    baked, settings = bake_map(tmp_path / "a.exr", "mars", 30.0, sun_azimuth=1.0)
    spec = OpenImageIO.ImageInput.open(str(baked.files[0])).spec()
    assert spec.getattribute("skybake:sunDirection") == pytest.approx(baked.sun_direction)
    assert spec.getattribute("skybake:skyIlluminance") == pytest.approx(baked.sky_illuminance)
    assert spec.getattribute("skybake:directIlluminance") == pytest.approx(baked.direct_illuminance)
    assert spec.getattribute("skybake:preset") == "mars"
    recipe = json.loads(read_attributes(baked.files[0])["skybake:recipe"])
    assert recipe["map"] == settings.recipe()
    assert recipe["map"]["sun_elevation_deg"] == pytest.approx(30.0)


def test_progress_rises_to_one(tmp_path):
    shares = []
    bake("earth", tmp_path / "a.exr", map_settings(size=1024), progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert len(shares) > 2


@pytest.mark.parametrize(
    ("suffix", "options"),
    [(".exr", {}), (".hdr", {}), (".exr", {"projection": "cubemap", "layout": "exr"})],
)
def test_bands_do_not_show(tmp_path, monkeypatch, suffix, options):
    """A map written in one band is the map written in many."""
    from skybake.baking import pictures

    whole, _ = bake_map(tmp_path / f"whole{suffix}", size=96, **options)
    monkeypatch.setattr(pictures, "BAND_ROWS", 7)
    bands, _ = bake_map(tmp_path / f"bands{suffix}", size=96, **options)
    np.testing.assert_array_equal(pixels(whole.files[0]), pixels(bands.files[0]))
