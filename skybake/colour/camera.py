"""What a camera's sensor makes of a spectrum."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from skybake.colour.observer import LUMINOUS_EFFICACY, folding_weights, load_observer
from skybake.errors import InputError
from skybake.input_files import LARGEST_TABLE, read_text

Array = npt.NDArray[np.float64]

CAMERA_WHITES = ("d65", "none")
COLUMNS = ("wavelength_nm", "R", "G", "B")

COVERED = (400.0, 700.0)
"""Wavelengths that a table of a response must cover at least. [nm]"""

BEYOND = 10.0
"""How far beyond a map's wavelengths its light may be taken as at their ends. [nm]"""

LOST = 0.01
"""Share of a channel's response to daylight that may be further beyond."""

_LARGEST = 1e30
_D65 = Path(__file__).parents[1] / "data" / "cie_d65.csv"


@dataclass(frozen=True)
class CameraResponse:
    """How the three channels of a camera respond to light of each wavelength.

    Attributes
    ----------
    name : str
        Of the file that it was read from.
    wavelengths : tuple of float
        Ascending; beyond them the camera sees nothing. [nm]
    values : tuple of tuple of float
        Response of R, G and B at each, to radiant power, in a unit of its own; linear between.
    white : {"d65", "none"}
        Whether channels are scaled such that the light of D65 has equal values in all, or keep
        their ratios.
    digest : str
        SHA-256 of the file's text.
    """

    name: str
    wavelengths: tuple[float, ...]
    values: tuple[tuple[float, float, float], ...]
    white: str = "d65"
    digest: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        """Refuse a white that is not known."""
        if self.white not in CAMERA_WHITES:
            raise InputError(
                f"camera white: must be one of {', '.join(CAMERA_WHITES)}, got {self.white!r}"
            )

    def weights(self, wavelengths: Array, star_wavelengths: Array, star_irradiance: Array) -> Array:
        """Weights that fold radiance per unit of the star's light into the camera's channels.

        Parameters
        ----------
        wavelengths, star_wavelengths, star_irradiance
            As of `skybake.colour.observer.xyz_weights`.

        Returns
        -------
        ndarray of float64, shape (wavelength, 3)
            Values are such that the light of D65 has its luminance in the green channel, and in
            the others too unless `white` is none. [cd m⁻²]

        Raises
        ------
        InputError
            If more than `LOST` of a channel's response is beyond the wavelengths.
        """
        nodes, _ = load_observer()
        seen = load_d65()[:, None] * self.curves
        is_beyond = (nodes < wavelengths[0] - BEYOND) | (nodes > wavelengths[-1] + BEYOND)
        lost = seen[is_beyond].sum(axis=0) / seen.sum(axis=0)
        if lost.max() > LOST:
            raise InputError(
                f"camera {self.name}: response must lie within the map's wavelengths, "
                f"{wavelengths[0]:g} to {wavelengths[-1]:g} nm, got {lost.max():.0%} of "
                f"{'RGB'[int(lost.argmax())]} beyond"
            )
        return folding_weights(
            wavelengths, star_wavelengths, star_irradiance, self.scaled_curves, 1.0
        )

    @property
    def text(self) -> str:
        """Its name and its digest, as files state them."""
        return f"{self.name} sha256:{self.digest}" if self.digest else self.name

    @cached_property
    def curves(self) -> Array:
        """Response at the observer's wavelengths, shape (471, 3)."""
        nodes, _ = load_observer()
        own, values = np.array(self.wavelengths), np.array(self.values)
        return np.stack(
            [np.interp(nodes, own, each, left=0.0, right=0.0) for each in values.T], axis=1
        )

    @property
    def scaled_curves(self) -> Array:
        """As `curves`, in the scale of `weights`. [lm W⁻¹]"""
        return self.curves * self._gains

    @property
    def _gains(self) -> Array:
        """Factors by which the light of D65 has its luminance in a channel. [lm W⁻¹]"""
        light, (_, xyz_bar) = load_d65(), load_observer()
        luminance = LUMINOUS_EFFICACY * float(light @ xyz_bar[:, 1])
        seen: Array = light @ self.curves
        gains: Array = luminance / (seen if self.white == "d65" else np.full(3, seen[1]))
        return gains


@cache
def load_d65() -> Array:
    """Relative power of the standard illuminant D65 at the observer's wavelengths, shape (471,)."""
    lines = _D65.read_text(encoding="utf-8").splitlines()
    table = np.array([line.split(",") for line in lines[3:]], dtype=np.float64)
    nodes, _ = load_observer()
    power: Array = np.interp(nodes, table[:, 0], table[:, 1])
    power.flags.writeable = False
    return power


def load_camera(path: Path, white: str = "d65") -> CameraResponse:
    """Read a camera's response.

    Parameters
    ----------
    path : Path
        CSV with the columns wavelength_nm, R, G and B; lines that begin with # are remarks.
    white : {"d65", "none"}, optional
        As of `CameraResponse`.

    Raises
    ------
    InputError
        If the file cannot be read, is no such table, or does not cover `COVERED`.
    """
    where = str(path)
    text = read_text(path, where, LARGEST_TABLE)
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    header = tuple(cell.strip() for cell in lines[0].split(",")) if lines else ()
    if header != COLUMNS:
        raise InputError(
            f"{where}: columns must be {','.join(COLUMNS)}, got {','.join(header)[:80]!r}"
        )
    rows = [_row(where, line) for line in lines[1:]]
    if len(rows) < 2:
        raise InputError(f"{where}: must have at least 2 wavelengths, got {len(rows)}")
    table = np.array(rows)
    nodes, values = table[:, 0], table[:, 1:]
    late = nodes[1:][np.diff(nodes) <= 0.0]
    if late.size:
        raise InputError(f"{where}: wavelengths must ascend, got {late[0]:g} nm after more")
    first, last = COVERED
    if nodes[0] > first or nodes[-1] < last:
        raise InputError(
            f"{where}: must cover {first:g} to {last:g} nm, got {nodes[0]:g} to {nodes[-1]:g} nm"
        )
    response = CameraResponse(
        name=path.name,
        wavelengths=tuple(nodes.tolist()),
        values=tuple((r, g, b) for r, g, b in values.tolist()),
        white=white,
        digest=hashlib.sha256(text.encode()).hexdigest(),
    )
    _check_channels(where, response)
    return response


def _row(where: str, line: str) -> list[float]:
    try:
        numbers = [float(cell) for cell in line.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != len(COLUMNS) or not all(abs(each) < _LARGEST for each in numbers):
        raise InputError(f"{where}: a row must be four finite numbers, got {line[:60]!r}")
    if not numbers[0] > 0.0:
        raise InputError(f"{where}: a wavelength must be greater than 0 nm, got {numbers[0]:g} nm")
    return numbers


def _check_channels(where: str, response: CameraResponse) -> None:
    for name, channel, seen in zip(
        COLUMNS[1:], zip(*response.values, strict=True), response.curves.sum(axis=0), strict=True
    ):
        if min(channel) < 0.0 or not seen > 0.0:
            raise InputError(
                f"{where}: {name} must be at least 0, and greater where light is seen, got "
                f"{min(channel):g} to {max(channel):g}"
            )
