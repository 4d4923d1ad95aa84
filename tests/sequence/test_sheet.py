"""A contact sheet shows each frame once, in order, with its label."""

import numpy as np
import OpenImageIO
import pytest

from skybake.errors import InputError, OutputError
from skybake.image.light import Light
from skybake.sequence.frame import FrameOutcome
from skybake.sequence.planning import plan_sequence
from skybake.sequence.products import tile_label
from skybake.sequence.sheet import BACKGROUND, check_sheet, contact_sheet
from tests.sequence.pictures import dusk


def _read(path):
    image = OpenImageIO.ImageBuf(str(path))
    assert image.spec().format == OpenImageIO.UINT8
    return image.get_pixels(OpenImageIO.UINT8)


def _sheet(tmp_path, count):
    thumbnails = [dusk(k / max(count - 1, 1)) for k in range(count)]
    path = tmp_path / "sheet.png"
    labels = [f"{k:04d} {k:+.1f}°" for k in range(count)]
    contact_sheet(path, thumbnails, labels, title="earth")
    return thumbnails, _read(path)


def _places(sheet, thumbnail):
    """Corners at which a picture stands in another, row before column."""
    height, width = thumbnail.shape[:2]
    return [
        (row, column)
        for row, column in np.argwhere((sheet == thumbnail[0, 0]).all(axis=-1)).tolist()
        if np.array_equal(sheet[row : row + height, column : column + width], thumbnail)
    ]


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (7, 3), (6, 2), (5, 2)])
def test_every_frame_stands_once_and_in_reading_order(tmp_path, count, columns):
    thumbnails, sheet = _sheet(tmp_path, count)
    places = [_places(sheet, thumbnail) for thumbnail in thumbnails]
    assert [len(found) for found in places] == [1] * count
    corners = [found[0] for found in places]
    assert corners == sorted(corners)
    assert len({row for row, _ in corners}) == -(-count // columns)
    assert len({column for _, column in corners}) == columns


def test_a_label_stands_below_its_tile_and_the_title_above_all(tmp_path):
    thumbnails, sheet = _sheet(tmp_path, 4)
    height, width = thumbnails[0].shape[:2]
    for thumbnail in thumbnails:
        ((row, column),) = _places(sheet, thumbnail)
        below = sheet[row + height : row + height + 10, column : column + width]
        assert (below > 150).any()
    first_row = _places(sheet, thumbnails[0])[0][0]
    assert (sheet[:first_row] > 150).any()
    ((row, column),) = _places(sheet, thumbnails[1])
    assert (sheet[row : row + height, column + width :] == BACKGROUND).all()


def test_labels_differ_where_their_texts_do(tmp_path):
    same = [dusk(0.5)] * 2
    contact_sheet(tmp_path / "a.png", same, ["0001", "0002"], title="x")
    contact_sheet(tmp_path / "b.png", same, ["0001", "0001"], title="x")
    a, b = _read(tmp_path / "a.png"), _read(tmp_path / "b.png")
    differing = np.flatnonzero((a != b).any(axis=(1, 2)))
    assert differing.size
    assert differing.min() > len(a) * 0.8


def test_a_label_wider_than_its_tile_becomes_smaller_and_stays_within(tmp_path):
    label = "0001 2026-06-21"
    contact_sheet(tmp_path / "a.png", [dusk(0.5, 64, 128)] * 4, [label] * 4, title="")
    sheet = _read(tmp_path / "a.png")
    lines = (sheet[-16:] > 100).any(axis=(0, 2))
    gap = 4
    assert lines[gap : gap + 128].any()
    assert not lines[gap + 128 : gap + 128 + gap].any()
    np.testing.assert_array_equal(lines[gap : gap + 128], lines[2 * gap + 128 : 2 * gap + 256])


@pytest.mark.parametrize("count", [1, 4, 24, 97])
def test_a_sheet_is_about_as_wide_as_a_screen(tmp_path, count):
    _, sheet = _sheet(tmp_path, count)
    assert 1.1 < sheet.shape[1] / sheet.shape[0] < 2.6


def test_the_same_frames_make_the_same_bytes(tmp_path):
    _sheet(tmp_path, 3)
    before = (tmp_path / "sheet.png").read_bytes()
    _sheet(tmp_path, 3)
    assert (tmp_path / "sheet.png").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["sheet.png"]


def test_faults_are_said_up_front(tmp_path):
    with pytest.raises(InputError, match=r"suffix of a contact sheet must be .png, got '.jpg'"):
        check_sheet(tmp_path / "sheet.jpg")
    with pytest.raises(OutputError, match="folder must exist"):
        check_sheet(tmp_path / "absent" / "sheet.png")
    assert not list(tmp_path.iterdir())


def test_a_label_of_two_lines_is_two_lines_below_its_tile(tmp_path):
    thumbnails = [dusk(0.5, 64, 128)] * 2
    for name, labels in (("a", ["0001\nEV 9", "0002\nEV 9"]), ("b", ["0001", "0002"])):
        contact_sheet(tmp_path / f"{name}.png", thumbnails, labels, title="")
    two, one = _read(tmp_path / "a.png"), _read(tmp_path / "b.png")
    line = (len(two) - len(one)) // len(_places(two, thumbnails[0]))
    assert line >= 8
    first, second = (
        two[row + 64 + i * line : row + 64 + (i + 1) * line, column : column + 128]
        for (row, column) in _places(two, thumbnails[0])[:1]
        for i in range(2)
    )
    assert (first > 150).any()
    assert (second > 150).any()


@pytest.mark.parametrize(
    ("lux", "text"),
    [
        (0.0, "0 lx"),
        (2.34e-4, "0.00023 lx"),
        (0.01234, "0.0123 lx"),
        (9.876, "9.88 lx"),
        (432.1, "432 lx"),
        (99960.0, "100 000 lx"),
    ],
)
def test_a_tile_says_its_time_sun_exposure_and_light(lux, text):
    plan = plan_sequence(frames="7", sun_elevation=0.1)
    light = Light(
        sun_direction=(0.0, 0.0, 1.0),
        sun_colour=(1.0, 1.0, 1.0),
        direct_normal_illuminance=lux,
        direct_illuminance=0.25 * lux,
        sky_illuminance=0.75 * lux,
    )
    outcome = FrameOutcome(7, True, light, (), (), None, 9.87, {})
    assert tile_label(plan.frames[0], outcome) == f"7  sun 5.7 deg\nEV 9.9  {text}"
