"""Frame ranges and names, as people and other programs write them."""

from pathlib import Path

import fileseq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skybake.errors import InputError
from skybake.sequence.frames import MOST_FRAMES, FramePattern, chunks, format_frames, parse_frames

RANGES = {
    "7": (7,),
    "1-100x25": (1, 26, 51, 76),
    "1-5,150,200-203": (1, 2, 3, 4, 5, 150, 200, 201, 202, 203),
    "-5-2": (-5, -4, -3, -2, -1, 0, 1, 2),
    "-10--8": (-10, -9, -8),
    "-0003": (-3,),
    "0001-0003": (1, 2, 3),
    "5,1-3,2-6x2": (1, 2, 3, 4, 5, 6),
    "4-4": (4,),
    "1-10x100": (1,),
    "-7--3x2,0": (-7, -5, -3, 0),
}


@pytest.mark.parametrize("text", RANGES)
def test_ranges_hold_each_frame_once_in_order(text):
    assert parse_frames(text) == RANGES[text]


@pytest.mark.parametrize("text", RANGES)
def test_ranges_are_those_of_fileseq(text):
    assert parse_frames(text) == tuple(sorted(fileseq.FrameSet(text)))


def test_spaces_around_parts_are_left_out():
    assert parse_frames(" 1-3 , 8") == (1, 2, 3, 8)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "must be such as 1-100x5"),
        ("1,,2", "must be such as 1-100x5,150 or -10--1, got '' in '1,,2'"),
        ("1-", "must be such as"),
        ("--5", "must be such as"),
        ("1-10x", "must be such as"),
        ("1-10x-2", "must be such as"),
        ("5x2", "must be such as"),
        ("1 - 5", "must be such as"),
        ("1-10y2", "must be such as"),
        ("1.5", "must be such as"),
        ("+1", "must be such as"),
        ("\u0661", "must be such as"),
        ("#", "must be such as"),
        ("1" * 5000, "must be such as"),
        ("10-1", "a range must ascend, got '10-1'"),
        ("-1--10", "a range must ascend"),
        ("1-10x0", "a step must be at least 1"),
        ("1-100:5", "must have a step as in 1-100x5, got '1-100:5'; a colon is a step"),
        ("0-1000000", "must be at most 1000000"),
        ("1-999999999", "must be at most 1000000"),
        ("1-600000,600001-1200000", "must be at most 1000000"),
    ],
)
def test_what_is_no_range_is_refused_with_a_reason(text, reason):
    with pytest.raises(InputError) as fault:
        parse_frames(text)
    assert reason in str(fault.value)
    assert "\n" not in str(fault.value)


def test_a_million_frames_are_accepted():
    assert len(parse_frames(f"1-{MOST_FRAMES}")) == MOST_FRAMES


@pytest.mark.parametrize(
    ("frames", "text"),
    [
        (range(1, 97), "1-96"),
        ((1, 3, 5, 7, 9, 20), "1-9x2,20"),
        ((1, 2), "1-2"),
        ((1, 5), "1,5"),
        ((1, 3, 4, 5), "1,3-5"),
        ((1, 2, 3, 5, 7, 9), "1-3,5-9x2"),
        ((-10, -9, -8, -1, 0), "-10--8,-1-0"),
        ((3, 1, 2, 3), "1-3"),
        ((8,), "8"),
    ],
)
def test_frames_are_written_as_short_as_people_would(frames, text):
    assert format_frames(frames) == text


@given(st.sets(st.integers(-50, 50), min_size=1))
def test_written_frames_are_read_as_they_were(frames):
    assert parse_frames(format_frames(frames)) == tuple(sorted(frames))


@given(st.sets(st.integers(-(10**9) + 1, 10**9 - 1), min_size=1, max_size=20))
def test_fileseq_reads_what_is_written(frames):
    # Its ranges are lists, so only those of few frames.
    text = format_frames(frames)
    assert set(fileseq.FrameSet(text)) == frames


@given(st.text(alphabet="0123456789-x,: y#", max_size=12))
def test_no_text_gives_a_traceback(text):
    try:
        frames = parse_frames(text)
    except InputError:
        return
    assert frames
    assert parse_frames(format_frames(frames)) == frames


def test_chunks_hold_all_frames_and_the_last_what_is_left():
    assert chunks((1, 3, 5, 7, 9), 2) == [(1, 3), (5, 7), (9,)]
    assert chunks((1, 2), 10) == [(1, 2)]
    with pytest.raises(InputError, match="chunk: must be at least 1 frame, got 0"):
        chunks((1, 2), 0)


@pytest.mark.parametrize(
    ("pattern", "plain", "below"),
    [
        ("sky.####.exr", "sky.0007.exr", "sky.-005.exr"),
        ("sky.##.exr", "sky.07.exr", "sky.-5.exr"),
        ("sky.#.exr", "sky.0007.exr", "sky.-005.exr"),
        ("sky.%04d.exr", "sky.0007.exr", "sky.-005.exr"),
        ("sky_%d.exr", "sky_7.exr", "sky_-5.exr"),
        ("sky.{frame:04d}.exr", "sky.0007.exr", "sky.-005.exr"),
        ("sky.{frame}.exr", "sky.7.exr", "sky.-5.exr"),
        ("sky.$F4.exr", "sky.0007.exr", "sky.-005.exr"),
        ("sky.$F.exr", "sky.7.exr", "sky.-5.exr"),
        ("sky.@@@@@.exr", "sky.00007.exr", "sky.-0005.exr"),
        ("sky.@.exr", "sky.7.exr", "sky.-5.exr"),
        ("####_{face}.exr", "0007_{face}.exr", "-005_{face}.exr"),
        ("{face}.%03d.hdr", "{face}.007.hdr", "{face}.-05.hdr"),
        ("$SHOT.##.exr", "$SHOT.07.exr", "$SHOT.-5.exr"),
    ],
)
def test_a_frame_number_stands_where_the_pattern_says(pattern, plain, below):
    read = FramePattern.parse(f"maps/{pattern}")
    read.check(range(100))
    assert read.path(7) == Path("maps") / plain
    assert read.path(-5) == Path("maps") / below


@pytest.mark.parametrize("pattern", ["sky.####.exr", "sky.%04d.exr", "sky.@@@.exr", "sky.$F4.exr"])
@pytest.mark.parametrize("frame", [-12345, -5, 0, 7, 12345])
def test_names_are_those_of_fileseq_where_a_hash_is_a_digit(pattern, frame):
    theirs = fileseq.FileSequence(f"maps/{pattern}", pad_style=fileseq.PAD_STYLE_HASH1)
    assert str(FramePattern.parse(f"maps/{pattern}").path(frame)) == theirs.frame(frame)


def test_a_name_without_number_is_enough_for_one_frame():
    pattern = FramePattern.parse("out/sky.exr")
    pattern.check((5,))
    assert pattern.path(5) == Path("out/sky.exr")
    with pytest.raises(InputError) as fault:
        pattern.check((5, 6))
    assert str(fault.value) == (
        "out/sky.exr: must have a place for the frame number, as out/sky.####.exr, for 2 frames"
    )


def test_a_folder_may_hold_what_is_no_frame_number():
    pattern = FramePattern.parse("/jobs/a#1/me@home/{x}/100%/sky.##.exr")
    assert pattern.path(3) == Path("/jobs/a#1/me@home/{x}/100%/sky.03.exr")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("sky.####.%04d.exr", "must have one frame number, as sky.####.exr, got #### and %04d"),
        ("##x##.exr", "must have one frame number"),
        ("shot_####/sky.exr", "belongs in the name of the file, not of a folder"),
        ("{frame}/sky.####.exr", "belongs in the name of the file"),
        ("sky.%s.exr", "got a % that belongs to none"),
        ("sky.%%.exr", "got a %"),
        ("sky.%4d.exr", "got a %"),
        ("sky.%00d.exr", "got a %"),
        ("sky.%0123456789d.exr", "got a %"),
        ("sky.{time}.exr", "got a {"),
        ("sky.{frame:x}.exr", "got a {"),
        ("sky.{frame:04d}}.exr", "got a }"),
        ("sky.{0}.####.exr", "got a {"),
        ("", "pattern: must name a file"),
        ("/", "/: must name a file"),
    ],
)
def test_other_patterns_are_refused_with_a_reason(text, reason):
    with pytest.raises(InputError) as fault:
        FramePattern.parse(text)
    assert reason in str(fault.value)
