"""``skybake sequence --skip-existing``: what is left alone and what is baked again."""

import hashlib
import shutil
import subprocess
from contextlib import chdir
from pathlib import Path

import OpenImageIO
import pytest

from skybake.formats.reader import read_image
from skybake.sequence.digests import FOLDER as DIGESTS
from skybake.sequence.digests import verified_digests
from tests.cli.runs import invoke, listing
from tests.cli.sequences import DAY, QUICK, THREE, attributes, digests, files, records, sequence

pytestmark = pytest.mark.usefixtures("folder")


@pytest.fixture(scope="module")
def baked_once(tmp_path_factory):
    """Function that bakes a sequence into the current folder, or copies one of like arguments."""
    made = {}

    def bake(*arguments):
        if arguments not in made:
            made[arguments] = tmp_path_factory.mktemp("sequence")
            with chdir(made[arguments]):
                sequence(*arguments)
        shutil.copytree(made[arguments], Path(), dirs_exist_ok=True)

    return bake


@pytest.mark.parametrize("suffix", ["exr", "hdr"])
def test_a_resumed_run_skips_what_is_whole_and_writes_the_same_manifest(folder, suffix):
    arguments = (*DAY, "--frames", "1-4", "-o", f"a.#.{suffix}", "--manifest", "a.json")
    arguments += ("--manifest", "a.csv", "--contact-sheet", "a.png", "--preview")
    assert sequence(*arguments)["baked"] == 4
    before = digests("*")
    written = {path: path.stat().st_mtime_ns for path in files(f"*.{suffix}")}
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


def test_what_a_killed_process_left_goes_when_its_frame_is_found_whole(folder, baked_once):
    arguments = (*DAY, *THREE, "-o", "a.#.exr", "--preview")
    baked_once(*arguments)
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
    "a byte of the header changed": flip(0.02),
    "a byte more": lambda content: content + b"\0",
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


@pytest.mark.parametrize("suffix", ["exr", "hdr", "png"])
def test_a_byte_changed_anywhere_is_noticed(suffix):
    """Of two hundred places all over a file, with compressions that have no checksum."""
    frame = [*DAY, "--frames", "1", "-o", "a.#.hdr" if suffix == "hdr" else "a.#.exr"]
    frame += ["--preview"] if suffix == "png" else []
    frame += ["--compression", "none"] if suffix != "hdr" else []
    sequence(*frame)
    path = Path(f"a.0001.{suffix}")
    claim = (Path(DIGESTS) / f"a.0001.{'hdr' if suffix == 'hdr' else 'exr'}.sha256").read_text()
    claim = claim.splitlines()[0].removeprefix("# claim ")
    output = path.with_suffix(".hdr" if suffix == "hdr" else ".exr")
    content = path.read_bytes()
    assert verified_digests(output, claim, [path]) is not None
    for at in range(0, len(content), max(1, len(content) // 200)):
        path.write_bytes(content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :])
        assert verified_digests(output, claim, [path]) is None
    path.write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
    assert sequence(*frame, "--skip-existing")["baked"] == 1
    assert path.read_bytes() == content


def test_files_without_their_digests_are_baked_again(baked_once):
    arguments = (*DAY, *THREE, "-o", "a.#.exr")
    baked_once(*arguments)
    (Path(DIGESTS) / "a.0002.exr.sha256").unlink()
    (Path(DIGESTS) / "a.0003.exr.sha256").write_bytes(b"\xff")
    assert sequence(*arguments, "--skip-existing")["baked"] == 2
    assert sequence(*arguments, "--skip-existing")["baked"] == 0


def test_digests_are_as_sha256sum_checks_them():
    sequence(*DAY, *THREE, "-o", "a.#.exr", "--preview")
    names = sorted(path.name for path in Path(DIGESTS).iterdir())
    assert names == [f"a.000{number}.exr.sha256" for number in (1, 2, 3)]
    command = ["sha256sum", "--check", "--strict", "--quiet", *names]
    assert subprocess.run(command, cwd=DIGESTS, check=False).returncode == 0


def test_a_frame_of_another_time_of_the_same_light_is_baked_again():
    """Its files tell the time, which no pixel does."""
    time = ("--lat", "0", "--lon", "0", "--from", "2026-06-21T12:00Z", "--to", "2026-06-21T13:00Z")
    arguments = ("--frames", "1-2", "-o", "a.#.exr")
    sequence(*time, *arguments)
    digests_before = digests("*.exr")
    named = attributes("a.0001.exr")
    suns = "..".join(f"{record['sun_elevation_deg']!r}deg" for record in records("a.sequence.json"))
    bearings = "..".join(
        f"{record['sun_azimuth_deg']!r}deg" for record in records("a.sequence.json")
    )
    told = sequence("--sun", suns, "--sun-azimuth", bearings, *arguments, "--skip-existing")
    assert told["baked"] == 2
    assert "skybake:time" in named
    assert "skybake:time" not in attributes("a.0001.exr")
    sequence(*time, *arguments, "--skip-existing")
    assert digests("*.exr") == digests_before


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
def test_files_of_another_recipe_are_baked_again(change, baked_once):
    arguments = (*DAY, *THREE, "-o", "a.#.exr")
    baked_once(*arguments)
    told = sequence(*arguments, *change, "--skip-existing")
    # The first frame's sun is the same in both ranges.
    assert told["baked"] == (2 if change[0] == "--sun" else 3)


CHANGED_PICTURES = [
    (("--preview-ev", "12"), 3),
    # The frame with the highest sun is the one that all are exposed for by default.
    (("--preview-ev", "adapt"), 2),
    (("--view", "aces2"), 3),
    (("--white-balance", "auto"), 3),
    (("--white-balance", "none"), 0),
    (("--shot", "180,10,50"), 3),
    (("--preview-ev", "auto"), 0),
]


@pytest.mark.parametrize(("change", "baked"), CHANGED_PICTURES, ids=str)
def test_pictures_of_another_exposure_or_view_are_made_again(change, baked, baked_once):
    arguments = (*DAY, *THREE, "-o", "a.#.exr", "--preview")
    baked_once(*arguments)
    told = sequence(*arguments, *change, "--skip-existing")
    assert (told["baked"], told["skipped"]) == (baked, 3 - baked)
    before = digests("*")
    sequence(*arguments, *change)
    assert digests("*") == before


@pytest.mark.parametrize("damage", ["empty", "header only", "half"])
def test_a_picture_that_is_not_whole_is_made_again(damage):
    arguments = (*DAY, *THREE, "-o", "a.#.exr", "--preview")
    sequence(*arguments)
    before = digests("*")
    path = Path("a.0002.png")
    path.write_bytes(DAMAGES[damage](path.read_bytes()))
    assert sequence(*arguments, "--skip-existing")["baked"] == 1
    assert digests("*") == before


def test_a_picture_of_another_frame_is_made_again():
    arguments = (*DAY, *THREE, "-o", "a.#.exr", "--preview", "--preview-ev", "12")
    sequence(*arguments)
    before = digests("*")
    Path("a.0002.png").write_bytes(Path("a.0001.png").read_bytes())
    assert sequence(*arguments, "--skip-existing")["baked"] == 1
    assert digests("*") == before


def test_maps_alone_are_left_whatever_their_pictures_are():
    arguments = (*DAY, *THREE, "-o", "a.#.exr")
    sequence(*arguments, "--preview")
    told = sequence(*arguments, "--skip-existing", "--contact-sheet", "s.png", "--preview-ev", "3")
    assert told["skipped"] == 3


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
