"""Computes skybake/data/night/star_colours.csv: black bodies by their B-V, scaled to V = 0.

One that has the B-V of a star has its colour; one of its effective temperature has not.
Passbands: Bessell (1990), Publ. Astron. Soc. Pacific 102, 1181, table 2; fluxes of magnitude 0:
Bessell, Castelli & Plez (1998), Astron. Astrophys. 333, 231, table A2. The sun comes out at
V = -26.76 and B-V = 0.654.
"""

import numpy as np
from mie import read_columns, write

WAVELENGTHS = np.arange(350.0, 721.0)

B_BAND = (
    np.arange(360.0, 561.0, 10.0),
    (
        *(0.0, 0.030, 0.134, 0.567, 0.920, 0.978, 1.0, 0.978, 0.935, 0.853, 0.740),
        *(0.640, 0.536, 0.424, 0.325, 0.235, 0.150, 0.095, 0.043, 0.009, 0.0),
    ),
)
V_BAND = (
    np.arange(470.0, 701.0, 10.0),
    (
        *(0.0, 0.030, 0.163, 0.458, 0.780, 0.967, 1.0, 0.973, 0.898, 0.792, 0.684, 0.574),
        *(0.461, 0.359, 0.270, 0.197, 0.135, 0.081, 0.045, 0.025, 0.017, 0.013, 0.009, 0.0),
    ),
)
B_ZERO, V_ZERO = 6.320e-11, 3.631e-11
"""Mean irradiance in the band of a star of magnitude 0. [W m-2 nm-1]"""

SECOND_RADIATION_CONSTANT = 1.438776877e7
"""[nm K]"""

COLOURS = np.arange(-0.35, 3.4001, 0.05)
"""Beyond the bluest and the reddest star of the catalogue."""


def band_mean(spectrum, band):
    """Mean of a spectrum in a band, whose table is of the response to energy."""
    response = np.interp(WAVELENGTHS, *band, left=0.0, right=0.0)
    return (spectrum * response).sum() / response.sum()


def b_v(spectrum):
    """B-V of a spectrum at `WAVELENGTHS`."""
    blue, green = band_mean(spectrum, B_BAND) / B_ZERO, band_mean(spectrum, V_BAND) / V_ZERO
    return -2.5 * np.log10(blue / green)


def black_body(temperature):
    """Spectrum at `WAVELENGTHS`, of 1 at 550 nm."""
    x = SECOND_RADIATION_CONSTANT / temperature
    return (550.0 / WAVELENGTHS) ** 5 * np.expm1(x / 550.0) / np.expm1(x / WAVELENGTHS)


def temperature_of(colour):
    """Temperature of the black body that has a B-V, by bisection in its inverse. [K]"""
    low, high = 1e-6, 1e-3
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if b_v(black_body(1.0 / middle)) < colour else (low, middle)
    return 2.0 / (low + high)


def main():
    """Write the table, and print what the sun is as a star."""
    sun = np.array([list(map(float, row.values())) for row in read_columns(SUN)])
    spectrum = np.interp(WAVELENGTHS, sun[:, 0], sun[:, 1])
    magnitude = -2.5 * np.log10(band_mean(spectrum, V_BAND) / V_ZERO)
    print(f"sun: V {magnitude:.2f}, B-V {b_v(spectrum):.3f}")
    lines = []
    for colour in COLOURS:
        temperature = temperature_of(colour)
        level = V_ZERO / band_mean(black_body(temperature), V_BAND)
        lines.append((f"{colour:.2f}", f"{temperature:.1f}", f"{level:.5e}"))
    write(
        "night/star_colours.csv",
        [
            "Black body that has the B-V of a star, and its irradiance at 550 nm if V is 0.",
            "Bands of Bessell (1990), Publ. Astron. Soc. Pacific 102, 1181; zero points of",
            "Bessell, Castelli & Plez (1998), Astron. Astrophys. 333, 231.",
            "Computed by docs/derivations/star_colours.py. Licence: this project's own.",
        ],
        ["b_v", "temperature_k", "irradiance_w_m2_nm"],
        lines,
    )


SUN = "../../skybake/data/sun_astm_g173.csv"

if __name__ == "__main__":
    main()
