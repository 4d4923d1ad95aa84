"""Small presets in files, and what is said of faulty ones."""

from pathlib import Path

import pytest

from skybake.errors import PresetError
from skybake.preset import load_preset

MINIMAL = """
title = "A ball in thin haze"
[planet]
radius_km = 1000.0
atmosphere_top_km = 50.0
[star]
radius_km = 700000.0
distance_au = 1.0
irradiance_w_m2_nm = 1.5
[ground]
albedo = 0.2
[constituents.haze]
kind = "aerosol"
optical_depth = 0.3
optical_depth_wavelength_nm = 550.0
angstrom_exponent = 1.3
single_scattering_albedo = 0.9
profile = { kind = "exponential", scale_height_km = 5.0 }
phase = { kind = "henyey-greenstein", asymmetry = 0.7 }
"""

CUMULUS = """
[clouds.low]
kind = "cumulus"
"""


def write(folder: Path, old: str = "", new: str = "", text: str = MINIMAL) -> Path:
    assert old in text
    path = folder / "ball.toml"
    path.write_text(text.replace(old, new, 1) if old else text + new, encoding="utf-8")
    return path


PHASE = '{ kind = "henyey-greenstein", asymmetry = 0.7 }'
GAS = """
[constituents.gas]
kind = "gas"
pressure_pa = 610.0
temperature_k = 210.0
composition = { co2 = 1.0 }
profile = { kind = "exponential", scale_height_km = 11.0 }
"""


def message_about(path: Path) -> str:
    with pytest.raises(PresetError) as caught:
        load_preset(path)
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    assert message.startswith(f"{path}: ")
    return message.removeprefix(f"{path}: ")


def only_layer(folder, more="", text=CUMULUS):
    """The layer of clouds of a world that has one."""
    (only,) = load_preset(write(folder, new=f"{text}{more}\n")).clouds
    return only
