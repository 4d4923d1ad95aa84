"""Tables of polarisation in a preset."""

import pytest

from skybake.errors import PresetError
from skybake.preset import load_preset

TABLE = (
    "angle_deg,p12_300,p33_300,p12_900,p33_900\n0,0,1,0,1\n90,-0.5,0.1,-0.2,0.3\n180,0,-1,0,-1\n"
)


def preset(tmp_path, table=TABLE, phase='polarisation = "mine.csv"'):
    (tmp_path / "mine.csv").write_text(table)
    file = tmp_path / "world.toml"
    file.write_text(f'extends = "earth"\n[constituents.aerosol.phase]\n{phase}\n')
    return load_preset(file)


def polarisation(planet):
    return planet.constituents[2].phase.polarisation


def test_a_table_has_two_columns_for_each_wavelength(tmp_path):
    found = polarisation(preset(tmp_path))
    assert found.wavelength == (300.0, 900.0)
    assert found.p12 == ((0.0, -0.5, 0.0), (0.0, -0.2, 0.0))
    assert found.p33[1] == (1.0, 0.3, -1.0)


def test_another_phase_function_does_away_with_the_polarisation_of_the_former(tmp_path):
    assert polarisation(load_preset("earth")) is not None
    changed = preset(tmp_path, phase='table = "desert_dust_phase"')
    assert polarisation(changed) is None


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("p33_900", "p33_800", "column p12_ and a column p33_ for each"),
        ("p33_900", "p34_900", "named p12_NM or p33_NM, got 'p34_900'"),
        ("p33_900", "p33_red", "wavelength in nm, got 'red'"),
        ("-0.5", "-1.5", "p12_300 must be from -1 to 1"),
        ("\n0,", "\n1,", "from 0 to 180"),
    ],
)
def test_a_faulty_table_is_refused_in_a_line(tmp_path, old, new, fault):
    with pytest.raises(PresetError, match=fault) as caught:
        preset(tmp_path, TABLE.replace(old, new))
    assert "phase.polarisation" in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1
