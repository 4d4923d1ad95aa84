"""Worlds at random within the ranges of docs/presets.md."""

import math
import random

from skybake.preset.phases import ASYMMETRY

GASES = ("dry_air", "co2", "n2")
LIGHT_GASES = ("ar", "ch4", "h2", "he")


def random_world(seed):
    """Preset of a world that no one designed; three wavelengths, so that it is solved quickly."""
    draw = random.Random(seed)
    least, most = draw.choice([(1.0, 1e6), (300.0, 70_000.0), (300.0, 70_000.0)])
    radius = _spread(draw, least, most)
    top = max(0.1, min(radius, _spread(draw, 0.5, 3000.0)))
    depth = _spread(draw, 1e-3, 40.0)
    return {
        "title": f"random world {seed}",
        "wavelengths_nm": [450.0, 550.0, 650.0],
        "planet": {"radius_km": radius, "atmosphere_top_km": top},
        "star": {
            "radius_km": 695_700.0,
            "distance_au": 1.0,
            "irradiance_w_m2_nm": "sun_astm_g173",
        },
        "ground": {"albedo": _spectrum(draw, lambda: draw.choice([0.0, 1.0, draw.random()]))},
        "constituents": {
            f"c{i}": _constituent(draw, top, depth * draw.random())
            for i in range(draw.randint(1, 4))
        },
    }


def _constituent(draw, top, depth):
    kind = draw.choice(["gas", "aerosol", "aerosol", "absorber", "coefficients"])
    table = {"kind": kind, "profile": _profile(draw, top)}
    if kind == "gas":
        share = draw.random()
        return table | {
            "pressure_pa": _spread(draw, 1.0, 1e6),
            "temperature_k": draw.uniform(20.0, 1000.0),
            "composition": {draw.choice(GASES): share, draw.choice(LIGHT_GASES): 1.0 - share},
        }
    if kind == "absorber":
        return table | {
            "column_du": _spread(draw, 1.0, 1e5),
            "cross_section_m2": _spectrum(draw, lambda: _spread(draw, 1e-27, 1e-23)),
        }
    if kind == "aerosol":
        return table | {
            "optical_depth": depth,
            "angstrom_exponent": draw.uniform(-1.0, 3.0),
            "single_scattering_albedo": _spectrum(draw, lambda: draw.choice([1.0, draw.random()])),
            "phase": _phase(draw),
        }
    mean = depth / top
    return table | {
        "scattering_per_km": _spectrum(draw, lambda: mean * draw.uniform(0.5, 2.0)),
        "absorption_per_km": _spectrum(draw, lambda: mean * draw.choice([0.0, draw.random()])),
        "phase": _phase(draw),
    }


def _profile(draw, top):
    kind = draw.choice(["exponential", "exponential", "tent", "tabulated"])
    if kind == "exponential":
        return {"kind": kind, "scale_height_km": _spread(draw, 0.01 * top, 3.0 * top)}
    if kind == "tent":
        half_width = _spread(draw, 0.02 * top, top)
        return {"kind": kind, "center_km": draw.uniform(0.0, top), "half_width_km": half_width}
    inner = sorted(draw.uniform(0.0, top) for _ in range(draw.randint(0, 4)))
    altitude = [0.0, *inner, top]
    density = [_spread(draw, 1e-4, 1.0) for _ in altitude]
    return {"kind": kind, "altitude_km": altitude, "density": density}


def _phase(draw):
    least, most = ASYMMETRY

    def asymmetry():
        return draw.choice([draw.uniform(least, most), draw.uniform(0.6, most), least, most])

    kind = draw.choice(["rayleigh", "henyey-greenstein", "cornette-shanks", "double"])
    if kind == "rayleigh":
        return {"kind": kind, "depolarisation": draw.uniform(0.0, 0.5)}
    if kind == "double":
        return {
            "kind": "double-henyey-greenstein",
            "first_asymmetry": asymmetry(),
            "second_asymmetry": asymmetry(),
            "first_fraction": draw.random(),
        }
    return {"kind": kind, "asymmetry": asymmetry()}


def _spectrum(draw, value):
    if draw.random() < 0.6:
        return value()
    return {"wavelength_nm": [380.0, 550.0, 720.0], "values": [value() for _ in range(3)]}


def _spread(draw, least, most):
    return math.exp(draw.uniform(math.log(least), math.log(most)))
