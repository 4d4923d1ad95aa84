"""Lighting maps from the command line."""

import json

import numpy as np
import OpenImageIO
import pytest

from skybake.commands.ibl import ibl
from skybake.commands.options import choices
from skybake.ibl import program, settings
from skybake.projection.cubemap import FACES
from tests.baking.maps import pixels
from tests.cli.runs import invoke, listing
from tests.formats.cubes import decode, read_ktx2

SMALL = ("--specular-size", 16, "--mips", 4, "--diffuse-size", 8, "--samples", 32)
SETS = (*SMALL, "--dfg-size", 8)
SUN = ("--sun", "40deg", "--sun-azimuth", "60deg")


@pytest.fixture(scope="module")
def sunny(tmp_path_factory):
    """An equirect map of ours with its sun."""
    path = tmp_path_factory.mktemp("ibl") / "sunny.exr"
    made = invoke("render", *SUN, "--size", "1024x512", "-q", "-o", path)
    assert made.exit_code == 0, made.output
    return path


def cube_of(path):
    """Levels of a KTX 2 file of halves or floats, (6, edge, edge, 3), and its texts."""
    header, levels, _, texts = read_ktx2(path)
    pixel = {97: "half", 109: "float", 123: "rgb9e5", 122: "r11g11b10"}[header["vk"]]
    made = []
    for k, level in enumerate(levels):
        edge = header["width"] >> k
        made.append(np.asarray(decode(level, pixel)).reshape(6, edge, edge, 3))
    return made, texts, pixel


def direction_of_brightest(cube):
    from skybake.ibl.cube import texel_directions

    place = np.unravel_index(cube.sum(axis=-1).argmax(), cube.shape[:3])
    return texel_directions(cube.shape[1])[place]


def test_a_sky_becomes_a_whole_set_whose_sun_stands_where_it_is(tmp_path):
    made = invoke("ibl", *SUN, *SETS, "-o", tmp_path / "sky", "--json")
    assert made.exit_code == 0, made.output
    names = ["dfg.exr", "diffuse.ktx2", "sh.json", "sh.txt", "specular.ktx2"]
    assert listing(tmp_path) == [f"sky_{name}" for name in names]
    summary = json.loads(made.stdout)
    assert summary["roughness"] == pytest.approx([0.0, 1 / 3, 2 / 3, 1.0])
    levels, texts, _ = cube_of(tmp_path / "sky_specular.ktx2")
    assert [level.shape[1] for level in levels] == [16, 8, 4, 2]
    assert float(texts["whiteLuminance"].rstrip(b"\0")) == pytest.approx(39321.6)
    sun = np.array([np.sin(np.pi / 3), np.tan(np.radians(40.0)), -np.cos(np.pi / 3)])
    sun /= np.linalg.norm(sun)
    assert direction_of_brightest(levels[0]) @ sun > np.cos(np.radians(6.0))
    assert direction_of_brightest(levels[1]) @ sun > np.cos(np.radians(12.0))
    harmonics = json.loads((tmp_path / "sky_sh.json").read_text())
    y, z, x = (harmonics["radiance"][i][1] for i in (1, 2, 3))
    assert x > 0.0 > z
    assert y > 0.0


def test_a_map_lights_as_the_sky_it_shows(tmp_path, sunny):
    assert invoke("ibl", *SUN, *SETS, "-q", "-o", tmp_path / "sky").exit_code == 0
    made = invoke("ibl", "--input", sunny, *SETS, "-q", "-o", tmp_path / "map")
    assert made.exit_code == 0, made.output
    for part in ("diffuse", "specular"):
        ours, theirs = (cube_of(tmp_path / f"{one}_{part}.ktx2")[0] for one in ("sky", "map"))
        # The sun is within a texel of the map, whose place moves the light of it.
        for first, second in zip(ours[1:] or ours, theirs[1:] or theirs, strict=True):
            assert second == pytest.approx(first, rel=0.03, abs=0.01 * first.max())


def test_a_sun_that_is_left_to_a_light_is_in_no_map(tmp_path, sunny):
    for name, of in (("sky", SUN), ("map", ("--input", sunny))):
        left = ("--sun-disc", "exclude", "--parts", "diffuse,specular", *SMALL)
        made = invoke("ibl", *of, *left, "-q", "-o", tmp_path / name)
        assert made.exit_code == 0, made.output
    sky, of_map = (cube_of(tmp_path / f"{name}_diffuse.ktx2")[0][0] for name in ("sky", "map"))
    assert of_map == pytest.approx(sky, rel=0.02)
    assert cube_of(tmp_path / "map_specular.ktx2")[0][0].max() < 10.0


def test_a_map_that_states_no_sun_keeps_it_or_is_refused(tmp_path):
    path = tmp_path / "foreign.hdr"
    made = invoke("render", *SUN, "--size", "64x32", "-q", "-o", path)
    assert made.exit_code == 0
    lines = path.read_bytes().partition(b"\n\n")
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + lines[2])
    arguments = ("ibl", "--input", path, *SETS, "-q", "-o", tmp_path / "out")
    left = invoke(*arguments, "--sun-disc", "exclude")
    assert left.exit_code == 1
    assert left.stderr.count("\n") == 1
    assert "foreign.hdr: a sun that is to be taken away must be stated" in left.stderr
    assert listing(tmp_path) == ["foreign.hdr"]
    assert invoke(*arguments).exit_code == 0


def test_targets_set_axes_format_and_the_roughness_of_levels(tmp_path):
    base = (*SUN, "--parts", "specular", "--specular-size", 16, "--samples", 16, "-q")
    assert (
        invoke("ibl", *base, "--target", "bevy", "--mips", 3, "-o", tmp_path / "b").exit_code == 0
    )
    levels, _, pixel = cube_of(tmp_path / "b_specular.ktx2")
    assert pixel == "rgb9e5"
    # Without the disc the sky is brightest beside it; Bevy negates z.
    sun = np.array([np.sin(np.pi / 3), np.tan(np.radians(40.0)), +np.cos(np.pi / 3)])
    assert direction_of_brightest(levels[0]) @ sun / np.linalg.norm(sun) > 0.98
    made = invoke("ibl", *base, "--target", "filament", "-o", tmp_path / "f")
    assert made.exit_code == 0, made.output
    names = {f"f_m{mip}_{face}.exr" for mip in range(5) for face in FACES}
    assert names == {name for name in listing(tmp_path) if name.startswith("f_")}
    assert pixels(tmp_path / "f_m4_px.exr").shape == (1, 1, 3)


def test_cubes_of_a_sky_and_of_a_map_are_turned_alike(tmp_path, sunny):
    """To -Z, where their suns are then."""
    for name, of in (("sky", SUN), ("map", ("--input", sunny))):
        turned = ("--parts", "sh", "--rotate", "60deg", "-q", "-o", tmp_path / name)
        assert invoke("ibl", *of, *turned).exit_code == 0
        radiance = json.loads((tmp_path / f"{name}_sh.json").read_text())["radiance"]
        _, z, x = (radiance[i][1] for i in (1, 2, 3))
        assert z < 0.0
        assert abs(x) < 0.01 * abs(z)


def test_maps_of_unknown_scale_make_files_that_state_none(tmp_path):
    untagged = tmp_path / "untagged.exr"
    out = OpenImageIO.ImageOutput.create(str(untagged))
    assert out.open(str(untagged), OpenImageIO.ImageSpec(32, 16, 3, "half"))
    assert out.write_image(np.full((16, 32, 3), 0.5, np.float32))
    out.close()
    made = invoke("ibl", "--input", untagged, *SETS, "--json", "-o", tmp_path / "out")
    assert made.exit_code == 0, made.output
    assert json.loads(made.stdout)["white_luminance_cd_m2"] is None
    levels, texts, _ = cube_of(tmp_path / "out_specular.ktx2")
    assert "whiteLuminance" not in texts
    assert all(level == pytest.approx(0.5) for level in levels)


def test_cubes_are_written_as_dds(tmp_path, sunny):
    stored = ("--format", "dds", "--parts", "specular", *SMALL[:4])
    assert invoke("ibl", "--input", sunny, *stored, "-q", "-o", tmp_path / "a").exit_code == 0
    data = (tmp_path / "a_specular.dds").read_bytes()
    # Header and DX10 header, then six faces of 16, 8, 4 and 2 texels of four halves.
    assert data[:4] == b"DDS "
    assert len(data) == 148 + 6 * 8 * (256 + 64 + 16 + 4)


def test_files_of_faces_are_named_in_a_folder_as_cmgen_names_them(tmp_path):
    folder = tmp_path / "env"
    folder.mkdir()
    arguments = ("--parts", "diffuse,sh", "--diffuse-size", 4, "--format", "exr", "-q")
    assert invoke("ibl", *SUN, *arguments, "-o", f"{folder}/").exit_code == 0
    assert listing(folder) == sorted([*(f"i_{face}.exr" for face in FACES), "sh.json", "sh.txt"])


def test_nothing_is_written_if_one_file_of_a_set_fails(tmp_path):
    """Half of 32 bits for three colours hold no disc in cd/m2."""
    made = invoke(
        *("ibl", *SUN, *SETS, "--units", "nits", "--pixel", "rgb9e5", "-q", "-o", tmp_path / "sky")
    )
    assert made.exit_code == 1
    assert made.stderr.count("\n") == 1
    assert "sky_specular.ktx2" in made.stderr
    assert listing(tmp_path) == []


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (("--specular-size", "100"), "--specular-size: must be a power of two from 2 to 2048"),
        (("--specular-size", "8192"), "--specular-size: must be a power of two from 2 to 2048"),
        (("--diffuse-size", "0"), "--diffuse-size: must be a power of two from 2 to 512"),
        (("--mips", "10"), "--mips: must be from 2 to 9 for a specular size of 256, got 10"),
        (("--mips", "1"), "--mips: must be from 2 to 9"),
        (("--samples", "0"), "--samples: must be from 16 to 65536, got 0"),
        (("--dfg-size", "1"), "--dfg-size: must be from 2 to 1024, got 1"),
        (("--parts", "sh,light"), "must be some of specular,diffuse,sh,dfg"),
        (("--parts", "sh", "--mips", "4"), "--mips: needs --parts specular"),
        (("--parts", "sh", "--format", "dds"), "--format: needs --parts specular or diffuse"),
        (("--format", "dds", "--pixel", "rgb9e5"), "--pixel: must be one of auto, half, float"),
        (("--target", "blender"), "'blender' is not one of 'bevy', 'three', 'filament'"),
        (("--target", "bevy", "--format", "exr"), "--format: must be ktx2 for the target bevy"),
        (("--target", "three", "--format", "ktx2"), "--format: must be exr for the target three"),
        (("--target", "bevy", "--cube-space", "world"), "--cube-space: must be flip-z"),
        (("--target", "bevy", "--sun-soft"), "--sun-soft: needs --sun-disc include"),
        (("--face-names", "posx"), "--face-names: needs --format exr"),
        (("--format", "exr", "--face-names", "a,b"), "--face-names: must be px, posx"),
        (("--input", "a.exr", "--sun", "3deg"), "--sun: cannot be combined with --input"),
        (("--input", "a.exr", "--units", "nits"), "--units: cannot be combined with --input"),
        (("-o", "nowhere/"), "must be a folder that exists, got 'nowhere/'"),
        (("-o", "sky.ktx2"), "must be what the names of several files begin with"),
    ],
)
def test_what_cannot_be_made_is_refused_at_once(tmp_path, arguments, problem):
    made = invoke("ibl", *arguments)
    assert made.exit_code == 2
    assert made.stderr.count("\n") == 1
    assert problem in made.stderr


@pytest.mark.parametrize("content", [b"", b"#?RADIANCE\n\n-Y 3 +X 4\n"])
def test_files_that_are_no_maps_are_refused(tmp_path, content):
    path = tmp_path / "bad.hdr"
    path.write_bytes(content)
    made = invoke("ibl", "--input", path, *SETS, "-q", "-o", tmp_path / "out")
    assert made.exit_code == 1
    assert made.stderr.count("\n") == 1
    assert listing(tmp_path) == ["bad.hdr"]


def test_a_picture_of_integers_is_taken_with_a_warning(tmp_path, sunny):
    assert invoke("preview", sunny, "-o", tmp_path / "low.png", "-q").exit_code == 0
    made = invoke("ibl", "--input", tmp_path / "low.png", *SETS, "-q", "-o", tmp_path / "out")
    assert made.exit_code == 0, made.output
    assert "warning" in made.stderr
    assert "light beyond its white" in made.stderr


def test_choices_and_defaults_are_those_of_the_engine():
    assert choices.LIGHTING_PARTS == settings.PARTS
    assert choices.LIGHTING_FORMATS == settings.FORMATS
    assert choices.LIGHTING_TARGETS == program.PROGRAMS
    assert choices.MIP_ROUGHNESS == settings.MAPPINGS
    shown = {option.name: option.show_default for option in ibl.params}
    made = settings.LightingMaps()
    for name in ("specular_size", "diffuse_size", "mips", "samples", "dfg_size"):
        assert shown[name] == str(getattr(made, name))
