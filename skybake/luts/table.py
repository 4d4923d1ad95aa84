"""A table as it is written: values, and what they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from skybake.luts.mapping import Mapping

Texels = npt.NDArray[np.float32]


@dataclass(frozen=True, eq=False, kw_only=True)
class Table:
    """A table of an atmosphere.

    Attributes
    ----------
    name : str
        Of its files.
    values : ndarray of float32, shape (height, width, channel) or (depth, height, width, channel)
        Row 0 is the first in a file.
    channels : tuple of str
        Their names in a file.
    quantity, unit : str
        What the values are, and in which unit.
    is_radiance : bool
        Whether they are of the scale of maps.
    mapping : Mapping
        Where values are.
    """

    name: str
    values: Texels
    channels: tuple[str, ...] = ("R", "G", "B")
    quantity: str
    unit: str
    is_radiance: bool = False
    mapping: Mapping

    @property
    def size(self) -> tuple[int, ...]:
        """Width, height and depth. [texel]"""
        return self.values.shape[-2::-1]


def texels(values: npt.NDArray[np.floating]) -> Texels:
    """Return values as a file holds them."""
    return np.ascontiguousarray(values, np.float32)
