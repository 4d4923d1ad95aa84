"""Environments from files of ours and of others."""

import math

import numpy as np
import OpenEXR
import OpenImageIO
import pytest

from skybake.baking import bake
from skybake.colour.space import find_colour_space
from skybake.environment.load import load_environment
from skybake.environment.resample import resample
from skybake.errors import InputError
from skybake.image.settings import map_settings
from skybake.projection import Angular, Cubemap, Equirect, Fisheye, Octahedral
from tests.environment.maps import brightest, lit
from tests.formats.maps import sky, write_map


@pytest.fixture(scope="module")
def baked(tmp_path_factory):
    """Bakes a map of the same sky once for each projection; returns the first of its files."""
    folder, done = tmp_path_factory.mktemp("baked"), {}

    def of(projection, size, **options):
        key = (projection, size, tuple(sorted(options.items())))
        if key not in done:
            settings = map_settings(projection, size, sun_elevation=0.7, sun_azimuth=2.0, **options)
            done[key] = bake("earth", folder / f"{len(done)}.exr", settings).files[0]
        return done[key]

    return of


SUN = (math.cos(0.7) * math.sin(2.0), math.sin(0.7), -math.cos(0.7) * math.cos(2.0))


@pytest.mark.parametrize(
    ("projection", "size", "options", "expected"),
    [
        ("equirect", 128, {"rotation": 1.0}, Equirect(128)),
        ("equirect", 128, {"rows": "poles"}, Equirect(128, "poles")),
        ("cubemap", 64, {}, Cubemap(64)),
        ("cubemap", 64, {"layout": "vertical-cross"}, Cubemap(64, "vertical-cross")),
        ("cubemap", 64, {"layout": "row"}, Cubemap(64, "row")),
        ("cubemap", 64, {"layout": "exr", "rotation": -0.5}, Cubemap(64, "exr")),
        ("angular", 128, {}, Angular(128)),
        ("octahedral", 128, {}, Octahedral(128)),
        ("fisheye", 128, {"fov": 3.0}, Fisheye(128, 3.0)),
    ],
)
def test_maps_of_ours_say_where_they_look(baked, projection, size, options, expected):
    environment = load_environment(baked(projection, size, **options))
    assert environment.projection == expected
    assert environment.rotation == pytest.approx(options.get("rotation", 0.0))
    assert environment.space == find_colour_space("lin_rec709")
    assert environment.white_luminance == pytest.approx(1.2 * 2**15)
    assert environment.warnings == ()
    seen = resample(environment, Equirect(256))
    assert brightest(seen) @ SUN > math.cos(0.03)


def test_a_cube_of_ours_is_found_by_any_of_its_files_or_their_template(baked):
    first = baked("cubemap", 64)
    whole = load_environment(first)
    for name in (first.name.replace("px", "nz"), first.name.replace("px", "{face}")):
        np.testing.assert_array_equal(load_environment(first.with_name(name)).pixels, whole.pixels)


NAMES = [
    ("px", "nx", "py", "ny", "pz", "nz"),
    ("posx", "negx", "posy", "negy", "posz", "negz"),
    ("+X", "-X", "+Y", "-Y", "+Z", "-Z"),
    ("Right", "Left", "Top", "Bottom", "Front", "Back"),
    ("right", "left", "up", "down", "front", "back"),
]


@pytest.mark.parametrize("names", NAMES)
def test_faces_of_others_are_known_by_usual_names(tmp_path, names):
    environment = lit(Cubemap(16))
    for name, face in zip(names, environment.pixels, strict=True):
        write_map(tmp_path / f"bright_{name}.exr", face, pixel="float")
    for name in (names[0], names[5], "{face}"):
        found = load_environment(tmp_path / f"bright_{name}.exr")
        assert found.projection == Cubemap(16)
        np.testing.assert_array_equal(found.pixels, environment.pixels)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ((16, 32), Equirect(32)),
        ((24, 32), Cubemap(8, "cross")),
        ((32, 24), Cubemap(8, "vertical-cross")),
        ((8, 48), Cubemap(8, "row")),
        ((48, 8), Cubemap(8, "column")),
    ],
)
@pytest.mark.parametrize("suffix", [".exr", ".hdr"])
def test_others_are_known_by_their_shape(tmp_path, shape, expected, suffix):
    write_map(tmp_path / f"a{suffix}", sky(shape[1], shape[0]))
    assert load_environment(tmp_path / f"a{suffix}").projection == expected


def test_a_column_that_says_that_it_is_openexrs_is(tmp_path):
    write_map(tmp_path / "a.exr", sky(8, 48), envmap="cube")
    assert load_environment(tmp_path / "a.exr").projection == Cubemap(8, "exr")


def test_a_file_without_tags_has_neither_space_nor_scale(tmp_path):
    standard = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(standard, {"RGB": sky(16, 8)}) as file:
        file.write(str(tmp_path / "a.exr"))
    found = load_environment(tmp_path / "a.exr")
    assert (found.space, found.white_luminance, found.rotation) == (None, None, 0.0)


def test_what_a_caller_says_comes_before_what_the_file_says(baked):
    found = load_environment(
        baked("octahedral", 128),
        projection=Fisheye(fov=2.0),
        rotation=0.25,
        space="acescg",
        white_luminance=5.0,
    )
    assert found.projection == Fisheye(128, 2.0)
    assert (found.rotation, found.white_luminance) == (0.25, 5.0)
    assert found.space == find_colour_space("acescg")


@pytest.mark.parametrize("layers", [False, True])
def test_a_sun_in_a_part_of_its_own_is_added(baked, layers):
    whole = load_environment(baked("equirect", 128))
    apart = load_environment(baked("equirect", 128, sun_disc="separate", layers=layers))
    np.testing.assert_allclose(apart.pixels[0], whole.pixels[0], rtol=1e-3)


def broken(pixels, suffix=".exr", **options):
    def make(folder):
        path = folder / f"a{suffix}"
        write_map(path, np.asarray(pixels, np.float32), **options)
        return path

    return make


def with_nan(folder):
    pixels = sky(64, 32)
    pixels[20, 5, 1] = np.nan
    with OpenEXR.File(
        {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, {"RGB": pixels}
    ) as file:
        file.write(str(folder / "a.exr"))
    return folder / "a.exr"


def truncated(folder):
    path = broken(sky(64, 32))(folder)
    path.write_bytes(path.read_bytes()[:-2000])
    return path


def five_faces(folder):
    for name in ("px", "nx", "py", "ny", "nz"):
        write_map(folder / f"a_{name}.exr", sky(8, 8))
    return folder / "a_{face}.exr"


def uneven_faces(folder):
    for name in NAMES[0]:
        write_map(folder / f"a_{name}.exr", sky(*(9, 9) if name == "py" else (8, 8)))
    return folder / "a_nx.exr"


@pytest.mark.parametrize(
    ("make", "problem"),
    [
        (broken(sky(60, 32)), "a.exr: shape must be 2:1, or a cube's .*, got 60x32$"),
        (broken(sky(32, 32)), "a.exr: shape must be 2:1, .*, got 32x32$"),
        (with_nan, "a.exr: pixels must be finite, got nan in G at column 5, row 20$"),
        (truncated, "a.exr: must be complete, got "),
        (five_faces, "{face}.exr: all six faces must exist, got no a_pz.exr$"),
        (uneven_faces, "a_py.exr: all faces must be as large as a_px.exr, 8x8, got 9x9$"),
        (lambda folder: folder / "b.exr", "b.exr: must be an image file, got nothing$"),
    ],
)
def test_what_is_no_environment_is_refused_in_one_line(tmp_path, make, problem):
    path = make(tmp_path)
    with pytest.raises(InputError, match=problem) as caught:
        load_environment(path)
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith(str(tmp_path))


def test_a_projection_that_the_picture_has_not_the_shape_of_is_refused(tmp_path):
    path = broken(sky(64, 32))(tmp_path)
    with pytest.raises(InputError, match="shape must be that of the projection angular, got 64x32"):
        load_environment(path, projection="angular")


def test_negative_light_is_told(tmp_path):
    pixels = sky(64, 32)
    pixels[3, 4, 0] = -0.5
    path = broken(pixels)(tmp_path)
    (warning,) = load_environment(path).warnings
    assert warning == f"{path}: 1 pixels are negative and take light away (the least is -0.5)"


def test_integers_are_decoded_and_their_loss_is_told(tmp_path):
    codes = np.full((8, 16, 3), 188, np.uint8)
    spec = OpenImageIO.ImageSpec(16, 8, 3, "uint8")
    output = OpenImageIO.ImageOutput.create(str(tmp_path / "a.png"))
    assert output.open(str(tmp_path / "a.png"), spec)
    assert output.write_image(codes)
    output.close()
    found = load_environment(tmp_path / "a.png")
    np.testing.assert_allclose(found.pixels[0], 0.5028865, rtol=1e-5)
    (warning,) = found.warnings
    assert "a picture of integers holds no light beyond its white" in warning


def test_values_that_end_at_one_are_told(tmp_path):
    path = broken(np.minimum(3.0 * sky(64, 32), 1.0))(tmp_path)
    (warning,) = load_environment(path).warnings
    assert "values end at 1; light beyond it" in warning
