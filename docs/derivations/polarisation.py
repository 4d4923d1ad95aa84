"""Computes the tables of polarisation in skybake/data: P12 / P11 and P33 / P11; see mie.py.

The particles are those of aerosols.py and titan_haze.py. Martian dust has no such table: its grains
are irregular, and spheres polarise quite differently.
"""

import sys

import aerosols
import miepython
import numpy as np
import titan_haze
from mie import gamma_distribution, lognormal_distribution, read_columns, write

WAVELENGTHS = (360.0, 440.0, 550.0, 680.0, 830.0)
BEYOND_EYE = (350.0, *WAVELENGTHS, 1000.0)
ANGLES = np.concatenate([np.arange(0.0, 130.0, 2.0), np.arange(130.0, 180.1, 1.0)])
MU = np.cos(np.radians(ANGLES))


def sphere(index, size):
    """|S1|², |S2|² and Re S1 S2* of a sphere at `ANGLES`, shape (3, angle)."""
    across, along = miepython.S1_S2(index, size, MU, norm="bohren")
    return np.array([abs(across) ** 2, abs(along) ** 2, np.real(across * np.conj(along))])


def spheres(radius, number, index, wavelength):
    """P11, P12 and P33 of one particle, of a common norm, shape (3, angle)."""
    weight = radius * number * np.log(radius[1] / radius[0]) * wavelength**2
    sizes = 2e3 * np.pi * radius / wavelength
    across, along, mixed = sum(
        w * sphere(index, size) for w, size in zip(weight, sizes, strict=True)
    )
    return np.array([0.5 * (across + along), 0.5 * (along - across), mixed])


def component(part, wavelength):
    """Matrix of one particle of a component of aerosols.py."""
    width = np.log(part.deviation)
    low = max(part.limits[0], part.mode * np.exp(-3.5 * width))
    high = min(part.limits[1], part.mode * np.exp(6.0 * width**2 + 3.5 * width))
    radius = np.geomspace(low, high, aerosols.RADII)
    index = complex(
        np.interp(wavelength, part.nodes, part.real),
        -np.interp(wavelength, part.nodes, part.imaginary),
    )
    number = lognormal_distribution(part.mode, part.deviation, radius)
    return spheres(radius, number, index, wavelength)


def mixture(name, mineral_absorption=1.0):
    """Matrices of a mixture at `BEYOND_EYE`."""
    components = {key: aerosols.Component(key) for key in aerosols.MIXTURES[name]}
    for key, part in components.items():
        if key.startswith("mineral"):
            part.imaginary = [mineral_absorption * value for value in part.imaginary]
    counts = aerosols.MIXTURES[name]
    return [
        sum(counts[key] * component(part, w) for key, part in components.items())
        for w in BEYOND_EYE
    ]


def volcanic():
    """Matrices of droplets as they were a year after Pinatubo."""
    acid = aerosols.Component("sulfate")
    acid.deviation = aerosols.VOLCANIC_DEVIATION
    acid.mode = aerosols.VOLCANIC_EFFECTIVE_RADIUS * np.exp(-2.5 * np.log(acid.deviation) ** 2)
    return [component(acid, w) for w in BEYOND_EYE]


def venus():
    """Matrices of the droplets of Venus' cloud tops."""
    radius = np.geomspace(0.2, 4.0, aerosols.RADII)
    number = gamma_distribution(
        aerosols.VENUS_EFFECTIVE_RADIUS, aerosols.VENUS_EFFECTIVE_VARIANCE, radius
    )
    index = aerosols.VENUS_WAVELENGTHS, aerosols.VENUS_REFRACTIVE_INDEX
    return [spheres(radius, number, complex(np.interp(w, *index)), w) for w in WAVELENGTHS]


def titan():
    """Matrices of Titan's aggregates: those of a monomer, thinned by light without polarisation.

    What one sphere sends to another, and what is taken as isotropic, is not polarised.
    """
    rows = read_columns("titan_tholin_refractive_index.csv")
    nodes, real, imaginary = np.array([[float(x) for x in row.values()] for row in rows]).T
    matrices = []
    for w in WAVELENGTHS:
        index = complex(np.interp(w, nodes, real), -np.interp(w, nodes, imaginary))
        across, along, mixed = sphere(index, 2.0 * np.pi * titan_haze.MONOMER_RADIUS / w)
        polarised = titan_haze.polarised_share(w, ANGLES)
        whole = 0.5 * (across + along)
        matrices.append([whole, 0.5 * (along - across) * polarised, mixed * polarised])
    return matrices


def write_ratios(name, title, matrices):
    """Write the ratios of matrices."""
    columns, values = ["angle_deg"], [ANGLES]
    wavelengths = WAVELENGTHS if len(matrices) == len(WAVELENGTHS) else BEYOND_EYE
    for wavelength, (p11, p12, p33) in zip(wavelengths, matrices, strict=True):
        columns += [f"p12_{wavelength:.0f}", f"p33_{wavelength:.0f}"]
        values += [p12 / p11, p33 / p11]
    write(
        f"{name}_polarisation.csv",
        [
            f"{title}: elements P12 and P33 of the scattering matrix over P11, by wavelength [nm].",
            f"The particles are those of {name}_phase.csv; P12 below 0 polarises across the plane",
            "of scattering. Computed by docs/derivations/polarisation.py. Licence: this project's",
            "own.",
        ],
        columns,
        [(f"{row[0]:g}", *(f"{value:.4f}" for value in row[1:])) for row in np.transpose(values)],
    )
    print(name, flush=True)


def main(names):
    """Write the named tables, or all."""
    works = {
        f"opac_{key}": (title, lambda key=key: mixture(key))
        for key, title in aerosols.TITLES.items()
    }
    works["desert_dust"] = "Desert dust", lambda: mixture("desert", aerosols.DESERT_ABSORPTION)
    works["volcanic"] = "Volcanic stratospheric aerosol", volcanic
    works["venus_cloud"] = "Cloud tops of Venus", venus
    works["titan_haze"] = "Titan's haze", titan
    for name, (title, work) in works.items():
        if not names or name in names:
            write_ratios(name, title, work())


if __name__ == "__main__":
    main(sys.argv[1:])
