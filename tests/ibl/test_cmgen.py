"""Filament's own program makes the same of the same map, as far as it is exact."""

import re
import subprocess

import numpy as np
import pytest

from skybake.ibl.cube import coarser
from skybake.ibl.diffuse import diffuse_cube
from skybake.ibl.harmonics import filament_text, harmonics_of
from skybake.ibl.points import no_points
from skybake.ibl.settings import LightingMaps
from skybake.ibl.specular import SpecularFilter
from skybake.projection.cubemap import CROSS_ORIGINS, FACES
from tests.baking.maps import pixels
from tests.formats.maps import program, write_map
from tests.ibl.maps import directions

EDGE = 64

# Its crosses are in the axes of the world with this, as they stand in the file.
CMGEN = ("-q", "--no-mirror")


def _soft(edge):
    """Light of which every direction has another."""
    x, y, z = directions(edge).T
    light = np.stack([1.0 + 0.5 * x, 1.0 + 0.4 * z - 0.3 * x * y, 1.0 + 0.6 * y + 0.3 * x * z], -1)
    return light.reshape(6, edge, edge, 3).astype(np.float32)


def _numbers(text):
    rows = [re.findall(r"[-+]?\d+\.\d+", line.partition(";")[0]) for line in text.splitlines()]
    return np.array(rows, float)


def _faces(folder, prefix):
    return np.stack([pixels(folder / f"{prefix}_{face}.exr") for face in FACES])


@pytest.fixture(scope="module")
def cross(tmp_path_factory):
    cube = _soft(EDGE)
    picture = np.zeros((3 * EDGE, 4 * EDGE, 3), np.float32)
    for face, pixels_of_face in zip(FACES, cube, strict=True):
        row, column = (EDGE * each for each in CROSS_ORIGINS[face])
        picture[row : row + EDGE, column : column + EDGE] = pixels_of_face
    path = tmp_path_factory.mktemp("cmgen") / "cross.exr"
    write_map(path, picture, pixel="float")
    return path, cube


def _run(*arguments):
    done = subprocess.run(
        [program("cmgen"), *CMGEN, *map(str, arguments)], capture_output=True, check=True
    )
    assert b"rror" not in done.stderr


def test_harmonics_are_those_of_cmgen(cross):
    path, cube = cross
    text = path.with_name("sh.txt")
    _run("--sh=3", "--sh-shader", "--sh-window=no", f"--sh-output={text}", path)
    theirs, ours = (_numbers(each) for each in (text.read_text(), _ours(cube)))
    assert ours.shape == theirs.shape == (9, 3)
    assert np.abs(ours - theirs).max() < 0.01 * np.abs(theirs[0]).max()
    notable = np.abs(theirs) > 0.01
    assert ours[notable] == pytest.approx(theirs[notable], rel=0.01)
    names = [line.partition("//")[2] for line in text.read_text().splitlines()]
    assert [line.partition("//")[2] for line in _ours(cube).splitlines()] == names


def _ours(cube):
    return filament_text(harmonics_of(cube, no_points()))


def test_levels_are_those_of_cmgen_in_filaments_roughness(cross):
    """It is off by some percent itself, by samples of levels that are not weighted by size."""
    path, cube = cross
    folder = path.with_name("levels")
    _run(f"--ibl-ld={folder}", "--ibl-samples=1024", "-s", EDGE, "-f", "exr", path)
    maps = LightingMaps(specular_size=EDGE, mips=3, mapping="filament")
    made = SpecularFilter(cube, no_points())
    for mip, (edge, roughness) in enumerate(maps.levels()):
        ours = made.cube(edge, roughness, 512) if mip else coarser(cube, edge)
        theirs = _faces(folder / "cross", f"m{mip}")
        error = np.sqrt(np.mean((ours / theirs - 1.0) ** 2))
        turned = np.sqrt(np.mean((ours[:, :, ::-1] / theirs - 1.0) ** 2))
        assert error < (1e-3, 0.02, 0.04)[mip]
        assert turned > 2.0 * error


def test_the_diffuse_cube_is_that_of_cmgen(cross):
    path, cube = cross
    folder = path.with_name("irradiance")
    _run(f"--ibl-irradiance={folder}", "--ibl-samples=4096", "-s", 16, "-f", "exr", path)
    ours, theirs = diffuse_cube(cube, no_points(), 16), _faces(folder / "cross", "i")
    assert np.sqrt(np.mean((ours / theirs - 1.0) ** 2)) < 0.03
