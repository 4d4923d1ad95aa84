import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import skybake
from skybake.errors import PresetError
from skybake.preset import preset_names, preset_text

REPOSITORY = Path(__file__).resolve().parents[2]
LIST = """
from skybake.preset import load_preset, preset_names
for name in preset_names():
    print(load_preset(name).name)
"""


def names_seen_from(folder: Path) -> list[str]:
    run = subprocess.run(
        [sys.executable, "-c", LIST],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(folder)},
        capture_output=True,
        text=True,
        check=True,
    )
    return run.stdout.split()


@pytest.fixture
def copied(tmp_path):
    ignore = shutil.ignore_patterns("__pycache__", "presets")
    shutil.copytree(Path(skybake.__file__).parent, tmp_path / "skybake", ignore=ignore)
    return tmp_path


def test_presets_are_found_beside_the_code_as_the_wheel_installs_them(copied):
    shutil.copytree(REPOSITORY / "presets", copied / "skybake" / "presets")
    assert names_seen_from(copied) == preset_names()


def test_presets_are_found_at_the_top_of_a_repository(copied):
    shutil.copytree(REPOSITORY / "presets", copied / "presets")
    assert names_seen_from(copied) == preset_names()


def test_the_text_of_a_preset_is_its_file():
    for name in preset_names():
        assert preset_text(name) == (REPOSITORY / "presets" / f"{name}.toml").read_text("utf-8")


def test_the_text_of_an_unknown_preset_is_refused_with_the_known_names():
    with pytest.raises(PresetError, match="known presets: earth, "):
        preset_text("vulcan")


def test_loading_a_preset_imports_neither_numpy_nor_scipy():
    code = (
        "import sys; from skybake.preset import load_preset; load_preset('mars'); "
        "sys.exit(bool({'numpy', 'scipy', 'pandas'} & set(sys.modules)))"
    )
    run = subprocess.run([sys.executable, "-c", code], cwd=REPOSITORY, check=False)
    assert run.returncode == 0
