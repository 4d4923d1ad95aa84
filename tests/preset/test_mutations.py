"""A preset that was tampered with is refused in one line, or makes air of finite numbers."""

import tomllib
import warnings
from copy import deepcopy
from pathlib import Path

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from skybake.errors import PresetError, PresetWarning
from skybake.optics.medium import build_medium
from skybake.optics.spectrum import limb_darkening, star_irradiance, star_spectrum
from skybake.preset import load_preset, preset_text
from skybake.preset.document import Document, Source
from skybake.preset.toml import toml_text
from skybake.sky.sky import WAVELENGTHS
from tests.preset.files import MINIMAL

CLOUDS = """
[clouds.low]
kind = "cumulus"
base_km = 1.2
depth_km = 0.9
cover = 0.4
liquid_water_path_g_m2 = 120.0
effective_radius_um = 8.0
wind_m_s = [6.0, 250.0]
[clouds.high]
kind = "cirrus"
base_km = 8.0
optical_depth = 0.3
phase = { kind = "henyey-greenstein", asymmetry = 0.8 }
"""
TEXTS = (MINIMAL, MINIMAL + CLOUDS, *map(preset_text, ("earth", "mars")))
BASES = [tomllib.loads(text) for text in TEXTS]
NUMBERS = st.sampled_from(
    [0, -1, 1, 1e-300, 1e-9, 0.5, 0.99, 1.0, 2.0, 99.0, 550.0, 1e3, 1e6, 1e9, 1e300, 2**70]
) | st.floats(width=64)
WORDS = st.sampled_from(
    [
        "none",
        "earth",
        "dry_air",
        "afgl_us_standard",
        "ozone_233k",
        "mars_dust_phase",
        "a.csv",
        "3/8",
    ]
) | st.sampled_from(["exponential", "tent", "tabulated", "cornette-shanks", "rgb", "gas", "", "/"])
FACTORS = st.sampled_from([0.0, 1e-12, 1e-3, 0.3, 0.5, 0.9, 1.01, 1.1, 2.0, 3.0, 1e3, 1e12, -1.0])
ACTIONS = st.sampled_from(["scale"] * 7 + ["change", "drop", "misspell"])
SPECTRA = st.fixed_dictionaries(
    {"wavelength_nm": st.lists(NUMBERS, max_size=3), "values": st.lists(NUMBERS, max_size=3)}
)
WIDE = st.fixed_dictionaries(
    {"wavelength_nm": st.just([1.0, 1e6]), "values": st.lists(NUMBERS, min_size=2, max_size=2)}
)
VALUES = NUMBERS | WORDS | st.booleans() | st.lists(NUMBERS, max_size=4) | SPECTRA | WIDE


def places(table, at=()):
    for name, value in table.items():
        yield (*at, name)
        if isinstance(value, dict):
            yield from places(value, (*at, name))


def value_at(table, key):
    for name in key:
        table = table[name]
    return table


@st.composite
def mutants(draw):
    preset = deepcopy(draw(st.sampled_from(BASES)))
    for _ in range(draw(st.integers(1, 2))):
        action = draw(ACTIONS)
        keys = sorted(places(preset))
        if action == "scale":
            keys = [key for key in keys if isinstance(value_at(preset, key), float)]
        *tables, name = draw(st.sampled_from(keys))
        table = value_at(preset, tables)
        if action == "scale":
            table[name] *= draw(FACTORS)
        elif action == "drop":
            del table[name]
        elif action == "misspell":
            table[f"{name}s"] = table.pop(name)
        else:
            table[name] = draw(VALUES)
    return preset


@settings(max_examples=200)
@given(mutants())
def test_a_mutated_preset_is_refused_in_lines_or_makes_a_finite_medium(tmp_path_factory, preset):
    path = tmp_path_factory.mktemp("mutant") / "own.toml"
    path.write_text(toml_text(preset), encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PresetWarning)
        try:
            planet = load_preset(path)
            wavelengths = np.array(planet.wavelengths or WAVELENGTHS, dtype=float)
            medium = build_medium(planet, wavelengths)
            star = [star_irradiance(planet.star, wavelengths), *star_spectrum(planet.star)]
            star.append(limb_darkening(planet.star, wavelengths))
        except PresetError as error:
            for line in (str(error), *error.faults):
                assert len(line.splitlines()) == 1
                assert line.strip()
            return
    layers = [
        np.array([one.base, one.depth, one.size, one.cover, one.optical_depth, one.wind_from])
        for one in planet.clouds
    ]
    for array in layers:
        assert (array >= 0.0).all()
    for array in (*medium[2:], *star, *layers):
        assert np.isfinite(array).all()
    for array in medium._replace(matrix=np.zeros(0))[2:]:
        assert (array >= 0.0).all()
    assert (medium.scattering <= medium.extinction).all()
    assert (medium.ground_albedo <= 1.0).all()


TABLES = st.recursive(
    NUMBERS, lambda inner: st.dictionaries(st.sampled_from("abc"), inner, max_size=3)
)


@given(st.lists(st.dictionaries(st.sampled_from("abc"), TABLES, max_size=3), max_size=4))
def test_every_value_of_merged_tables_has_the_source_that_wrote_it_last(tables):
    document = Document()
    sources = [Source(f"{i}.toml", Path()) for i in range(len(tables))]
    for table, source in zip(tables, sources, strict=True):
        document.lay(table, source)
    for key, value in document.leaves():
        wrote = tables[sources.index(document.source(key))]
        for name in key:
            wrote = wrote[name]
        assert repr(wrote) == repr(value)
