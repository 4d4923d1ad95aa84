"""Makes a set of tables, and writes it."""

from __future__ import annotations

import math
from collections.abc import Mapping as Values
from dataclasses import dataclass
from pathlib import Path

from skybake.errors import InputError
from skybake.formats.spec import Attribute, MapSpec
from skybake.image.scene import Scene
from skybake.luts.aerial_perspective import aerial_tables
from skybake.luts.constants import (
    Constants,
    camera_constants,
    known_constants,
    light_constants,
    mapping_constants,
)
from skybake.luts.description import describe_tables
from skybake.luts.files import file_names, folder_of_tables, write_tables
from skybake.luts.lookup_code import lookup_code
from skybake.luts.mapping import Mapping
from skybake.luts.multiple_scattering import multiple_scattering_table
from skybake.luts.parametrisations import TABLES, find_mappings
from skybake.luts.settings import TableSettings
from skybake.luts.shading import LANGUAGES
from skybake.luts.sky_view import error_near_sun, sky_view_table
from skybake.luts.table import Table
from skybake.luts.transmittance import transmittance_table
from skybake.version import __version__


@dataclass(frozen=True, eq=False, kw_only=True)
class TableSet:
    """Tables of one sky, and the numbers that they are looked up with.

    Attributes
    ----------
    tables : dict of str to Table
        By name: those of `skybake.luts.parametrisations.TABLES`, and ``aerial_transmittance``.
    constants : Constants
        Of formulas and code.
    error_near_sun : dict of str to float or None
        Of the view of the sky, see `skybake.luts.sky_view.error_near_sun`.
    """

    tables: dict[str, Table]
    constants: Constants
    error_near_sun: dict[str, float] | None

    def code(self, heading: str) -> dict[str, str]:
        """Return the code that looks them up, by language; its first lines are a comment."""
        mappings = {name: self.tables[name].mapping for name in TABLES}
        sizes = {name: self.tables[name].size for name in TABLES}
        return {
            language: lookup_code(language, mappings, sizes, self.constants, heading)
            for language in LANGUAGES
        }


@dataclass(frozen=True, kw_only=True)
class BakedTables:
    """What was written.

    Attributes
    ----------
    files : tuple of Path
        All of them.
    recipe_hash : str
        Of the recipe that they state.
    error_near_sun : dict of str to float or None
        As of `TableSet`.
    """

    files: tuple[Path, ...]
    recipe_hash: str
    error_near_sun: dict[str, float] | None


def check_scene(scene: Scene) -> None:
    """Refuse a sky of which there are no tables.

    Raises
    ------
    InputError
        If the world has no air or has clouds, the observer is above the air, lights of the night
        are to be shown, a moon eclipses the sun, or the method has single scattering alone.
    """
    medium, altitude = scene.sky.medium, scene.settings.view.altitude
    height = medium.r_top - medium.r_bottom
    if not scene.planet.constituents:
        raise InputError(f"preset: must have air, got {scene.planet.name}, which has none")
    if any(not layer.is_empty for layer in scene.planet.clouds):
        names = ", ".join(layer.name for layer in scene.planet.clouds)
        raise InputError(f"clouds: must be none, since tables hold clear air, got {names}")
    if not altitude < height:
        raise InputError(
            f"altitude: must be below the top of the atmosphere at {height:g} km, got "
            f"{altitude:g} km"
        )
    if scene.settings.night.shows_glow or scene.settings.night.shows_stars:
        raise InputError("night: must not be shown in tables, which are symmetric about the sun")
    if scene.sky.eclipse is not None:
        raise InputError("moon: must not eclipse the sun in tables, which are symmetric about it")
    if scene.settings.lighting.method == "march":
        raise InputError("method: must be full or hillaire, got march")


def make_tables(scene: Scene, settings: TableSettings | None = None) -> TableSet:
    """Make the tables of a sky.

    Parameters
    ----------
    scene : Scene
        The observer, the sun, the colour space and the scale.
    settings : TableSettings, optional
        What the tables are like.

    Raises
    ------
    SkybakeError
        If the scene is refused, see `check_scene`, or cannot be solved for.
    """
    settings = settings or TableSettings()
    check_scene(scene)
    mappings, sizes = find_mappings(settings.parametrisation), settings.sizes
    atmosphere = scene.sky.atmosphere
    constants = mapping_constants(scene, settings, mappings)

    def where(name: str) -> tuple[Mapping, tuple[int, ...], dict[str, float]]:
        return mappings[name], sizes[name], constants

    weights = scene.rgb_weights
    made = (
        transmittance_table(
            scene.sky.medium, weights, *where("transmittance"), workers=scene.workers
        ),
        multiple_scattering_table(atmosphere, weights, *where("multiple_scattering")),
        sky_view_table(scene, *where("sky_view")),
        *aerial_tables(scene, settings, mappings["aerial_perspective"], constants),
    )
    tables = {table.name: table for table in made}
    return TableSet(
        tables=tables,
        constants={
            **known_constants(constants),
            **light_constants(scene),
            **camera_constants(settings),
        },
        error_near_sun=error_near_sun(scene, tables["sky_view"], constants),
    )


def bake_tables(
    scene: Scene,
    folder: Path | str,
    settings: TableSettings | None = None,
    *,
    attributes: Values[str, Attribute] | None = None,
) -> BakedTables:
    """Make the tables of a sky and write them, with what they are and code that looks them up.

    Parameters
    ----------
    scene, settings
        As of `make_tables`.
    folder : Path or str
        Where to; it is made if only the folder that holds it exists.
    attributes : mapping of str to Attribute, optional
        What files shall state besides.

    Raises
    ------
    SkybakeError
        If the scene, a setting or a target cannot be used; no file is left then.
    """
    settings, folder = settings or TableSettings(), Path(folder)
    check_scene(scene)
    with folder_of_tables(folder):
        made = make_tables(scene, settings)
        description = describe_tables(scene, settings, made.tables, file_names(), made.constants)
        description["tables"]["sky_view"]["error_near_sun"] = made.error_near_sun
        encoding = scene.settings.encoding
        spec = MapSpec(
            *(1, 1, encoding.space, encoding.white_luminance),
            pixel=settings.pixel,
            attributes={
                "skybake:preset": scene.planet.name,
                "skybake:parametrisation": settings.parametrisation,
                "skybake:recipeHash": description["recipe_hash"],
                **(attributes or {}),
            },
        )
        files = write_tables(
            folder, made.tables, description, made.code(_heading(scene, settings)), spec
        )
    return BakedTables(
        files=files, recipe_hash=description["recipe_hash"], error_near_sun=made.error_near_sun
    )


def _heading(scene: Scene, settings: TableSettings) -> str:
    """Return what the code says of itself."""
    lighting, space = scene.settings.lighting, scene.settings.encoding
    return (
        f"Lookup of the tables beside this file, by skybake {__version__}.\n"
        f"Sky of {scene.planet.name}, sun {math.degrees(lighting.sun_elevation):.6g} degrees high, "
        f"observer {scene.settings.view.altitude:.6g} km high.\n"
        f"{settings.parametrisation}; {space.space.name}; a radiance of 1 is "
        f"{space.white_luminance:.9g} cd/m2.\n"
        "Textures are filtered linearly and clamped to their edges."
    )
