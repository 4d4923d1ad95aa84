"""Makes accuracy.md and its plots, from the project's root: ``python -m docs.make_accuracy``.

Needs matplotlib. ``--quick`` takes few suns and paths, to see that everything runs.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
from collections.abc import Iterable, Iterator
from pathlib import Path

import matplotlib as mpl
import numpy as np

import skybake
from skybake.image.luminous import luminous_weights
from skybake.image.scene import Scene
from skybake.preset import load_preset
from skybake.reference.estimate import radiance
from skybake.sky.sky import Sky
from tests.comparison import (
    Comparison,
    compare,
    horizon_distance,
    join,
    places,
    sun_distance,
)
from tests.skies import view_cosines
from tests.truth import TRUTH_WAVELENGTHS, load_truth

mpl.use("Agg")
from matplotlib import pyplot as plt

TABLES = ("EARTH_A", "EARTH_HAZE", "MARS_A")
METHODS = ("full", "hillaire")
BANDS = {"0 to 90": (0.0, 90.0), "-2 to -6": (-6.0, -2.0), "-9 to -12": (-12.0, -9.0)}
BOUNDS = {
    "0 to 90": {"EARTH_A": 0.5, "EARTH_HAZE": 0.5, "MARS_A": 0.8},
    "-2 to -6": {"EARTH_A": 1.0, "EARTH_HAZE": 1.0, "MARS_A": 2.0},
    "-9 to -12": {"EARTH_A": 3.0, "EARTH_HAZE": 3.0, "MARS_A": 3.0},
}

# Seidelmann (ed., 1992), Explanatory Supplement to the Astronomical Almanac, p. 491: common
# logarithm of the illuminance of sun and sky as a cubic of the elevation over 90 deg. [lx]
SEIDELMANN = {
    60: 1.031e5, 30: 4.63e4, 20: 2.738e4, 10: 1.112e4, 5: 4538.0, 2: 1921.0, 0: 758.6, -2: 189.4,
    -3: 79.07, -4: 29.93, -6: 3.412, -8: 0.3481, -10: 0.04211, -12: 0.008056, -18: 6.447e-4,
}  # fmt: skip
# A separate spherical Monte Carlo, all orders: air and ozone, and with aerosol of depth 0.1. [lx]
CLEAR = {0: 1002.0, -4: 36.0, -6: 3.57, -8: 0.353, -10: 0.042, -12: 0.0065}
HAZY = {0: 886.0, -4: 31.4, -6: 3.09, -8: 0.312, -10: 0.0396, -12: 0.0063}
# Blender 5.0.1, Multiple Scattering sky texture: integral of a rendered panorama without the
# sun's disc. [lx]
BLENDER = {60: 9700.0, 30: 7800.0, 5: 3160.0, 0: 906.0, -3: 133.0, -6: 21.0, -12: 3.2, -18: 0.52}

VIEWS = ((0, 0), (45, 0), (45, 90), (45, 180), (80, 0), (80, 90), (80, 180), (120, 90))


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Lines of a Markdown table."""
    lines = [list(head), *(list(row) for row in rows)]
    lines.insert(1, ["---"] * len(lines[0]))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def kilometres(altitude: float) -> str:
    """Human-readable altitude."""
    return f"{altitude:g} km" if altitude >= 1.0 else f"{altitude * 1e3:g} m"


def place_of(part: Comparison, i: int) -> str:
    """Where and at which sun a row looks."""
    row = part.rows[i]
    return (
        f"sun {row['sun_elevation_deg']:g}°, zenith angle {row['view_zenith_deg']:.4g}°, "
        f"azimuth {row['relative_azimuth_deg']:g}°, {row['wavelength_nm']:g} nm"
    )


def measure(quick: bool) -> dict[tuple[str, str, float], Comparison]:
    """Errors by atmosphere, method and altitude."""
    measured = {}
    for name in TABLES:
        sites = places(load_truth(name))
        suns = tuple({sun for _, sun in sites if not quick or sun in (10.0, 12.0, -4.0, -5.0)})
        for altitude in sorted({altitude for altitude, _ in sites}):
            for method in METHODS:
                measured[name, method, altitude] = compare(name, method, (altitude,), suns)
    return measured


def within(part: Comparison, band: str) -> Comparison:
    """Rows whose sun is in a band."""
    low, high = BANDS[band]
    sun = part.rows["sun_elevation_deg"]
    return part.where((sun >= low) & (sun <= high))


def summary(parts: Iterable[Comparison]) -> list[str]:
    """Cells of a table for both methods."""
    cells = []
    for part in parts:
        worst = np.abs(part.error).argmax()
        cells += [
            f"{100 * part.rms:.2f}",
            f"{100 * part.error.mean():+.2f}",
            f"{100 * part.error[worst]:+.1f}",
        ]
    return cells


def error_rows(measured: dict[tuple[str, str, float], Comparison]) -> Iterator[list[str]]:
    """Errors by atmosphere, sun and altitude."""
    for name in TABLES:
        altitudes = sorted({h for other, _, h in measured if other == name})
        for band in BANDS:
            groups = [(kilometres(h), [h]) for h in altitudes]
            if len(altitudes) > 1:
                groups.append(("**all**", altitudes))
            for label, group in groups:
                parts = [
                    within(join([measured[name, method, h] for h in group]), band)
                    for method in METHODS
                ]
                if parts[0].error.size:
                    size = str(parts[0].error.size)
                    bound = f"{BOUNDS[band][name]:g}"
                    yield [name, label, band, size, bound, *summary(parts)]


def sharp_rows() -> Iterator[list[str]]:
    """Errors of the default method beside the tables of low noise."""
    for name in ("twilight_EARTH_A", "twilight_MARS_A", "aureole_MARS_MIE"):
        for altitude, sun in places(load_truth(name)):
            part = compare(name, "full", (altitude,), (sun,))
            noise = f"{100 * np.median(part.noise):.2f}"
            worst = place_of(part, int(np.abs(part.error).argmax()))
            yield [name, f"{sun:g}", str(part.error.size), noise, *summary([part]), worst]


def worst_rows(measured: dict[tuple[str, str, float], Comparison]) -> Iterator[list[str]]:
    """Where the default method is off most."""
    for (name, method, altitude), whole in measured.items():
        if method != "full":
            continue
        for band in BANDS:
            part = within(whole, band)
            if not part.error.size:
                continue
            away = (horizon_distance(name, part.rows) > 1.0) & (sun_distance(part.rows) > 4.0)
            for label, group in (("elsewhere", part.where(away)), ("near", part.where(~away))):
                if group.error.size:
                    i = int(np.abs(group.error).argmax())
                    yield [
                        name,
                        kilometres(altitude),
                        label,
                        f"{100 * group.error[i]:+.1f}",
                        f"{100 * group.noise[i]:.1f}",
                        place_of(group, i),
                    ]


def traced_rows(quick: bool) -> Iterator[list[str]]:
    """Presets by the default method beside the path tracer."""
    zenith, azimuth = np.array(VIEWS, dtype=float).T
    samples = 500 if quick else 4000
    for planet in ("earth", "mars"):
        for altitude in (0.0, 10.0):
            for sun in (10.0,) if quick else (60.0, 10.0, 0.0, -6.0):
                sky = Sky(planet, math.radians(sun), altitude, wavelengths=TRUTH_WAVELENGTHS[::-1])
                fast = sky.radiance_per_irradiance(*view_cosines(zenith, azimuth, sun))
                slow, stderr = radiance(
                    sky.medium,
                    altitude,
                    sky.sun_elevation,
                    np.radians(zenith),
                    np.radians(azimuth),
                    samples=samples,
                )
                lit = slow > 1e-3 * slow.max()
                error, noise = (fast / slow - 1.0)[lit], (stderr / slow)[lit]
                i = np.abs(error / noise).argmax()
                yield [
                    planet,
                    kilometres(altitude),
                    f"{sun:g}",
                    f"{100 * math.sqrt(np.mean(noise**2)):.2f}",
                    f"{100 * math.sqrt(np.mean(error**2)):.2f}",
                    f"{100 * error.mean():+.2f}",
                    f"{100 * error[i]:+.1f} ± {100 * noise[i]:.1f}",
                ]


def illuminance(sun: float, method: str = "full") -> tuple[float, float]:
    """Horizontal illuminance of `earth` at the ground by the sky, and by sky and sun. [lx]"""
    settings = skybake.map_settings(sun_elevation=math.radians(sun), method=method)
    scene = Scene(load_preset("earth"), settings)
    sky = scene.sky_illuminance()
    return sky, sky + scene.sun_illuminance()[1]


def light_rows(suns: Iterable[int]) -> Iterator[list[str]]:
    """Illuminances beside those of others."""
    for sun in suns:
        sky, whole = illuminance(sun)
        others = [source.get(sun) for source in (SEIDELMANN, CLEAR, HAZY, BLENDER)]
        shown = ["" if value is None else f"{value:.3g}" for value in others]
        yield [str(sun), f"{whole:.3g}", *shown[:3], f"{sky:.3g}", shown[3]]


def plot_errors(measured: dict[tuple[str, str, float], Comparison], path: Path) -> None:
    """Errors over the sky of EARTH_A at the ground, for two suns and both methods."""
    figure, axes = plt.subplots(2, 2, figsize=(8.4, 7.6), subplot_kw={"projection": "polar"})
    for line, method, span in zip(axes, METHODS, (2.0, 30.0), strict=True):
        whole = measured["EARTH_A", method, 0.001]
        for axis, sun in zip(line, (10.0, -4.0), strict=True):
            rows = whole.rows
            part = whole.where(
                (rows["sun_elevation_deg"] == sun)
                & (rows["wavelength_nm"] == 550.0)
                & (rows["view_zenith_deg"] < 90.0)
            )
            azimuth = np.radians(part.rows["relative_azimuth_deg"])
            dots = axis.scatter(
                np.concatenate([azimuth, -azimuth]),
                np.tile(part.rows["view_zenith_deg"], 2),
                c=np.tile(100.0 * part.error, 2),
                s=26,
                cmap="RdBu_r",
                vmin=-span,
                vmax=span,
                edgecolors="0.6",
                linewidths=0.3,
            )
            axis.set_theta_zero_location("N")
            axis.set_rlim(0.0, 93.0)
            axis.set_rticks([30.0, 60.0, 90.0], ["30°", "60°", "90°"], fontsize=7, color="0.4")
            axis.set_thetagrids((0, 45, 90, 135, 180), fontsize=7)
            axis.set_title(f"{method}, sun {sun:g}°", fontsize=10)
        figure.colorbar(dots, ax=line, label="error [%]", shrink=0.8)
    figure.suptitle("EARTH_A at the ground, 550 nm; sun's azimuth up, horizon outside", fontsize=11)
    figure.savefig(path, dpi=80)
    plt.close(figure)


def plot_light(quick: bool, path: Path) -> None:
    """Zenith luminance and horizontal illuminance of `earth` from noon to night."""
    suns = np.array([60, 10, -4, -12]) if quick else np.r_[90:20:-10, 20:4:-5, 4:-19:-1].astype(int)
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 4.4), layout="constrained")
    for method, style in zip(METHODS, ("C0-", "C0:"), strict=True):
        sky = Sky("earth", 0.0, method=method)
        luminous = luminous_weights(sky)[:, 1]
        fine = np.linspace(89.0, -18.0, 215)
        up = []
        for sun in fine:
            source = dataclasses.replace(sky.source, elevation=math.radians(sun))
            light = sky.skylight.radiance_per_irradiance(source, np.ones(1), np.array([source.mu]))
            up.append(float(light[0] @ luminous))
        left.semilogy(fine, up, style, label=f"skybake, {method}")
        light = np.array([illuminance(sun, method) for sun in suns])
        right.semilogy(suns, light[:, 0], style, label=f"skybake, {method}: sky")
        if method == "full":
            right.semilogy(suns, light[:, 1], "C1-", label="skybake, full: sky and sun")
    for values, style, label in (
        (BLENDER, "ks", "Blender 5.0.1: sky"),
        (SEIDELMANN, "C1o", "Seidelmann 1992: sky and sun"),
        (HAZY, "C2x", "Monte Carlo, aerosol 0.1: sky"),
    ):
        right.plot(list(values), list(values.values()), style, markersize=5, label=label)
    left.set_ylabel("luminance of the zenith [cd/m²]")
    right.set_ylabel("illuminance of the horizontal [lx]")
    for axis in (left, right):
        axis.set_xlabel("sun's elevation [deg]")
        axis.invert_xaxis()
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8, loc="lower left")
    figure.savefig(path, dpi=80)
    plt.close(figure)


def main() -> None:
    """Measure, plot and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few suns and paths")
    parser.add_argument("--output", type=Path, default=Path(__file__).parent, metavar="FOLDER")
    arguments = parser.parse_args()
    images = arguments.output / "images"
    images.mkdir(parents=True, exist_ok=True)
    quick = arguments.quick
    measured = measure(quick)
    plot_errors(measured, images / "accuracy_errors.png")
    plot_light(quick, images / "accuracy_light.png")
    suns = (60, -6) if quick else (60, 30, 5, 0, -3, -4, -6, -8, -10, -12, -18)
    text = Path(__file__).with_name("accuracy.template.md").read_text(encoding="utf-8")
    numbers = ("rms", "mean", "worst")
    columns = [f"{method}: {number}" for method in METHODS for number in numbers]
    fields = {
        "errors": table(
            ["atmosphere", "altitude", "sun [deg]", "rows", "aim: rms", *columns],
            error_rows(measured),
        ),
        "sharp": table(
            ["table", "sun [deg]", "rows", "table's noise", *numbers, "place of the worst"],
            sharp_rows(),
        ),
        "worst": table(
            ["atmosphere", "altitude", "sun or horizon", "error", "table's noise", "place"],
            worst_rows(measured),
        ),
        "traced": table(
            [
                *("preset", "altitude", "sun [deg]", "rms noise", "rms difference"),
                *("mean difference", "least likely"),
            ],
            traced_rows(quick),
        ),
        "light": table(
            [
                *(
                    "sun [deg]",
                    "sky and sun",
                    "Seidelmann",
                    "clear Monte Carlo",
                    "hazy Monte Carlo",
                ),
                *("sky", "Blender 5.0.1: sky"),
            ],
            light_rows(suns),
        ),
    }
    for name, value in fields.items():
        text = text.replace(f"{{{name}}}\n", value)
    (arguments.output / "accuracy.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
