"""``skybake sequence``: what it is told, what it bakes, and what it says."""

import csv
import hashlib
import json
import math
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest

import skybake
from skybake.baking import MapSettings
from skybake.colour.exposure import luminance_from_ev
from skybake.errors import OutputError
from skybake.formats.reader import read_image
from skybake.preset import load_preset
from skybake.sequence.frames import parse_frames
from skybake.sequence.plan import Frame, Plan
from tests.cli.runs import SMALL, invoke, listing
from tests.cli.test_faults import check_fault, table

QUICK = (*SMALL, "--method", "hillaire")
DAY = ("--sun", "20deg..60deg")
THREE = ("--frames", "1-3")
PARIS = ("--lat", "48.8566", "--lon", "2.3522", "--tz", "Europe/Paris")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def sequence(*arguments, status=0):
    """Bake quietly; returns what ``--json`` prints."""
    result = invoke("sequence", *QUICK, "--json", "--quiet", *arguments)
    assert result.exit_code == status, result.output
    return json.loads(result.stdout)


def plan(*arguments):
    """Frames of a dry run."""
    result = invoke("sequence", "--dry-run", "--json", *arguments)
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)["frames"]


def attributes(path):
    return read_image(Path(path))[1]


def digests(pattern):
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in _found(pattern)}


def _found(pattern):
    found = sorted(Path().glob(pattern))
    assert found
    return found


USAGE = """
--sun 30                               => --frames: is needed, as 1-96
--frames 1-3 --sun 10..95              => '--sun': must be from -90deg to 90deg, got 95
--frames 1-3 --sun 10..                => '--sun': must be an angle such as 5deg
--frames 1-3 --sun 10..20..30          => '--sun': must be an angle such as 5deg
--frames 1-3 --sun 5deg...10deg        => '--sun': must have two dots between two values, got 5deg
--frames 1-3 --altitude 5..10km        => '--altitude': must have a unit on both sides, got 5..10km
--frames 1-3 --sun 0.1..0.5rad         => '--sun': must have a unit on both sides, got 0.1..0.5rad
--frames 1-3 --altitude 0..-1km        => '--altitude': must be at least 0m, which is the ground
--frames 1:3                           => '--frames': must have a step as in 1-100x5, got '1:3'
--frames 3-1                           => '--frames': a range must ascend, got '3-1'
--frames 1-3x0                         => '--frames': a step must be at least 1
--frames 1-9999999                     => '--frames': must be at most 1000000, got more
--frames x                             => '--frames': must be as 1-100x5,150 or -10--1, got 'x'
--frames 1-3 --only 4                  => --only: must name frames of 1-3, got 4
--frames 1-3 --only 2-4                => --only: must name frames of 1-3, got 4
--frames 1-9x4 --only 0-5              => --only: must name frames of 1-9, got 0
--frames 1-9x4 --only 2-4              => --only: must name frames of 1-9, got 2
--frames 1-3 --every 10min             => --every: needs --from and --to
--frames 1-3 --lat 48 --lon 2          => --lat: needs --from and --to
--frames 1-3 --from 2026-06-21T04:00Z  => --from, --to: each needs the other
P --frames 1-3 D --sun 30              => --sun: needs no --from and --to beside it
P --frames 1-3 D --sun-azimuth 30      => --sun-azimuth: needs no --from and --to beside it
P D                                    => --frames: is needed, or --every
P D --every 0min                       => '--every': must be greater than 0s, got 0min
P D --every soon                       => '--every': must be a duration such as 10min
P D --every 1h --frames 1-3            => --frames: must be as many as --every makes, which is 6, g
P --from 2026-06-21T04:00 --to 2026-06-21T04:00 --every 1h => --to: must be after the start
--from 2026-06-21T04:00 --to 2026-06-21T06:00 --every 1h --lat 1 --lon 2 => --from: needs an offset
--frames 1-3 -o sky.exr                => --output: sky.exr: must have a place for the frame number
--frames 1-3 -o sky.##.##.exr          => --output: sky.##.##.exr: must have one frame number
--frames 1-3 -o a.##/sky.exr           => --output: a.##/sky.exr: frame number must stand in the fil
--frames 1-3 -o sky.%5x.exr            => --output: sky.%5x.exr: frame number must be as ####
--frames 1-3 -o sky.####               => '-o' / '--output': sky.####: suffix must be .exr or .hdr
--frames 1-3 --preview sky.png         => --preview: sky.png: must have a place for the frame number
--frames 1-3 --preview sky.%q.png      => --preview: sky.%q.png: frame number must be as ####
--frames 1-3 --preview sky.#.jpg       => '--preview': sky.#.jpg: suffix must be .png, got '.jpg'
--frames 1-3 --preview-ev 3            => --preview-ev: needs --preview or --contact-sheet or --anim
--frames 1-3 --view aces1              => --view: needs --preview or --contact-sheet or --animate
--frames 1-3 --preview --preview-ev x  => '--preview-ev': must be auto or a number from -30 to 40
--frames 1-3 --exposure-curve a.csv --ev 3 => --ev: needs no --exposure-curve beside it
--frames 1-3 --exposure-curve a.csv --units nits => --units: needs no --exposure-curve beside it
--frames 1-3 --manifest a.xml          => '--manifest': a.xml: suffix must be .json or .csv or .usda
--frames 1-3 --contact-sheet a.jpg     => '--contact-sheet': a.jpg: suffix must be .png
--frames 1-3 --animate a.mp4           => '--animate': a.mp4: suffix must be .webp or .gif
--frames 1-3 --fps fast                => '--fps': 'fast' is not a valid float
--frames 1-3 --workers 0               => '--workers': 0 is not in the range 1<=x<=256
--frames 1-3 --retry -1                => '--retry': -1 is not in the range 0<=x<=100
--frames 1-3 --chunk-size 0            => '--chunk-size': 0 is not in the range x>=1
--frames 1-3 --progress loud           => '--progress': 'loud' is not one of 'auto', 'bar', 'plain'
--frames 1-3 --pixel half -o a.#.hdr   => --pixel: needs an .exr output
--frames 1-3 --cube-layout cross       => --cube-layout: needs --projection cubemap
--frames 1-3 --size 64x64              => --size: width must be twice the height, got 64x64
"""
SHORT = {
    "P": PARIS,
    "D": ("--from", "2026-06-21T04:00", "--to", "2026-06-21T09:00"),
}


@pytest.mark.parametrize(("arguments", "message"), table(USAGE))
def test_wrong_usage_is_one_line_exit_2_and_no_file(folder, arguments, message):
    words = [word for text in arguments.split() for word in SHORT.get(text, (text,))]
    check_fault(invoke("sequence", *words), 2, message)
    assert listing(folder) == []


FAILED = """
--preset vulcan                     => unknown preset 'vulcan'
--set dust.optical_depth=0.1..2     => --set: 'dust.optical_depth': unknown key
--set aerosol.optical_depth=0.1..-2 => optical_depth: must be
--set aerosol.optical_depth=0.1...2 => optical_depth: must be a number, got '0.1...2'
--set aerosol.optical_depth=0.1..   => optical_depth: must be a number, got '0.1..'
-o absent/a.#.exr                   => absent/a.0001.exr: folder must exist, got
--preview absent/a.#.png            => absent/a.0001.png: folder must exist, got
--manifest absent/a.json            => absent/a.json: folder must exist, got
--contact-sheet absent/a.png        => absent/a.png: folder must exist, got
--animate absent/a.webp             => absent/a.webp: folder must exist, got
--animate a.gif --fps 90            => a.gif: frames per second must be from 0.1 to 50, got 90
--exposure-curve absent.csv         => absent.csv: must be a CSV file that can be read, got
--projection cubemap --size 8 --manifest a.usda => a.usda: a dome light of USD needs maps of the
--manifest a.json --manifest ./a.json => a.json: must be written once, got the file of two
--preview a.#.png --contact-sheet a.0002.png => a.0002.png: must be written once, got the file of
--emit-openjd absent/job            => absent/job: must be a folder, got
"""


@pytest.mark.parametrize(("arguments", "message"), table(FAILED))
def test_what_cannot_be_done_is_one_line_exit_1_and_no_file(folder, arguments, message):
    check_fault(invoke("sequence", *QUICK, *THREE, *arguments.split()), 1, message)
    assert listing(folder) == []


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("frame,ev\n", "must hold the columns frame and ev, got no row"),
        ("frame;ev\n1;15\n", "line 2: must hold numbers under frame and ev"),
        ("frame,ev\n1,bright\n", "line 2: must hold numbers under frame and ev"),
        ("frame,ev\n1\n", "line 2: must hold numbers under frame and ev"),
        ("frame,ev\n1,41\n", "line 2: ev must be from -30 to 40, got 41"),
        ("frame,ev\n1,nan\n", "line 2: ev must be from -30 to 40, got nan"),
        ("frame,ev\n2,15\n1,14\n", "line 3: frames must ascend, got 1"),
        (b"\xff\xfe\x00", "must be a CSV file that can be read, got"),
    ],
)
def test_a_faulty_exposure_curve_is_one_line(folder, content, message):
    path = Path("ev.csv")
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    result = invoke("sequence", *QUICK, *THREE, "--exposure-curve", "ev.csv")
    check_fault(result, 1, f"ev.csv: {message}")
    assert listing(folder) == ["ev.csv"]


def test_a_range_goes_evenly_and_exactly_from_the_first_frame_to_the_last():
    frames = plan(
        *("--sun", "-6..90deg", "--sun-azimuth", "350..370", "--altitude", "0..400km"),
        *("--frames", "1-5,9"),
    )
    assert [one["frame"] for one in frames] == [1, 2, 3, 4, 5, 9]
    assert [one["sun_elevation_deg"] for one in frames] == pytest.approx([-6, 6, 18, 30, 42, 90])
    assert [one["sun_azimuth_deg"] for one in frames][::5] == pytest.approx([350.0, 370.0])
    assert [one["altitude_m"] for one in frames] == pytest.approx([0, 5e4, 1e5, 15e4, 2e5, 4e5])
    assert [one["file"] for one in frames][::5] == ["earth.0001.exr", "earth.0009.exr"]


def test_a_single_frame_is_the_start_of_its_range():
    (frame,) = plan("--sun", "10..20", "--frames", "7", "-o", "a.exr")
    assert frame["sun_elevation_deg"] == pytest.approx(10.0)
    assert frame["file"] == "a.exr"


def test_a_part_has_the_suns_of_the_whole():
    whole = plan(*DAY, "--frames", "1-96")
    assert plan(*DAY, "--frames", "1-96", "--only", "0010-0012,96") == [*whole[9:12], whole[95]]


def test_a_part_may_name_what_lies_between_the_frames():
    """As farms do that know no steps."""
    frames = plan(*DAY, "--frames", "1-96x5", "--only", "10-20")
    assert [one["frame"] for one in frames] == [11, 16]


def test_a_dry_run_prints_the_plan_and_writes_nothing(folder):
    result = invoke("sequence", *DAY, *THREE, "--dry-run", "--altitude", "1km")
    assert result.exit_code == 0
    assert result.stderr == ""
    assert result.stdout.splitlines() == [
        "1  sun 20.00deg at 180.00deg, altitude 1000m  earth.0001.exr",
        "2  sun 40.00deg at 180.00deg, altitude 1000m  earth.0002.exr",
        "3  sun 60.00deg at 180.00deg, altitude 1000m  earth.0003.exr",
    ]
    assert listing(folder) == []


def test_the_frames_of_a_day_are_counted_from_one_and_know_their_time():
    frames = plan(
        *(*PARIS, "--from", "2026-06-21T04:00", "--to", "2026-06-21T22:00", "--every", "10min")
    )
    assert [one["frame"] for one in frames] == list(range(1, 110))
    assert frames[0]["label"] == "2026-06-21T04:00:00+02:00"
    assert frames[0]["skybake:time"] == "2026-06-21T02:00:00Z"
    assert frames[-1]["label"] == "2026-06-21T22:00:00+02:00"
    highest = max(frames, key=lambda one: one["sun_elevation_deg"])
    assert highest["sun_elevation_deg"] == pytest.approx(90 - 48.8566 + 23.44, abs=0.02)
    assert highest["label"][11:16] == "13:50"


def test_frames_that_are_left_out_leave_a_gap_in_time():
    times = ("--from", "2026-06-21T04:00", "--to", "2026-06-21T06:00")
    whole = plan(*PARIS, *times, "--frames", "1-5")
    assert [one["label"][11:16] for one in whole] == ["04:00", "04:30", "05:00", "05:30", "06:00"]
    assert plan(*PARIS, *times, "--frames", "1-5x2") == whole[::2]


PLACES = {
    "Paris, where clocks skip an hour": (
        (*PARIS, "--from", "2026-03-29T01:00", "--to", "2026-03-29T04:00"),
        ["01:00:00+01:00", "03:00:00+02:00", "04:00:00+02:00"],
        (-41, -14),
    ),
    "Quito, where noon is high": (
        *(("--lat", "0.18S", "--lon", "78.47W", "--tz", "America/Guayaquil"),),
        ["11:00:00-05:00", "12:00:00-05:00", "13:00:00-05:00"],
        (69, 90),
    ),
    "Tromsø in summer, where the sun stays up": (
        *(("--lat", "69.65", "--lon", "18.96", "--tz", "Europe/Oslo"),),
        ["23:00:00+02:00", "00:00:00+02:00", "01:00:00+02:00"],
        (2.5, 5.5),
    ),
    "Tromsø in winter, where it stays down": (
        *(("--lat", "69.65", "--lon", "18.96", "--tz", "Europe/Oslo"),),
        ["11:00:00+01:00", "12:00:00+01:00", "13:00:00+01:00"],
        (-5, -2.5),
    ),
}
SPANS = {
    "Quito, where noon is high": ("2026-03-20T11:00", "2026-03-20T13:00"),
    "Tromsø in summer, where the sun stays up": ("2026-06-20T23:00", "2026-06-21T01:00"),
    "Tromsø in winter, where it stays down": ("2026-12-21T11:00", "2026-12-21T13:00"),
}


@pytest.mark.parametrize("place", PLACES)
def test_places_have_their_clock_and_their_sun(place):
    where, labels, (lowest, highest) = PLACES[place]
    span = SPANS.get(place)
    times = () if span is None else ("--from", span[0], "--to", span[1])
    frames = plan(*where, *times, "--every", "1h")
    assert [one["label"][11:] for one in frames] == labels
    for one in frames:
        assert lowest < one["sun_elevation_deg"] < highest


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


def records(path):
    return json.loads(Path(path).read_text("utf-8"))["records"]


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


@pytest.mark.parametrize("suffix", ["exr", "hdr"])
def test_a_resumed_run_skips_what_is_whole_and_writes_the_same_manifest(folder, suffix):
    arguments = (*DAY, "--frames", "1-4", "-o", f"a.#.{suffix}", "--manifest", "a.json")
    arguments += ("--manifest", "a.csv", "--contact-sheet", "a.png", "--preview")
    assert sequence(*arguments)["baked"] == 4
    before = digests("*")
    written = {path: path.stat().st_mtime_ns for path in _found(f"*.{suffix}")}
    Path(f"a.0003.{suffix}").unlink()
    Path("a.0002.png").unlink()
    told = sequence(*arguments, "--skip-existing", "--workers", "1", "--retry", "2")
    assert (told["baked"], told["skipped"]) == (2, 2)
    assert digests("*") == before
    kept = [path for path, time in written.items() if path.stat().st_mtime_ns == time]
    assert [path.name for path in kept] == [f"a.0001.{suffix}", f"a.0004.{suffix}"]
    told = sequence(*arguments, "--skip-existing")
    assert (told["baked"], told["skipped"]) == (0, 4)
    assert digests("*") == before


def test_what_a_killed_process_left_goes_when_its_frame_is_found_whole(folder):
    arguments = (*DAY, *THREE, "-o", "a.#.exr", "--preview")
    sequence(*arguments)
    before = listing(folder)
    for name in ("a.0002.exr", "a.0003.png"):
        digest = hashlib.sha256(name.encode()).hexdigest()[:12]
        left = folder / f".skybake-{digest}-0123456789abcdef"
        left.mkdir()
        (left / "whole.exr").write_bytes(b"half")
    assert sequence(*arguments, "--skip-existing")["skipped"] == 3
    assert listing(folder) == before


def without_last(content):
    return content[:-1]


def cut(share):
    return lambda content: content[: int(len(content) * share)]


def flip(share):
    """Change a byte amid the pixels."""

    def flipped(content):
        at = int(len(content) * share)
        return content[:at] + bytes([content[at] ^ 0xFF]) + content[at + 1 :]

    return flipped


DAMAGES = {
    "empty": cut(0.0),
    "header only": cut(0.05),
    "half": cut(0.5),
    "last block lost": cut(0.97),
    "last byte lost": without_last,
    "a byte changed": flip(0.9),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_file_that_is_not_whole_is_baked_again(damage):
    arguments = (*DAY, *THREE, "-o", "a.#.exr", "--compression", "zips")
    sequence(*arguments)
    before = digests("*.exr")
    path = Path("a.0002.exr")
    path.write_bytes(DAMAGES[damage](path.read_bytes()))
    assert digests("*.exr") != before
    told = sequence(*arguments, "--skip-existing")
    assert (told["baked"], told["skipped"]) == (1, 2)
    assert digests("*.exr") == before


@pytest.mark.parametrize("damage", ["empty", "header only", "half", "last byte lost"])
def test_a_radiance_picture_that_is_not_whole_is_baked_again(damage):
    arguments = (*DAY, "--frames", "1-2", "-o", "a.#.hdr")
    sequence(*arguments)
    before = digests("*.hdr")
    path = Path("a.0002.hdr")
    path.write_bytes(DAMAGES[damage](path.read_bytes()))
    assert sequence(*arguments, "--skip-existing")["baked"] == 1
    assert digests("*.hdr") == before


def test_files_of_others_are_baked_again():
    arguments = (*DAY, "--frames", "1-5", "-o", "a.#.exr")
    sequence(*arguments)
    before = digests("*.exr")
    pixels, _ = read_image(Path("a.0001.exr"))
    foreign = OpenImageIO.ImageBuf(pixels)
    assert foreign.write("foreign.exr")
    Path("foreign.exr").replace("a.0001.exr")
    assert invoke("render", *QUICK, "--sun", "30", "-q", "-o", "b.hdr").exit_code == 0
    Path("b.hdr").replace("a.0002.exr")
    Path("a.0004.exr").replace("a.0003.exr")
    Path("a.0004.exr").write_text("no picture", encoding="utf-8")
    told = sequence(*arguments, "--skip-existing")
    assert (told["baked"], told["skipped"]) == (4, 1)
    assert digests("*.exr") == before


CHANGED = [
    ("--sun", "20deg..61deg"),
    ("--size", "32x16"),
    ("--units", "nits"),
    ("--pixel", "float"),
    ("--compression", "piz"),
    ("--colorspace", "acescg"),
    ("--set", "aerosol.optical_depth=0.3"),
    ("--altitude", "1m"),
]


@pytest.mark.parametrize("change", CHANGED, ids=lambda change: change[0])
def test_files_of_another_recipe_are_baked_again(change):
    arguments = (*DAY, *THREE, "-o", "a.#.exr")
    sequence(*arguments)
    told = sequence(*arguments, *change, "--skip-existing")
    # The first frame's sun is the same in both ranges.
    assert told["baked"] == (2 if change[0] == "--sun" else 3)


def test_a_cube_of_six_files_is_skipped_as_a_whole():
    arguments = ("--projection", "cubemap", "--size", "16", *DAY, "--frames", "1-2")
    told = sequence(*arguments, "-o", "sky_{face}.####.exr")
    assert len(told["files"]) == 12
    assert told["written"] == ["sky.sequence.json"]
    before = digests("*.exr")
    Path("sky_ny.0002.exr").unlink()
    told = sequence(*arguments, "-o", "sky_{face}.####.exr", "--skip-existing")
    assert (told["baked"], told["skipped"]) == (1, 1)
    assert digests("*.exr") == before


def test_two_frames_never_share_a_file(folder):
    settings = MapSettings(width=16, projection="cubemap")
    first, second = (Frame(i, 0, settings, Path(f"a.{i}.exr")) for i in (1, 2))
    for name in ("a.1_px.exr", "a.2_nz.exr"):
        (folder / name).symlink_to(folder / "same.exr")
    planet = load_preset("earth")
    with pytest.raises(OutputError, match=r"a.2_nz.exr: must be written once, got the file of two"):
        Plan((planet,), (first, second)).check("aces2")
    Plan((planet,), (first,)).check("aces2")


def test_every_file_has_the_white_of_the_whole_sequence():
    sequence(*DAY, *THREE, "--ev", "12", "-o", "a.#.exr")
    (white,) = {attributes(path)["whiteLuminance"] for path in _found("*.exr")}
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
    for path in _found("*.png"):
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


def emitted(*arguments):
    result = invoke("sequence", "--emit-commands", *arguments)
    assert result.exit_code == 0, result.output
    return result.stdout.splitlines()


def test_emitted_commands_have_what_makes_the_frames_and_nothing_else(folder):
    Path("own.toml").write_text('extends = "earth"\n', encoding="utf-8")
    Path("ev.csv").write_text("frame,ev\n1,15\n", encoding="utf-8")
    Path("flat.csv").write_text("wavelength_nm,albedo\n300,0.2\n900,0.2\n", encoding="utf-8")
    lines = emitted(
        *("--preset", "own.toml", "--set", "aerosol.optical_depth=0.1..0.3", *DAY),
        *("--set", "ground.albedo=flat.csv", "--frames", "1-4", "--chunk-size", "3"),
        *("-o", "out dir/a.#.exr", "--workers", "1", "--skip-existing", "--retry", "2"),
        *("--contact-sheet", "s.png", "--preview-ev", "3", "--view", "aces1"),
        *("--exposure-curve", "ev.csv", "--manifest", "m.json", "--dask", "tcp://a:1", "-q"),
    )
    first = (
        f"skybake sequence --preset={folder}/own.toml --set=aerosol.optical_depth=0.1..0.3 "
        f"--set=ground.albedo={folder}/flat.csv --sun=20deg..60deg --frames=1-4 "
        f"--exposure-curve={folder}/ev.csv '--output={folder}/out dir/a.#.exr' "
        "--skip-existing --retry=2 --workers=1 --only "
    )
    assert lines == [f"{first}1-3", f"{first}4"]


def test_emitted_commands_of_a_part_are_of_that_part():
    lines = emitted(*DAY, "--frames", "1-9", "--only", "2-4,9", "--chunk-size", "2", "--preview")
    assert [line.partition(" --only ")[2] for line in lines] == ["2-3", "4,9"]
    assert all(" --preview " in line and "earth.####.exr" in line for line in lines)


def test_help_names_what_patterns_mean():
    text = " ".join(invoke("sequence", "--help").stdout.split())
    assert "#### is the frame number in four digits, as is a single #" in text


def test_the_default_name_tells_what_was_set_of_the_world(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for changes, name in (
        ((), "mars"),
        (("--set", "dust.optical_depth=2"), "mars_dust.optical_depth=2"),
        (("--set", "dust.optical_depth=0.3..2"), "mars"),
    ):
        result = invoke("sequence", "--preset", "mars", "--frames", "1-2", *changes, "--dry-run")
        assert result.exit_code == 0
        assert result.stdout.splitlines()[1].endswith(f"  {name}.0002.exr")
