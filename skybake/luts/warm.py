"""Compiles the kernels of tables in advance."""

from __future__ import annotations

from skybake.image.scene import Scene
from skybake.image.settings import map_settings
from skybake.luts.bake import make_tables
from skybake.luts.settings import TableSettings
from skybake.preset import load_preset

SMALL = TableSettings(
    transmittance_size=(2, 2),
    multiple_scattering_size=(2, 2),
    sky_view_size=(2, 2),
    aerial_size=(2, 2, 2),
)
"""The smallest tables, which need the same kernels as others."""


def compile_kernels() -> None:
    """Make small tables."""
    make_tables(Scene(load_preset("earth"), map_settings()), SMALL)
