"""Computes the tables of Titan's haze in skybake/data; see mie.py.

Its particles are aggregates of some thousand spheres of tholin. Tomasko et al. (2008), Planet.
Space Sci. 56, 669, appendix A, give the light that they scatter: each sphere's by Mie theory, times
the interference of all of them by their distances, and a little that one sphere sends to another.
Their formulae were fitted to aggregates of up to 1024 spheres; they used them, too, for more. Read
from titan-aerosols 0.4.0, with M0 = |(m^2 - 1) / (m^2 + 2)|.
"""

import miepython
import numpy as np
from mie import WAVELENGTHS, mean_cosine, normalise, read_columns, write, write_phase

MONOMERS = 3000
MONOMER_RADIUS = 50.0  # nm

# Tomasko et al. (2008), table A2: pair distances in radii of a monomer, fractal dimension 2.
DISTANCE_CUT, FIRST_RADIUS, SECOND_RADIUS, RADIUS_CUT = 3.194, 1.598, 3.478, 1e4
EXCHANGE_FACTOR, EXCHANGE_EXPONENT = 1.12, 0.529

# Mean cosines of the phase functions that Huygens' light was fitted with, table 1 of that paper,
# lie between 0.729 and 0.799 from 360 to 830 nm, and are at most 0.783 up to 600 nm, where it has
# one table for all altitudes; they are taken to rise. The formulae give 0.83 in the blue and 0.79
# in the red. What is missing in the blue, where light is scattered more than once within an
# aggregate, is taken as isotropic.
ASYMMETRY_WAVELENGTHS = (360.0, 600.0, 713.0)
ASYMMETRY = (0.729, 0.783, 0.799)

# Doose et al. (2016), Icarus 270, 355: single scattering albedo above 200 km, read off Barnes et
# al. (2018), Astron. J. 156, 247, figure 4. It begins at 500 nm.
ALBEDO_WAVELENGTHS = (500.0, 550.0, 600.0, 650.0, 700.0, 750.0, 800.0, 830.0)
ALBEDO_ALOFT = (0.8438, 0.8773, 0.9012, 0.9173, 0.9285, 0.9339, 0.9356, 0.9348)
# Above 80 km the haze falls off over 65 km (Tomasko et al. 2008).
SCALE_HEIGHT = 65.0

ANGLES = np.concatenate(
    [
        np.arange(0.0, 2.0, 0.1),
        np.arange(2.0, 10.0, 0.25),
        np.arange(10.0, 30.0, 0.5),
        np.arange(30.0, 181.0, 2.0),
    ]
)


def pair_distances():
    """Distances between monomers in radii of one, and the share of pairs at each."""
    greatest = FIRST_RADIUS * np.sqrt(MONOMERS * np.log(RADIUS_CUT))
    distance = np.arange(2.0, greatest, 0.125)
    within = (1.0 - np.exp(-((distance / FIRST_RADIUS) ** 2) / MONOMERS)) * (
        1.0 - np.exp(-((distance / SECOND_RADIUS) ** DISTANCE_CUT))
    )
    within = (within + 2.0 / MONOMERS) / (1.0 + 2.0 / MONOMERS)
    share = np.zeros_like(distance)
    share[0] = within[0]
    share[1:-1] = 0.5 * (within[2:] - within[:-2])
    return distance, share


def _coherent(size, angles):
    """Light of all monomers together over that of one, by their distances."""
    distance, share = pair_distances()
    twice_sine = 2.0 * np.sin(np.radians(angles) / 2.0)
    pairs = np.sinc(np.multiply.outer(twice_sine, distance * size) / np.pi) @ share
    return pairs * (MONOMERS**2 - MONOMERS) + MONOMERS


def aggregate(wavelength, angles):
    """Phase function of aggregates by the formulae, not normalised."""
    rows = read_columns("titan_tholin_refractive_index.csv")
    nodes, real, imaginary = np.array([[float(x) for x in row.values()] for row in rows]).T
    index = complex(np.interp(wavelength, nodes, real), -np.interp(wavelength, nodes, imaginary))
    size = 2.0 * np.pi * MONOMER_RADIUS / wavelength
    _, scattering, _, _ = miepython.efficiencies_mx(index, np.array([size]))
    distance, share = pair_distances()
    distance = distance * size
    coherent = _coherent(size, angles)
    monomer = miepython.i_unpolarized(index, size, np.cos(np.radians(angles)), norm="one")
    phase = coherent * monomer
    depth = np.sum(share / distance**2) * (MONOMERS - 1) / 4.0 * scattering[0] * size**2
    polarisability = abs((index**2 - 1.0) / (index**2 + 2.0))
    exchange = EXCHANGE_FACTOR * polarisability * depth**EXCHANGE_EXPONENT
    return phase + exchange * (1.0 - exchange) * np.interp(90.0, angles, phase)


def haze_phase(wavelength):
    """Phase function of the haze, whose mean cosine is at most `ASYMMETRY`."""
    phase = normalise(aggregate(wavelength, ANGLES), ANGLES)
    wanted = np.interp(wavelength, ASYMMETRY_WAVELENGTHS, ASYMMETRY)
    isotropic = max(1.0 - wanted / mean_cosine(phase, ANGLES), 0.0)
    print(f"{wavelength:.0f} nm: isotropic {isotropic:.3f}", flush=True)
    return normalise((1.0 - isotropic) * phase + isotropic / (4.0 * np.pi), ANGLES)


def polarised_share(wavelength, angles):
    """Share at angles of the light that is polarised as a monomer's."""
    rows = read_columns("titan_tholin_refractive_index.csv")
    nodes, real, imaginary = np.array([[float(x) for x in row.values()] for row in rows]).T
    index = complex(np.interp(wavelength, nodes, real), -np.interp(wavelength, nodes, imaginary))
    size = 2.0 * np.pi * MONOMER_RADIUS / wavelength
    monomer = miepython.i_unpolarized(index, size, np.cos(np.radians(angles)), norm="one")
    total = np.exp(np.interp(angles, ANGLES, np.log(haze_phase(wavelength))))
    polarised = monomer * _coherent(size, angles)
    # All of what is scattered forward is coherent.
    return polarised / polarised[0] * total[0] / total


def albedos():
    """Single scattering albedo below 80 km, and the mean of what lies above."""
    aloft = np.interp(WAVELENGTHS, ALBEDO_WAVELENGTHS, ALBEDO_ALOFT)
    # A guess: the parabola through the first three values.
    parabola = np.polyfit(ALBEDO_WAVELENGTHS[:3], ALBEDO_ALOFT[:3], 2)
    aloft = np.where(WAVELENGTHS < 500.0, np.polyval(parabola, WAVELENGTHS), aloft)
    # The rule of Doose et al. (2016), as Es-sayeh et al. (2023), Planet. Sci. J. 4, 44, give it.
    below = np.minimum((0.565 + aloft) / 1.5, 1.0)
    # From 80 to 200 km one changes into the other evenly.
    height = np.linspace(0.0, 220.0, 2201)
    haze = np.exp(-height / SCALE_HEIGHT)
    share = np.sum(haze * np.minimum(height / 120.0, 1.0)) / np.sum(haze)
    return below, (1.0 - share) * below + share * aloft


def main():
    """Write the tables."""
    origin = [
        "Doose et al. (2016), Icarus 270, 355, read off Barnes et al. (2018), Astron. J. 156, 247,",
        "figure 4; below 500 nm a guess, the parabola through 500, 550 and 600 nm.",
        "Computed by docs/derivations/titan_haze.py. Licence: published facts; cite the papers.",
    ]
    below, above = albedos()
    for name, where, values in (
        ("titan_haze", "below 80 km", below),
        ("titan_upper_haze", "above 80 km, its mean", above),
    ):
        write(
            f"{name}.csv",
            [f"Single scattering albedo of Titan's haze {where}.", *origin],
            ["wavelength_nm", "single_scattering_albedo"],
            [(f"{w:.0f}", f"{a:.4f}") for w, a in zip(WAVELENGTHS, values, strict=True)],
        )
    write_phase(
        "titan_haze_phase.csv",
        [
            "Titan's haze: phase function [per sr], columns by wavelength [nm].",
            "Aggregates of 3000 spheres of tholin of 0.05 um: Tomasko et al. (2008), Planet. Space",
            "Sci. 56, 669, appendix A; an isotropic part for mean cosines as in its table 1.",
            "Computed by docs/derivations/titan_haze.py. Licence: this project's own.",
        ],
        ANGLES,
        [haze_phase(w) for w in WAVELENGTHS],
    )


if __name__ == "__main__":
    main()
