"""Which channels of a file hold light, coverage and depth."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from skybake.errors import InputError
from skybake.formats.exr_layers import ExrPart

_DEPTHS = ("z", "depth", "depth.z", "depth.v", "depth.r", "depth.y")
_COMBINED = "combined"


class Channel(NamedTuple):
    """A channel of a file.

    Attributes
    ----------
    part : int
        Of the file.
    name : str
        In the part.
    """

    part: int
    name: str


class Beauty(NamedTuple):
    """Channels of light.

    Attributes
    ----------
    part : int
        Of the file.
    colours : tuple of str
        R, G and B.
    alpha : str or None
        Coverage, by which the light is multiplied.
    """

    part: int
    colours: tuple[str, str, str]
    alpha: str | None


def find_beauty(path: Path, parts: Sequence[ExrPart], layer: str | None) -> Beauty:
    """Find the light of a file.

    Parameters
    ----------
    path : Path
        For messages.
    parts : sequence of ExrPart
        Of the file.
    layer : str or None
        What is before the last dot of the channels' names, or the name of a part; by default
        nothing, or else the only layer that has R, G and B, or whose name ends in Combined.

    Raises
    ------
    InputError
        If there are no such channels, which lists those that there are.
    """
    found = dict(_layers(parts))
    if layer is not None:
        for (number, name), beauty in found.items():
            if layer in {name, parts[number].name, f"{parts[number].name}.{name}"}:
                return beauty
        raise InputError(f"{path}: layer {layer!r} must have R, G, B; channels: {_listed(parts)}")
    plain = [beauty for (_, name), beauty in found.items() if not name]
    combined = [beauty for (_, name), beauty in found.items() if name.lower().endswith(_COMBINED)]
    for some in (plain[:1], combined, list(found.values())):
        if len(some) == 1:
            return some[0]
    problem = "one layer must be named" if found else "channels must be R, G, B"
    raise InputError(f"{path}: {problem}; channels: {_listed(parts)}")


def find_depth(path: Path, parts: Sequence[ExrPart], name: str | None) -> Channel:
    """Find the depth of a file.

    Parameters
    ----------
    path, parts
        As of `find_beauty`.
    name : str or None
        The channel, perhaps after its part's name and a dot; by default the only one called Z or
        depth, by itself or in a layer.

    Raises
    ------
    InputError
        As `find_beauty`.
    """
    every = [Channel(k, each) for k, part in enumerate(parts) for each in part.channels]
    if name is not None:
        for channel in every:
            if name in {channel.name, f"{parts[channel.part].name}.{channel.name}"}:
                return channel
        raise InputError(f"{path}: channel {name!r} must be there; channels: {_listed(parts)}")
    known = [each for each in every if _is_depth(each.name, parts[each.part].name)]
    plain = [each for each in known if each.name.lower() in {"z", "depth"}]
    for some in (plain[:1], known, every):
        if len(some) == 1:
            return some[0]
    problem = "one depth must be named" if known else "depth must be called Z, or be named"
    raise InputError(f"{path}: {problem}; channels: {_listed(parts)}")


def _layers(parts: Sequence[ExrPart]) -> Iterator[tuple[tuple[int, str], Beauty]]:
    for number, part in enumerate(parts):
        by_upper = {name.upper(): name for name in part.channels}
        for name in part.channels:
            before, dot, last = name.rpartition(".")
            if last.upper() != "R":
                continue
            own = [by_upper.get(f"{before}{dot}{one}".upper()) for one in "RGBA"]
            red, green, blue, alpha = own
            if red is not None and green is not None and blue is not None:
                yield (number, before), Beauty(number, (red, green, blue), alpha)


def _is_depth(name: str, part: str) -> bool:
    whole, own = f"{part}.{name}".lower(), name.lower()
    return own in _DEPTHS or any(whole.endswith(f".{one}") for one in _DEPTHS)


def _listed(parts: Sequence[ExrPart]) -> str:
    names = [
        f"{part.name}.{each}" if part.name else each for part in parts for each in part.channels
    ]
    return ", ".join("".join(c if c.isprintable() else "?" for c in name) for name in names)
