"""Light that clouds of spheres scatter, and the files in which it is kept; needs miepython.

Set MIEPYTHON_USE_JIT=1 before Python starts, or it takes an hour instead of minutes.
"""

import csv
from pathlib import Path

import miepython
import numpy as np

HERE = Path(__file__).resolve().parent
DATA = HERE.parents[1] / "skybake" / "data"

WAVELENGTHS = np.append(np.arange(360.0, 821.0, 20.0), 830.0)

BEYOND_EYE = np.concatenate([[350.0], WAVELENGTHS, np.arange(850.0, 1001.0, 50.0)])
"""Where refractive indices are known beyond what the eye sees."""


def gamma_distribution(effective_radius, effective_variance, radius):
    """Relative number of particles in equal steps of radius: Hansen & Travis (1974), eq. 2.56."""
    exponent = (1.0 - 3.0 * effective_variance) / effective_variance
    scaled = radius / effective_radius
    return scaled**exponent * np.exp(-scaled / effective_variance)


def lognormal_distribution(mode_radius, geometric_deviation, radius):
    """Particles in equal steps of radius, one in all; the mode is that of dN / d(ln r)."""
    width = np.log(geometric_deviation)
    exponent = np.log(radius / mode_radius) / width
    return np.exp(-0.5 * exponent**2) / (np.sqrt(2.0 * np.pi) * width * radius)


def scatter(radius, number, refractive_index, wavelength, angles):
    """Cross-sections and phase function of spheres.

    Parameters
    ----------
    radius, number : ndarray, shape (size,)
        Radii in even steps of their logarithm [um], and particles in equal steps of
        radius [um⁻¹]; both ends of the integrand should vanish.
    refractive_index : complex
        Its imaginary part is negative.
    wavelength, angles : float, ndarray
        [nm], [deg]

    Returns
    -------
    extinction, scattering : float
        Mean cross-sections. [um²]
    phase : ndarray, shape of `angles`
        [sr⁻¹]
    """
    step = np.log(radius[1] / radius[0])
    weight = np.pi * radius**3 * number * step
    size = 2e3 * np.pi * radius / wavelength
    extinction, scattering, _, _ = miepython.efficiencies_mx(refractive_index, size)
    mu = np.cos(np.radians(angles))
    phase = sum(
        w * miepython.i_unpolarized(refractive_index, x, mu, norm="one")
        for w, x in zip(weight * scattering, size, strict=True)
    )
    total = np.sum(weight * scattering)
    return np.sum(weight * extinction), total, phase / total


def normalise(phase, angles):
    """Scale a table whose logarithm is linear between its angles to integrate to 1."""
    return phase / _integrate(phase, angles, 1.0)


def mean_cosine(phase, angles):
    """Asymmetry of a normalised table."""
    fine = _fine_angles()
    return _integrate(phase, angles, np.cos(np.radians(fine)))


def read_columns(name):
    """Columns of a CSV table beside this file, as text."""
    with (HERE / name).open(encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def write(name, header, columns, rows):
    """Write a CSV table under skybake/data."""
    lines = [*(f"# {line}" for line in header), ",".join(columns), *map(",".join, rows)]
    (DATA / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_phase(name, header, angles, phases, wavelengths=WAVELENGTHS):
    """Write phase functions, shape (wavelength, angle)."""
    write(
        name,
        header,
        ["angle_deg", *(f"{w:.0f}" for w in wavelengths)],
        [
            (f"{angle:g}", *(f"{value:.5g}" for value in row))
            for angle, row in zip(angles, np.transpose(phases), strict=True)
        ],
    )


def _fine_angles():
    return np.concatenate([np.linspace(0.0, 30.0, 30001), np.linspace(30.0, 180.0, 15001)[1:]])


def _integrate(phase, angles, factor):
    fine = _fine_angles()
    values = factor * np.exp(np.interp(fine, angles, np.log(phase)))
    half = np.sin(np.radians(fine) / 2.0) ** 2
    return 4.0 * np.pi * np.trapezoid(values, half)
