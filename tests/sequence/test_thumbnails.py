"""Thumbnails lie on disk until they become pictures, of however many frames."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from skybake.errors import OutputError
from skybake.image.light import Light
from skybake.sequence.frame import FrameOutcome
from skybake.sequence.thumbnails import Thumbnails
from tests.formats.maps import listing
from tests.sequence.pictures import dusk

REPOSITORY = Path(__file__).parents[2]


def outcome(number, **thumbnails):
    light = Light(
        sun_direction=(0.0, 1.0, 0.0),
        sun_colour=(1.0, 1.0, 1.0),
        direct_normal_illuminance=1.0,
        direct_illuminance=1.0,
        sky_illuminance=1.0,
    )
    pictures = {int(width.lstrip("w")): picture for width, picture in thumbnails.items()}
    return FrameOutcome(number, True, light, (), (), None, None, pictures)


def test_pictures_come_back_by_number_and_width_whatever_the_order(tmp_path):
    thumbnails = Thumbnails(tmp_path)
    for number in (7, 3, 5):
        kept = thumbnails.keep(outcome(number, w96=dusk(number / 10), w32=dusk(0.5, 16, 32)))
        assert kept.thumbnails == {}
    assert listing(tmp_path) == []
    pictures = thumbnails.pictures(96, [3, 5, 7])
    assert len(pictures) == 3
    for picture, number in zip(pictures, (3, 5, 7), strict=True):
        np.testing.assert_array_equal(picture, dusk(number / 10))
    np.testing.assert_array_equal(thumbnails.pictures(32, [5])[0], dusk(0.5, 16, 32))
    np.testing.assert_array_equal(pictures[1:][0], dusk(0.5))


def test_a_disk_without_room_for_them_is_one_line(small_disk):
    thumbnails = Thumbnails(small_disk)
    large = outcome(1, w256=dusk(0.5, 128, 256))
    with pytest.raises(OutputError, match=r"disk: thumbnails must be writable, got No space left"):
        thumbnails.keep(large)


MANY = """
import sys
from pathlib import Path
from skybake.sequence.animation import write_animation
from skybake.sequence.sheet import contact_sheet
from skybake.sequence.thumbnails import Thumbnails
from tests.sequence.pictures import dusk
from tests.sequence.test_thumbnails import outcome

folder, kind, count = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
thumbnails = Thumbnails(folder)
numbers = list(range(count))
for number in numbers:
    share = number / count
    thumbnails.keep(outcome(number, w256=dusk(share, 128, 256), w512=dusk(share, 256, 512)))
if kind == "sheet":
    labels = [str(number) for number in numbers]
    contact_sheet(folder / "a.png", thumbnails.pictures(256, numbers), labels, title="many")
else:
    write_animation(folder / f"a.{kind}", thumbnails.pictures(512, numbers), 24.0)
lines = open("/proc/self/status").read().splitlines()
print(*(line.split()[1] for line in lines if line.startswith("VmHWM:")))
"""


def peak(folder, kind, count):
    """Memory of a process that makes a picture of so many frames. [MB]"""
    process = subprocess.run(
        [sys.executable, "-c", MANY, folder, kind, str(count)],
        env=os.environ | {"PYTHONPATH": str(REPOSITORY)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert process.returncode == 0, process.stderr
    return int(process.stdout) / 1024


# Frames of a GIF wait in Pillow's memory, with a byte for each pixel.
@pytest.mark.parametrize(
    ("kind", "frames", "each"),
    [
        pytest.param("sheet", 400, 0.03, marks=pytest.mark.slow),
        pytest.param("sheet", 2000, 0.03, marks=pytest.mark.nightly),
        ("webp", 200, 0.05),
        ("gif", 60, 0.3),
    ],
)
def test_memory_hardly_grows_with_the_number_of_frames(tmp_path, kind, frames, each):
    few, many = (peak(tmp_path, kind, count) for count in (20, frames))
    assert many - few < each * frames
