"""Maps at wavelengths, as other programs read them."""

import json
import math
import warnings

import numpy as np
import OpenEXR
import pytest

import skybake
from skybake.clouds.at_wavelengths import cubic_shares, nodes_among
from skybake.colour.observer import LUMINOUS_EFFICACY, load_observer
from skybake.formats.reader import read_attributes
from skybake.formats.spectral_exr import read_stokes_channel, stokes_channel
from skybake.image.bands import spectral_scenes
from skybake.image.scene import Scene
from skybake.image.sensor import DEFAULT_WAVELENGTHS, Sensor
from skybake.image.settings import Clouds
from skybake.inspect.clouded import clouded_light
from skybake.optics.spectrum import hat_means, hats_at
from skybake.sky.disc import Disc
from skybake.sky.sky import Sky
from tests.cli.runs import invoke, listing

WAVELENGTHS = np.array(DEFAULT_WAVELENGTHS)
COLUMNS = "wavelength_nm,R,G,B\n"


def quick(size=64, wavelengths=DEFAULT_WAVELENGTHS, **values):
    """Settings of a map whose atmosphere need not be solved for."""
    sensor = values.pop("sensor", Sensor(wavelengths=wavelengths))
    return skybake.map_settings(size=size, sensor=sensor, **{"method": "hillaire", **values})


def channels(path):
    file = OpenEXR.File(str(path), separate_channels=True)
    return {name: channel.pixels for name, channel in file.channels().items()}, file.header()


def spectrum(path):
    """Wavelengths, ascending, and radiances of shape (row, column, wavelength)."""
    found, _ = channels(path)
    names = {read_stokes_channel(name): name for name in found if read_stokes_channel(name)}
    order = sorted(names)
    return np.array([each[1] for each in order]), np.stack(
        [found[names[each]].astype(float) for each in order], axis=-1
    )


def luminance(radiance, wavelengths=WAVELENGTHS):
    """By the trapezoid rule over the observer at the wavelengths. [cd m⁻²]"""
    nodes, xyz_bar = load_observer()
    weighted = radiance * np.interp(wavelengths, nodes, xyz_bar[:, 1])
    return LUMINOUS_EFFICACY * np.trapezoid(weighted, wavelengths, axis=-1)


@pytest.fixture(scope="module")
def baked(tmp_path_factory):
    folder = tmp_path_factory.mktemp("spectral")
    skybake.bake("earth", folder / "sky.exr", quick(pixel="float"))
    return folder / "sky.exr"


def test_openexr_finds_a_channel_of_each_wavelength_and_what_the_layout_asks_for(baked):
    found, header = channels(baked)
    wanted = {"R", "G", "B", *(stokes_channel(0, each) for each in DEFAULT_WAVELENGTHS)}
    assert set(found) == wanted
    assert "S0.550,0nm" in found
    assert header["spectralLayoutVersion"] == "1.0"
    assert header["emissiveUnits"] == "W.m^-2.sr^-1"


def test_colour_science_reads_the_layout(baked):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from colour import read_spectral_image_Fichet2021

        components, specification = read_spectral_image_Fichet2021(str(baked), additional_data=True)
    assert specification.is_emissive
    assert not specification.is_polarised
    wavelengths, values = components["S0"]
    assert np.sort(wavelengths).tolist() == WAVELENGTHS.tolist()
    assert values.shape == (32, 64, 31)


def test_the_spectrum_has_the_luminance_of_the_map(baked, tmp_path):
    """Within 0.2 %, both of the colours in its file and of those in a map without a spectrum."""
    _, radiance = spectrum(baked)
    skybake.bake("earth", tmp_path / "plain.exr", quick(pixel="float", sensor=Sensor()))
    weights = np.array([0.2126390, 0.7151687, 0.0721923]) * 1.2 * 2**15
    height = np.cos(math.pi * ((np.arange(32) + 0.5) / 32 - 0.5))[:, None]
    for path, most in ((baked, 2e-3), (tmp_path / "plain.exr", 6e-3)):
        found, _ = channels(path)
        seen = np.stack([found[name] for name in "RGB"], axis=-1) @ weights
        ratio = luminance(radiance) / seen
        assert np.abs(ratio - 1.0).max() < most
        assert (ratio * height * seen).sum() == pytest.approx((height * seen).sum(), rel=2e-3)


def test_pixels_are_the_radiance_of_the_sky(baked):
    wavelengths, radiance = spectrum(baked)
    sky = Sky("earth", math.radians(30.0), wavelengths=wavelengths, method="hillaire")
    for row, column in ((4, 10), (10, 40), (14, 5)):
        elevation = math.pi * (0.5 - (row + 0.5) / 32)
        bearing = 2.0 * math.pi * (column + 0.5) / 64
        # The middle of the map faces south, its left half is the east.
        direction = [
            math.cos(elevation) * math.sin(bearing),
            math.sin(elevation),
            -math.cos(elevation) * math.cos(bearing),
        ]
        per_irradiance = sky.radiance(np.array(direction)) / sky.irradiance
        light = per_irradiance * hat_means(sky.star.irradiance, wavelengths)
        assert radiance[row, column] == pytest.approx(light, rel=4e-3)


def test_the_disc_brings_the_irradiance_of_the_sun_at_each_wavelength(tmp_path):
    wavelengths = (420.0, 550.0, 680.0)
    skybake.bake("earth", tmp_path / "sun.exr", quick(128, wavelengths, sun_disc="only"))
    _, radiance = spectrum(tmp_path / "sun.exr")
    step = math.pi / 64
    height = np.cos(step * (np.arange(64) + 0.5) - math.pi / 2.0)[:, None, None]
    sky = Sky("earth", math.radians(30.0), wavelengths=np.array(wavelengths), method="hillaire")
    normal, _ = Disc(sky.skylight, sky.source).irradiance_per_irradiance()
    light = normal * hat_means(sky.star.irradiance, np.array(wavelengths))
    assert (radiance * height * step**2).sum(axis=(0, 1)) == pytest.approx(light, rel=3e-3)


@pytest.mark.parametrize(
    ("values", "files"),
    [({"projection": "cubemap", "size": 8}, 6), ({"projection": "fisheye", "size": 16}, 1)],
)
def test_every_projection_has_a_spectrum(tmp_path, values, files):
    skybake.bake("earth", tmp_path / "a.exr", quick(wavelengths=(450.0, 600.0), **values))
    assert len(listing(tmp_path)) == files
    for name in listing(tmp_path):
        wavelengths, radiance = spectrum(tmp_path / name)
        assert wavelengths.tolist() == [450.0, 600.0]
        assert radiance.max() > 0.01


def test_more_wavelengths_than_are_solved_for_together_are_all_there(tmp_path):
    many = tuple(np.linspace(380.0, 720.0, 50).tolist())
    skybake.bake("earth", tmp_path / "a.exr", quick(16, many))
    wavelengths, radiance = spectrum(tmp_path / "a.exr")
    assert wavelengths == pytest.approx(many, abs=1e-4)
    assert (radiance[4] > 0.0).all()


def test_the_mean_over_a_hat_keeps_the_integral_of_what_is_linear_between():
    star = skybake.load_preset("earth").star.irradiance
    nodes = np.arange(390.0, 710.1, 0.05)
    light = np.interp(nodes, star.wavelength, star.values)
    even = hat_means(star, WAVELENGTHS)
    hats = [np.clip(1.0 - np.abs(nodes - each) / 10.0, 0.0, None) for each in WAVELENGTHS]
    wanted = [np.trapezoid(light * hat, nodes) / 10.0 for hat in hats]
    assert even == pytest.approx(wanted, rel=1e-4)


def test_a_recipe_and_a_name_tell_the_wavelengths(baked):
    recipe = json.loads(read_attributes(baked)["skybake:recipe"])["map"]
    assert recipe["wavelengths_nm"] == "400:700:10"


@pytest.mark.parametrize(
    ("preset", "values", "problem"),
    [
        ("earth", {"wavelengths": (300.0, 400.0)}, r"wavelength must be within .* got 300 nm"),
        ("earth", {"wavelengths": (500.0, 500.0)}, "spectral: wavelengths must ascend"),
        ("earth", {"wavelengths": ()}, "spectral: must be 1 to 512 wavelengths, got 0"),
        ("earth-hillaire2020", {"wavelengths": (500.0,)}, "needs a preset of rendering spectral"),
        ("earth", {"mips": True}, "must be without mips"),
        ("earth", {"layers": True}, "must be without layers"),
    ],
)
def test_what_has_no_spectrum_is_refused_in_a_line_and_leaves_no_file(
    tmp_path, preset, values, problem
):
    with pytest.raises(skybake.SkybakeError, match=problem) as raised:
        skybake.bake(preset, tmp_path / "a.exr", quick(**values))
    assert "\n" not in str(raised.value)
    assert listing(tmp_path) == []


def test_a_spectral_map_is_found_fine_and_converted_without_its_spectrum(baked, tmp_path):
    assert invoke("check", baked).stdout == f"{baked}: fine\n"
    result = invoke("convert", baked, tmp_path / "small.exr", "--size", "32")
    assert "the spectrum is left out" in result.stderr
    found, header = channels(tmp_path / "small.exr")
    assert set(found) == {"R", "G", "B"}
    assert "spectralLayoutVersion" not in header
    assert "skybake:spectralUnits" not in header


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("380:720:10nm", [380.0 + 10.0 * i for i in range(35)]),
        ("400:420", [400.0, 410.0, 420.0]),
        ("450nm,550,650", [450.0, 550.0, 650.0]),
        ("400:400.3:0.1", [400.0, 400.1, 400.2, 400.3]),
    ],
)
def test_wavelengths_are_a_range_or_a_list(text, wanted):
    from skybake.commands.options.sensor import wavelengths

    assert list(wavelengths(text)) == wanted


@pytest.mark.parametrize(
    "text", ["", "blue", "700:400", "400:700:0", "1:2:3:4", "400,500:600", "nan"]
)
def test_other_wavelengths_are_wrong_usage(tmp_path, monkeypatch, text):
    monkeypatch.chdir(tmp_path)
    result = invoke("render", "--size", "64", "--spectral", text)
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert listing(tmp_path) == []


def test_frames_of_a_sequence_have_spectra_too(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    options = ("--frames", "1-2", "--sun", "20..30", "--size", "32", "--method", "hillaire")
    result = invoke("sequence", *options, "--spectral", "450,600", "-o", "a.####.exr", "-q")
    assert result.exit_code == 0, result.output
    for number in (1, 2):
        wavelengths, radiance = spectrum(tmp_path / f"a.{number:04}.exr")
        assert wavelengths.tolist() == [450.0, 600.0]
        assert radiance.max() > 0.01


@pytest.mark.parametrize(
    "options",
    [
        ("--moon-elevation", "20deg", "--sun", "-30"),
        ("--lst", "3h", "--lat", "30", "--sun", "-30"),
        ("--lst", "3h", "--lat", "30", "--sun", "-30", "--light-pollution", "5mcd"),
    ],
)
def test_spectra_of_lights_of_the_night_have_the_luminance_of_the_map(
    tmp_path, monkeypatch, options
):
    """Lines of the airglow included, each of which is spread over the channels beside it."""
    monkeypatch.chdir(tmp_path)
    quickly = ("--size", "32", "--method", "hillaire", "--pixel", "float", "-q")
    result = invoke("render", *quickly, "--spectral", *options, "-o", "night.exr")
    assert result.exit_code == 0, result.stderr
    found, header = channels(tmp_path / "night.exr")
    weights = np.array([0.2126390, 0.7151687, 0.0721923]) * header["whiteLuminance"]
    seen = np.stack([found[name] for name in "RGB"], axis=-1) @ weights
    _, radiance = spectrum(tmp_path / "night.exr")
    assert radiance.min() > 0.0
    assert luminance(radiance) == pytest.approx(seen, rel=2e-3)


def test_the_green_line_is_in_the_channels_beside_it():
    wavelengths = np.array([440.0, 550.0, 560.0, 675.0])
    hats = hats_at(np.array([557.7, 558.0, 600.0]), wavelengths)
    # 557.7 is nearer to 560, and the hat of 550 reaches 25 nm down and 10 up.
    assert hats[0] == pytest.approx([0.0, 0.23 / 17.5, 0.77 / 17.5, 0.0], rel=1e-6)
    assert (hats[2] == 0.0).all()


def test_clouds_have_the_spectrum_of_rays():
    """At wavelengths too between those at which the light of clouds is solved for."""
    nodes = np.linspace(420.0, 680.0, 14)
    assert nodes_among(nodes).size == 7
    planet = skybake.load_preset("earth-overcast")
    scene = Scene(planet, quick(32, tuple(nodes.tolist())))
    bands = spectral_scenes(scene)
    sky = bands[0][0].sky
    zenith, azimuth = np.array([0.3, 0.9, 1.4]), np.array([1.0, 4.0, 2.0])
    places = zenith[:, None], azimuth[:, None], np.full((3, 1), 1e-4)
    found = np.concatenate([band.evaluate(*places)[:, 0] for band, _ in bands[2:4]], axis=1)
    light = np.diag(hat_means(sky.star.irradiance, nodes))[:, 6:12:2]
    rays = clouded_light(planet, sky, zenith, azimuth, light, Clouds())
    assert found[:, ::2] == pytest.approx(rays, rel=5e-3)


def test_cubics_through_nodes_are_exact_for_cubics():
    nodes, at = np.array([400.0, 450.0, 500.0, 560.0, 600.0]), np.linspace(400.0, 600.0, 23)
    shares = cubic_shares(nodes, at)
    assert (nodes / 500.0) ** 3 @ shares == pytest.approx((at / 500.0) ** 3, rel=1e-12)
    assert shares.sum(axis=0) == pytest.approx(np.ones(23))


def test_stars_that_the_day_outshines_are_in_no_spectrum(tmp_path):
    from skybake.ephemeris.celestial import CelestialFrame
    from skybake.image.night import Night

    night = Night(frame=CelestialFrame("earth", 1.0, 0.5))
    for name, values in (("plain", {}), ("starry", {"night": night})):
        shown = quick(32, (500.0, 600.0), pixel="float", **values)
        skybake.bake("earth", tmp_path / f"{name}.exr", shown)
    _, plain = spectrum(tmp_path / "plain.exr")
    _, starry = spectrum(tmp_path / "starry.exr")
    assert (plain == starry).all()
