"""Computes skybake/data/mars_dust.csv and mars_dust_phase.csv; needs miepython, takes minutes.

Spheres describe how much of the light Martian dust takes and how its forward lobe looks,
for that lobe is diffraction. Its grains are irregular, so the sides and the back of the
phase function are twice as bright as those of spheres and have no glory: there the double
Henyey-Greenstein function holds that Curiosity's sky surveys gave.
"""

import csv
from pathlib import Path

import miepython
import numpy as np

HERE = Path(__file__).resolve().parent
DATA = HERE.parents[1] / "skybake" / "data"

# Wolff et al. (2009), J. Geophys. Res. 114, E00D04; Hansen & Travis (1974) gamma distribution.
EFFECTIVE_RADIUS = 1.5  # um
EFFECTIVE_VARIANCE = 0.3

# Chen-Chen, Perez-Hoyos & Sanchez-Lavega (2019), Icarus 330, 16: double Henyey-Greenstein.
FIRST_ASYMMETRY = 0.889
SECOND_ASYMMETRY = 0.094
# The first lobe's weight follows the mean cosine of irregular grains, by T-matrix.
ASYMMETRY_WAVELENGTHS = (440.0, 550.0, 680.0)
ASYMMETRY = (0.766, 0.693, 0.700)

# Between these angles [deg] one description fades into the other.
SPHERES_BELOW, MEASURED_ABOVE = 15.0, 30.0

WAVELENGTHS = np.append(np.arange(360.0, 821.0, 20.0), 830.0)
ANGLES = np.concatenate(
    [
        np.arange(0.0, 2.0, 0.1),
        np.arange(2.0, 10.0, 0.25),
        np.arange(10.0, 30.0, 0.5),
        np.arange(30.0, 181.0, 2.0),
    ]
)


def mie_dust(wavelength, angles, refractive_index):
    """Extinction per geometric cross-section, single scattering albedo, phase function."""
    radius = np.geomspace(0.02, 20.0, 500)
    exponent = (1.0 - 3.0 * EFFECTIVE_VARIANCE) / EFFECTIVE_VARIANCE
    number = radius**exponent * np.exp(-radius / (EFFECTIVE_RADIUS * EFFECTIVE_VARIANCE))
    # Steps are even in log(radius), hence the third power; at both ends the integrand vanishes.
    weight = number * radius**3
    size = 2e3 * np.pi * radius / wavelength
    extinction, scattering, _, _ = miepython.efficiencies_mx(refractive_index, size)
    mu = np.cos(np.radians(angles))
    phase = sum(
        w * miepython.i_unpolarized(refractive_index, x, mu, norm="one")
        for w, x in zip(weight * scattering, size, strict=True)
    )
    phase /= np.sum(weight * scattering)
    total = np.sum(weight * extinction)
    return total / np.sum(weight), np.sum(weight * scattering) / total, phase


def measured_phase(wavelength, angles):
    """Double Henyey-Greenstein function."""
    asymmetry = np.interp(wavelength, ASYMMETRY_WAVELENGTHS, ASYMMETRY)
    first = (asymmetry - SECOND_ASYMMETRY) / (FIRST_ASYMMETRY - SECOND_ASYMMETRY)
    mu = np.cos(np.radians(angles))
    lobes = [
        (1.0 - g**2) / (4.0 * np.pi * (1.0 + g**2 - 2.0 * g * mu) ** 1.5)
        for g in (FIRST_ASYMMETRY, SECOND_ASYMMETRY)
    ]
    return first * lobes[0] + (1.0 - first) * lobes[1]


def blend(spheres, measured, angles):
    """Fade between both in the logarithm and normalise over the sphere."""
    t = np.clip((angles - SPHERES_BELOW) / (MEASURED_ABOVE - SPHERES_BELOW), 0.0, 1.0)
    fade = t * t * (3.0 - 2.0 * t)
    phase = np.exp((1.0 - fade) * np.log(spheres) + fade * np.log(measured))
    fine = np.concatenate([np.linspace(0.0, 30.0, 30001), np.linspace(30.0, 180.0, 15001)[1:]])
    values = np.exp(np.interp(fine, angles, np.log(phase)))
    half = np.sin(np.radians(fine) / 2.0) ** 2
    return phase / (4.0 * np.pi * np.trapezoid(values, half))


def write(name, header, columns, rows):
    """Write a CSV table under skybake/data."""
    lines = [*(f"# {line}" for line in header), ",".join(columns), *map(",".join, rows)]
    (DATA / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def main():
    """Write both tables."""
    with (HERE / "mars_dust_refractive_index.csv").open(encoding="utf-8") as file:
        rows = csv.reader(line for line in file if not line.startswith("#"))
        next(rows)
        nodes, real, imaginary = np.array([[float(cell) for cell in row] for row in rows]).T
    extinction, albedo, phases = [], [], []
    for wavelength in WAVELENGTHS:
        index = complex(
            np.interp(wavelength, nodes, real), -np.interp(wavelength, nodes, imaginary)
        )
        one_extinction, one_albedo, spheres = mie_dust(wavelength, ANGLES, index)
        extinction.append(one_extinction)
        albedo.append(one_albedo)
        phases.append(blend(spheres, measured_phase(wavelength, ANGLES), ANGLES))
        print(f"{wavelength:.0f} nm: {one_extinction:.4f} {one_albedo:.4f}")
    relative = np.array(extinction) / np.interp(550.0, WAVELENGTHS, extinction)
    origin = [
        "Spheres with the refractive indices of Wolff et al. (2009), J. Geophys. Res. 114,",
        "E00D04; gamma distribution, effective radius 1.5 um, effective variance 0.3.",
        "Computed by docs/derivations/mars_dust.py. Licence: this project's own.",
    ]
    write(
        "mars_dust.csv",
        ["Martian dust: extinction relative to 550 nm and single scattering albedo.", *origin],
        ["wavelength_nm", "relative_extinction", "single_scattering_albedo"],
        [
            (f"{w:.0f}", f"{e:.4f}", f"{a:.4f}")
            for w, e, a in zip(WAVELENGTHS, relative, albedo, strict=True)
        ],
    )
    write(
        "mars_dust_phase.csv",
        [
            "Martian dust: phase function [per sr], its integral over the sphere 1; columns are",
            "named by wavelength [nm]. Below 15 deg that of spheres, above 30 deg the double",
            "Henyey-Greenstein function of Chen-Chen et al. (2019), Icarus 330, 16.",
            *origin,
        ],
        ["angle_deg", *(f"{w:.0f}" for w in WAVELENGTHS)],
        [
            (f"{angle:g}", *(f"{value:.4g}" for value in row))
            for angle, row in zip(ANGLES, np.transpose(phases), strict=True)
        ],
    )


if __name__ == "__main__":
    main()
