"""What a PanoramaSky of Godot 3 shows toward directions in its axes, on a virtual screen."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np

SCRIPT = Path(__file__).with_suffix(".gd")


def is_there():
    """Whether this machine has what it takes: the packages godot3 and xvfb of Debian."""
    return shutil.which("godot3") is not None and shutil.which("xvfb-run") is not None


def shown(file, directions, folder):
    """Return its version, and RGB toward unit vectors, shape (direction, 3)."""
    project, wanted, result = (Path(folder) / name for name in ("project", "w.json", "r.json"))
    project.mkdir(exist_ok=True)
    (project / "project.godot").write_text("config_version=4\n")
    wanted.write_text(json.dumps(directions))
    screen = ["xvfb-run", "-a", "godot3", "--video-driver", "GLES3", "--audio-driver", "Dummy"]
    subprocess.run(
        [*screen, "--path", project, "-s", SCRIPT, file, wanted, result],
        check=True,
        capture_output=True,
        timeout=300,
    )
    found = json.loads(result.read_text())
    code = np.array(found["colours"])
    linear = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
    return found["version"], linear
