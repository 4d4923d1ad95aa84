"""Worlds without air: a black sky, lit ground and the sun's whole light."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

from skybake.formats.reader import read_image
from tests.cli.runs import SMALL, invoke, listing

NO_AIR = [f"--set={name}=none" for name in ("air", "ozone", "aerosol")]
QUICK = (*SMALL, "-q")

pytestmark = pytest.mark.usefixtures("folder")


def done(*arguments):
    result = invoke(*arguments)
    assert result.exit_code == 0, result.output
    return result.stdout


@pytest.mark.parametrize("method", ["full", "scalar", "hillaire", "march"])
def test_ground_is_lit_as_a_white_surface_times_its_albedo_and_the_sky_is_black(method):
    grey = ("--ground-albedo", "0.3", "--colorspace", "xyz", "--units", "nits", "--pixel", "float")
    told = json.loads(
        done(
            *("render", *QUICK, *NO_AIR, *grey, "--sun", "30", "--sun-disc", "exclude"),
            *("--method", method, "--json", "-o", "a.exr"),
        )
    )
    assert told["sky_illuminance_lux"] == 0.0
    assert told["direct_illuminance_lux"] == pytest.approx(133_100 / 2, rel=1e-3)
    pixels, _ = read_image(Path("a.exr"))
    luminance = pixels[..., 1]
    assert np.all(luminance[:15] == 0.0)
    np.testing.assert_allclose(
        luminance[18:], 0.3 * told["direct_illuminance_lux"] / math.pi, rtol=2e-3
    )


@pytest.mark.parametrize(
    "arguments", [("--sun=-5",), ("--altitude", "400km"), ("--altitude", "400km", "--sun=-10")]
)
def test_the_ground_has_no_twilight(arguments):
    """From orbit the sun is seen below the horizontal, and lights the ground beyond the limb."""
    told = json.loads(done("render", *QUICK, *NO_AIR, *arguments, "--json", "-o", "a.exr"))
    assert told["sky_illuminance_lux"] == 0.0
    pixels, _ = read_image(Path("a.exr"))
    assert np.isfinite(pixels).all()
    assert pixels.min() >= 0.0
    assert pixels.max() > 0.0 or "400km" not in arguments


@pytest.mark.slow
def test_a_probe_sees_ground_below_and_nothing_above():
    Path("in.csv").write_text("view_zenith_deg,relative_azimuth_deg\n30,0\n180,0\n", "utf-8")
    for method in ("full", "reference"):
        text = done(
            *("probe", *NO_AIR, "--ground-albedo", "0.3", "--sun", "30", "--directions", "in.csv"),
            *("--wavelengths", "550", "--per-irradiance", "--method", method, "--samples", "50"),
        )
        up, down = (float(row["radiance_550nm"]) for row in csv.DictReader(text.splitlines()))
        assert up == 0.0
        assert down == pytest.approx(0.3 * 0.5 / math.pi, rel=1e-6)


@pytest.mark.parametrize("method", ["full", "reference"])
def test_where_nothing_scatters_light_its_polarisation_is_refused(method):
    Path("in.csv").write_text("view_zenith_deg,relative_azimuth_deg\n30,0\n", "utf-8")
    few = ("--directions", "in.csv", "--wavelengths", "550", "--samples", "2")
    result = invoke("probe", *NO_AIR, "--stokes", "--method", method, *few)
    assert result.exit_code == 1
    told = "polarisation: world must have something that scatters light, got none"
    assert result.output == f"skybake: {told}\n"


def test_a_check_prints_figures_of_nothing():
    text = done("presets", "check", "earth", *NO_AIR)
    assert "visibility: without limit at the ground" in text
    assert "turbidity" not in text
    assert "will not render" not in text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--visibility", "5km"), "--visibility: needs a constituent of kind aerosol that reaches"),
        (("--turbidity", "2"), "--turbidity: needs a constituent of kind aerosol that reaches the"),
        (("--ozone", "200"), "--ozone: needs an absorber of the name ozone, earth has no absorber"),
    ],
)
def test_what_would_need_air_is_refused(arguments, message):
    result = invoke("render", *QUICK, *NO_AIR, *arguments)
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr.startswith(f"skybake: {message}")


def test_a_plot_of_nothing_is_refused():
    pytest.importorskip("matplotlib")
    result = invoke("presets", "plot", "earth", *NO_AIR)
    assert result.exit_code == 1
    assert result.stderr == "skybake: earth: must have a constituent to draw, got none\n"
    assert listing(Path()) == []


def test_a_sequence_goes_from_night_to_day():
    told = json.loads(
        done(
            *("sequence", *SMALL, "-q", *NO_AIR, "--sun=-3..60", "--frames", "1-3", "--json"),
            *("-o", "a.#.exr", "--contact-sheet", "a.png"),
        )
    )
    assert told["baked"] == 3
    record = json.loads(Path("a.sequence.json").read_text("utf-8"))["records"]
    assert [one["sky_illuminance_lux"] for one in record] == [0.0, 0.0, 0.0]


def test_a_preset_of_its_own_may_have_no_constituents():
    text = 'extends = "earth"\n[constituents]\nair = "none"\nozone = "none"\naerosol = "none"\n'
    Path("moon.toml").write_text(text, "utf-8")
    assert "sun above the atmosphere: 1.331e+05 lx" in done("presets", "check", "moon.toml")
