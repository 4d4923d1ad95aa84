"""Blender, by the script that ``--lights`` writes for it."""

import os
import shutil
import subprocess

from tests.peers import scenes
from tests.peers.files import read_views
from tests.peers.peer import AbsentError, Rendered

PYTHON = "SKYBAKE_PEER_BPY"
_SCRIPT = scenes.FOLDER / "blender_views.py"


def render(baked, folder):
    """Render all views.

    Parameters
    ----------
    baked : tests.peers.files.Files
        The map and its lights.
    folder : Path
        For files in between.

    Raises
    ------
    AbsentError
        If there is no Blender.
    """
    settings = [
        f"light={baked.script}",
        f"usd={baked.usd}",
        f"albedo={scenes.ALBEDO}",
        *(f"{name}={value[0]},{value[1]}" for name, value in scenes.SQUARE_VIEWS.items()),
        f"pole_size={scenes.POLE_HEIGHT},{scenes.POLE_RADIUS}",
        f"picture={scenes.PICTURE[0]},{scenes.PICTURE[1]}",
    ]
    subprocess.run(
        [*_command(), *settings, str(folder)],
        check=True,
        capture_output=True,
        text=True,
        timeout=1200,
    )
    return Rendered((folder / "version").read_text(), read_views(folder))


def _command():
    python = os.environ.get(PYTHON)
    if python:
        return [python, str(_SCRIPT)]
    program = shutil.which("blender")
    if program is None:
        raise AbsentError(
            f"no blender in PATH, and {PYTHON} does not name a Python that has the package bpy"
        )
    return [program, "--background", "--factory-startup", "--python", str(_SCRIPT), "--"]
