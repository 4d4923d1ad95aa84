"""Makes tables.md and its picture: ``python docs/make_tables.py``.

Measures the tables, takes formulas from their definitions, and photographs tables_example.html in
Chromium; in a minute. Needs Pillow, and Chromium as ``chromium`` in PATH.
"""

from __future__ import annotations

import io
import math
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from PIL import Image

import skybake
from skybake.image.scene import Scene
from skybake.luts.aerial_perspective import air_segments, screen_directions
from skybake.luts.bake import bake_tables, make_tables
from skybake.luts.lookup import look_up
from skybake.luts.multiple_scattering import mean_radiance
from skybake.luts.parametrisations import PARAMETRISATIONS, TABLES, find_mappings
from skybake.luts.settings import TableSettings
from skybake.luts.transmittance import colour_shares, space_transmittance
from skybake.projection.equirect import column_bearings, row_zeniths

FOLDER = Path(__file__).parent
PAGE = FOLDER / "tables_example.html"
PICTURE = ("earth", 8.0, 1.5, (195.0, 2.0), 13.6)
"""World, sun [deg], altitude [km], look [deg] and exposure."""

SIZE = (1280, 720)
LOSSY = 88
SKIES = (
    *(("earth-hillaire2020", sun, 0.2) for sun in (60, 20, 5)),
    *(("earth", sun, 0.2) for sun in (30, 5, -4)),
    *(("mars", sun, 0.2) for sun in (40, 5)),
)
LARGER = (384, 216)
ROWS = 256
DISTANCES = (0.05, 0.2, 1.0, 3.0, 10.0, 30.0, 100.0)
PLACES = 400
SUNS = ((10, 80), (2, 10), (-2, 2), (-5, -2), (-8, -5))


def table(head: Iterable[object], rows: Iterable[Iterable[object]]) -> str:
    """Return a table of Markdown."""
    lines = [list(map(str, head))]
    lines.append(["---"] * len(lines[0]))
    lines += [list(map(str, row)) for row in rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def scene_of(preset: str, sun: float, altitude: float) -> Scene:
    """Return a sky whose sun is in the south; degrees and km."""
    view = skybake.map_settings(sun_elevation=math.radians(sun), altitude=altitude)
    return Scene(skybake.load_preset(preset), view)


def sky_errors(scene: Scene, settings: TableSettings) -> tuple[float, float]:
    """Root mean square error above the horizon, and the largest beside the sun. [%]"""
    made = make_tables(scene, settings)
    zenith = row_zeniths(ROWS)[:, None]
    azimuth = column_bearings(2 * ROWS)[None] - math.pi
    true = scene.evaluate_clear(zenith, azimuth, 1e-9) @ scene.luminance
    inputs = {"zenith": zenith, "cos_azimuth": np.cos(azimuth)}
    found = look_up(made.tables["sky_view"], made.constants, inputs) @ scene.luminance
    above = np.broadcast_to(zenith < made.constants["HORIZON"][0], true.shape)
    weight = np.broadcast_to(np.sin(zenith), true.shape)
    error = 100.0 * (found / true - 1.0)
    rms = math.sqrt(np.average(error[above] ** 2, weights=weight[above]))
    sun = scene.sky.source.zenith
    nu = np.cos(zenith) * math.cos(sun) + np.sin(zenith) * math.sin(sun) * np.cos(azimuth)
    near = above & (nu > math.cos(math.radians(2.0)))
    return rms, float(np.abs(error[near]).max()) if near.any() else math.nan


def sky_rows() -> Iterator[list[str]]:
    """Errors of the sky's view, for each world and sun."""
    for preset, sun, altitude in SKIES:
        scene = scene_of(preset, sun, altitude)
        kinds = [TableSettings(parametrisation=name) for name in PARAMETRISATIONS]
        kinds.append(TableSettings(sky_view_size=LARGER))
        errors = [sky_errors(scene, kind) for kind in kinds]
        nearest = (errors[0][1], errors[-1][1])
        beside = ["" if math.isnan(one) else f"{one:.2g}" for one in nearest]
        yield [f"`{preset}`", f"{sun}", *(f"{rms:.2g}" for rms, _ in errors), *beside]


def transmittance_rows() -> Iterator[list[str]]:
    """Errors of the transmittance at places between texels."""
    scene = scene_of("earth-hillaire2020", 30.0, 0.2)
    medium, random = scene.sky.medium, np.random.default_rng(1)
    altitude = 30.0 * random.random(4000) ** 3
    horizon = -np.sqrt(altitude * (altitude + 2.0 * medium.r_bottom)) / (medium.r_bottom + altitude)
    mu = horizon + (1.0 - horizon) * random.random(4000) ** 3
    true = space_transmittance(medium, altitude, mu) @ colour_shares(scene.rgb_weights)
    for name in PARAMETRISATIONS:
        made = make_tables(scene, TableSettings(parametrisation=name))
        inputs = {"altitude": altitude, "mu": mu}
        error = look_up(made.tables["transmittance"], made.constants, inputs) - true
        yield [name, f"{math.sqrt((error**2).mean()):.2g}", f"{np.abs(error).max():.2g}"]


def multiple_rows() -> Iterator[list[str]]:
    """Errors of multiple scattering between texels, by the sun's elevation."""
    scene = scene_of("earth", 20.0, 0.2)
    shares = colour_shares(scene.rgb_weights)
    altitude = np.full(200, 5.0)
    for name in ("hillaire2020", "bruneton2017"):
        made = make_tables(scene, TableSettings(parametrisation=name))
        errors = []
        for least, most in SUNS:
            mu_s = np.sin(np.radians(np.linspace(least, most, altitude.size)))
            light = mean_radiance(scene.sky.atmosphere.field, altitude, mu_s)
            true = light[:, : len(shares)] @ shares @ scene.luminance
            inputs = {"altitude": altitude, "mu_s": mu_s}
            found = look_up(made.tables["multiple_scattering"], made.constants, inputs)
            errors.append(100.0 * math.sqrt(((found @ scene.luminance / true - 1.0) ** 2).mean()))
        yield [name, *(f"{float(f'{one:.2g}'):g}" for one in errors)]


def volume_rows() -> Iterator[list[str]]:
    """Errors of the volumes at places between texels."""
    scene = scene_of("earth", 20.0, 0.2)
    random = np.random.default_rng(1)
    x, y = random.random((2, PLACES))
    distances = np.array(DISTANCES)
    for look in (25.0, 0.0):
        for name in ("hillaire2020", "linear"):
            settings = TableSettings(parametrisation=name, elevation=math.radians(look))
            made = make_tables(scene, settings)
            true = air_segments(scene, screen_directions(settings, x, y), distances)
            light = true.radiance @ scene.rgb_weights @ scene.luminance
            passed = true.transmittance @ colour_shares(scene.rgb_weights)
            inputs = {"screen_x": x[:, None], "screen_y": y[:, None], "distance": distances}
            near = made.constants["NEAREST"][0]
            weight = np.minimum(distances / max(near, 1e-9), 1.0)[:, None]
            volumes = (
                look_up(made.tables[which], made.constants, inputs)
                for which in ("aerial_perspective", "aerial_transmittance")
            )
            found, through = next(volumes)[..., :3] * weight, 1.0 + (next(volumes) - 1.0) * weight
            error = np.sqrt(((found @ scene.luminance - light) ** 2).mean(axis=0))
            share = 100.0 * error / light.mean(axis=0)
            largest = np.abs(through - passed).max(axis=(0, 2))
            where = "up, 25 degrees" if look else "at the horizon"
            yield [where, name, "light, %", *(f"{one:.2g}" for one in share)]
            yield ["", "", "transmittance", *(f"{one:.2g}" for one in largest)]


def photograph(path: Path) -> None:
    """Draw the example with Chromium, from files of its own."""
    preset, sun, altitude, look, ev = PICTURE
    azimuth, elevation = map(math.radians, look)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        settings = TableSettings(azimuth=azimuth, elevation=elevation)
        bake_tables(scene_of(preset, sun, altitude), folder, settings)
        shutil.copy(PAGE, folder)
        subprocess.run(
            [
                *("chromium", "--headless=new", "--no-sandbox", "--use-angle=swiftshader"),
                *("--enable-unsafe-swiftshader", "--allow-file-access-from-files"),
                *("--virtual-time-budget=60000", f"--user-data-dir={folder / 'profile'}"),
                f"--window-size={SIZE[0]},{SIZE[1]}",
                f"--screenshot={folder / 'page.png'}",
                f"{(folder / PAGE.name).as_uri()}?ev={ev}",
            ],
            check=True,
            capture_output=True,
            timeout=120,
        )
        picture = Image.open(io.BytesIO((folder / "page.png").read_bytes())).convert("RGB")
    picture.save(path, quality=LOSSY)


def document() -> str:
    """Return the text of tables.md."""
    fields = {
        f"{name} {kind}": f"```\n{find_mappings(kind)[name].forward.strip()}\n```\n"
        for kind in PARAMETRISATIONS
        for name in TABLES
    }
    names = [*PARAMETRISATIONS, "hillaire2020, {}x{}".format(*LARGER)]
    fields["sky errors"] = table(
        ["world", "sun [deg]", *names, "at the sun", "in {}x{}".format(*LARGER)], sky_rows()
    )
    fields["transmittance errors"] = table(
        ["parametrisation", "root mean square", "largest"], transmittance_rows()
    )
    fields["multiple errors"] = table(
        ["parametrisation", *(f"sun {least} to {most} deg" for least, most in SUNS)],
        multiple_rows(),
    )
    fields["volume errors"] = table(
        ["camera", "parametrisation", "error of", *(f"{one:g} km" for one in DISTANCES)],
        volume_rows(),
    )
    text = (FOLDER / "tables.template.md").read_text(encoding="utf-8")
    for name, value in fields.items():
        text = text.replace(f"{{{name}}}\n", value)
    return text


def main() -> None:
    """Write text and picture."""
    (FOLDER / "tables.md").write_text(document(), encoding="utf-8")
    photograph(FOLDER / "images" / "tables.jpg")


if __name__ == "__main__":
    main()
