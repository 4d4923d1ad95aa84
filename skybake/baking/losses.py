"""What a user should know of a map that was baked: what its file loses, or that it is black."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from skybake.errors import OutputError
from skybake.image.scene import Scene
from skybake.sky.closure import closure_warning

HALF_MOST = 65504.0
"""Largest half float, and what programs make of all that is larger."""

COARSE = 0.01
"""Relative error of a value beyond which it counts as lost."""

_SMALLEST = {"half": 2.0**-24, "rgb9e5": 2.0**-24, "r11g11b10": 2.0**-20}
_NAMES = {"half": "half floats", "rgb9e5": "shared exponents", "r11g11b10": "small floats"}

_WARNED_SHARE, _MOST_SHARE = 1e-3, 0.5

_RADIANCE = (
    f"values beyond {HALF_MOST:g} are lost in programs that hold a .hdr in half floats, such as "
    "three.js; let 1.0 stand for more light, as --units ev15 does, draw the sun's disc soft, or "
    "leave it out"
)


class HalfLoss:
    """Counts values that half floats, or smaller ones, hold badly, as they are written.

    Parameters
    ----------
    pixel : str
        Type of the values: half, or one of those of 32 bits for three colours.

    Attributes
    ----------
    lit, coarse, zero : int
        Values other than 0; those of them whose error in half is above `COARSE`, and those
        that become 0.
    largest : float
        Of all magnitudes.
    """

    def __init__(self, pixel: str = "half") -> None:
        self._name = _NAMES[pixel]
        # Below their normal values all types have steps of one size.
        self._zero = 0.5 * _SMALLEST[pixel]
        self._dim = self._zero / COARSE
        self.lit = self.coarse = self.zero = 0
        self.largest = 0.0

    def add(self, rows: npt.NDArray[np.float32]) -> None:
        """Count the values of a band of rows."""
        magnitude = np.abs(rows)
        self.largest = max(self.largest, float(magnitude.max(initial=0.0)))
        self.lit += int(np.count_nonzero(magnitude))
        dim = magnitude[magnitude < self._dim]
        self.coarse += int(np.count_nonzero(dim))
        self.zero += int(np.count_nonzero(dim[dim <= self._zero]))

    def warning(self, path: Path) -> str | None:
        """Say what is lost of a file, or return None if that is little.

        A Radiance picture holds all, but programs that read it may not.

        Raises
        ------
        OutputError
            If more than half of the values are.
        """
        if path.suffix.lower() == ".hdr":
            return _RADIANCE if self.largest > HALF_MOST else None
        share = self.coarse / max(self.lit, 1)
        if share > _MOST_SHARE:
            raise OutputError(
                f"{path}: {self._name} must hold most values within {COARSE:.0%}, got {share:.0%} "
                f"beyond and {self.zero / self.lit:.0%} as 0; use float, or let 1.0 stand for less "
                "light"
            )
        if share <= _WARNED_SHARE:
            return None
        return (
            f"{self._name} hold the darkest values with errors above {COARSE:.0%}; use float, or "
            "let 1.0 stand for less light"
        )


def scene_warnings(scene: Scene, peak: float) -> list[str]:
    """Return what is known of a map before it is written.

    Parameters
    ----------
    scene : Scene
        What it shows.
    peak : float
        Of the sun's disc and of stars.
    """
    found = []
    if scene.sky.method == "hillaire":
        found.append(closure_warning(scene.sky.medium))
    if scene.layer_names == ("sun",) and peak == 0.0:
        found.append(
            "the map is black: no light of the sun's disc, the only thing in it, arrives here"
        )
    if scene.layer_names == ("stars",) and peak == 0.0:
        found.append("the map is black: no star, of which alone it consists, is seen from here")
    return [one for one in found if one is not None]
