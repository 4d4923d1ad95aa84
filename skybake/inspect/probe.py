"""Radiance in given directions, as numbers."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from skybake.angles import cosine_between
from skybake.ephemeris.moon import Moon
from skybake.errors import InputError, UnsolvableError
from skybake.image.light import light_of_scene
from skybake.image.luminous import luminous_weights
from skybake.image.scene import Scene
from skybake.image.settings import Clouds, Lighting, MapSettings, View
from skybake.image.survey import DARK, ROUNDING
from skybake.inspect.clouded import clouded_light
from skybake.inspect.polarised import check_polarisation, stokes_columns
from skybake.inspect.traced import traced_radiance
from skybake.optics.medium import Array
from skybake.preset import Planet
from skybake.sky.sky import WAVELENGTHS, Sky

COLUMNS = ("view_zenith_deg", "relative_azimuth_deg")
REFERENCE = "reference"


@dataclass(frozen=True)
class Directions:
    """Directions to look in.

    Attributes
    ----------
    text : tuple of (str, str)
        Zenith angle, and bearing less that of the sun, clockwise, as given, in degrees.
    zenith, azimuth : ndarray of float64, shape (direction,)
        The same. [rad]
    """

    text: tuple[tuple[str, str], ...]
    zenith: Array
    azimuth: Array


def read_directions(where: str, lines: Iterable[str]) -> Directions:
    """Read directions from CSV with the columns of `COLUMNS`; others are ignored.

    Raises
    ------
    InputError
        If it is not CSV, a column is missing, or a value is not a number or not a zenith angle.
    """
    rows = csv.DictReader(lines)
    try:
        return _read_rows(where, rows)
    except csv.Error as error:
        # The reader counts the lines of the rows that it has returned.
        line = rows.line_num + 1
        raise InputError(f"{where}: line {line}: must be CSV, got {error}") from error


def _read_rows(where: str, rows: csv.DictReader[str]) -> Directions:
    found = [name.strip() for name in rows.fieldnames or ()]
    missing = [name for name in COLUMNS if name not in found]
    if missing:
        raise InputError(
            f"{where}: must have the columns {', '.join(COLUMNS)}, got "
            f"{', '.join(found) or 'nothing'}"
        )
    rows.fieldnames = found
    text = []
    for row in rows:
        values = [(row[name] or "").strip() for name in COLUMNS]
        for name, value in zip(COLUMNS, values, strict=True):
            _check_angle(f"{where}: line {rows.line_num}: {name}", name, value)
        text.append((values[0], values[1]))
    if not text:
        raise InputError(f"{where}: must hold at least one direction, got none")
    return _directions(text)


def default_directions(sun_elevation: float) -> Directions:
    """Return the circle at the sun's elevation, at least 10 deg, and the sun's vertical plane."""
    zenith = 90.0 - max(round(math.degrees(sun_elevation), 6), 10.0)
    circle = [(f"{zenith:g}", f"{azimuth}") for azimuth in range(0, 181, 15)]
    plane = [(f"{angle}", "0") for angle in range(85, -1, -5)]
    plane += [(f"{angle}", "180") for angle in range(5, 86, 5)]
    return _directions(circle + plane)


def probe(
    planet: Planet,
    directions: Directions,
    *,
    sun_elevation: float,
    sun_azimuth: float = math.pi,
    altitude: float = 0.0,
    sun_distance: float | None = None,
    moon: Moon | None = None,
    wavelengths: Array | None = None,
    per_irradiance: bool = False,
    illuminance: bool = False,
    with_stokes: bool = False,
    method: str = "full",
    samples: int = 10_000,
    clouds: Clouds | None = None,
) -> str:
    """Radiances of a planet's sky as CSV.

    Parameters
    ----------
    planet : Planet
        The world.
    directions : Directions
        Where to look.
    sun_elevation : float
        At the observer. [rad]
    sun_azimuth : float, optional
        Bearing of the sun, from which the directions' azimuths count clockwise. [rad]
    altitude : float, optional
        Of the observer. [km]
    sun_distance : float, optional
        Of the sun; default the preset's. [au]
    moon : Moon, optional
        What may be in front of the sun.
    wavelengths : ndarray, optional
        In any order; default the renderer's own. [nm]
    per_irradiance : bool, optional
        Divide by the star's irradiance above the atmosphere, without luminance and
        chromaticity.
    illuminance : bool, optional
        Repeat the illuminances by sun and sky in every row.
    with_stokes : bool, optional
        Add Stokes parameters and the degree and angle of linear polarisation.
    method : {"full", "scalar", "hillaire", "march", "reference"}, optional
        `reference` traces paths and adds the standard errors.
    samples : int, optional
        Paths for each direction and wavelength of the reference.
    clouds : Clouds, optional
        When clouds are seen, if the world has any.

    Returns
    -------
    str
        Lines that repeat the directions and add ``radiance_680nm`` and so on
        [W m⁻² sr⁻¹ nm⁻¹, or sr⁻¹], and without `per_irradiance` luminance
        [cd m⁻²] and CIE 1931 chromaticity.

    Raises
    ------
    SkybakeError
        If a value is out of range, the preset does not cover a wavelength, or light is negative
        beyond rounding.
    """
    fast = "full" if method == REFERENCE else method
    sky = Sky(
        planet,
        sun_elevation,
        altitude,
        sun_azimuth=sun_azimuth,
        sun_distance=sun_distance,
        moon=moon,
        wavelengths=wavelengths,
        method=fast,
    )
    sky.check_clouds()
    if with_stokes:
        check_polarisation(planet, sky)
    columns: dict[str, Array] = {}
    seen = clouds or Clouds()
    values, errors = _radiance(planet, sky, directions, method, samples, seen)
    scale = np.ones(sky.wavelengths.size) if per_irradiance else sky.irradiance
    for k, wavelength in enumerate(sky.wavelengths):
        columns[f"radiance_{wavelength:g}nm"] = values[:, k] * scale[k]
        if errors is not None:
            columns[f"stderr_{wavelength:g}nm"] = errors[:, k] * scale[k]
    if not per_irradiance:
        columns |= _colour(planet, sky, directions, method, samples, seen, values)
    if with_stokes:
        paths = samples if method == REFERENCE else None
        columns |= stokes_columns(sky, directions.zenith, directions.azimuth, scale, paths)
    if illuminance:
        columns |= _illuminance(planet, sky, directions, seen)
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*COLUMNS, *columns])
    for i, text in enumerate(directions.text):
        writer.writerow([*text, *(f"{column[i]:.7g}" for column in columns.values())])
    return out.getvalue()


def _radiance(
    planet: Planet, sky: Sky, directions: Directions, method: str, samples: int, clouds: Clouds
) -> tuple[Array, Array | None]:
    """Radiance per unit irradiance and, by the reference, its standard error. [sr⁻¹]"""
    if method == REFERENCE:
        if sky.eclipse is not None:
            raise InputError("eclipse: method must be full or hillaire, got reference")
        zenith, azimuth = directions.zenith, directions.azimuth
        return traced_radiance(planet, sky, zenith, azimuth, samples, clouds.time)
    if sky.eclipse is not None and planet.clouds:
        raise InputError("eclipse: must be probed without clouds")
    clouded = _clouded(planet, sky, directions, np.eye(sky.wavelengths.size), clouds)
    if clouded is not None:
        return _without_rounding(clouded), None
    if sky.eclipse is not None:
        mu = np.cos(directions.zenith)
        eclipsed, _ = sky.eclipse.radiance_per_irradiance(mu, directions.azimuth)
        return _without_rounding(eclipsed), None
    sun_zenith = sky.source.zenith
    mu, sine = np.cos(directions.zenith), np.sin(directions.zenith)
    nu = cosine_between(mu, sine, math.cos(sun_zenith), math.sin(sun_zenith), directions.azimuth)
    return _without_rounding(sky.radiance_per_irradiance(mu, nu)), None


def _clouded(
    planet: Planet, sky: Sky, directions: Directions, weights: Array, clouds: Clouds
) -> Array | None:
    zenith, azimuth = directions.zenith, directions.azimuth
    return clouded_light(planet, sky, zenith, azimuth, weights, clouds)


def _without_rounding(radiance: Array) -> Array:
    """Take radiance per unit irradiance that rounding left below 0 for 0; refuse what is less."""
    if not np.isfinite(radiance).all():
        raise UnsolvableError(f"light: radiance must be finite, got {radiance.sum()}")
    least, most = float(radiance.min()), float(radiance.max())
    if least < -max(ROUNDING * most, DARK / math.pi):
        raise UnsolvableError(
            f"light: radiance per irradiance must be at least 0 beside a brightest one of "
            f"{most:.3g} sr-1, got {least:.3g}; the atmosphere is beyond what the method resolves"
        )
    return np.maximum(radiance, 0.0)


def _colour(
    planet: Planet,
    sky: Sky,
    directions: Directions,
    method: str,
    samples: int,
    clouds: Clouds,
    values: Array | None,
) -> dict[str, Array]:
    """Luminance and chromaticity, from the renderer's own wavelengths."""
    own = np.array(planet.wavelengths or WAVELENGTHS)
    if not np.array_equal(sky.wavelengths, own):
        sky = Sky(
            planet,
            sky.sun_elevation,
            sky.altitude,
            sun_azimuth=sky.sun_azimuth,
            sun_distance=sky.sun_distance,
            moon=sky.moon,
            method=sky.method,
        )
        values = None
    weights = luminous_weights(sky)
    # Three channels instead of many wavelengths.
    xyz = None if method == REFERENCE else _clouded(planet, sky, directions, weights, clouds)
    if xyz is None:
        if values is None:
            values, _ = _radiance(planet, sky, directions, method, samples, clouds)
        xyz = values @ weights
    total = xyz.sum(axis=1)
    total[total == 0.0] = math.nan
    return {
        "luminance_cd_m2": xyz[:, 1],
        "chromaticity_x": xyz[:, 0] / total,
        "chromaticity_y": xyz[:, 1] / total,
    }


def _illuminance(
    planet: Planet, sky: Sky, directions: Directions, clouds: Clouds
) -> dict[str, Array]:
    lighting = Lighting(
        sky.sun_elevation,
        sun_azimuth=sky.sun_azimuth,
        sun_distance=sky.sun_distance,
        method=sky.method,
        moon=sky.moon,
    )
    settings = MapSettings(View(sky.altitude), lighting, clouds=clouds)
    light = light_of_scene(Scene(planet, settings))
    figures = {
        "direct_normal_illuminance_lux": light.direct_normal_illuminance,
        "direct_illuminance_lux": light.direct_illuminance,
        "sky_illuminance_lux": light.sky_illuminance,
    }
    return {name: np.full(directions.zenith.size, value) for name, value in figures.items()}


def _check_angle(where: str, name: str, text: str) -> None:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{where}: must be a number, got {text!r}")
    if name == COLUMNS[0] and not 0.0 <= value <= 180.0:
        raise InputError(f"{where}: must be from 0 to 180, got {text}")


def _directions(text: list[tuple[str, str]]) -> Directions:
    degrees = np.array([[float(value) for value in row] for row in text])
    return Directions(tuple(text), *np.radians(degrees).T)
