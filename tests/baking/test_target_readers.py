"""Programs find in the files of their targets the directions that these encode."""

import numpy as np
import pytest

from skybake.projection import cubemap
from tests.baking.maps import pixels
from tests.baking.test_other_programs import run
from tests.formats.maps import program
from tests.peers.orientation import bake_directions, worst_angle

EDGE = 64
FLIPS = {"world": (1.0, 1.0, 1.0), "flip-x": (-1.0, 1.0, 1.0)}


def worst_of_faces(faces, brightest, signs=(1.0, 1.0, 1.0)):
    """Largest angle of all texels of six faces, which look in the cube's own directions. [deg]"""
    looked = [cubemap.face_directions(face, EDGE).reshape(-1, 3) for face in cubemap.FACES]
    colours = np.concatenate([image.reshape(-1, 3) for image in faces])
    return worst_angle(colours, brightest, np.concatenate(looked) * signs)


@pytest.mark.parametrize(("option", "space"), [((), "world"), (("--no-mirror",), "flip-x")])
def test_cmgen_makes_cubes_of_each_space_of_filaments_map(tmp_path, option, space):
    """Its own is in the axes of the world; without its mirror it is that of three.js."""
    (file,), brightest = bake_directions(tmp_path, "filament", "equirect", 512)
    extract = [f"--extract={tmp_path / 'cube'}", "-f", "rgb32f", "-f", "exr", "-s", EDGE]
    run(program("cmgen"), "-q", *option, *extract, file)
    faces = [pixels(tmp_path / "cube" / file.stem / f"{face}.exr") for face in cubemap.FACES]
    assert worst_of_faces(faces, brightest, FLIPS[space]) < 1.5
    other = FLIPS["flip-x" if space == "world" else "world"]
    assert worst_of_faces(faces, brightest, other) > 90.0


def test_exrenvmap_finds_directions_in_both_maps_of_openexr(tmp_path):
    (flat,), brightest = bake_directions(tmp_path, "openexr", "equirect", 512)
    (cube,), _ = bake_directions(tmp_path, "openexr", "cubemap", EDGE)
    run(program("exrenvmap"), "-c", "-w", EDGE, flat, tmp_path / "theirs.exr")
    ours, theirs = (
        pixels(file).reshape(6, EDGE, EDGE, 3) for file in (cube, tmp_path / "theirs.exr")
    )
    for images, tolerance in ((ours, 0.01), (theirs, 1.5)):
        faces = [
            cubemap.openexr_face(face, image)
            for face, image in zip(cubemap.FACES, images, strict=True)
        ]
        assert worst_of_faces(faces, brightest) < tolerance
