"""Where in a table a value is: the way from a place in the air to texture coordinates and back."""

from __future__ import annotations

from collections.abc import Mapping as Values
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from skybake.luts.formula import evaluate
from skybake.optics.medium import Array

PLACEMENTS = {
    "centres": "texel i of N at (i + 0.5) / N",
    "ends": "texel i of N at i / (N - 1): the first at 0, the last at 1",
    "halves": "each half of N texels by itself, its first at its begin and its last at its end",
}
"""Which of the shares 0 to 1 along an axis texels hold, by name."""

_LOOKUPS = {
    "centres": "{texture} = {share}",
    "ends": "{texture} = 0.5 / {size} + {share} * (1 - 1 / {size})",
    "halves": "{texture} = 0.5 / {size} + {share} * (1 - 2 / {size}) + "
    "(0 if {share} < 0.5 else 1 / {size})",
}
_SHARES, _TEXTURES = ("x", "y", "z"), ("u", "v", "w")


@dataclass(frozen=True, kw_only=True)
class Mapping:
    """How the values of one table are spread over its axes.

    Attributes
    ----------
    table : str
        Name of the table.
    inputs : tuple of str
        What a value is looked up by.
    forward : str
        Formula of the shares ``x``, ``y`` and of a volume ``z``, from 0 to 1, of these.
    inverse : str
        Formula of the inputs of the shares.
    placements : tuple of str
        Of `PLACEMENTS`, for each axis.
    """

    table: str
    inputs: tuple[str, ...]
    forward: str
    inverse: str
    placements: tuple[str, ...]

    @property
    def textures(self) -> tuple[str, ...]:
        """Names of the texture coordinates."""
        return _TEXTURES[: len(self.placements)]

    def lookup(self, sizes: tuple[int, ...]) -> str:
        """Return the formula of the texture coordinates ``u``, ``v`` and ``w`` of the inputs.

        Parameters
        ----------
        sizes : tuple of int
            Width, height and depth of the table. [texel]
        """
        lines = [self.forward.strip()]
        for axis, placement in enumerate(self.placements):
            names = {"texture": _TEXTURES[axis], "share": _SHARES[axis], "size": sizes[axis]}
            lines.append(_LOOKUPS[placement].format(**names))
        return "\n".join(lines)

    def texels(self, sizes: tuple[int, ...], constants: Values[str, float]) -> dict[str, Any]:
        """Return the inputs that the texels of a table stand for.

        Parameters
        ----------
        sizes : tuple of int
            Width, height and depth. [texel]
        constants : mapping of str to float
            Those of the formulas.

        Returns
        -------
        dict of str to ndarray
            By the names of `inputs`, of a shape that broadcasts to (depth, height, width) or
            (height, width).
        """
        shares: dict[str, npt.ArrayLike] = {}
        for axis, (size, placement) in enumerate(zip(sizes, self.placements, strict=True)):
            shape = [1] * len(sizes)
            shape[len(sizes) - 1 - axis] = size
            shares[_SHARES[axis]] = _texel_shares(size, placement).reshape(shape)
        known = evaluate(self.inverse, {**constants, **shares})
        return {name: known[name] for name in self.inputs}

    def coordinates(
        self, sizes: tuple[int, ...], values: Values[str, npt.ArrayLike]
    ) -> tuple[Array, ...]:
        """Return the texture coordinates at which inputs are looked up.

        Parameters
        ----------
        sizes : tuple of int
            As of `lookup`.
        values : mapping of str to array_like
            Constants, and the inputs.
        """
        known = evaluate(self.lookup(sizes), values)
        return tuple(np.asarray(known[name]) for name in self.textures)


def _texel_shares(size: int, placement: str) -> Array:
    if placement == "centres":
        return (np.arange(size) + 0.5) / size
    if placement == "ends":
        return np.linspace(0.0, 1.0, size)
    half = np.linspace(0.0, 0.5, size // 2)
    # What is just below a half belongs to the first of both.
    half[-1] = np.nextafter(0.5, 0.0)
    return np.concatenate([half, np.linspace(0.5, 1.0, size // 2)])
