"""Computes the tables of ground albedo, cloud decks and a dwarf star in skybake/data.

Grassland was made with other programs; see its table.
"""

import numpy as np
from mie import read_columns, write

# Warren & Brandt (2008), J. Geophys. Res. 113, D14220: imaginary index of ice, each 10 nm from 400.
ICE_AT_360 = 2.0e-11
ICE = """
2.365e-11 2.669e-11 3.135e-11 4.140e-11 6.268e-11 9.239e-11 1.325e-10 1.956e-10 2.861e-10 4.172e-10
5.889e-10 8.036e-10 1.076e-9 1.409e-9 1.813e-9 2.289e-9 2.839e-9 3.461e-9 4.159e-9 4.930e-9
5.730e-9 6.890e-9 8.580e-9 1.040e-8 1.220e-8 1.430e-8 1.660e-8 1.890e-8 2.090e-8 2.400e-8
2.900e-8 3.440e-8 4.030e-8 4.300e-8 4.920e-8 5.870e-8 7.080e-8 8.580e-8 1.020e-7 1.180e-7
1.340e-7 1.400e-7 1.430e-7 1.450e-7
"""
SNOW_GRAIN_DIAMETER = 0.3e-3  # m, fresh snow that has settled
SNOW_SHAPE = 13.0  # absorption path in grain diameters, Kokhanovsky & Zege (2004)
# Soot and dust of remote snow take 1 to 2 % of the visible: Grenfell, Warren & Mullen (1994)
# measured 0.96 to 0.98 in Antarctica, where pure ice would give 0.99.
SNOW_IMPURITY = 0.985

PIGMENT = 0.1  # mg of chlorophyll per m3: the open ocean
# Under a uniform sky a calm surface turns back 6.6 % (Burt 1954, J. Meteor. 11, 283).
SURFACE_REFLECTANCE = 0.066
# Of the light from below, what gets through the surface: Morel (1988), after Austin (1974).
WATER_TO_AIR, INTERNAL_REFLECTANCE = 0.52, 0.48

PLANCK, LIGHT, BOLTZMANN = 6.62607015e-34, 2.99792458e8, 1.380649e-23
ASTRONOMICAL_UNIT, SOLAR_RADIUS = 149597870.7, 695700.0  # km
DWARF_TEMPERATURE, DWARF_RADIUS = 3000.0, 0.2  # K, solar radii


def snow():
    """Albedo of deep snow under diffuse light; Kokhanovsky & Zege (2004), Appl. Opt. 43, 1589."""
    wavelength = np.concatenate([[360.0], np.arange(400.0, 831.0, 10.0)])
    index = np.array([ICE_AT_360, *map(float, ICE.split())])
    absorption = 4.0 * np.pi * index / (wavelength * 1e-9)
    path = SNOW_SHAPE * SNOW_GRAIN_DIAMETER
    return wavelength, SNOW_IMPURITY * np.exp(-np.sqrt(absorption * path))


def ocean():
    """Albedo of the open ocean under diffuse light, from 400 to 700 nm; Morel (1988)."""
    rows = read_columns("ocean_case1.csv")
    columns = {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}
    wavelength = columns["wavelength_nm"]
    attenuation = (
        columns["pure_attenuation_per_m"]
        + columns["pigment_attenuation"] * PIGMENT ** columns["pigment_exponent"]
    )
    particles = 0.30 * PIGMENT**0.62
    share = 2e-3 + 0.02 * (0.5 - 0.25 * np.log10(PIGMENT)) * 550.0 / wavelength
    backscatter = 0.5 * columns["pure_scattering_per_m"] + share * particles
    below = 0.33 * backscatter / attenuation
    for _ in range(50):
        mean_cosines = 0.90 * (1.0 - below) / (1.0 + 2.25 * below)
        below = 0.33 * backscatter / attenuation / mean_cosines
    above = WATER_TO_AIR * below / (1.0 - INTERNAL_REFLECTANCE * below)
    return wavelength, SURFACE_REFLECTANCE + (1.0 - SURFACE_REFLECTANCE) * above


def dwarf():
    """Irradiance at 1 au by a black sphere. [W m⁻² nm⁻¹]"""
    wavelength = np.arange(350.0, 841.0, 5.0)
    metres = wavelength * 1e-9
    exponent = PLANCK * LIGHT / (metres * BOLTZMANN * DWARF_TEMPERATURE)
    radiance = 2.0 * PLANCK * LIGHT**2 / metres**5 / np.expm1(exponent) * 1e-9
    sine = DWARF_RADIUS * SOLAR_RADIUS / ASTRONOMICAL_UNIT
    return wavelength, np.pi * radiance * sine**2


def rows(wavelength, values, form=".4f"):
    """Lines of a table."""
    return [(f"{w:g}", format(v, form)) for w, v in zip(wavelength, values, strict=True)]


def main():
    """Write all tables."""
    columns = ["wavelength_nm", "albedo"]
    script = "Computed by docs/derivations/grounds.py. Licence: this project's own."
    write(
        "snow.csv",
        [
            "Albedo of deep, clean snow under diffuse light, grains of 0.3 mm.",
            "Kokhanovsky & Zege (2004), Appl. Opt. 43, 1589, with ice of Warren & Brandt (2008),",
            "J. Geophys. Res. 113, D14220; 1.5 % less for impurities, as Grenfell et al. (1994),",
            "J. Geophys. Res. 99, 18669.",
            script,
        ],
        columns,
        rows(*snow()),
    )
    wavelength, albedo = ocean()
    # Outside, molecules of water only: the reflectance of the deep blue holds on, beyond 700 nm
    # water is black.
    wavelength = np.array([360.0, *wavelength, 750.0, 830.0])
    albedo = np.array([albedo[0], *albedo, SURFACE_REFLECTANCE, SURFACE_REFLECTANCE])
    write(
        "ocean.csv",
        [
            "Albedo of the open ocean under diffuse light, 0.1 mg chlorophyll per m3, calm.",
            "Morel (1988), J. Geophys. Res. 93, 10749; surface 6.6 %, Burt (1954), J. Meteor. 11.",
            "Held below 400 nm, that of the surface beyond 750 nm.",
            script,
        ],
        columns,
        rows(wavelength, albedo),
    )
    write(
        "m_dwarf_3000k.csv",
        [
            "Irradiance at 1 au by a black sphere of 3000 K and 0.2 solar radii: Planck's law.",
            "Real dwarfs of this class have bands of TiO and VO that take half of some of the red.",
            script,
        ],
        ["wavelength_nm", "irradiance_w_m2_nm"],
        rows(*dwarf(), ".5g"),
    )


if __name__ == "__main__":
    main()
