"""Sections of a preset that describe what the atmosphere is made of."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

from skybake.constants import DOBSON_UNIT
from skybake.preset.model import (
    Absorber,
    Aerosol,
    Coefficients,
    Constituent,
    CornetteShanksPhase,
    DoubleHenyeyGreensteinPhase,
    ExponentialProfile,
    Gas,
    HenyeyGreensteinPhase,
    Phase,
    Profile,
    RayleighPhase,
    Spectrum,
    TabulatedPhase,
    TabulatedProfile,
    TentProfile,
)
from skybake.preset.section import Section

GASES = ("dry_air", "co2", "n2", "ar", "ch4", "h2", "he")
"""Gases whose refractive index skybake knows."""

PROFILES = ("exponential", "tent", "tabulated")
PHASES = (
    "rayleigh",
    "henyey-greenstein",
    "cornette-shanks",
    "double-henyey-greenstein",
    "tabulated",
)

MAX_ASYMMETRY = 0.99
"""Beyond it the forward peak is narrower than the tables' finest steps."""


def read_constituent(name: str, section: Section, top: float) -> Constituent:
    """Read ``[constituents.name]``.

    Parameters
    ----------
    name : str
        Its key.
    section : Section
        Its table.
    top : float
        Altitude that a tabulated profile must reach. [km]

    Raises
    ------
    PresetError
        With the key and the rule that it breaks.
    """
    kind = section.choice("kind", tuple(_READERS))
    constituent = _READERS[kind](name, section, top)
    section.finish()
    return constituent


def _read_gas(name: str, section: Section, top: float) -> Gas:
    fractions = section.section("composition")
    composition = tuple(
        (gas, fractions.number(gas, 0.0, 1.0)) for gas in GASES if fractions.has(gas)
    )
    fractions.finish()
    total = sum(fraction for _, fraction in composition)
    if not math.isclose(total, 1.0, abs_tol=0.01):
        section.fail("composition", f"mole fractions must add up to 1 within 0.01, got {total:g}")
    profile = _read_profile(section, name, top)
    if isinstance(profile, TabulatedProfile):
        # Pressure and temperature are those of the ground.
        if profile.density[0] == 0.0:
            section.fail("profile", "must have gas at the ground")
        profile = _relative(profile, profile.density[0])
    return Gas(
        name=name,
        profile=profile,
        pressure=section.number("pressure_pa", 0.0, 1e9),
        temperature=section.number("temperature_k", 1.0, 1e5),
        composition=composition,
    )


def _read_absorber(name: str, section: Section, top: float) -> Absorber:
    return Absorber(
        name=name,
        profile=_read_shape(section, name, top),
        column=section.number("column_du", 0.0, 1e6) * DOBSON_UNIT,
        cross_section=section.spectrum("cross_section_m2", 0.0, 1e-15),
    )


def _read_aerosol(name: str, section: Section, top: float) -> Aerosol:
    tabulated = section.has("relative_extinction")
    if tabulated == section.has("angstrom_exponent"):
        section.fail("", "must give either relative_extinction or angstrom_exponent")
    return Aerosol(
        name=name,
        profile=_read_shape(section, name, top),
        optical_depth=section.number("optical_depth", 0.0, 1e3),
        optical_depth_wavelength=section.number("optical_depth_wavelength_nm", 100.0, 1e5),
        extinction_spectrum=(
            section.spectrum("relative_extinction", 1e-9, 1e9)
            if tabulated
            else section.number("angstrom_exponent", -5.0, 5.0)
        ),
        single_scattering_albedo=section.spectrum("single_scattering_albedo", 0.0, 1.0),
        phase=_read_phase(section.section("phase")),
    )


def _read_coefficients(name: str, section: Section, top: float) -> Coefficients:
    scattering = section.spectrum("scattering_per_km", 0.0, 1e4, default=0.0)
    absorption = section.spectrum("absorption_per_km", 0.0, 1e4, default=0.0)
    phase: Phase
    if any(scattering.values) or section.has("phase"):
        phase = _read_phase(section.section("phase"))
    else:
        phase = HenyeyGreensteinPhase(Spectrum(section.where("phase"), (), (0.0,)))
    return Coefficients(name, _read_profile(section, name, top), scattering, absorption, phase)


_READERS: dict[str, Callable[[str, Section, float], Constituent]] = {
    "gas": _read_gas,
    "absorber": _read_absorber,
    "aerosol": _read_aerosol,
    "coefficients": _read_coefficients,
}


def _read_profile(section: Section, column: str, top: float) -> Profile:
    if isinstance(section.raw("profile"), str):
        altitude, density = section.columns("profile", "altitude_km", column)
    else:
        inner = section.section("profile")
        kind = inner.choice("kind", PROFILES)
        if kind == "exponential":
            exponential = ExponentialProfile(inner.number("scale_height_km", 1e-3, 1e5))
            inner.finish()
            return exponential
        if kind == "tent":
            tent = TentProfile(
                inner.number("center_km", 0.0, top), inner.number("half_width_km", 1e-3, 1e5)
            )
            inner.finish()
            return tent
        altitude = inner.numbers("altitude_km", 0.0, 1e6)
        density = inner.numbers("density", 0.0, 1e35)
        inner.finish()
    if len(altitude) != len(density) or len(altitude) < 2:
        section.fail("profile", "altitude_km and density must be equally many, at least 2")
    if any(a >= b for a, b in pairwise(altitude)):
        section.fail("profile", "altitudes must ascend")
    if min(density) < 0.0 or max(density) == 0.0:
        section.fail("profile", "densities must be at least 0 and not all 0")
    starts_late = altitude[0] > 0.0 and density[0] > 0.0
    if starts_late or (altitude[-1] < top and density[-1] > 0.0):
        section.fail(
            "profile",
            f"must cover 0 to {top:g} km or end in density 0, "
            f"got {altitude[0]:g} to {altitude[-1]:g} km",
        )
    return TabulatedProfile(altitude, density)


def _read_shape(section: Section, column: str, top: float) -> Profile:
    """Profile of which only the shape counts, with a maximum of about 1."""
    profile = _read_profile(section, column, top)
    if isinstance(profile, TabulatedProfile):
        return _relative(profile, max(profile.density))
    return profile


def _relative(profile: TabulatedProfile, unit: float) -> TabulatedProfile:
    return TabulatedProfile(profile.altitude, tuple(n / unit for n in profile.density))


def _read_phase(section: Section) -> Phase:
    kind = section.choice("kind", PHASES)
    phase: Phase
    if kind == "rayleigh":
        # 1/2 belongs to a molecule that can be polarised along one axis only.
        phase = RayleighPhase(section.spectrum("depolarisation", 0.0, 0.5, default=0.0))
    elif kind == "henyey-greenstein":
        phase = HenyeyGreensteinPhase(_read_asymmetry(section, "asymmetry"))
    elif kind == "cornette-shanks":
        phase = CornetteShanksPhase(_read_asymmetry(section, "asymmetry"))
    elif kind == "double-henyey-greenstein":
        phase = DoubleHenyeyGreensteinPhase(
            _read_asymmetry(section, "first_asymmetry"),
            _read_asymmetry(section, "second_asymmetry"),
            section.spectrum("first_fraction", 0.0, 1.0),
        )
    else:
        phase = _read_tabulated_phase(section)
    section.finish()
    return phase


def _read_asymmetry(section: Section, key: str) -> Spectrum:
    return section.spectrum(key, -MAX_ASYMMETRY, MAX_ASYMMETRY)


def _read_tabulated_phase(section: Section) -> TabulatedPhase:
    columns = section.table("table", "angle_deg")
    angle = columns.get("angle_deg", ())
    if not angle or angle[0] != 0.0 or angle[-1] != 180.0:
        section.fail("table", "column angle_deg must run from 0 to 180")
    if any(a >= b for a, b in pairwise(angle)):
        section.fail("table", "angle_deg must ascend")
    bands = sorted(
        (_wavelength_of_column(section, key), values)
        for key, values in columns.items()
        if key != "angle_deg"
    )
    if not bands:
        section.fail("table", "must have a column of values beside angle_deg")
    if len({wavelength for wavelength, _ in bands}) < len(bands):
        section.fail("table", "wavelengths must differ from each other")
    if any(min(values) <= 0.0 for _, values in bands):
        section.fail("table", "values must be greater than 0")
    return TabulatedPhase(
        section.where("table"),
        tuple(math.radians(a) for a in angle),
        tuple(wavelength for wavelength, _ in bands) if len(bands) > 1 else (),
        tuple(values for _, values in bands),
    )


def _wavelength_of_column(section: Section, column: str) -> float:
    try:
        wavelength = float(column)
    except ValueError:
        wavelength = math.nan
    if not 1.0 <= wavelength <= 1e6:
        section.fail("table", f"columns must be named by their wavelength in nm, got {column!r}")
    return wavelength
