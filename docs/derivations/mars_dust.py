"""Computes skybake/data/mars_dust.csv and mars_dust_phase.csv; see mie.py.

Spheres describe how much of the light Martian dust takes and how its forward lobe looks,
for that lobe is diffraction. Its grains are irregular, so the sides and the back of the
phase function are up to twice as bright as those of spheres and have no glory. Curiosity's
sky surveys measured how bright, at 650 nm. The colour of the sides is that of spheres, for
it stems from absorption within a grain, which depends little on its shape.
"""

import numpy as np
from mie import (
    BEYOND_EYE,
    gamma_distribution,
    normalise,
    read_columns,
    scatter,
    write,
    write_phase,
)

# Wolff et al. (2009), J. Geophys. Res. 114, E00D04; Hansen & Travis (1974) gamma distribution.
EFFECTIVE_RADIUS = 1.5  # um
EFFECTIVE_VARIANCE = 0.3
RADIUS = np.geomspace(0.02, 20.0, 500)

# Chen-Chen, Perez-Hoyos & Sanchez-Lavega (2019), Icarus 330, 16: double Henyey-Greenstein.
MEASURED_WAVELENGTH = 650.0
FIRST_ASYMMETRY = 0.889
SECOND_ASYMMETRY = 0.094
# They give 0.743 +- 0.106; this much brings the mean cosines of all wavelengths within 0.03 of
# those that the T-matrix method gives for irregular grains.
FIRST_FRACTION = 0.75

# Between these angles [deg] one description fades into the other; they cross at 20.
SPHERES_BELOW, MEASURED_ABOVE = 16.0, 26.0
SMOOTHING = 20  # half width of the mean that takes glories out of the colour [deg]

ANGLES = np.concatenate(
    [
        np.arange(0.0, 2.0, 0.1),
        np.arange(2.0, 10.0, 0.25),
        np.arange(10.0, 30.0, 0.5),
        np.arange(30.0, 181.0, 2.0),
    ]
)


def spheres(wavelength):
    """Extinction per geometric cross-section, single scattering albedo, phase function."""
    rows = read_columns("mars_dust_refractive_index.csv")
    nodes, real, imaginary = np.array([[float(x) for x in row.values()] for row in rows]).T
    index = complex(np.interp(wavelength, nodes, real), -np.interp(wavelength, nodes, imaginary))
    number = gamma_distribution(EFFECTIVE_RADIUS, EFFECTIVE_VARIANCE, RADIUS)
    extinction, scattering, phase = scatter(RADIUS, number, index, wavelength, ANGLES)
    return extinction, scattering / extinction, phase


def measured_phase():
    """Double Henyey-Greenstein function at `MEASURED_WAVELENGTH`."""
    mu = np.cos(np.radians(ANGLES))
    lobes = [
        (1.0 - g**2) / (4.0 * np.pi * (1.0 + g**2 - 2.0 * g * mu) ** 1.5)
        for g in (FIRST_ASYMMETRY, SECOND_ASYMMETRY)
    ]
    return FIRST_FRACTION * lobes[0] + (1.0 - FIRST_FRACTION) * lobes[1]


def colour(phase, reference):
    """Ratio of two phase functions of spheres, smooth over angle."""
    degrees = np.arange(-SMOOTHING, 181 + SMOOTHING)
    mirrored = 180.0 - np.abs(180.0 - np.abs(degrees))
    ratio = np.interp(mirrored, ANGLES, np.log(phase / reference))
    window = 2 * SMOOTHING + 1
    mean = np.convolve(ratio, np.full(window, 1.0 / window), mode="valid")
    return np.exp(np.interp(ANGLES, np.arange(181), mean))


def blend(phase, sides):
    """Fade from the forward lobe to the sides in the logarithm, and normalise."""
    t = np.clip((ANGLES - SPHERES_BELOW) / (MEASURED_ABOVE - SPHERES_BELOW), 0.0, 1.0)
    fade = t * t * (3.0 - 2.0 * t)
    return normalise(phase ** (1.0 - fade) * sides**fade, ANGLES)


def main():
    """Write both tables."""
    _, _, reference = spheres(MEASURED_WAVELENGTH)
    extinction, albedo, phases = zip(*(spheres(w) for w in BEYOND_EYE), strict=True)
    relative = np.array(extinction) / np.interp(550.0, BEYOND_EYE, extinction)
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
            for w, e, a in zip(BEYOND_EYE, relative, albedo, strict=True)
        ],
    )
    write_phase(
        "mars_dust_phase.csv",
        [
            "Martian dust: phase function [per sr], its integral over the sphere 1; columns are",
            "named by wavelength [nm]. Below 16 deg that of spheres, above 26 deg the double",
            "Henyey-Greenstein function of Chen-Chen et al. (2019), Icarus 330, 16, at 650 nm in",
            "the colour of spheres.",
            *origin,
        ],
        ANGLES,
        [blend(phase, measured_phase() * colour(phase, reference)) for phase in phases],
        BEYOND_EYE,
    )


if __name__ == "__main__":
    main()
