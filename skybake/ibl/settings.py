"""What a set of lighting maps consists of."""

from __future__ import annotations

import math
from dataclasses import dataclass

from skybake.errors import InputError

PARTS = ("specular", "diffuse", "sh", "dfg")
FORMATS = ("ktx2", "dds", "exr")
MAPPINGS = ("linear", "filament")

SMALLEST_SOURCE, USUAL_SOURCE = 128, 512
"""Edges of the cube that is filtered: at least, and of which specular cubes are not averaged of
more than one texel where they are larger. [pixel]"""

LARGEST_SPECULAR, LARGEST_DIFFUSE, LARGEST_DFG = 2048, 512, 1024
FEWEST_SAMPLES, MOST_SAMPLES = 16, 65536


@dataclass(frozen=True, kw_only=True)
class LightingMaps:
    """What a set of lighting maps consists of.

    Attributes
    ----------
    parts : tuple of str
        Some of `PARTS`.
    specular_size, diffuse_size : int
        Edges of the cubes, powers of 2. [pixel]
    mips : int
        Levels of the specular cube, each of half the edge of that before it: the roughness rises
        from 0 in the first, which is the map itself, to 1 in the last.
    mapping : {"linear", "filament"}
        How: perceptual roughness is level / (mips - 1), or, as Filament's shaders have it,
        level / (mips - 1) is roughness * (2 - roughness).
    samples : int
        Directions in which the lobe of a texel is sampled.
    dfg_size : int
        Width and height of the split sum's table. [pixel]
    dfg_multiscatter, dfg_upward : bool
        See `skybake.ibl.dfg.dfg_table`; and whether rows rise from roughness 1 to 0, as programs
        have it that count rows of a texture from the bottom.
    """

    parts: tuple[str, ...] = PARTS
    specular_size: int = 256
    diffuse_size: int = 64
    mips: int = 7
    mapping: str = "linear"
    samples: int = 1024
    dfg_size: int = 128
    dfg_multiscatter: bool = False
    dfg_upward: bool = False

    def __post_init__(self) -> None:
        """Refuse what cannot be made."""
        for part in self.parts:
            if part not in PARTS:
                raise InputError(f"parts: must be among {', '.join(PARTS)}, got {part!r}")
        if not self.parts:
            raise InputError(f"parts: must be some of {', '.join(PARTS)}, got none")
        _check_power("specular size", self.specular_size, LARGEST_SPECULAR)
        _check_power("diffuse size", self.diffuse_size, LARGEST_DIFFUSE)
        most = int(math.log2(self.specular_size)) + 1
        if not 2 <= self.mips <= most:
            raise InputError(
                f"mips: must be from 2 to {most} for a specular size of {self.specular_size}, "
                f"got {self.mips}"
            )
        _check_range("samples", self.samples, FEWEST_SAMPLES, MOST_SAMPLES)
        _check_range("dfg size", self.dfg_size, 2, LARGEST_DFG)
        if self.mapping not in MAPPINGS:
            raise InputError(f"mapping: must be one of {', '.join(MAPPINGS)}, got {self.mapping!r}")

    @property
    def source_edge(self) -> int:
        """Edge of the cube that is filtered. [pixel]"""
        finer = max(2 * self.specular_size, SMALLEST_SOURCE)
        return max(min(finer, USUAL_SOURCE), self.specular_size)

    def levels(self) -> list[tuple[int, float]]:
        """Return edge [pixel] and perceptual roughness of each level of the specular cube."""
        return [(self.specular_size >> mip, self.roughness(mip)) for mip in range(self.mips)]

    def roughness(self, mip: int) -> float:
        """Return the perceptual roughness of a level."""
        share = mip / (self.mips - 1)
        return share if self.mapping == "linear" else 1.0 - math.sqrt(1.0 - share)


def _check_power(name: str, size: int, largest: int) -> None:
    if not 2 <= size <= largest or size & (size - 1):
        raise InputError(f"{name}: must be a power of two from 2 to {largest}, got {size}")


def _check_range(name: str, value: int, least: int, most: int) -> None:
    if not least <= value <= most:
        raise InputError(f"{name}: must be from {least} to {most}, got {value}")
