"""Whether programs find in the files of their targets the directions that these encode.

``python -m tests.peers.orientation`` asks all programs that this machine has, and fails if one of
them finds a direction elsewhere. Those of Debian that are quick are asked by the test suite too.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from skybake.baking.orientation_chart import CHART_LUMINANCE, bake_orientation_chart
from skybake.image.settings import map_settings
from skybake.image.target import find_target

# Away from edges of cubes, poles and seams, in no plane of symmetry.
_SIDES = [
    (x, y, z)
    for x in (-0.9, -0.31, 0.83)
    for y in (-0.77, 0.23)
    for z in (-0.87, -0.18, 0.37, 0.95)
]
DIRECTIONS = np.array(_SIDES) / np.linalg.norm(_SIDES, axis=1, keepdims=True)
"""Unit vectors in the world's axes, shape (direction, 3)."""


def bake_directions(folder, target, projection=None, size=256, suffix=None, **values):
    """Write the map of directions for a target; return its files and what 1.0 is in them."""
    settings = map_settings(projection, size, target=target, pixel="float", **values)
    name = settings.view.projection.name
    path = Path(folder) / f"{target}_{name}{suffix or find_target(target).suffix(name)}"
    files = bake_orientation_chart(path, settings, is_lettered=False)
    return files, CHART_LUMINANCE / settings.encoding.white_luminance


def in_axes(target, directions=DIRECTIONS):
    """Directions in the axes of a target, as lists."""
    axes = find_target(target).axes
    return [axes.direction(tuple(one)) for one in directions.tolist()]


def worst_angle(colours, brightest, directions=DIRECTIONS):
    """Largest angle between directions and those that colours encode. [deg]"""
    found = 2.0 * np.asarray(colours, float) / brightest - 1.0
    found /= np.linalg.norm(found, axis=1, keepdims=True)
    cosine = np.clip((found * directions).sum(axis=1), -1.0, 1.0)
    return math.degrees(float(np.arccos(cosine.min())))


LIMIT = 1.0
"""Largest angle that is no fault: half a texel, and the rounding of RGBE. [deg]"""


def measured(targets):
    """Yield what was asked, of which version, and the largest angle that it was off. [deg]"""
    for suffix in (".exr", ".hdr"):
        for target in targets:
            with tempfile.TemporaryDirectory() as folder:
                files, brightest = bake_directions(folder, target, "equirect", 512, suffix)
                found = ASKED[target](files, in_axes(target), folder)
                for what, version, colours in found:
                    yield f"{target} {suffix} {what}", version, worst_angle(colours, brightest)
    if "three" not in targets:
        return
    with tempfile.TemporaryDirectory() as folder:
        files, brightest = bake_directions(folder, "three", "cubemap", 128)
        for what, version, colours in ask_three(files, in_axes("three"), folder):
            yield f"three cube {what}", version, worst_angle(colours, brightest)


def ask_three(files, directions, _folder):
    from tests.peers import three_directions

    if not three_directions.is_there():
        return
    found = three_directions.shown(files, directions)
    for what in ("background", "environment"):
        yield what, found["version"], found[what]


def ask_mitsuba(files, directions, _folder):
    from tests.peers import mitsuba_directions

    if find_spec("mitsuba") is not None:
        yield "emitter", *mitsuba_directions.shown(files[0], directions)


def ask_blender(files, directions, folder):
    python = os.environ.get("SKYBAKE_PEER_BPY")
    if python is None:
        return
    wanted, result = Path(folder) / "wanted.json", Path(folder) / "result.json"
    wanted.write_text(json.dumps(directions))
    script = Path(__file__).with_name("blender_directions.py")
    subprocess.run(
        [python, script, files[0], wanted, result], check=True, capture_output=True, timeout=900
    )
    found = json.loads(result.read_text())
    yield "world", found["version"], found["colours"]


def ask_godot(files, directions, folder):
    from tests.peers import godot_directions

    if godot_directions.is_there():
        yield "sky", *godot_directions.shown(files[0], directions, folder)


ASKED = {
    "three": ask_three,
    "mitsuba": ask_mitsuba,
    "blender": ask_blender,
    "godot": ask_godot,
}


def main(targets):
    """Print a line for each that these programs were asked, and return an exit status."""
    is_fine = True
    for what, version, angle in measured(targets):
        is_fine &= angle < LIMIT
        sys.stdout.write(f"{what:28} {version:28} off by at most {angle:.2f} deg\n")
        sys.stdout.flush()
    return 0 if is_fine else 1


if __name__ == "__main__":
    sys.exit(main(ASKED))
