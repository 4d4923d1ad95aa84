"""Spectra and phase functions, as a preset describes them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Spectrum:
    """A quantity against wavelength, linear between its nodes.

    Attributes
    ----------
    where : str
        Where the preset gives it, for messages.
    wavelength : tuple of float
        Nodes, strictly ascending [nm]; empty if one value holds everywhere.
    values : tuple of float
        Values at the nodes, or the one value.
    """

    where: str
    wavelength: tuple[float, ...]
    values: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class RayleighPhase:
    """Scattering by anisotropic molecules with this depolarisation ratio of natural light."""

    depolarisation: Spectrum


@dataclass(frozen=True, slots=True)
class HenyeyGreensteinPhase:
    """Henyey & Greenstein (1941) with this mean cosine."""

    asymmetry: Spectrum


@dataclass(frozen=True, slots=True)
class CornetteShanksPhase:
    """Cornette & Shanks (1992); its parameter is slightly less than the mean cosine."""

    asymmetry: Spectrum


@dataclass(frozen=True, slots=True)
class DoubleHenyeyGreensteinPhase:
    """Two Henyey-Greenstein lobes, the first with weight `first_fraction`."""

    first_asymmetry: Spectrum
    second_asymmetry: Spectrum
    first_fraction: Spectrum


@dataclass(frozen=True)
class PolarisationTable:
    """Elements of a scattering matrix over P11, linear over scattering angle and wavelength.

    Attributes
    ----------
    where : str
        Where the preset names it, for messages.
    angle : tuple of float
        Scattering angles, ascending from 0 to pi. [rad]
    wavelength : tuple of float
        Strictly ascending. [nm]
    p12, p33 : tuple of tuple of float
        One tuple a wavelength, one value an angle, from -1 to 1. P12 below 0 polarises across the
        plane of scattering.
    """

    where: str
    angle: tuple[float, ...]
    wavelength: tuple[float, ...]
    p12: tuple[tuple[float, ...], ...]
    p33: tuple[tuple[float, ...], ...]


@dataclass(frozen=True, slots=True)
class TabulatedPhase:
    """A table over scattering angle, interpolated in the logarithm, and over wavelength.

    Attributes
    ----------
    where : str
        Where the preset names it, for messages.
    angle : tuple of float
        Scattering angles, ascending from 0 to pi. [rad]
    wavelength : tuple of float
        Strictly ascending [nm]; empty if the one column holds everywhere.
    values : tuple of tuple of float
        One tuple a wavelength, one value an angle, all positive. [sr⁻¹]
    polarisation : PolarisationTable or None
        How the light is polarised; None if that is not known.
    """

    where: str
    angle: tuple[float, ...]
    wavelength: tuple[float, ...]
    values: tuple[tuple[float, ...], ...]
    polarisation: PolarisationTable | None = None


Phase = (
    RayleighPhase
    | HenyeyGreensteinPhase
    | CornetteShanksPhase
    | DoubleHenyeyGreensteinPhase
    | TabulatedPhase
)
