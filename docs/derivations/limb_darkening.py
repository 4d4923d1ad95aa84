"""Computes skybake/data/sun_limb_darkening.csv from polynomials of the fifth degree.

The quadratics keep their means over the disc, and differ from them by at most 0.017 of the centre's
radiance where mu is above 0.1.
"""

import numpy as np
from mie import read_columns, write

# Nodes of mu^2 at which the quadratic is fitted: equal areas of the disc.
MU = np.sqrt((np.arange(1000) + 0.5) / 1000.0)


def quadratic(coefficients):
    """Least squares over the disc of 1 - u (1 - mu) - v (1 - mu^2), its mean kept."""
    darkening = 1.0 - np.polynomial.polynomial.polyval(MU, coefficients)
    # The means of 1 - mu and 1 - mu^2 over the disc are 1/3 and 1/2: v follows from u.
    total = np.mean(darkening)
    linear = (1.0 - MU) - (2.0 / 3.0) * (1.0 - MU**2)
    rest = darkening - 2.0 * total * (1.0 - MU**2)
    u = np.sum(linear * rest) / np.sum(linear**2)
    return u, 2.0 * total - (2.0 / 3.0) * u


def main():
    """Write the table, and print the largest deviation of each of its rows."""
    lines = []
    for row in read_columns("neckel_labs_1994.csv"):
        wavelength, *coefficients, mean = map(float, row.values())
        # Printed digits leave the sum of the coefficients off by 2e-5.
        coefficients = np.array(coefficients) / np.sum(coefficients)
        u, v = quadratic(coefficients)
        mu = np.linspace(0.1, 1.0, 91)
        deviation = 1.0 - u * (1.0 - mu) - v * (1.0 - mu**2)
        deviation -= np.polynomial.polynomial.polyval(mu, coefficients)
        kept = 1.0 - u / 3.0 - v / 2.0
        print(f"{wavelength}: {np.abs(deviation).max():.4f}, mean {kept:.4f} ({mean})")
        lines.append((f"{wavelength:g}", f"{u:.4f}", f"{v:.4f}"))
    write(
        "sun_limb_darkening.csv",
        [
            "Limb darkening of the sun's continuum: I(mu)/I(1) = 1 - u (1 - mu) - v (1 - mu^2),",
            "mu the cosine at the photosphere. Fitted to the polynomials of Neckel & Labs (1994),",
            "Solar Phys. 153, 91, table I, by docs/derivations/limb_darkening.py.",
            "Licence: published facts; cite the paper.",
        ],
        ["wavelength_nm", "limb_darkening_u", "limb_darkening_v"],
        lines,
    )


if __name__ == "__main__":
    main()
