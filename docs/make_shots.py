"""Makes the pictures of docs/shots.md: ``python docs/make_shots.py``, in a minute."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

FOLDER = Path(__file__).parent / "images"
SHOTS = {
    "shuttle": "--altitude 350km --sun=-22deg --look limb --fov 12deg",
    "sunset": "--altitude 400km --sun=-18.5deg --look limb --fov 40deg --roll 12deg",
    "globe": "--altitude 36000km --sun 25deg --sun-azimuth 110deg --look planet",
    "mars": "--preset mars --altitude 300km --sun=-10deg --look limb --fov 38deg",
    "mars-night": "--preset mars --altitude 250km --sun=-23deg --look limb --fov 30deg",
}


def main() -> None:
    """Take each shot and keep its picture."""
    with tempfile.TemporaryDirectory() as folder:
        for name, options in SHOTS.items():
            command = [sys.executable, "-m", "skybake", "shot", "-q", "--size", "1280x720"]
            files = ["-o", f"{folder}/{name}.exr", "--preview", str(FOLDER / f"shot-{name}.png")]
            subprocess.run([*command, *options.split(), *files], check=True)


if __name__ == "__main__":
    main()
