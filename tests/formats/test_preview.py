import hashlib
import struct
import subprocess
import sys

import numpy as np
import OpenImageIO
import pytest

from skybake.colour.space import COLOUR_SPACES, find_colour_space, rgb_from_xyz
from skybake.errors import InputError, OutputError
from skybake.formats import preview
from skybake.formats.preview import DEFAULT_VIEW, VIEWS, display_values, write_preview
from tests.formats.maps import listing, sky

REC709 = find_colour_space("lin_rec709")


def codes(path):
    return OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.UINT8)


def chunks(path):
    data, at, found = path.read_bytes(), 8, []
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        found.append(kind.decode())
        at += 12 + length
    return found


def grey(*values):
    return np.repeat(np.array(values, np.float32)[None, :, None], 3, axis=2)


@pytest.mark.parametrize(
    ("view", "middle_grey", "white"), [("aces1", 0.356, 0.812), ("aces2", 0.349, 0.707)]
)
def test_greys_have_the_published_codes_of_the_aces_transforms(view, middle_grey, white):
    """Scene 0.18 becomes 10 cd m⁻² of 100 in both, and 0.349 is the sRGB code of a tenth."""
    shown = display_values(grey(0.18, 1.0), REC709, view)

    np.testing.assert_allclose(shown[0, :, 1], (middle_grey, white), atol=1e-3)


@pytest.mark.parametrize("view", VIEWS)
@pytest.mark.parametrize("space", COLOUR_SPACES.values(), ids=lambda space: space.name)
def test_the_same_colour_looks_the_same_from_every_space(view, space):
    xyz = np.array([[0.2, 0.25, 0.5], [0.4, 0.4, 0.3], [3.0, 2.9, 2.0]])
    expected = display_values((xyz @ rgb_from_xyz(REC709).T).astype(np.float32)[None], REC709, view)
    shown = display_values((xyz @ rgb_from_xyz(space).T).astype(np.float32)[None], space, view)

    np.testing.assert_allclose(shown, expected, atol=1e-3)


@pytest.mark.parametrize("view", VIEWS)
def test_suns_saturated_blues_and_negative_light_stay_on_the_display(view):
    pixels = np.array([[[0.1, 0.3, 1.2], [1e6, 1e5, 1e4], [65504] * 3, [-0.2, -0.1, 0.4], [0] * 3]])
    shown = display_values(pixels.astype(np.float32), find_colour_space("acescg"), view)

    assert np.isfinite(shown).all()
    assert shown.min() >= 0.0
    assert shown.max() <= 1.0


def test_codes_are_the_display_values_dithered_by_less_than_one_code(tmp_path):
    ramp = np.broadcast_to(grey(*np.linspace(0.01, 0.02, 256)), (128, 256, 3)).copy()
    write_preview(tmp_path / "a.png", ramp, REC709, gain=1.0)
    wanted = display_values(ramp, REC709, DEFAULT_VIEW) * 255.0
    difference = codes(tmp_path / "a.png") - wanted

    assert np.abs(difference).max() < 1.0
    # Plain rounding is off by half a code in whole columns; the mean of 128 dithered
    # texels has a standard deviation of at most 0.5 / sqrt(128) = 0.044.
    assert np.abs(difference.mean(axis=0)).max() < 5 * 0.044


def test_gain_is_exposure(tmp_path):
    write_preview(tmp_path / "a.png", sky(), REC709, gain=2.0)
    write_preview(tmp_path / "b.png", 2.0 * sky(), REC709, gain=1.0)

    np.testing.assert_array_equal(codes(tmp_path / "a.png"), codes(tmp_path / "b.png"))


def test_the_same_map_gives_the_same_bytes_whatever_the_threads(tmp_path):
    digests = set()
    before = OpenImageIO.get_int_attribute("threads")
    try:
        for threads in (1, 2, 4):
            OpenImageIO.attribute("threads", threads)
            write_preview(tmp_path / "a.png", sky(256, 128), REC709, gain=1.0, max_width=100)
            digests.add(hashlib.sha256((tmp_path / "a.png").read_bytes()).hexdigest())
    finally:
        OpenImageIO.attribute("threads", before)

    assert len(digests) == 1


def test_the_same_map_gives_the_same_bytes_whatever_the_rows_at_once(tmp_path, monkeypatch):
    digests = []
    for most in (100 * 50, 100 * 16, 100 * 7):
        monkeypatch.setattr(preview, "PIXELS_AT_ONCE", most)
        write_preview(tmp_path / "a.png", sky(100, 50), REC709, gain=1.0)
        digests.append(hashlib.sha256((tmp_path / "a.png").read_bytes()).hexdigest())

    assert len(set(digests)) == 1


def test_the_picture_is_tagged_srgb_and_has_no_date(tmp_path):
    write_preview(tmp_path / "a.png", sky(), REC709, gain=1.0)

    assert "sRGB" in chunks(tmp_path / "a.png")
    assert "tIME" not in chunks(tmp_path / "a.png")


@pytest.mark.parametrize(
    ("size", "max_width", "expected"),
    [
        ((256, 128), 64, (64, 32)),
        ((256, 128), 100, (100, 50)),
        ((64, 32), 1024, (64, 32)),
        ((32, 192), 16, (16, 96)),
        ((512, 1), 16, (16, 1)),
    ],
)
def test_large_maps_are_made_smaller_in_proportion(tmp_path, size, max_width, expected):
    write_preview(tmp_path / "a.png", sky(*size), REC709, gain=1.0, max_width=max_width)

    assert codes(tmp_path / "a.png").shape[1::-1] == expected


def test_a_sun_does_not_ring_where_the_map_is_made_smaller(tmp_path):
    rows = np.full((128, 256, 3), 0.18, np.float32)
    rows[40, 100] = 1e5
    write_preview(tmp_path / "a.png", rows, REC709, gain=1.0, max_width=64)
    shown = codes(tmp_path / "a.png")

    assert shown.max() == 255
    assert shown.min() >= 88


def test_the_configuration_of_the_environment_does_not_change_the_picture(tmp_path, monkeypatch):
    expected = display_values(grey(0.18), REC709, "aces2")
    monkeypatch.setenv("OCIO", str(tmp_path / "studio.ocio"))

    np.testing.assert_array_equal(display_values(grey(0.18), REC709, "aces2"), expected)


def test_an_unknown_view_or_suffix_is_refused_with_the_known_ones(tmp_path):
    with pytest.raises(InputError, match="view: must be one of aces1, aces2, got 'filmic'"):
        write_preview(tmp_path / "a.png", sky(), REC709, gain=1.0, view="filmic")
    with pytest.raises(InputError, match=r"a.jpg: suffix of a preview must be .png, got '.jpg'"):
        write_preview(tmp_path / "a.jpg", sky(), REC709, gain=1.0)
    assert listing(tmp_path) == []


def test_a_preview_without_a_folder_is_refused(tmp_path):
    with pytest.raises(OutputError, match="folder must exist, got"):
        write_preview(tmp_path / "missing" / "a.png", sky(), REC709, gain=1.0)


SHORT_OF_MEMORY = """
import resource
import sys
from pathlib import Path
import numpy as np
from skybake.colour.space import find_colour_space
from skybake.formats.preview import write_preview
pixels = np.ones((2048, 4096, 3), np.float32)
used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + pixels.nbytes // 2, -1))
try:
    write_preview(Path(sys.argv[1]), pixels, find_colour_space("lin_rec709"), gain=1.0)
except MemoryError:
    print("told")
"""


@pytest.mark.skipif(sys.platform != "linux", reason="memory is limited and measured as on Linux")
def test_a_lack_of_memory_is_told_and_does_not_end_the_process(tmp_path):
    """OpenImageIO 3.2 divides by zero where it cannot copy pixels."""
    arguments = [sys.executable, "-c", SHORT_OF_MEMORY, str(tmp_path / "a.png")]
    environment = {"PYTHONPATH": ":".join(sys.path)}
    result = subprocess.run(arguments, env=environment, capture_output=True, text=True, check=False)
    assert (result.returncode, result.stdout) == (0, "told\n")
    assert listing(tmp_path) == []
