"""What the README says is so."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from skybake.preset import preset_names, preset_text
from tests.cli.runs import installed

REPOSITORY = Path(__file__).parents[1]
README = (REPOSITORY / "README.md").read_text("utf-8")
SHELL = re.findall(r"^```sh\n(.*?)^```", README, re.MULTILINE | re.DOTALL)
PYTHON = re.findall(r"^```python\n(.*?)^```", README, re.MULTILINE | re.DOTALL)
RENDER, TEST = SHELL[:2]

QUICKER = """
import subprocess, sys

command, *words = sys.argv[1:]
if command in ("render", "sequence"):
    sizes = [words[i + 1] for i, word in enumerate(words) if word == "--size"]
    pixels = [max(int(edge) // 8, 16) for edge in (sizes or ["512x256"])[-1].split("x")]
    words += ["--size", "x".join(map(str, pixels))]
if "--clouds" in words:
    words += ["--clouds-quality", "draft"]
if command in ("render", "sequence", "ibl", "luts"):
    words += ["--method", "hillaire"]
sys.exit(subprocess.call([sys.executable, "-m", "skybake", command, *words]))
"""
"""Makes what it is told to, an eighth as wide and by the quickest method."""


@pytest.fixture
def shell(tmp_path):
    """Run a script in an empty folder, with skybake on the path as an installation puts it."""
    (tmp_path / "quicker.py").write_text(QUICKER)
    environment = installed(tmp_path / "bin", f'exec {sys.executable} {tmp_path}/quicker.py "$@"')
    folder = tmp_path / "empty"
    folder.mkdir()

    def run(script):
        return subprocess.run(
            script if isinstance(script, list) else ["/bin/sh", "-ec", script],
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            check=True,
            timeout=300,
        )

    run.folder = folder
    return run


def test_two_commands_set_it_up():
    assert RENDER == "pip install . && skybake render --sun 5deg --preset mars --preview\n"
    assert TEST == 'pip install ".[test]" && pytest\n'


@pytest.mark.parametrize("script", [RENDER.removeprefix("pip install . && "), *SHELL[2:]])
def test_every_command_of_the_readme_runs(shell, script):
    assert "skybake" in script
    shell(script)
    made = {path.suffix for path in shell.folder.rglob("*")}
    assert (".csv" if "probe" in script else ".exr") in made


def test_the_python_of_the_readme_runs(shell):
    assert len(PYTHON) == 1
    radiance = shell([sys.executable, "-c", PYTHON[0]]).stdout
    assert len(re.findall(r"\d\.\d+", radiance)) == 16
    assert sorted(path.name for path in shell.folder.iterdir()) == ["mars.exr", "mars.png"]


def test_the_table_of_presets_is_that_of_skybake():
    rows = re.findall(r"^\| `([a-z0-9-]+)` \| (.+) \|$", README, re.MULTILINE)
    titles = [(name, tomllib.loads(preset_text(name))["title"]) for name in preset_names()]
    assert rows == titles


DOCUMENTS = [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").rglob("*.md"))]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_every_link_to_a_file_leads_to_one(document):
    for target in re.findall(r"\]\((?!https?:)([^)#]+)", document.read_text("utf-8")):
        assert (document.parent / target).exists()
