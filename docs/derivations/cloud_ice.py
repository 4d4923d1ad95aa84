"""Computes the phase function of ice clouds in skybake/data, and that of dry ice; see mie.py.

Hexagonal prisms in any orientation, put together from what is known of their parts, and not
traced: half of the light is diffracted, the rest passes through the crystals. Prisms refract by
60 and 90 degrees between their faces, which piles light up from the angle of least deviation on:
the halos, whose inner edges the disc of the sun and imperfect prisms blur. Shares are chosen such
that the halo of 22 deg is about twice as bright as what surrounds it, as where a third of the
crystals is smooth (Forster & Mayer 2022, Atmos. Chem. Phys. 22, 15179), and the mean cosine is
that of mixtures of rough and smooth crystals (0.75 to 0.80: Baum et al. 2014, J. Quant.
Spectrosc. Radiat. Transf. 146, 123). A declared simplification: no crystal of one shape has
exactly this phase function, and plates that float level, with their parhelia, are left out.
"""

import numpy as np
from cloud_droplets import angles
from mie import gamma_distribution, mean_cosine, normalise, scatter, write

WAVELENGTHS = np.array([360.0, 450.0, 550.0, 700.0, 830.0])
# Warren & Brandt (2008), J. Geophys. Res. 113, D14220, to the third decimal.
INDEX = (1.324, 1.316, 1.311, 1.307, 1.304)

DIFFRACTED = 0.5
BROAD = 0.31
HALO_22, HALO_46 = 0.045, 0.008
DIFFRACTED_MEAN_COSINE, BROAD_MEAN_COSINE = 0.985, 0.72

# Widths of the halos' inner edges and what follows outward. [deg]
HALO_22_WIDTHS, HALO_46_WIDTHS = (0.6, 5.0), (1.0, 7.0)

CO2_RADIUS, CO2_INDEX = 1.5, 1.41


def least_deviation(index, prism):
    """Angle by which a prism refracts at least. [deg]"""
    half = np.radians(prism / 2.0)
    return 2.0 * np.degrees(np.arcsin(index * np.sin(half))) - prism


def lobe(asymmetry):
    """Henyey-Greenstein. [sr⁻¹]"""
    nu = np.cos(np.radians(angles()))
    scale = (1.0 - asymmetry**2) / (4.0 * np.pi)
    return scale / (1.0 + asymmetry**2 - 2.0 * asymmetry * nu) ** 1.5


def ring(at, widths):
    """Light that begins at an angle and fades outward. [sr⁻¹]"""
    beyond = angles() - at
    shape = np.where(
        beyond < 0.0, np.exp(-((beyond / widths[0]) ** 2)), np.exp(-beyond / widths[1])
    )
    return normalise(shape + 1e-12, angles())


def ice(index):
    """Phase function of the prisms. [sr⁻¹]"""
    rest = 1.0 - DIFFRACTED - BROAD - HALO_22 - HALO_46
    phase = (
        DIFFRACTED * lobe(DIFFRACTED_MEAN_COSINE)
        + BROAD * lobe(BROAD_MEAN_COSINE)
        + HALO_22 * ring(least_deviation(index, 60.0), HALO_22_WIDTHS)
        + HALO_46 * ring(least_deviation(index, 90.0), HALO_46_WIDTHS)
        + rest * lobe(0.0)
    )
    return normalise(phase, angles())


def co2_mean_cosine():
    """Mean cosine of spheres of dry ice at 550 nm, see skybake.preset.particles."""
    radius = np.geomspace(0.15, 5.0, 600)
    number = gamma_distribution(CO2_RADIUS, 0.1, radius)
    _, _, phase = scatter(radius, number, complex(CO2_INDEX, 0.0), 550.0, angles())
    return mean_cosine(normalise(phase, angles()), angles())


def main():
    """Write the table, and print mean cosines at 550 nm."""
    phases = [ice(index) for index in INDEX]
    write(
        "cloud_ice_phase.csv",
        [
            "Ice clouds: phase function [per sr], columns by wavelength [nm].",
            "Parametric: diffraction, halos of 22 and 46 deg, the rest smooth; a declared",
            "simplification. Refraction: Warren & Brandt (2008), J. Geophys. Res. 113, D14220;",
            "strength of the halos: Forster & Mayer (2022), Atmos. Chem. Phys. 22, 15179; mean",
            "cosine: Baum et al. (2014), J. Quant. Spectrosc. Radiat. Transf. 146, 123.",
            "Computed by docs/derivations/cloud_ice.py. Licence: this project's own.",
        ],
        ["angle_deg", *(f"{w:.0f}" for w in WAVELENGTHS)],
        [
            (f"{angle:.7g}", *(f"{value:.4g}" for value in row))
            for angle, row in zip(angles(), np.transpose(phases), strict=True)
        ],
    )
    middle = list(WAVELENGTHS).index(550.0)
    print(f"ice: {mean_cosine(phases[middle], angles()):.4f}, dry ice: {co2_mean_cosine():.4f}")
    at = [
        float(np.interp(a, angles(), phases[middle]))
        for a in (10.0, 19.0, 22.2, 35.0, 46.2, 90.0, 150.0)
    ]
    print("at 10, 19, 22.2, 35, 46.2, 90, 150 deg:", np.round(at, 4))


if __name__ == "__main__":
    main()
