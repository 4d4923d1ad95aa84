"""Planets from TOML: where presets are, what they may contain, and every check of it."""

from skybake.preset.extend import Override, Overrides, load_document, planet_name
from skybake.preset.find import preset_names, preset_text
from skybake.preset.load import load_preset
from skybake.preset.model import (
    Absorber,
    Aerosol,
    Coefficients,
    Constituent,
    CornetteShanksPhase,
    DoubleHenyeyGreensteinPhase,
    ExponentialProfile,
    Gas,
    Ground,
    HenyeyGreensteinPhase,
    Phase,
    Planet,
    Profile,
    RayleighPhase,
    Spectrum,
    Star,
    TabulatedPhase,
    TabulatedProfile,
    TentProfile,
)
from skybake.preset.template import preset_template, resolved_text

__all__ = [
    "Absorber",
    "Aerosol",
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
    "Profile",
    "RayleighPhase",
    "Spectrum",
    "Star",
    "TabulatedPhase",
    "TabulatedProfile",
    "TentProfile",
    "load_document",
    "load_preset",
    "planet_name",
    "preset_names",
    "preset_template",
    "preset_text",
    "resolved_text",
]
