"""Planets from TOML: where presets are, what they may contain, and every check of it."""

from skybake.preset.clouds_model import KINDS as CLOUD_KINDS
from skybake.preset.clouds_model import CloudLayer, Tile
from skybake.preset.extend import Override, Overrides, load_document, planet_name
from skybake.preset.find import preset_names, preset_text
from skybake.preset.load import load_preset
from skybake.preset.model import (
    Absorber,
    Aerosol,
    Coefficients,
    Constituent,
    ExponentialProfile,
    Gas,
    Ground,
    Planet,
    Profile,
    Star,
    TabulatedProfile,
    TentProfile,
)
from skybake.preset.optics_model import (
    CornetteShanksPhase,
    DoubleHenyeyGreensteinPhase,
    HenyeyGreensteinPhase,
    Phase,
    PolarisationTable,
    RayleighPhase,
    Spectrum,
    TabulatedPhase,
)
from skybake.preset.template import preset_template, resolved_text

__all__ = [
    "CLOUD_KINDS",
    "Absorber",
    "Aerosol",
    "CloudLayer",
    "Coefficients",
    "Constituent",
    "CornetteShanksPhase",
    "DoubleHenyeyGreensteinPhase",
    "ExponentialProfile",
    "Gas",
    "Ground",
    "HenyeyGreensteinPhase",
    "Override",
    "Overrides",
    "Phase",
    "Planet",
    "PolarisationTable",
    "Profile",
    "RayleighPhase",
    "Spectrum",
    "Star",
    "TabulatedPhase",
    "TabulatedProfile",
    "TentProfile",
    "Tile",
    "load_document",
    "load_preset",
    "planet_name",
    "preset_names",
    "preset_template",
    "preset_text",
    "resolved_text",
]
