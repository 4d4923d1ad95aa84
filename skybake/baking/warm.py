"""Compiles every kernel in advance, as for a container image."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from skybake.baking.late_kernels import compiled_in_background
from skybake.baking.write import bake
from skybake.cloud_fields.build import build_field
from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.moon import Moon
from skybake.image.night import Night
from skybake.image.settings import Clouds, Lighting, MapSettings, View
from skybake.optics.medium import build_medium
from skybake.optics.phase import build_phase
from skybake.preset import Planet, load_preset
from skybake.projection import Cubemap, Equirect, Fisheye, Perspective
from skybake.projection.cubemap import LAYOUTS
from skybake.reference import cloudy
from skybake.reference.estimate import radiance
from skybake.reference.stokes import stokes
from skybake.scattering.atmosphere import build_atmosphere
from skybake.scattering.spin_harmonics import fill_each_spin, harmonic_count
from skybake.scattering.stokes import polarisation_of
from skybake.scattering.stokes_solver import ORDER, trace_stokes
from skybake.scattering.tables import Atmosphere
from skybake.sky.pixels import blacken_negative
from skybake.sky.sky import METHODS, WAVELENGTHS, Sky

SMALL = MapSettings(View(projection=Equirect(16)))
ORBIT = 400.0
NIGHT = math.radians(-40.0)

CLOUDY = "earth-fair", "earth-broken", "earth-cirrus"
"""Presets whose clouds need all kernels that draw some: heaps, decks and trails."""


def compile_all() -> None:
    """Bake each kind of map, in small, and trace a few paths."""
    planet = load_preset("earth")
    with compiled_in_background(), tempfile.TemporaryDirectory() as folder:
        for number, settings in enumerate(_kinds()):
            bake(planet, Path(folder) / f"{number}.exr", settings)
        _compile_clouds(Path(folder))
    medium = build_medium(planet, WAVELENGTHS)
    # Tables that are already stored needed no kernels; only dust has an aureole.
    build_atmosphere(medium, "hillaire")
    _compile_polarisation(build_atmosphere(medium, "full"))
    build_atmosphere(build_medium(load_preset("mars"), WAVELENGTHS), "full")
    # Few maps have pixels of negative luminance.
    blacken_negative(np.zeros(3, np.float32), np.zeros((0, 1, 3), np.float32))
    here = np.zeros(1)
    radiance(medium, 0.0, SMALL.lighting.sun_elevation, here, here, samples=2)
    stokes(medium, 0.0, SMALL.lighting.sun_elevation, here, here, samples=2)
    Sky(planet, SMALL.lighting.sun_elevation).radiance(np.array([0.0, 1.0, 0.0]))


def solve(names: Iterable[str | Path], notice: Callable[[str], None]) -> None:
    """Build the missing tables of presets.

    Parameters
    ----------
    names : iterable of str or Path
        As `skybake.load_preset` takes them.
    notice : callable
        Called with a line before each that takes long.

    Raises
    ------
    SkybakeError
        If a preset cannot be used.
    """
    planets: list[Planet] = [load_preset(name) for name in names]
    for planet in planets:
        sky = Sky(planet, SMALL.lighting.sun_elevation)
        if not sky.is_solved:
            notice(f"solving for the light in the atmosphere of {planet.name}")
            _ = sky.atmosphere


def _compile_polarisation(atmosphere: Atmosphere) -> None:
    """Trace a ray through light that is not polarised; the true one takes long to solve for."""
    count = 2 * harmonic_count(ORDER) * atmosphere.scaled.mixture.size
    dark = np.zeros((*atmosphere.field.radiance.shape[:2], count), np.float32)
    polarisation = polarisation_of(atmosphere.scaled, ORDER, dark)
    fill_each_spin(polarisation.harmonics, np.zeros(1), np.zeros((1, 2, harmonic_count(ORDER))))
    ray = np.array([[atmosphere.medium.r_bottom, 1.0, 1.0, 1.0]])
    trace_stokes(atmosphere, polarisation, ray)


def _compile_clouds(folder: Path) -> None:
    """Draw clouds of each shape, which are kept as well, and bake and trace those of one."""
    worlds = [load_preset(name) for name in CLOUDY]
    for world in worlds:
        for layer in world.clouds:
            build_field(layer)
    settings = replace(SMALL, clouds=Clouds(quality="draft"))
    bake(worlds[0], folder / "clouds.exr", settings)
    clouds = worlds[0].clouds
    cloudy.radiance(
        build_medium(worlds[0], WAVELENGTHS),
        [build_field(layer) for layer in clouds],
        [build_phase(layer.phase, WAVELENGTHS) for layer in clouds],
        0.0,
        SMALL.lighting.sun_elevation,
        SMALL.lighting.sun_azimuth,
        np.zeros(1),
        np.zeros(1),
        samples=2,
    )


def _kinds() -> list[MapSettings]:
    cubes = [Cubemap(16, layout) for layout in LAYOUTS]
    projections = (*cubes, Fisheye(16), Perspective(16, 8))
    return [
        # The method scalar has the kernels of the full one.
        *(replace(SMALL, lighting=Lighting(method=each)) for each in METHODS if each != "scalar"),
        replace(SMALL, lighting=Lighting(math.radians(-4.0))),
        replace(SMALL, lighting=Lighting(NIGHT), night=Night(CelestialFrame("earth", 0.0, 0.0))),
        replace(SMALL, lighting=Lighting(moon=Moon(Lighting.sun_azimuth, Lighting.sun_elevation))),
        MapSettings(View(ORBIT, Equirect(16))),
        MapSettings(View(ORBIT, cubes[0])),
        *(MapSettings(View(projection=projection)) for projection in projections),
    ]
