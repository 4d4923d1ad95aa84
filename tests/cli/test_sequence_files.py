"""``skybake sequence``: its maps, what it writes about them, and what it says."""

import csv
import hashlib
import json
import math
from pathlib import Path

import numpy as np
import pytest

import skybake
from skybake.colour.exposure import luminance_from_ev
from skybake.formats.reader import read_image
from skybake.preset import load_preset
from skybake.sequence.frames import parse_frames
from tests.cli.runs import invoke, listing
from tests.cli.sequences import (
    DAY,
    PARIS,
    QUICK,
    THREE,
    attributes,
    digests,
    files,
    records,
    sequence,
)

pytestmark = pytest.mark.usefixtures("folder")


def test_a_southern_noon_sun_crosses_the_seam_whole():
    """At Ushuaia the sun of noon stands in the north, where left and right edge meet."""
    told = sequence(
        *("--lat", "54.8S", "--lon", "68.3W", "--date", "2026-12-21"),
        *("--from", "noon-10min", "--to", "noon+10min", "--frames", "1-9"),
        *("--sun-disc", "only", "--pixel", "float", "--manifest", "a.json"),
    )
    edges = []
    for file, record in zip(told["files"], records("a.json"), strict=True):
        pixels, found = read_image(Path(file))
        zenith = (np.arange(32) + 0.5) / 32 * math.pi
        size = (2 * math.pi / 64) * 2 * math.sin(math.pi / 64) * np.sin(zenith)
        luminance = pixels @ [0.2126, 0.7152, 0.0722] * found["whiteLuminance"]
        flux = float((luminance * size[:, None]).sum())
        assert flux == pytest.approx(record["sun_illuminance_lux"], rel=2e-3)
        edges.append((bool(pixels[:, 0].any()), bool(pixels[:, -1].any())))
    assert (True, True) in edges
    assert edges[0] == (True, False)
    assert edges[-1] == (False, True)


def test_a_sequence_bakes_what_single_renders_bake(folder):
    sequence(*DAY, *THREE, "-o", "a.####.exr")
    for number, sun in enumerate(("20deg", "40deg", "60deg"), start=1):
        assert invoke("render", *QUICK, "--sun", sun, "-q", "-o", "b.exr").exit_code == 0
        assert Path("b.exr").read_bytes() == Path(f"a.{number:04d}.exr").read_bytes()
    assert listing(folder) == ["a.0001.exr", "a.0002.exr", "a.0003.exr", "a.sequence.json", "b.exr"]


def test_a_frame_of_a_time_is_the_render_of_that_time():
    times = ("--from", "2026-06-21T10:00", "--to", "2026-06-21T11:00")
    sequence(*PARIS, *times, "--frames", "1-2", "-o", "a.#.exr", "--refraction")
    place = (*PARIS, "--time", "2026-06-21T11:00", "--refraction")
    assert invoke("render", *QUICK, *place, "-q", "-o", "b.exr").exit_code == 0
    assert Path("b.exr").read_bytes() == Path("a.0002.exr").read_bytes()
    assert attributes("b.exr")["skybake:time"] == "2026-06-21T09:00:00Z"


def test_a_number_that_is_set_goes_evenly_over_the_frames():
    mars = ("--preset", "mars", "--sun", "30deg")
    sequence(*mars, *THREE, "--set", "dust.optical_depth=0.3..2", "-o", "a.#.exr")
    for frame, depth in ((1, 0.3), (2, 1.15), (3, 2)):
        recipe = json.loads(attributes(f"a.{frame:04d}.exr")["skybake:recipe"])
        changed = recipe["preset"]["set"]
        assert changed == {"constituents.dust.optical_depth": pytest.approx(depth)}
    assert (
        invoke(
            *("render", *QUICK, *mars, "--set", "dust.optical_depth=2", "-o", "b.exr", "-q")
        ).exit_code
        == 0
    )
    assert Path("b.exr").read_bytes() == Path("a.0003.exr").read_bytes()
    first, second, third = (one["sun_illuminance_lux"] for one in records("a.sequence.json"))
    # Bouguer's law: both steps are of 0.85 at 550 nm, and the dust is almost grey.
    path = 1.0 / math.sin(math.radians(30.0))
    assert math.log(first / second) == pytest.approx(0.85 * path, rel=0.05)
    assert math.log(second / third) == pytest.approx(0.85 * path, rel=0.05)


def test_files_and_manifest_tell_the_light():
    told = sequence(*DAY, *THREE, "--altitude", "2km", "-o", "a.#.exr")
    assert told["written"] == ["a.sequence.json"]
    for record in records("a.sequence.json"):
        (file,) = record["files"]
        found = attributes(file)
        for key, name in (
            ("sun_direction", "skybake:sunDirection"),
            ("sun_colour", "skybake:sunColour"),
            ("sun_illuminance_lux", "skybake:directNormalIlluminance"),
            ("direct_illuminance_lux", "skybake:directIlluminance"),
            ("sky_illuminance_lux", "skybake:skyIlluminance"),
        ):
            assert np.array_equal(np.float32(record[key]), np.float32(found[name]))
        elevation = math.radians(record["sun_elevation_deg"])
        assert record["sun_direction"][1] == pytest.approx(math.sin(elevation), abs=1e-7)
        assert record["sun_illuminance_lux"] * math.sin(elevation) == pytest.approx(
            record["direct_illuminance_lux"], rel=1e-4
        )
        assert record["altitude_m"] == 2000.0
        assert record["white_luminance_cd_m2"] == pytest.approx(1.2 * 2**15)
        assert record["sha256"] == [hashlib.sha256(Path(file).read_bytes()).hexdigest()]


def test_the_light_of_a_frame_is_that_of_a_render():
    sequence("--sun", "25deg", "--frames", "1", "-o", "a.exr")
    (record,) = records("a.sequence.json")
    result = invoke("render", *QUICK, "--sun", "25deg", "--json", "-q", "-o", "b.exr")
    told = json.loads(result.stdout)
    for key in ("direct_illuminance_lux", "sky_illuminance_lux", "sun_direction"):
        assert record[key] == pytest.approx(told[key], rel=1e-6, abs=1e-7)


def test_every_file_has_the_white_of_the_whole_sequence():
    sequence(*DAY, *THREE, "--ev", "12", "-o", "a.#.exr")
    (white,) = {attributes(path)["whiteLuminance"] for path in files("*.exr")}
    assert white == pytest.approx(luminance_from_ev(12.0))


def test_an_exposure_curve_is_straight_between_its_rows_and_level_beyond():
    Path("ev.csv").write_text("\ufeffframe,ev\n2,15\n4,11\n", encoding="utf-8")
    sequence("--sun", "30", "--frames", "1-5", "--exposure-curve", "ev.csv", "-o", "a.#.exr")
    pixels = []
    for frame, ev in enumerate((15, 15, 13, 11, 11), start=1):
        found, named = read_image(Path(f"a.{frame:04d}.exr"))
        assert named["whiteLuminance"] == pytest.approx(luminance_from_ev(ev), rel=1e-6)
        assert records("a.sequence.json")[frame - 1]["white_luminance_cd_m2"] == pytest.approx(
            luminance_from_ev(ev)
        )
        pixels.append(found[8].mean())
    assert pixels[2] / pixels[0] == pytest.approx(4.0, rel=2e-3)


def evs(*arguments):
    sequence(*DAY, "--frames", "1-4", "--manifest", "a.json", "--preview", *arguments)
    return [record["exposure_ev"] for record in records("a.json")]


def test_all_pictures_have_one_exposure_unless_told_otherwise():
    (ev,) = set(evs())
    assert set(evs("--only", "1-2")) == {ev}
    adapted = evs("--preview-ev", "adapt")
    assert adapted[-1] == ev
    assert len(set(adapted)) == 4
    assert evs("--preview-ev", "9.5") == [9.5] * 4
    Path("ev.csv").write_text("frame,ev\n1,15\n4,12\n", encoding="utf-8")
    assert evs("--exposure-curve", "ev.csv") == pytest.approx([15, 14, 13, 12])
    assert set(evs("--exposure-curve", "ev.csv", "--preview-ev", "3")) == {3.0}


def test_a_picture_of_a_part_is_that_of_the_whole():
    arguments = (*DAY, "--frames", "1-4", "--preview", "p.#.png", "-o", "a.#.exr")
    sequence(*arguments)
    before = digests("*.png")
    for path in files("*.png"):
        path.unlink()
    for part in ("1-2", "3-4"):
        sequence(*arguments, "--only", part)
    assert digests("*.png") == before


def test_a_part_leaves_no_manifest_unless_told(folder):
    arguments = (*DAY, "--frames", "1-4", "-o", "a.#.exr", "--only", "2-3")
    assert sequence(*arguments)["written"] == []
    assert listing(folder) == ["a.0002.exr", "a.0003.exr"]
    told = sequence(
        *arguments, "--manifest", "b.json", "--manifest", "b.csv", "--manifest", "b.usda"
    )
    assert told["written"] == ["b.json", "b.csv", "b.usda"]
    assert json.loads(Path("b.json").read_text("utf-8"))["frames"] == "2-3"
    with Path("b.csv").open(encoding="utf-8") as file:
        assert [row["frame"] for row in csv.DictReader(file)] == ["2", "3"]
    assert "a.0003.exr" in Path("b.usda").read_text("utf-8")


def test_a_manifest_elsewhere_finds_the_maps(folder):
    for name in ("maps", "lists"):
        (folder / name).mkdir()
    sequence(*DAY, *THREE, "-o", "maps/a.#.exr", "--manifest", "lists/a.json")
    for record in records("lists/a.json"):
        assert (folder / "lists" / record["files"][0]).is_file()


def test_a_manifest_has_the_recipe_and_the_command():
    sequence(*DAY, *THREE, "-o", "a.#.exr", "--skip-existing", "--retry", "1", "--workers", "1")
    manifest = json.loads(Path("a.sequence.json").read_text("utf-8"))
    recipe = manifest["recipe"]
    assert recipe["map"]["width"] == 64
    assert "sun_elevation_deg" not in recipe["map"]
    assert recipe["preset"] == load_preset("earth").recipe
    command = ["skybake", "sequence", "--sun=20deg..60deg", "--frames=1-3", "--size=64x32"]
    assert recipe["command"] == [*command, "--method=hillaire", f"--output={Path.cwd()}/a.#.exr"]
    assert parse_frames(manifest["frames"]) == (1, 2, 3)
    assert manifest["skybake"] == skybake.__version__


def test_a_manifest_tells_of_the_world_only_what_all_frames_have():
    changes = ("--set", "aerosol.optical_depth=0.1..0.3", "--set", "ground.albedo=0.4")
    sequence("--sun", "30", *THREE, *changes, "-o", "a.#.exr")
    recipe = json.loads(Path("a.sequence.json").read_text("utf-8"))["recipe"]
    of_frame = json.loads(attributes("a.0001.exr")["skybake:recipe"])["preset"]
    assert of_frame["set"].keys() - recipe["preset"]["set"].keys() == {
        "constituents.aerosol.optical_depth"
    }
    assert recipe["preset"]["set"] == {"ground.albedo": 0.4}
    told, whole = (one["constituents"]["aerosol"] for one in (recipe["preset"], of_frame))
    assert whole == told | {"optical_depth": 0.1}
    assert "--set=aerosol.optical_depth=0.1..0.3" in recipe["command"]


def test_contact_sheet_and_moving_picture_hold_all_frames():
    from PIL import Image

    sequence(
        *DAY, "--frames", "1-6", "--contact-sheet", "s.png", "--animate", "m.webp", "--fps", "8"
    )
    with Image.open("m.webp") as moving:
        assert (moving.n_frames, moving.size) == (6, (512, 256))
    with Image.open("s.png") as sheet:
        columns = round(sheet.width / 264)
        assert columns * round(sheet.height / 150) >= 6
        brightness = np.asarray(sheet.convert("L"), float)
    assert brightness.max() > 200


def test_a_contact_sheet_is_the_same_beside_a_moving_picture():
    sequence(*DAY, *THREE, "--contact-sheet", "a.png")
    sequence(*DAY, *THREE, "--contact-sheet", "b.png", "--animate", "b.webp")
    assert Path("a.png").read_bytes() == Path("b.png").read_bytes()


def test_lines_tell_each_frame_and_the_summary_is_on_standard_output(folder):
    result = invoke("sequence", *QUICK, *DAY, *THREE, "-o", "a.#.exr", "--workers", "1")
    assert result.exit_code == 0
    lines = [line for line in result.stderr.splitlines() if "/3 " in line]
    assert [line[: line.index(",")] for line in lines] == [
        f"skybake: {i}/3 baked a.000{i}.exr" for i in (1, 2, 3)
    ]
    assert all("frames/s" in line for line in lines)
    assert "s left" in lines[0]
    assert result.stdout.splitlines()[0] == "a.sequence.json"
    assert result.stdout.splitlines()[1].startswith("3 frames baked, 0 skipped, 0 failed; ")
    again = invoke("sequence", *QUICK, *DAY, *THREE, "-o", "a.#.exr", "--skip-existing")
    assert sorted(line.partition(" ")[2][4:] for line in again.stderr.splitlines()) == [
        f"skipped a.000{i}.exr" for i in (1, 2, 3)
    ]


def test_a_quiet_run_prints_nothing():
    result = invoke("sequence", *QUICK, *DAY, *THREE, "-q")
    assert (result.exit_code, result.output) == (0, "")


def test_progress_for_the_open_job_description():
    result = invoke("sequence", *QUICK, *DAY, "--frames", "1-4", "-q", "--progress", "openjd")
    assert result.stderr == ""
    lines = result.stdout.splitlines()
    assert [line for line in lines if line.startswith("openjd_progress")] == [
        f"openjd_progress: {share:.1f}" for share in (25, 50, 75, 100)
    ]
    assert [line.split()[0] for line in lines[1::2]] == ["openjd_status:"] * 4


def test_json_is_one_object():
    told = sequence(*DAY, *THREE, "-o", "a.#.exr")
    assert told["files"] == ["a.0001.exr", "a.0002.exr", "a.0003.exr"]
    assert (told["baked"], told["skipped"], told["failed"]) == (3, 0, {})
    assert told["seconds"] > 0.0
