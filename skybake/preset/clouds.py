"""Tables of a preset that describe its layers of clouds."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal, NamedTuple, cast

from skybake.errors import PresetWarning
from skybake.preset.cloud_kinds import DEFAULTS
from skybake.preset.cloud_tile import tile_file, tile_size
from skybake.preset.cloud_values import (
    read_cover,
    read_optical_depth,
    read_pair,
    read_particles,
    read_seed,
    read_wind,
)
from skybake.preset.clouds_model import KINDS, TILE, CloudLayer, Tile
from skybake.preset.constituents import Top
from skybake.preset.document import Document, Source
from skybake.preset.extend import NAME
from skybake.preset.message import shown
from skybake.preset.optics_model import Phase
from skybake.preset.particles import DEFAULT_EFFECTIVE_RADIUS
from skybake.preset.section import Gather, Section

MAX_LAYERS = 8
"""Layers whose light can be solved for one after another in a reasonable time."""

INTERPOLATIONS = ("linear", "constant")


def read_clouds(section: Section, highest: Top | None) -> tuple[CloudLayer, ...]:
    """Read ``[clouds]``.

    Parameters
    ----------
    section : Section
        A table of layers by their names.
    highest : Top or None
        Top of the atmosphere; None if that is faulty itself.

    Raises
    ------
    PresetError
        With all errors.

    Warns
    -----
    PresetWarning
        If layers overlap.
    """
    names = section.keys()
    if len(names) > MAX_LAYERS:
        section.fail("", f"must be at most {MAX_LAYERS} layers, got {len(names)}")
    for name in names:
        if not NAME.fullmatch(name):
            section.fail("", f"names must consist of letters, digits, _ and -, got {shown(name)}")
    read = Gather()
    layers = tuple(read(_read_named, section, name, highest) for name in names)
    read.finish()
    _note_overlaps(section, layers)
    return layers


def _read_named(section: Section, name: str, highest: Top | None) -> CloudLayer:
    return read_layer(name, section.section(name), highest)


def check_layer(table: Mapping[str, Any]) -> None:
    """Check a layer's table by itself; of a tile's all but the file.

    Messages begin with ``layer: clouds.layer``.

    Raises
    ------
    PresetError
        With each key and the rule that it breaks.
    """
    document = Document()
    document.lay({"clouds": {"layer": dict(table)}}, Source("layer", Path(), is_file=False))
    section = Section(document, ("clouds", "layer"))
    if TILE in table:
        _read_tile_values(section)
    else:
        read_layer("layer", section, None)


def read_layer(name: str, section: Section, highest: Top | None) -> CloudLayer:
    """Read one layer.

    Parameters
    ----------
    name : str
        Its key.
    section : Section
        Its table.
    highest : Top or None
        What must be above it; None if that is faulty itself.

    Raises
    ------
    PresetError
        With each key and the rule that it breaks.
    """
    given = section.keys()
    is_tile = TILE in given
    if is_tile == ("kind" in given):
        section.fail("", "must give either kind or tile")
    layer = (
        _read_tile_layer(name, section)
        if is_tile
        else _read_kind(name, section, section.choice("kind", KINDS[:-1]))
    )
    if highest is not None and layer.base + layer.depth > highest.altitude:
        section.fail(
            "base_km",
            f"the clouds must end below the atmosphere's top at {highest.altitude:g} km, "
            f"got {layer.base + layer.depth:g} km (see {highest.where})",
        )
    return layer


def _read_kind(name: str, section: Section, kind: str) -> CloudLayer:
    usual = DEFAULTS[kind]
    read = Gather(section)
    base = read(section.number, "base_km", 0.0, 1e6, default=usual.base)
    depth = read(section.number, "depth_km", 1e-3, 1e3, default=usual.depth)
    size = read(section.number, "size_km", 1e-2, 1e3, default=usual.size)
    cover = read(read_cover, section, usual.cover)
    phase, radius = read(read_particles, section, usual.phase) or (None, DEFAULT_EFFECTIVE_RADIUS)
    optical_depth = read(read_optical_depth, section, usual.optical_depth, radius)
    seed = read(read_seed, section)
    speed, bearing = read(read_wind, section, usual.wind) or (None, None)
    read.finish()
    return CloudLayer(
        *(name, kind, base, depth, size, cover, optical_depth, phase, seed, speed, bearing),
    )


def _read_tile_layer(name: str, section: Section) -> CloudLayer:
    read = Gather()
    values = read(_read_tile_values, section)
    file = read(tile_file, section)
    read.finish()
    depth, period = tile_size(section, file)
    return CloudLayer(
        name=name,
        kind=TILE,
        base=values.base,
        depth=depth,
        size=period,
        cover=1.0,
        optical_depth=0.0,
        phase=values.phase,
        seed=0,
        wind_speed=values.wind[0],
        wind_from=values.wind[1],
        tile=Tile(str(file.path.resolve()), file.digest, values.interpolation, values.origin),
    )


class _TileValues(NamedTuple):
    """What a tile's table says besides its file."""

    base: float
    phase: Phase
    interpolation: Literal["constant", "linear"]
    origin: tuple[float, float]
    wind: tuple[float, float]


def _read_tile_values(section: Section) -> _TileValues:
    read = Gather(section)
    section.has(TILE)
    base = read(section.number, "base_km", 0.0, 1e6)
    phase, _ = read(read_particles, section, "water") or (None, None)
    interpolation = read(section.choice, "interpolation", INTERPOLATIONS, default=INTERPOLATIONS[0])
    origin = read(read_pair, section, "origin_km", [0.0, 0.0], (-1e6, 1e6), (-1e6, 1e6))
    wind = read(read_wind, section, 0.0)
    read.finish()
    return _TileValues(base, phase, cast(Any, interpolation), origin, wind)


def _note_overlaps(section: Section, layers: tuple[CloudLayer, ...]) -> None:
    for lower, upper in pairwise(sorted(layers, key=lambda layer: layer.base)):
        top = lower.base + lower.depth
        if top > upper.base:
            warnings.warn(
                f"{section.where(upper.name)}: begins at {upper.base:g} km, within "
                f"{section.where(lower.name)}, which reaches {top:g} km: both are drawn, and "
                "light passes one after the other",
                PresetWarning,
                stacklevel=2,
            )
