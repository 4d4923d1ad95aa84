"""Computes the tables of terrestrial and Venusian aerosols in skybake/data; see mie.py.

Components, their number in a mixture and their refractive indices are those of Hess, Koepke &
Schult (1998), Optical Properties of Aerosols and Clouds, Bull. Amer. Meteor. Soc. 79, 831, tables
1 and 4, at 80 % relative humidity. Mineral grains are taken as spheres, too.
"""

import sys

import numpy as np
from mie import (
    BEYOND_EYE,
    WAVELENGTHS,
    gamma_distribution,
    lognormal_distribution,
    mean_cosine,
    normalise,
    read_columns,
    scatter,
    write,
    write_phase,
)

ANGLES = np.concatenate(
    [
        np.arange(0.0, 0.5, 0.02),
        np.arange(0.5, 2.0, 0.05),
        np.arange(2.0, 10.0, 0.25),
        np.arange(10.0, 30.0, 0.5),
        np.arange(30.0, 130.0, 2.0),
        # Rainbow and glory.
        np.arange(130.0, 180.1, 1.0),
    ]
)
RADII = 400

# Particles per cm3, Hess et al. (1998), table 4.
MIXTURES = {
    "continental_clean": {"water_soluble": 2600.0, "insoluble": 0.15},
    "continental_average": {"water_soluble": 7000.0, "insoluble": 0.4, "soot": 8300.0},
    "continental_polluted": {"water_soluble": 15700.0, "insoluble": 0.6, "soot": 34300.0},
    "urban": {"water_soluble": 28000.0, "insoluble": 1.5, "soot": 130000.0},
    "desert": {
        "water_soluble": 2000.0,
        "mineral_nucleation": 269.5,
        "mineral_accumulation": 30.5,
        "mineral_coarse": 0.142,
    },
    "maritime_clean": {
        "water_soluble": 1500.0,
        "sea_salt_accumulation": 20.0,
        "sea_salt_coarse": 3.2e-3,
    },
    "stratospheric": {"sulfate": 1.0},
}

# OPAC's minerals absorb more than those of deserts: AERONET has a single scattering albedo of 0.946
# at 550 nm over the Sahara and Arabia (Kim et al. 2011, Atmos. Chem. Phys. Discuss. 11, 20181),
# OPAC 0.888. This factor of the imaginary index of its minerals brings one to the other.
DESERT_ABSORPTION = 0.36

# Droplets of 75 % sulphuric acid a year after Pinatubo: effective radius 0.5 um (Russell et al.
# 1996, J. Geophys. Res. 101, 18745), one mode of the width that balloons counted in 1992
# (Deshler et al. 1993, Geophys. Res. Lett. 20, 1435: 1.3 to 1.6).
VOLCANIC_EFFECTIVE_RADIUS = 0.5
VOLCANIC_DEVIATION = 1.5

# Hansen & Hovenier (1974), J. Atmos. Sci. 31, 1137: from the polarisation of Venus.
VENUS_EFFECTIVE_RADIUS = 1.05
VENUS_EFFECTIVE_VARIANCE = 0.07
VENUS_WAVELENGTHS = (365.0, 550.0, 990.0)
VENUS_REFRACTIVE_INDEX = (1.46, 1.44, 1.43)
# What of the light survives a scattering: Titov et al. (2018), Space Sci. Rev. 214, 126, held
# beyond 655 nm. Below 445 nm what is absorbed follows the band of the cloud's absorber, about 340
# nm and 140 nm wide at half its height: Perez-Hoyos et al. (2018), J. Geophys. Res. Planets 123,
# 145.
VENUS_ALBEDO_WAVELENGTHS = (360.0, 380.0, 400.0, 420.0, 445.0, 550.0, 655.0, 830.0)
VENUS_ALBEDO = (0.9776, 0.9811, 0.9857, 0.9903, 0.9950, 0.99897, 0.99930, 0.99930)


class Component:
    """A lognormal kind of particle and its refractive index."""

    def __init__(self, name):
        (sizes,) = (row for row in read_columns("opac_components.csv") if row["component"] == name)
        self.mode = float(sizes["mode_radius_um"])
        self.deviation = float(sizes["geometric_standard_deviation"])
        self.limits = float(sizes["least_radius_um"]), float(sizes["greatest_radius_um"])
        rows = [r for r in read_columns("opac_refractive_index.csv") if r["component"] == name]
        self.nodes = [float(row["wavelength_nm"]) for row in rows]
        self.real = [float(row["real"]) for row in rows]
        self.imaginary = [float(row["imaginary"]) for row in rows]

    def scatter(self, wavelength):
        """Cross-sections [um²] of one particle and phase function."""
        width = np.log(self.deviation)
        # From where particles are few to where even their volume is spent.
        low = max(self.limits[0], self.mode * np.exp(-3.5 * width))
        high = min(self.limits[1], self.mode * np.exp(6.0 * width**2 + 3.5 * width))
        radius = np.geomspace(low, high, RADII)
        number = lognormal_distribution(self.mode, self.deviation, radius)
        index = complex(
            np.interp(wavelength, self.nodes, self.real),
            -np.interp(wavelength, self.nodes, self.imaginary),
        )
        return scatter(radius, number, index, wavelength, ANGLES)


def mix(parts):
    """Sum (share, extinction, scattering, phase) of the parts of a mixture."""
    extinction = sum(n * e for n, e, _, _ in parts)
    scattering = sum(n * s for n, _, s, _ in parts)
    phase = sum(n * s * p for n, _, s, p in parts) / scattering
    return extinction, scattering / extinction, normalise(phase, ANGLES)


def opac_mixture(name, mineral_absorption=1.0):
    """Optics of an OPAC mixture at all wavelengths, minerals' imaginary index times a factor."""
    components = {key: Component(key) for key in MIXTURES[name]}
    for key, part in components.items():
        if key.startswith("mineral"):
            part.imaginary = [mineral_absorption * value for value in part.imaginary]
    return [
        mix([(MIXTURES[name][key], *part.scatter(w)) for key, part in components.items()])
        for w in BEYOND_EYE
    ]


def volcanic():
    """Optics of droplets as they were a year after Pinatubo."""
    acid = Component("sulfate")
    acid.deviation = VOLCANIC_DEVIATION
    acid.mode = VOLCANIC_EFFECTIVE_RADIUS * np.exp(-2.5 * np.log(VOLCANIC_DEVIATION) ** 2)
    return [mix([(1.0, *acid.scatter(w))]) for w in BEYOND_EYE]


def venus():
    """Optics of the droplets of Venus' cloud tops."""
    radius = np.geomspace(0.2, 4.0, RADII)
    number = gamma_distribution(VENUS_EFFECTIVE_RADIUS, VENUS_EFFECTIVE_VARIANCE, radius)
    results = []
    for w in WAVELENGTHS:
        index = complex(np.interp(w, VENUS_WAVELENGTHS, VENUS_REFRACTIVE_INDEX))
        extinction, _, phase = scatter(radius, number, index, w, ANGLES)
        albedo = np.interp(w, VENUS_ALBEDO_WAVELENGTHS, VENUS_ALBEDO)
        results.append((extinction, albedo, normalise(phase, ANGLES)))
    return results


def write_tables(name, title, origin, results, wavelengths=BEYOND_EYE):
    """Write what is kept of an aerosol, and print it at 550 nm."""
    extinction, albedo, phases = (np.array(column) for column in zip(*results, strict=True))
    relative = extinction / np.interp(550.0, wavelengths, extinction)
    asymmetry = [mean_cosine(phase, ANGLES) for phase in phases]
    write(
        f"{name}.csv",
        [f"{title}: extinction relative to that at 550 nm.", *origin],
        ["wavelength_nm", "relative_extinction", "single_scattering_albedo", "asymmetry"],
        [
            (f"{w:.0f}", f"{e:.4f}", f"{a:.5f}", f"{g:.4f}")
            for w, e, a, g in zip(wavelengths, relative, albedo, asymmetry, strict=True)
        ],
    )
    write_phase(
        f"{name}_phase.csv",
        [f"{title}: phase function [per sr], columns by wavelength [nm].", *origin],
        ANGLES,
        phases,
        wavelengths,
    )
    at = [float(np.interp(550.0, wavelengths, x)) for x in (extinction, albedo, asymmetry)]
    print(f"{name}: {at[0]:.4g} um2, albedo {at[1]:.4f}, asymmetry {at[2]:.4f}", flush=True)


SCRIPT = "Computed by docs/derivations/aerosols.py. Licence: this project's own."
OPAC_ORIGIN = [
    "Spheres of the components of Hess, Koepke & Schult (1998), OPAC, Bull. Amer. Meteor. Soc.",
    "79, 831, in their number densities and at 80 % relative humidity (sulphuric acid: dry).",
    SCRIPT,
]
TITLES = {
    "continental_clean": "Clean continental aerosol",
    "continental_average": "Average continental aerosol",
    "continental_polluted": "Polluted continental aerosol",
    "urban": "Urban aerosol",
    "desert": "Desert aerosol",
    "maritime_clean": "Clean maritime aerosol",
    "stratospheric": "Background stratospheric aerosol",
}


def main(names):
    """Write the named tables, or all."""
    for key, title in TITLES.items():
        if not names or key in names:
            write_tables(f"opac_{key}", title, OPAC_ORIGIN, opac_mixture(key))
    if not names or "desert_dust" in names:
        origin = [
            *OPAC_ORIGIN[:2],
            "Minerals with 0.36 of their imaginary index, for the single scattering albedo of",
            "0.946 at 550 nm in Kim et al. (2011), Atmos. Chem. Phys. Discuss. 11, 20181.",
            SCRIPT,
        ]
        results = opac_mixture("desert", DESERT_ABSORPTION)
        write_tables("desert_dust", "Desert dust", origin, results)
    if not names or "volcanic" in names:
        origin = [
            "Spheres of 75 % sulphuric acid, refractive index as OPAC's; one lognormal mode of",
            "effective radius 0.5 um, geometric deviation 1.5, as in the year after Pinatubo",
            "(Russell et al. 1996, J. Geophys. Res. 101, 18745; Deshler et al. 1993, Geophys. Res.",
            "Lett. 20, 1435).",
            SCRIPT,
        ]
        write_tables("volcanic", "Volcanic stratospheric aerosol", origin, volcanic())
    if not names or "venus" in names:
        origin = [
            "Spheres of Hansen & Hovenier (1974), J. Atmos. Sci. 31, 1137; single scattering",
            "albedo of Titov et al. (2018), Space Sci. Rev. 214, 126, below 445 nm with the band",
            "of the absorber in Perez-Hoyos et al. (2018), J. Geophys. Res. Planets 123, 145.",
            SCRIPT,
        ]
        write_tables("venus_cloud", "Cloud tops of Venus", origin, venus(), WAVELENGTHS)


if __name__ == "__main__":
    main(sys.argv[1:])
