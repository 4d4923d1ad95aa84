"""``skybake sequence``: what it is told, what it plans, and what it emits."""

import json
import math
from pathlib import Path

import pytest

from skybake.errors import OutputError
from skybake.image.settings import map_settings
from skybake.preset import load_preset
from skybake.sequence.plan import Frame, Plan
from tests.cli.runs import invoke, listing
from tests.cli.sequences import DAY, PARIS, QUICK, THREE, plan
from tests.cli.test_faults import check_fault, table

pytestmark = pytest.mark.usefixtures("folder")

USAGE = """
--sun 30                               => --frames: is required, such as 1-96
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
--frames x                             => '--frames': must be such as 1-100x5,150 or -10--1, got 'x'
--frames 1-3 --only 4                  => --only: must name frames of 1-3, got 4
--frames 1-3 --only 2-4                => --only: must name frames of 1-3, got 4
--frames 1-9x4 --only 0-5              => --only: must name frames of 1-9, got 0
--frames 1-9x4 --only 2-4              => --only: must name frames of 1-9, got 2
--frames 1-3 --every 10min             => --every: needs --from and --to
--frames 1-3 --lat 48 --lon 2          => --lat: needs --from and --to
--frames 1-3 --from 2026-06-21T04:00Z  => --from: needs --to as well
P --frames 1-3 D --sun 30              => --sun: cannot be combined with --from and --to
P --frames 1-3 D --sun-azimuth 30      => --sun-azimuth: cannot be combined with --from and --to
P D                                    => --frames: is required, or --every
P D --every 0min                       => '--every': must be greater than 0s, got 0min
P D --every soon                       => '--every': must be a duration such as 10min
P D --every 1h --frames 1-3            => --frames: must be as many as --every makes, which is 6, g
P --from 2026-06-21T04:00 --to 2026-06-21T04:00 --every 1h => --to: must be after the start
--from 2026-06-21T04:00 --to 2026-06-21T06:00 --every 1h --lat 1 --lon 2 => --from: needs an offset
--frames 1-3 -o sky.exr                => --output: sky.exr: must have a place for the frame number
--frames 1-3 -o sky.##.##.exr          => --output: sky.##.##.exr: must have one frame number
--frames 1-3 -o a.##/sky.exr           => --output: a.##/sky.exr: the frame number belongs in the na
--frames 1-3 -o sky.%5x.exr            => --output: sky.%5x.exr: frame number must be as ####
--frames 1-3 -o sky.####               => sky.####: suffix must be .exr or .hdr or .ktx2 or .dds
--frames 1-3 --preview sky.png         => --preview: sky.png: must have a place for the frame number
--frames 1-3 --preview sky.%q.png      => --preview: sky.%q.png: frame number must be as ####
--frames 1-3 --preview sky.#.jpg       => '--preview': sky.#.jpg: suffix must be .png, got '.jpg'
--frames 1-3 --preview-ev 3            => --preview-ev: needs --preview or --contact-sheet or --anim
--frames 1-3 --view aces1              => --view: needs --preview or --contact-sheet or --animate
--frames 1-3 --white-balance auto      => --white-balance: needs --preview or --contact-sheet or --a
--frames 1-3 --shot 180,0,50           => --shot: needs --preview or --contact-sheet or --animate
--frames 1-3 --preview --preview-ev x  => '--preview-ev': must be auto or a number from -30 to 40
--frames 1-3 --exposure-curve a.csv --ev 3 => --ev: cannot be combined with --exposure-curve
--frames 1-3 --exposure-curve a.csv --units nits => --units: cannot be combined with --exp
--frames 1-3 --manifest a.xml          => '--manifest': a.xml: suffix must be .json or .csv or .usda
--frames 1-3 --contact-sheet a.jpg     => '--contact-sheet': a.jpg: suffix must be .png
--frames 1-3 --animate a.mp4           => '--animate': a.mp4: suffix must be .webp or .gif
--frames 1-3 --fps fast                => '--fps': must be a number greater than 0 and at most 1000
--frames 1-3 --fps nan                 => '--fps': must be a number greater than 0 and at most 1000
--frames 1-3 --fps inf                 => '--fps': must be a number greater than 0 and at most 1000
--frames 1-3 --fps 0                   => '--fps': must be a number greater than 0 and at most 1000
--frames 1-3 --fps -24                 => '--fps': must be a number greater than 0 and at most 1000
--frames 1-3 --sun-azimuth 0..1e20     => '--sun-azimuth': must be at most 1000 turns, got 1e20
--frames 1-3 --workers 0               => '--workers': 0 is not in the range 1<=x<=256
--frames 1-3 --retry -1                => '--retry': -1 is not in the range 0<=x<=100
--frames 1-3 --chunk-size 0            => '--chunk-size': 0 is not in the range x>=1
--frames 1-3 --chunk-size 3            => --chunk-size: needs --emit-commands or --emit-openjd
--frames 1-3 --dry-run --emit-commands => --dry-run: cannot be combined with --emit-commands or
--frames 1-3 --dry-run --emit-openjd j => --dry-run: cannot be combined with --emit-commands or
--frames 1-3 --emit-openjd=            => '--emit-openjd': must name a folder, got ''
--frames 1-3 --workers 2 --dask tcp://a:1 => --workers: cannot be combined with --dask
--frames 1-3 --json --progress openjd  => --json: cannot be combined with --progress openjd
P E --date 0001-01-01 --frames 1-3     => --from: date must be in the years 1000 to 2999, got 0001-
P E --date 9999-12-31 --frames 1-3     => --from: date must be in the years 1000 to 2999, got 9999-
--frames 1-3 --progress loud           => '--progress': 'loud' is not one of 'auto', 'bar', 'plain'
--frames 1-3 --pixel half -o a.#.hdr   => --pixel: needs an .exr, .ktx2 or .dds output
--frames 1-3 --cube-layout cross       => --cube-layout: needs --projection cubemap
--frames 1-3 --size 64x64              => --size: width must be twice the height, got 64x64
"""
SHORT = {
    "P": PARIS,
    "D": ("--from", "2026-06-21T04:00", "--to", "2026-06-21T09:00"),
    "E": ("--from", "sunrise", "--to", "sunset"),
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
--set aerosol.optical_depth=0..1e999 => optical_depth: must be a number, got '0..1e999'
--set aerosol.optical_depth=0.1..   => optical_depth: must be a number, got '0.1..'
-o absent/a.#.exr                   => absent/a.0001.exr: folder must exist, got
--preview absent/a.#.png            => absent/a.0001.png: folder must exist, got
--manifest absent/a.json            => absent/a.json: folder must exist, got
--contact-sheet absent/a.png        => absent/a.png: folder must exist, got
--animate absent/a.webp             => absent/a.webp: folder must exist, got
--animate a.gif --fps 90            => a.gif: frames per second must be from 0.1 to 50, got 90
--exposure-curve absent.csv         => absent.csv: cannot be read: No such file or directory
--projection cubemap --size 8 --manifest a.usda => a.usda: a dome light of USD needs maps of the
-o \x01.#.exr --manifest a.usda      => a.usda: USD must be able to hold a file's name, got
--manifest a.json --manifest ./a.json => a.json: two files would be written under this name
--preview a.#.png --contact-sheet a.0002.png => a.0002.png: two files would be written under th
--emit-openjd absent/job            => absent/job: cannot be created (
"""


@pytest.mark.parametrize(("arguments", "message"), table(FAILED))
def test_what_cannot_be_done_is_one_line_exit_1_and_no_file(folder, arguments, message):
    check_fault(invoke("sequence", *QUICK, *THREE, *arguments.split()), 1, message)
    assert listing(folder) == []


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "must hold the columns frame and ev, got nothing"),
        ("frame,ev\n", "must hold at least one frame and its ev, got none"),
        ("frame;ev\n1;15\n", "must hold the columns frame and ev, got frame;ev"),
        ("frame,ev,ev\n1,15,3\n", "must hold the columns frame and ev, got frame, ev, ev"),
        (f"frame,ev\n1,{'1' * 200_000}\n", "cannot be read as a CSV file (field larger"),
        ("frame,ev\ninf,15\n", "line 2: frame must be finite, got inf"),
        ("frame,ev\n1,bright\n", "line 2: must hold numbers under frame and ev"),
        ("frame,ev\n1\n", "line 2: must hold numbers under frame and ev"),
        ("frame,ev\n1,41\n", "line 2: ev must be from -30 to 40, got 41"),
        ("frame,ev\n1,nan\n", "line 2: ev must be from -30 to 40, got nan"),
        ("frame,ev\n2,15\n1,14\n", "line 3: frames must ascend, got 1"),
        (b"\xff\xfe\x00", "must be UTF-8 text"),
    ],
)
def test_a_faulty_exposure_curve_is_one_line(folder, content, message):
    path = Path("ev.csv")
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    result = invoke("sequence", *QUICK, *THREE, "--exposure-curve", "ev.csv")
    check_fault(result, 1, f"ev.csv: {message}")
    assert listing(folder) == ["ev.csv"]


def test_an_exposure_curve_is_not_written_over(folder):
    Path("ev.csv").write_text("frame,ev\n1,15\n", encoding="utf-8")
    arguments = ("--exposure-curve", "ev.csv", "--manifest", folder / "ev.csv")
    result = invoke("sequence", *QUICK, *THREE, *arguments)
    check_fault(result, 1, "ev.csv: cannot be written, because the exposure curve is read")
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


def test_two_frames_never_share_a_file(folder):
    settings = map_settings(size=16, projection="cubemap")
    first, second = (Frame(i, 0, settings, Path(f"a.{i}.exr")) for i in (1, 2))
    for name in ("a.1_px.exr", "a.2_nz.exr"):
        (folder / name).symlink_to(folder / "same.exr")
    planet = load_preset("earth")
    with pytest.raises(
        OutputError, match=r"a.2_nz.exr: two files would be written under this name"
    ):
        Plan((planet,), (first, second)).check("aces2")
    Plan((planet,), (first,)).check("aces2")


def test_help_names_what_patterns_mean():
    text = " ".join(invoke("sequence", "--help").stdout.split())
    assert "#### is the frame number in four digits, as is a single #" in text


def test_the_default_name_tells_what_was_set_of_the_world():
    for changes, name in (
        ((), "mars"),
        (("--set", "dust.optical_depth=2"), "mars_dust.optical_depth=2"),
        (("--set", "dust.optical_depth=0.3..2"), "mars"),
    ):
        result = invoke("sequence", "--preset", "mars", "--frames", "1-2", *changes, "--dry-run")
        assert result.exit_code == 0
        assert result.stdout.splitlines()[1].endswith(f"  {name}.0002.exr")


def test_frames_of_a_year_have_the_suns_distance_in_plan_and_manifest():
    times = ("--lat", "0", "--lon", "0", "--from", "2026-01-03T09:00Z", "--to", "2026-07-06T09:00Z")
    small = ("--size", "64x32", "--method", "hillaire", "-q", "--frames", "1-2", "-o", "a.#.exr")
    result = invoke("sequence", *times, *small, "--contact-sheet", "a.png", "--manifest", "a.json")
    assert result.exit_code == 0, result.output
    records = json.loads(Path("a.json").read_text("utf-8"))["records"]
    for record, distance in zip(records, (0.98330, 1.01664), strict=True):
        assert record["sun_distance_au"] == pytest.approx(distance, abs=2e-5)
        diameter = math.degrees(2 * math.asin(695_700 / (distance * 149_597_870.7)))
        assert record["sun_angular_diameter_deg"] == pytest.approx(diameter, rel=1e-4)
    planned = json.loads(invoke("sequence", *times, *small, "--dry-run", "--json").stdout)
    assert [frame["sun_distance_au"] for frame in planned["frames"]] == [
        record["sun_distance_au"] for record in records
    ]
    mean = invoke("sequence", *times, *small, "--dry-run", "--json", "--sun-distance", "mean")
    assert "sun_distance_au" not in json.loads(mean.stdout)["frames"][0]
