"""three.js in a headless Chromium, by the map and the JSON of its light."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np

from tests.peers import scenes
from tests.peers.peer import AbsentError, Rendered

MODULES = "SKYBAKE_PEER_NODE_MODULES"
_SCRIPT = scenes.FOLDER / "three_views.mjs"
_NEEDED = ("three", "playwright-core")


def render(baked, folder):
    """Render all views; parameters and errors are those of `tests.peers.blender.render`."""
    command = [_program("node"), str(_SCRIPT), str(_modules()), _program("chromium")]
    settings, output = folder / "settings.json", folder / "views.json"
    values = {
        "map": str(baked.map),
        "sun": json.loads(baked.json.read_text("utf-8"))["sun"],
        "albedo": scenes.ALBEDO,
        "views": scenes.SQUARE_VIEWS,
        "pole": [scenes.POLE_HEIGHT, scenes.POLE_RADIUS],
        "picture": scenes.PICTURE,
    }
    settings.write_text(json.dumps(values))
    subprocess.run(
        [*command, str(settings), str(output)],
        check=True,
        capture_output=True,
        text=True,
        timeout=600,
    )
    rendered = json.loads(output.read_text())
    views = (_pixels(rendered["views"][name]) for name in scenes.Views._fields)
    return Rendered(f"r{rendered['version']}", scenes.Views(*views))


def _pixels(view):
    return np.array(view["values"], np.float32).reshape(view["height"], view["width"], 3)


def _program(name):
    program = shutil.which(name)
    if program is None:
        raise AbsentError(f"no {name} in PATH")
    return program


def _modules():
    """Folder of node modules: as the environment says, or where npm installs for all."""
    given = os.environ.get(MODULES)
    if given is None:
        asked = [_program("npm"), "root", "--global"]
        given = subprocess.run(asked, check=True, capture_output=True, text=True).stdout.strip()
    missing = [name for name in _NEEDED if not (Path(given) / name).is_dir()]
    if missing:
        names = " and ".join(missing)
        raise AbsentError(f"no {names} in {given}; {MODULES} may name another folder")
    return Path(given).resolve()
