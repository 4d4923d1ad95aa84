"""What a renderer has written: its light, and how far what it shows is."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from skybake.aerial.channels import Beauty, Channel, find_beauty, find_depth
from skybake.aerial.depth import Depths, checked_depths
from skybake.errors import InputError
from skybake.formats.exr_layers import ExrPart, read_exr
from skybake.formats.targets import real_target

DEPTH_KINDS = ("planar", "ray")


@dataclass(frozen=True, kw_only=True)
class Reading:
    """How the files of a renderer are read.

    Attributes
    ----------
    layer : str or None
        Of the light, see `find_beauty`.
    depth_channel : str or None
        See `find_depth`.
    depth_kind : {"planar", "ray"}
        Whether depths are along the camera's axis or along rays.
    depth_unit : float
        Length of 1 in the depths. [km]
    depth_background : {"inf", "0"} or None
        What depths that are none become, see `checked_depths`.
    """

    layer: str | None = None
    depth_channel: str | None = None
    depth_kind: str = "planar"
    depth_unit: float = 1e-3
    depth_background: str | None = None


@dataclass(frozen=True, kw_only=True)
class Source:
    """What a renderer has written.

    Attributes
    ----------
    path : Path
        File of the light.
    parts : list of ExrPart
        All that it holds.
    beauty : Beauty
        Where the light is.
    depths : Depths
        How far what it shows is.
    """

    path: Path
    parts: list[ExrPart]
    beauty: Beauty
    depths: Depths

    @property
    def part(self) -> ExrPart:
        """The part that holds the light."""
        return self.parts[self.beauty.part]


def read_source(path: Path, depth: Path | None, reading: Reading) -> Source:
    """Read the files of a renderer.

    Parameters
    ----------
    path : Path
        Of the light.
    depth : Path or None
        Of the depth, if it is another.
    reading : Reading
        How.

    Raises
    ------
    InputError
        If a file cannot be read, has no such channels, sizes differ, or a depth is no distance.
    """
    parts = read_exr(path)
    beauty = find_beauty(path, parts, reading.layer)
    where = path if depth is None else depth
    others = parts if real_target(where) == real_target(path) else read_exr(where)
    channel = find_depth(where, others, reading.depth_channel)
    wide, high = parts[beauty.part].size
    width, height = others[channel.part].size
    if (width, height) != (wide, high):
        raise InputError(
            f"{where}: depth must be as large as {path}, {wide}x{high}, got {width}x{height}"
        )
    return Source(
        path=path, parts=parts, beauty=beauty, depths=_depths(where, others, channel, reading)
    )


def _depths(path: Path, parts: list[ExrPart], channel: Channel, reading: Reading) -> Depths:
    values = parts[channel.part].plane(channel.name)
    unit = reading.depth_unit
    given = path, channel.name, values, unit, reading.depth_background
    return Depths(checked_depths(*given), unit, reading.depth_kind == "planar")
