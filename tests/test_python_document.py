"""What docs/python.md shows runs as it stands."""

import re
import subprocess
import sys
from pathlib import Path

from tests.cli.runs import installed

DOCUMENT = (Path(__file__).parents[1] / "docs" / "python.md").read_text("utf-8")
EXAMPLES = re.findall(r"^```python\n(.*?)^```", DOCUMENT, re.MULTILINE | re.DOTALL)

QUICKER = """
import functools, skybake
skybake.map_settings = functools.partial(skybake.map_settings, method="hillaire")
"""
"""Bakes by the quickest method where an example asks for none."""


def test_the_examples_run_in_their_order_and_write_their_files(tmp_path):
    folder = tmp_path / "empty"
    folder.mkdir()
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", QUICKER + "\n".join(EXAMPLES)],
        cwd=folder,
        env=installed(tmp_path / "bin"),
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "2026-06-21T22:07" in done.stdout
    assert "Ls 180 16:30:00" in done.stdout
    assert done.stdout.endswith("time sunset: needs day\n")
    assert sorted(path.name for path in folder.iterdir() if path.is_file()) == [
        "chart.exr",
        "cross.exr",
        "dome.exr",
        "dusk.exr",
        "dusk.png",
        *(f"evening.{number:04}.exr" for number in range(1, 5)),
        "evening.png",
        "evening.sequence.json",
        "gale.exr",
        "hazy.exr",
        *(f"sky.{kind}" for kind in ("exr", "light.json", "py", "usda")),
        "spectrum.exr",
        *(f"storm.{number:04}.exr" for number in range(1, 4)),
        "three.exr",
        "west.exr",
        "west.png",
    ]
