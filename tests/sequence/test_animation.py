"""Moving pictures show each frame, for its time, without flicker."""

import sys

import numpy as np
import pytest
from PIL import Image, ImageSequence

from skybake.errors import InputError, OutputError
from skybake.sequence.animation import check_animation, write_animation
from tests.sequence.pictures import dusk


def _write(path, thumbnails, fps=24.0):
    write_animation(path, thumbnails, fps)
    with Image.open(path) as moving:
        frames, durations = [], []
        for frame in ImageSequence.Iterator(moving):
            frames.append(np.asarray(frame.convert("RGB")))
            durations.append(frame.info["duration"])
        assert moving.info["loop"] == 0
        return frames, durations


def _blocks(picture, edge=8):
    rows, columns = picture.shape[0] // edge, picture.shape[1] // edge
    return picture.reshape(rows, edge, columns, edge, 3).mean(axis=(1, 3))


@pytest.mark.parametrize(("suffix", "tolerance"), [("webp", 4.0), ("gif", 4.0), ("GIF", 4.0)])
def test_every_frame_is_shown_in_order(tmp_path, suffix, tolerance):
    thumbnails = [dusk(k / 11) for k in range(12)]
    frames, _ = _write(tmp_path / f"sky.{suffix}", thumbnails)
    assert len(frames) == 12
    for frame, thumbnail in zip(frames, thumbnails, strict=True):
        off = _blocks(frame.astype(float)) - _blocks(thumbnail.astype(float))
        assert np.sqrt(np.mean(off**2)) < tolerance


@pytest.mark.parametrize(
    ("suffix", "fps", "tick"), [("gif", 24, 10), ("gif", 30, 10), ("webp", 24, 1), ("webp", 60, 1)]
)
def test_durations_add_up_to_the_time_of_all_frames(tmp_path, suffix, fps, tick):
    _, durations = _write(tmp_path / f"sky.{suffix}", [dusk(k / 29, 8, 16) for k in range(30)], fps)
    assert len(durations) == 30
    assert abs(sum(durations) - 30_000 / fps) <= tick / 2
    assert max(durations) - min(durations) <= tick


def test_one_frame_is_enough(tmp_path):
    for suffix in ("gif", "webp"):
        write_animation(tmp_path / f"sky.{suffix}", [dusk(0.5)], 24.0)
        with Image.open(tmp_path / f"sky.{suffix}") as picture:
            assert picture.size == (96, 48)


def test_what_stands_still_in_a_gif_does_not_flicker(tmp_path):
    # The sky moves above, and below the same ground is painted in every frame.
    thumbnails = [np.concatenate([dusk(k / 7), dusk(0.3)]) for k in range(8)]
    frames, _ = _write(tmp_path / "sky.gif", thumbnails)
    for frame in frames[1:]:
        np.testing.assert_array_equal(frame[48:], frames[0][48:])


def test_all_frames_of_a_gif_share_one_palette(tmp_path):
    # Tables of eight frames would add up to more.
    frames, _ = _write(tmp_path / "sky.gif", [dusk(k / 7) for k in range(8)])
    colours = np.unique(np.concatenate(frames).reshape(-1, 3), axis=0)
    assert 128 < len(colours) <= 256


def test_a_dithered_gradient_has_no_bands(tmp_path):
    thumbnails = [dusk(k / 23, 96, 192) for k in range(24)]
    frames, _ = _write(tmp_path / "sky.gif", thumbnails)
    off = [
        _blocks(frame.astype(float)) - _blocks(thumbnail.astype(float))
        for frame, thumbnail in zip(frames, thumbnails, strict=True)
    ]
    plain = []
    survey = Image.fromarray(np.concatenate(thumbnails)).quantize(256)
    for thumbnail in thumbnails:
        banded = Image.fromarray(thumbnail).quantize(palette=survey, dither=Image.Dither.NONE)
        plain.append(_blocks(np.asarray(banded.convert("RGB"), float)) - _blocks(thumbnail * 1.0))
    assert np.sqrt(np.mean(np.square(off))) < 0.75 * np.sqrt(np.mean(np.square(plain)))


@pytest.mark.parametrize(
    ("name", "fps", "fault", "reason"),
    [
        ("sky.mp4", 24, InputError, "must be one of .webp, .gif, got '.mp4'"),
        ("sky", 24, InputError, "must be one of .webp, .gif, got ''"),
        ("sky.gif", 60, InputError, "frames per second must be from 0.1 to 50, got 60"),
        ("sky.webp", 0, InputError, "frames per second must be from 0.1 to 60, got 0"),
        ("sky.webp", float("nan"), InputError, "got nan"),
        ("absent/sky.gif", 24, OutputError, "folder must exist"),
    ],
)
def test_faults_are_said_up_front(tmp_path, name, fps, fault, reason):
    with pytest.raises(fault, match=reason):
        check_animation(tmp_path / name, fps)


def test_without_pillow_the_extra_is_named_in_one_line(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "PIL", None)
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    with pytest.raises(InputError) as fault:
        check_animation(tmp_path / "sky.gif", 24.0)
    assert str(fault.value) == (f"{tmp_path}/sky.gif: needs Pillow; try pip install Pillow")


def test_a_picture_that_cannot_be_written_leaves_the_one_before(tmp_path):
    path = tmp_path / "sky.webp"
    write_animation(path, [dusk(0.5)], 24.0)
    before = path.read_bytes()
    too_wide = np.zeros((4, 20000, 3), np.uint8)
    with pytest.raises(OutputError, match=r"sky\.webp: cannot be written completely: "):
        write_animation(path, [too_wide, too_wide], 24.0)
    assert path.read_bytes() == before
    assert [one.name for one in tmp_path.iterdir()] == ["sky.webp"]
