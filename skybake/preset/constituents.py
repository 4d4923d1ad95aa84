"""Sections of a preset that describe what the atmosphere is made of."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

from skybake.constants import DOBSON_UNIT
from skybake.preset.model import (
    Absorber,
    Aerosol,
    Coefficients,
    Constituent,
    ExponentialProfile,
    Gas,
    Profile,
    TabulatedProfile,
    TentProfile,
)
from skybake.preset.optics_model import HenyeyGreensteinPhase, Phase, Spectrum
from skybake.preset.phases import read_phase
from skybake.preset.section import Gather, Section

GASES = ("dry_air", "co2", "n2", "ar", "ch4", "h2", "he")
"""Gases whose refractive index skybake knows."""

PROFILES = ("exponential", "tent", "tabulated")


class Top(NamedTuple):
    """Top of the atmosphere [km], and where it was written, for messages."""

    altitude: float
    where: str


def read_constituent(name: str, section: Section, top: Top | None) -> Constituent:
    """Read ``[constituents.name]``.

    Parameters
    ----------
    name : str
        Its key.
    section : Section
        Its table.
    top : Top or None
        Altitude that a tabulated profile must reach; None if that is faulty itself.

    Raises
    ------
    PresetError
        With each key and the rule that it breaks.
    """
    return _READERS[section.choice("kind", tuple(_READERS))](name, section, top)


def _read_gas(name: str, section: Section, top: Top | None) -> Gas:
    read = Gather(section)
    profile = read(_read_gas_profile, section, name, top)
    pressure = read(section.number, "pressure_pa", 0.0, 1e9)
    temperature = read(section.number, "temperature_k", 1.0, 1e5)
    composition = read(_read_composition, section)
    read.finish()
    return Gas(name, profile, pressure, temperature, composition)


def _read_gas_profile(section: Section, column: str, top: Top | None) -> Profile:
    profile = _read_profile(section, column, top)
    if isinstance(profile, TabulatedProfile):
        # Pressure and temperature are those of the ground.
        if profile.density[0] == 0.0:
            section.fail("profile", "must have gas at the ground")
        profile = _relative(profile, profile.density[0])
    return profile


def _read_composition(section: Section) -> tuple[tuple[str, float], ...]:
    fractions = section.section("composition")
    read = Gather(fractions)
    composition = tuple(
        (gas, read(fractions.number, gas, 0.0, 1.0)) for gas in GASES if fractions.has(gas)
    )
    read.finish()
    total = sum(fraction for _, fraction in composition)
    if not math.isclose(total, 1.0, abs_tol=0.01):
        section.fail("composition", f"mole fractions must add up to 1 within 0.01, got {total:g}")
    return composition


def _read_absorber(name: str, section: Section, top: Top | None) -> Absorber:
    read = Gather(section)
    profile = read(_read_shape, section, name, top)
    column = read(section.number, "column_du", 0.0, 1e6)
    cross_section = read(section.spectrum, "cross_section_m2", 0.0, 1e-15)
    read.finish()
    return Absorber(name, profile, column * DOBSON_UNIT, cross_section)


def _read_aerosol(name: str, section: Section, top: Top | None) -> Aerosol:
    read = Gather(section)
    profile = read(_read_shape, section, name, top)
    optical_depth = read(section.number, "optical_depth", 0.0, 1e3)
    wavelength = read(section.number, "optical_depth_wavelength_nm", 100.0, 1e5, default=550.0)
    spectrum = read(_read_extinction_spectrum, section, wavelength)
    albedo = read(section.spectrum, "single_scattering_albedo", 0.0, 1.0)
    phase = read(lambda: read_phase(section.section("phase")))
    read.finish()
    return Aerosol(name, profile, optical_depth, wavelength, spectrum, albedo, phase)


def _read_extinction_spectrum(section: Section, wavelength: float | None) -> Spectrum | float:
    tabulated = section.has("relative_extinction")
    if tabulated == section.has("angstrom_exponent"):
        section.fail("", "must give either relative_extinction or angstrom_exponent")
    if not tabulated:
        return section.number("angstrom_exponent", -5.0, 5.0)
    spectrum = section.spectrum("relative_extinction", 1e-9, 1e9)
    nodes = spectrum.wavelength
    if nodes and wavelength and not nodes[0] <= wavelength <= nodes[-1]:
        section.fail(
            "optical_depth_wavelength_nm",
            f"must be within relative_extinction's {nodes[0]:g} to {nodes[-1]:g} nm, "
            f"got {wavelength:g}",
        )
    return spectrum


def _read_coefficients(name: str, section: Section, top: Top | None) -> Coefficients:
    read = Gather(section)
    profile = read(_read_profile, section, name, top)
    scattering = read(section.spectrum, "scattering_per_km", 0.0, 1e4, default=0.0)
    absorption = read(section.spectrum, "absorption_per_km", 0.0, 1e4, default=0.0)
    phase = read(_read_phase_if_due, section, scattering)
    read.finish()
    return Coefficients(name, profile, scattering, absorption, phase)


def _read_phase_if_due(section: Section, scattering: Spectrum | None) -> Phase:
    if section.has("phase") or (scattering and any(scattering.values)):
        return read_phase(section.section("phase"))
    return HenyeyGreensteinPhase(Spectrum(section.where("phase"), (), (0.0,)))


_READERS: dict[str, Callable[[str, Section, Top | None], Constituent]] = {
    "gas": _read_gas,
    "absorber": _read_absorber,
    "aerosol": _read_aerosol,
    "coefficients": _read_coefficients,
}


def _read_profile(section: Section, column: str, top: Top | None) -> Profile:
    if isinstance(section.raw("profile"), str):
        altitude, density = section.columns("profile", "altitude_km", column)
        return _checked_profile(section, altitude, density, top)
    inner = section.section("profile")
    kind = inner.choice("kind", PROFILES)
    read = Gather(inner)
    if kind == "exponential":
        scale_height = read(inner.number, "scale_height_km", 1e-3, 1e5)
        read.finish()
        return ExponentialProfile(scale_height)
    if kind == "tent":
        center = read(inner.number, "center_km", 0.0, 1e6 if top is None else top.altitude)
        half_width = read(inner.number, "half_width_km", 1e-3, 1e5)
        read.finish()
        return TentProfile(center, half_width)
    altitude = read(inner.numbers, "altitude_km", 0.0, 1e6)
    density = read(inner.numbers, "density", 0.0, 1e35)
    read.finish()
    return _checked_profile(section, altitude, density, top)


def _checked_profile(
    section: Section, altitude: tuple[float, ...], density: tuple[float, ...], top: Top | None
) -> TabulatedProfile:
    if len(altitude) != len(density) or len(altitude) < 2:
        section.fail("profile", "altitude_km and density must have the same length, at least 2")
    if any(a >= b for a, b in pairwise(altitude)):
        section.fail("profile", "altitudes must ascend")
    if min(density) < 0.0 or max(density) == 0.0:
        section.fail("profile", "densities must be at least 0 and not all 0")
    starts_late = altitude[0] > 0.0 and density[0] > 0.0
    span = f"got {altitude[0]:g} to {altitude[-1]:g} km"
    if top is not None and altitude[-1] < top.altitude and density[-1] > 0.0:
        section.fail(
            "profile",
            f"must cover 0 to {top.altitude:g} km or end in density 0, {span} (see {top.where})",
        )
    if starts_late:
        section.fail("profile", f"must begin at 0 km or with density 0, {span}")
    return TabulatedProfile(altitude, density)


def _read_shape(section: Section, column: str, top: Top | None) -> Profile:
    """Profile of which only the shape counts, with a maximum of about 1."""
    profile = _read_profile(section, column, top)
    if isinstance(profile, TabulatedProfile):
        return _relative(profile, max(profile.density))
    return profile


def _relative(profile: TabulatedProfile, unit: float) -> TabulatedProfile:
    return TabulatedProfile(profile.altitude, tuple(n / unit for n in profile.density))
