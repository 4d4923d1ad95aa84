"""What docs/tables.md says is so."""

from pathlib import Path

import pytest

from skybake.luts.files import TABLE_NAMES, file_names
from skybake.luts.parametrisations import PARAMETRISATIONS, TABLES, find_mappings
from skybake.luts.settings import TableSettings
from tests.luts.sets import baked, read_texture, scene_of

DOCUMENT = (Path(__file__).parents[2] / "docs" / "tables.md").read_text(encoding="utf-8")
SHOWN = [
    *(("hillaire2020", table) for table in TABLES),
    ("bruneton2017", "multiple_scattering"),
    ("bruneton2017", "sky_view"),
    ("linear", "transmittance"),
    ("linear", "sky_view"),
]


@pytest.mark.parametrize(("name", "table"), SHOWN)
def test_formulas_are_those_that_fill_the_tables(name, table):
    assert f"```\n{find_mappings(name)[table].forward.strip()}\n```" in DOCUMENT


def test_mappings_that_are_said_to_be_alike_are():
    mappings = {name: find_mappings(name) for name in PARAMETRISATIONS}
    first = mappings["hillaire2020"]
    assert mappings["bruneton2017"]["transmittance"].forward == first["transmittance"].forward
    assert mappings["bruneton2017"]["aerial_perspective"] == first["aerial_perspective"]
    assert mappings["linear"]["multiple_scattering"] == first["multiple_scattering"]


def test_files_and_sizes_are_those_that_are_listed(tmp_path):
    about = baked(tmp_path, scene_of(), pixel="half")
    for name in TABLE_NAMES:
        size = "x".join(map(str, about["tables"][name]["size"]))
        assert f"| `{name}` | {size} |" in DOCUMENT
        assert read_texture(tmp_path / f"{name}.ktx2").shape[-2::-1] == tuple(
            about["tables"][name]["size"]
        )
    assert about["colour"]["white_luminance_cd_m2"] == pytest.approx(39321.6)
    listed = {name for names in file_names().values() for name in names} | {"luts.json"}
    assert {path.name for path in tmp_path.iterdir()} == listed
    assert TableSettings().far == 128.0
