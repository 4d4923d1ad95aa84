"""The layout of spectral images in OpenEXR files.

Fichet, Pacanowski & Wilkie (2021), "An OpenEXR Layout for Spectral Images", Journal of Computer
Graphics Techniques 10(3). A channel is named by the Stokes component and the wavelength with a
decimal comma, since a dot divides layers; R, G and B beside them are for programs that read no
spectra.
"""

from __future__ import annotations

import re

from skybake.formats.spec import Attribute

LAYOUT_VERSION = "1.0"

SPECTRAL_UNITS = "skybake:spectralUnits"

_NAME = re.compile(r"S([0-3])\.(\d+(?:,\d*)?)nm")


def stokes_channel(component: int, wavelength: float) -> str:
    """Name of the channel of a Stokes component, 0 to 3, at a wavelength [nm]."""
    whole, _, decimals = f"{wavelength:.4f}".rstrip("0").partition(".")
    return f"S{component}.{whole},{decimals or '0'}nm"


def read_stokes_channel(name: str) -> tuple[int, float] | None:
    """Stokes component and wavelength [nm] of a channel; None of one that is no spectrum's."""
    found = _NAME.fullmatch(name)
    if found is None:
        return None
    return int(found[1]), float(found[2].replace(",", "."))


def spectral_attributes(*, is_polarised: bool) -> dict[str, Attribute]:
    """Attributes that the layout asks for.

    Its only unit of radiance names no nanometre, so that the one of the values, W m⁻² sr⁻¹ nm⁻¹,
    is stated beside it.
    """
    return {
        "spectralLayoutVersion": LAYOUT_VERSION,
        "emissiveUnits": "W.m^-2.sr^-1",
        SPECTRAL_UNITS: "W.m^-2.sr^-1.nm^-1",
        **({"polarisationHandedness": "right"} if is_polarised else {}),
    }
