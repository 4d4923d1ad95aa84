"""The reference tables of tests/data/reference and the atmospheres they were computed for."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import numpy.typing as npt

from skybake.optics.matrix import rayleigh_matrix, unpolarising_matrix
from skybake.optics.medium import Medium, altitude_nodes
from skybake.optics.phase import integrate_phase, scattering_angles

Array = npt.NDArray[np.float64]

TRUTH_WAVELENGTHS = np.array([680.0, 550.0, 440.0])
"""Wavelengths of the tables and of every `truth_medium`. [nm]"""

TRUTH_FOLDER = Path(__file__).parent / "data" / "reference"
_PREFIXES = "twilight_", "aureole_", "horizon_", "aloft_"
_SHORT_NAMES = {
    "radiance_per_unit_irradiance_sr-1": "radiance",
    "order1_part_deterministic": "order1",
}


def load_truth(name: str) -> np.ndarray:
    """Reference radiances of "EARTH_A", "EARTH_HAZE" or "MARS_A", at all their altitudes.

    With the prefix "twilight_" or "aureole_" those of the low-noise tables, with "horizon_"
    or "aloft_" those of the package's own path tracer, which lack `order1`.

    Returns
    -------
    structured ndarray, shape (row,)
        Fields altitude_km, sun_elevation_deg, view_zenith_deg,
        relative_azimuth_deg, wavelength_nm, radiance, stderr and order1 (the
        part scattered or reflected once), the last three per unit solar
        irradiance. [sr^-1]
    """
    return _load(f"{name}_*km.csv")


def load_irradiance_truth(name: str) -> np.ndarray:
    """Reference irradiances of "EARTH_A" or "MARS_A", at all their altitudes.

    Returns
    -------
    structured ndarray, shape (row,)
        Fields as the files' columns; what was not computed is NaN.
    """
    return _load(f"irradiance_{name}_*km.csv")


def load_vector_truth(name: str) -> np.ndarray:
    """Stokes vectors of "RAY" or "RAYMIE", at the ground.

    Returns
    -------
    structured ndarray, shape (row,)
        Fields as the file's columns.
    """
    path = TRUTH_FOLDER / f"vector_{name}_0.001km.csv"
    return np.genfromtxt(path, delimiter=",", names=True, usecols=range(1, 20))


@functools.cache
def vector_medium(name: str) -> Medium:
    """The air of a vector table, at `TRUTH_WAVELENGTHS`."""
    clear = _earth_a()
    isotropic = unpolarising_matrix(clear.phase[2])
    molecules = rayleigh_matrix(np.zeros(3))
    kept = [0, 2] if name == "RAY" else [0, 1, 2]
    density, scattering, extinction, phase = (
        clear.density.copy(), clear.scattering.copy(), clear.extinction.copy(), clear.phase.copy()
    )  # fmt: skip
    table = np.genfromtxt(
        TRUTH_FOLDER / "vector_aerosol_scattering_matrix.csv", delimiter=",", names=True
    )
    air = np.genfromtxt(TRUTH_FOLDER / "vector_atmosphere.csv", delimiter=",", names=True)[:3]
    angle = np.radians(table["angle_deg"])
    p11, p12, p33 = (
        np.stack(
            [
                np.interp(scattering_angles(), angle, table[f"{each}_{w:.0f}"])
                for w in TRUTH_WAVELENGTHS
            ],
            axis=1,
        )
        for each in ("P11", "P12", "P33")
    )
    norm = integrate_phase(p11)
    density[:, 1] = np.exp(-_altitudes(6360.0) / 1.5)
    extinction[1] = _coefficient_of(air["aerosol_optical_depth"], 1.5)
    scattering[1] = air["aerosol_ssa"] * extinction[1]
    phase[1] = p11 / norm
    matrix = np.stack([molecules, np.stack([p12, p11, p33]) / norm, isotropic])
    return clear._replace(
        density=np.ascontiguousarray(density[:, kept]),
        scattering=scattering[kept],
        extinction=extinction[kept],
        phase=phase[kept],
        matrix=matrix[kept],
    )


def truth_medium(name: str) -> Medium:
    """One of the atmospheres the tables were computed for, at `TRUTH_WAVELENGTHS`."""
    atmospheres = {
        "EARTH_A": _earth_a,
        "EARTH_HAZE": _earth_haze,
        "MARS_A": _mars_a,
        "MARS_MIE": _mars_mie,
    }
    return atmospheres[name.split("_", 1)[1] if name.startswith(_PREFIXES) else name]()


def rayleigh(theta: Array) -> Array:
    """Rayleigh's phase function without depolarisation. [sr^-1]"""
    return 3.0 / (16.0 * np.pi) * (1.0 + np.cos(theta) ** 2)


def henyey_greenstein(theta: Array, g: float) -> Array:
    """Henyey & Greenstein (1941). [sr^-1]"""
    return (1.0 - g * g) / (4.0 * np.pi * (1.0 + g * g - 2.0 * g * np.cos(theta)) ** 1.5)


def cornette_shanks(theta: Array, g: float) -> Array:
    """Cornette & Shanks (1992), eq. 8. [sr^-1]"""
    scale = 1.5 * (1.0 + np.cos(theta) ** 2) / (2.0 + g * g)
    return scale * henyey_greenstein(theta, g)


@functools.cache
def _load(pattern: str) -> np.ndarray:
    paths = sorted(TRUTH_FOLDER.glob(pattern))
    if not paths:
        msg = f"{TRUTH_FOLDER}: no table matches {pattern}"
        raise FileNotFoundError(msg)
    return np.concatenate([_load_table(path) for path in paths])


def _load_table(path: Path) -> np.ndarray:
    columns = path.read_text().split("\n", 1)[0].split(",")
    numeric = [i for i, name in enumerate(columns) if name not in ("atmosphere", "phase")]
    rows = np.genfromtxt(path, delimiter=",", skip_header=1, usecols=numeric)
    names = [_SHORT_NAMES.get(columns[i], columns[i]) for i in numeric]
    return np.rec.fromarrays(rows.T, names=names).view(np.ndarray)


def _altitudes(radius: float) -> Array:
    return altitude_nodes(radius, radius + 100.0)


def _coefficient_of(optical_depth: Array, scale_height: float) -> Array:
    """Coefficient at the ground of an exponential profile with that vertical optical depth."""
    return optical_depth / (scale_height * -np.expm1(-100.0 / scale_height))


def _medium(
    radius: float,
    densities: list[Array],
    scattering: list[Array],
    extinction: list[Array],
    phases: list[list[Array]],
    ground_albedo: Array,
) -> Medium:
    """Stack the constituents' arrays; `phases` is [constituent][wavelength]."""
    return Medium(
        r_bottom=radius,
        r_top=radius + 100.0,
        density=np.stack(densities, axis=1),
        scattering=np.stack(scattering),
        extinction=np.stack(extinction),
        phase=np.stack([np.stack(phase, axis=1) for phase in phases]),
        ground_albedo=ground_albedo,
    )


def _earth(
    aerosol_height: float,
    aerosol_scattering: Array,
    aerosol_extinction: Array,
    aerosol_phase: Array,
    ground_albedo: Array,
) -> Medium:
    h = _altitudes(6360.0)
    theta = scattering_angles()
    rayleigh_scattering = np.array([5.802e-3, 13.558e-3, 33.1e-3])
    ozone_absorption = np.array([0.650e-3, 1.881e-3, 0.085e-3])
    isotropic = np.full_like(theta, 0.25 / np.pi)
    return _medium(
        radius=6360.0,
        densities=[
            np.exp(-h / 8.0),
            np.exp(-h / aerosol_height),
            np.maximum(0.0, 1.0 - np.abs(h - 25.0) / 15.0),
        ],
        scattering=[rayleigh_scattering, aerosol_scattering, np.zeros(3)],
        extinction=[rayleigh_scattering, aerosol_extinction, ozone_absorption],
        phases=[[rayleigh(theta)] * 3, [aerosol_phase] * 3, [isotropic] * 3],
        ground_albedo=ground_albedo,
    )


def _earth_a() -> Medium:
    return _earth(
        aerosol_height=1.2,
        aerosol_scattering=np.full(3, 3.996e-3),
        aerosol_extinction=np.full(3, 4.440e-3),
        aerosol_phase=cornette_shanks(scattering_angles(), 0.8),
        ground_albedo=np.full(3, 0.3),
    )


def _earth_haze() -> Medium:
    extinction = _coefficient_of(0.25 * (TRUTH_WAVELENGTHS / 550.0) ** -1.3, 1.5)
    return _earth(
        aerosol_height=1.5,
        aerosol_scattering=0.93 * extinction,
        aerosol_extinction=extinction,
        aerosol_phase=henyey_greenstein(scattering_angles(), 0.70),
        ground_albedo=np.full(3, 0.2),
    )


def _mars_a() -> Medium:
    h = _altitudes(3389.5)
    theta = scattering_angles()
    rayleigh_scattering = np.array([9.921e-5, 2.3588e-4, 5.9252e-4])
    dust_extinction = _coefficient_of(np.full(3, 0.5), 11.1)
    return _medium(
        radius=3389.5,
        densities=[np.exp(-h / 11.1)] * 2,
        scattering=[rayleigh_scattering, np.array([0.97, 0.89, 0.68]) * dust_extinction],
        extinction=[rayleigh_scattering, dust_extinction],
        phases=[
            [rayleigh(theta)] * 3,
            [henyey_greenstein(theta, g) for g in (0.70, 0.74, 0.80)],
        ],
        ground_albedo=np.array([0.28, 0.16, 0.06]),
    )


def _mars_mie() -> Medium:
    grey = _mars_a()
    table = np.genfromtxt(TRUTH_FOLDER / "mars_dust_mie_phase.csv", delimiter=",", skip_header=1)
    mu, cosine = np.cos(scattering_angles()), np.cos(np.radians(table[:, 0]))
    dust = np.stack([np.interp(-mu, -cosine, each) for each in table[:, 1:].T], axis=1)
    dust /= 2.0 * np.pi * np.trapezoid(dust, -mu, axis=0)
    scattering = grey.scattering.copy()
    scattering[1] = np.array([0.9720, 0.8980, 0.7884]) * grey.extinction[1]
    return grey._replace(scattering=scattering, phase=np.stack([grey.phase[0], dust]))
