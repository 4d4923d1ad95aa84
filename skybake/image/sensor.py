"""What of the light a map records besides what an eye sees, or instead of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from skybake.colour.camera import CameraResponse
from skybake.errors import InputError
from skybake.optics.medium import Array
from skybake.units import degrees

DEFAULT_WAVELENGTHS = tuple(float(each) for each in range(400, 701, 10))
"""Wavelengths of a spectral map. [nm]"""

MOST_WAVELENGTHS = 512
MOST_AT_ONCE = 48
"""Wavelengths that are solved for together."""

LONGEST = 1e6
"""[nm]"""

CLOSEST = 0.01
"""Least distance of wavelengths. [nm]"""

_VISIBLE = (400.0, 700.0)
_COARSEST = 25.0


@dataclass(frozen=True)
class Sensor:
    """What a map records of the light.

    Attributes
    ----------
    wavelengths : tuple of float or None
        Ascending: the map holds the radiance at each in a channel of its own, see
        `skybake.formats.spectral_exr`. [nm]
    response : CameraResponse or None
        Camera whose channels R, G and B are instead of an eye's.
    stokes : bool
        Hold the Stokes components S0 to S3 of all channels.
    polarizer : float or None
        Of a linear polarising filter before the map: angle of its axis from the vertical,
        counter-clockwise as seen along the view. [rad]

    Raises
    ------
    InputError
        If wavelengths are none, too many, too close, or not ascending, or if a filter is combined
        with Stokes components, of which it leaves none.
    """

    wavelengths: tuple[float, ...] | None = None
    response: CameraResponse | None = None
    stokes: bool = False
    polarizer: float | None = None

    def __post_init__(self) -> None:
        """Refuse what no file can hold."""
        if self.wavelengths is not None:
            _check_wavelengths(self.wavelengths)
        if self.polarizer is None:
            return
        if not math.isfinite(self.polarizer):
            raise InputError(f"polarizer: must be finite, got {self.polarizer}")
        if self.stokes:
            raise InputError("polarizer: must be without stokes, since it passes one component")

    @property
    def is_eye(self) -> bool:
        """Whether the map holds what an eye sees, and nothing else."""
        return self.wavelengths is None and self.response is None and not self.is_polarised

    @property
    def is_polarised(self) -> bool:
        """Whether the map depends on the light's polarisation."""
        return self.stokes or self.polarizer is not None

    def groups(self) -> list[Array]:
        """Return the wavelengths in groups that are solved for together, of nearly equal sizes."""
        wavelengths = np.array(self.wavelengths or (), dtype=float)
        count = -(-wavelengths.size // MOST_AT_ONCE)
        return [] if count == 0 else np.array_split(wavelengths, count)

    def colour_wavelengths(self) -> Array | None:
        """Return the wavelengths that colours are made of too; None for the usual ones.

        They are those of the spectrum where one solution has all of them and they sample what
        an eye sees.
        """
        groups = self.groups()
        if len(groups) != 1:
            return None
        (wavelengths,) = groups
        visible = np.array(_VISIBLE)
        seen = wavelengths[(wavelengths >= visible[0]) & (wavelengths <= visible[1])]
        gaps = np.diff(np.concatenate([visible[:1], seen, visible[1:]]))
        covers = wavelengths[0] <= visible[0] and wavelengths[-1] >= visible[1]
        return wavelengths if covers and gaps.max() <= _COARSEST else None

    def recipe(self) -> dict[str, Any]:
        """All that decides the pixels, in human-readable units, fit for JSON."""
        camera = self.response
        return {
            **({} if self.wavelengths is None else {"wavelengths_nm": _short(self.wavelengths)}),
            **({} if camera is None else {"camera": camera.text, "camera_white": camera.white}),
            **({"stokes": True} if self.stokes else {}),
            **({} if self.polarizer is None else {"polarizer_deg": degrees(self.polarizer)}),
        }


def _short(wavelengths: tuple[float, ...]) -> list[float] | str:
    """Return wavelengths as first:last:step where they are even, else as they are."""
    steps = np.diff(wavelengths)
    if len(wavelengths) > 2 and np.allclose(steps, steps[0], rtol=0.0, atol=1e-6):
        return f"{wavelengths[0]:g}:{wavelengths[-1]:g}:{steps[0]:g}"
    return list(wavelengths)


def _check_wavelengths(wavelengths: tuple[float, ...]) -> None:
    if not 1 <= len(wavelengths) <= MOST_WAVELENGTHS:
        raise InputError(
            f"spectral: must be 1 to {MOST_WAVELENGTHS} wavelengths, got {len(wavelengths)}"
        )
    for number in wavelengths:
        if not 0.0 < number < LONGEST:
            raise InputError(
                f"spectral: a wavelength must be greater than 0 and less than {LONGEST:g} nm, "
                f"got {number:g} nm"
            )
    for below, above in pairwise(wavelengths):
        if not above - below >= CLOSEST:
            raise InputError(
                f"spectral: wavelengths must ascend by at least {CLOSEST:g} nm, got {above:g} nm "
                f"after {below:g} nm"
            )
