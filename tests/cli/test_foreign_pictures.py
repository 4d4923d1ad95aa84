"""Pictures by others, and damaged ones, shown by a process or refused in one line."""

import math
import random

import numpy as np
import OpenEXR
import OpenImageIO
import pytest

from skybake.baking.preview import preview_file
from skybake.errors import SkybakeError
from tests.cli.runs import invoke, listing, run
from tests.formats.maps import sky, write_map


def exr(path, channels=None, **header):
    standard = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(standard | header, channels or {"RGB": sky(16, 8)}) as file:
        file.write(str(path))


def hdr(path, lines):
    path.write_bytes(
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + b"\n-Y 1 +X 2\n" + bytes([128] * 8)
    )


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf, 1e-30, 1e30])
def test_a_white_luminance_that_is_none_is_one_line(folder, value):
    exr("a.exr", whiteLuminance=value)
    result = invoke("preview", "a.exr")
    assert result.exit_code == 1
    assert result.stderr.startswith("skybake: a.exr: whiteLuminance: must be ")
    assert result.stderr.count("\n") == 1
    assert listing(folder) == ["a.exr"]


REFUSED = [
    ({"whiteLuminance": "bright"}, "whiteLuminance: must be a number, got 'bright'"),
    ({"colorInteropID": 3.0}, "colour space must be one of"),
    ({"colorInteropID": "a\nb"}, "colour space must be one of"),
]


@pytest.mark.parametrize(("header", "message"), REFUSED)
def test_tags_of_another_type_are_one_line(folder, header, message):
    exr("a.exr", **header)
    result = invoke("preview", "a.exr")
    assert result.exit_code == 1
    assert message in result.stderr
    assert result.stderr.count("\n") == 1
    assert listing(folder) == ["a.exr"]


LINES = [
    (b"PRIMARIES=0.64 0.33\n", "chromaticities: must be 8 numbers, got (0.64, 0.33)"),
    (b"PRIMARIES=a b\n", "EXPOSURE and PRIMARIES must be numbers"),
    (b"PRIMARIES=nan 0.3 0.3 0.6 0.15 0.06 0.3 0.3\n", "chromaticities: must be 8 numbers"),
    (b"EXPOSURE=-1\n", "EXPOSURE must be at least 0 and finite, got -1"),
    (b"EXPOSURE=nan\n", "EXPOSURE must be at least 0 and finite, got nan"),
    (b"EXPOSURE=1e30\n", "whiteLuminance: must be from 1e-09 to 1e+15 cd/m2, got 1.79e-28"),
]


@pytest.mark.parametrize(("lines", "message"), LINES)
def test_a_header_of_a_radiance_picture_that_says_nothing_sound_is_one_line(folder, lines, message):
    hdr(folder / "a.hdr", lines)
    result = invoke("preview", "a.hdr")
    assert result.exit_code == 1
    assert message in result.stderr
    assert result.stderr.count("\n") == 1
    assert listing(folder) == ["a.hdr"]


def test_attributes_that_are_no_text_do_not_matter(folder):
    exr("plain.exr")
    exr("a.exr", comments="Maerz")
    content = (folder / "a.exr").read_bytes()
    (folder / "a.exr").write_bytes(content.replace(b"Maerz", b"M\xe4\xff\xfez"))
    hdr(folder / "a.hdr", b"OWNER=M\xe4rz\n\xff\xfe=3\n")
    for name in ("plain.exr", "a.exr", "a.hdr"):
        result = invoke("preview", name, "-o", f"{name}.png")
        assert result.exit_code == 0, result.output
    assert (folder / "a.exr.png").read_bytes() == (folder / "plain.exr.png").read_bytes()


def fault_of(path):
    """What is said of a picture that cannot be shown; nothing of one that can."""
    try:
        preview_file(path, path.with_suffix(".png"))
    except SkybakeError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("byte", [0x00, 0x0A, 0x80, 0xFF])
@pytest.mark.parametrize("suffix", [".exr", ".hdr"])
def test_a_changed_byte_of_a_header_is_no_traceback(tmp_path, suffix, byte):
    path = tmp_path / f"a{suffix}"
    write_map(path, sky(32, 16), attributes={"skybake:recipe": "x" * 50})
    content = path.read_bytes()
    refused = 0
    for at in random.Random(byte).sample(range(900), 16):
        path.write_bytes(content[:at] + bytes([byte]) + content[at + 1 :])
        message = fault_of(path)
        refused += bool(message)
        assert message.isprintable()
        message.encode()
    assert refused


MEASURED = """
import sys
from skybake.cli import main
try:
    main(sys.argv[1:])
finally:
    # Unlike the maximum that getrusage tells, this one is not inherited from who ran us.
    lines = open("/proc/self/status").read().splitlines()
    print(*(line.split()[1] for line in lines if line.startswith("VmHWM:")))
"""


@pytest.mark.slow
def test_16k_is_shown_with_less_than_500_megabytes(tmp_path):
    output = OpenImageIO.ImageOutput.create("exr")
    assert output.open(str(tmp_path / "a.exr"), OpenImageIO.ImageSpec(16384, 8192, 3, "half"))
    rows = np.tile(sky(1024, 256), (1, 16, 1))
    for first in range(0, 8192, 256):
        assert output.write_scanlines(first, first + 256, 0, rows)
    assert output.close()
    status, printed, errors = run(
        "preview", "a.exr", "-q", "-o", "a.png", cwd=tmp_path, code=MEASURED
    )
    assert status == 0, errors
    assert int(printed) * 1024 < 500e6
    picture = OpenImageIO.ImageBuf(str(tmp_path / "a.png"))
    assert (picture.spec().width, picture.spec().height) == (1024, 512)
