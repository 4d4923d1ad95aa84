"""Computes the phase functions of cloud droplets in skybake/data; see mie.py.

Refractive indices of water are those of Hale & Querry (1973), Optical constants of water in the
200-nm to 200-um wavelength region, Appl. Opt. 12, 555, table I. What water absorbs of visible
light is left out: a droplet of 20 um takes 2e-5 of what it meets at 700 nm.
"""

import numpy as np
from mie import gamma_distribution, mean_cosine, normalise, scatter, write

EFFECTIVE_RADII = (5.0, 10.0, 20.0)
# Hansen & Travis (1974), Space Sci. Rev. 16, 527: 0.1 is common in clouds of water.
EFFECTIVE_VARIANCE = 0.1
WAVELENGTHS = np.array([360.0, 400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0, 830.0])

INDEX_WAVELENGTHS = np.arange(350.0, 851.0, 25.0)
INDEX = (
    *(1.343, 1.341, 1.339, 1.338, 1.337, 1.336, 1.335, 1.334, 1.333, 1.333, 1.332),
    *(1.332, 1.331, 1.331, 1.331, 1.330, 1.330, 1.330, 1.329, 1.329, 1.329),
)

# Of a size parameter near the most frequent ones: coarser steps leave fringes of single droplets.
STEP = 0.25
SMALLEST, LARGEST = 0.1, 3.2

# Between corona and cloudbow, where the phase function is smooth over several degrees, what is left
# of narrow resonances is noise of some percent. [deg], [node]
SMOOTH = (10.0, 20.0, 118.0, 128.0)
SMOOTHING = 4.0


def angles():
    """Angles of skybake.optics.phase.scattering_angles, whose values are then exact. [deg]"""
    forward = 2.0 * np.arcsin(np.linspace(0.0, 1.0, 513) ** 2 / np.sqrt(2.0))
    return np.degrees(np.concatenate([forward, np.pi - forward[-2::-1]]))


def droplets(effective_radius, wavelength):
    """Phase function of droplets of a gamma distribution, at `angles`. [sr⁻¹]"""
    size = 2e3 * np.pi * effective_radius / wavelength
    count = int(np.log(LARGEST / SMALLEST) * 1.5 * size / STEP)
    radius = np.geomspace(SMALLEST, LARGEST, count) * effective_radius
    number = gamma_distribution(effective_radius, EFFECTIVE_VARIANCE, radius)
    index = complex(np.interp(wavelength, INDEX_WAVELENGTHS, INDEX), 0.0)
    _, _, phase = scatter(radius, number, index, wavelength, angles())
    return without_resonances(phase)


def without_resonances(phase):
    """Average the logarithm over neighbouring nodes where it is smooth."""
    offsets = np.arange(-16, 17)
    weights = np.exp(-0.5 * (offsets / SMOOTHING) ** 2)
    padded = np.pad(np.log(phase), 16, mode="edge")
    averaged = np.convolve(padded, weights / weights.sum(), mode="valid")
    share = np.interp(angles(), (0.0, *SMOOTH, 180.0), (0.0, 0.0, 1.0, 1.0, 0.0, 0.0))
    return np.exp(share * averaged + (1.0 - share) * np.log(phase))


def main():
    """Write a table for each effective radius, and print it at 550 nm."""
    for effective_radius in EFFECTIVE_RADII:
        raw = [droplets(effective_radius, w) for w in WAVELENGTHS]
        phases = [normalise(phase, angles()) for phase in raw]
        write(
            f"cloud_droplets_{effective_radius:.0f}um_phase.csv",
            [
                f"Cloud droplets of effective radius {effective_radius:.0f} um: phase function "
                "[per sr], columns by wavelength [nm].",
                "Spheres of water, Hale & Querry (1973), Appl. Opt. 12, 555, without absorption;",
                "gamma distribution of effective variance 0.1, Hansen & Travis (1974), Space Sci.",
                "Rev. 16, 527.",
                "Computed by docs/derivations/cloud_droplets.py. Licence: this project's own.",
            ],
            ["angle_deg", *(f"{w:.0f}" for w in WAVELENGTHS)],
            [
                (f"{angle:.7g}", *(f"{value:.4g}" for value in row))
                for angle, row in zip(angles(), np.transpose(phases), strict=True)
            ],
        )
        middle = list(WAVELENGTHS).index(550.0)
        worst = max(float(np.max(np.abs(b / a - 1.0))) for a, b in zip(raw, phases, strict=True))
        print(
            f"{effective_radius:g} um: asymmetry {mean_cosine(phases[middle], angles()):.4f}, "
            f"normalised by at most {worst:.1e}",
            flush=True,
        )


if __name__ == "__main__":
    main()
