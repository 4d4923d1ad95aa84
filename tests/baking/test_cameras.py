"""Maps in the channels of a camera."""

import numpy as np
import pytest

import skybake
from skybake.colour.camera import load_camera
from skybake.colour.observer import load_observer
from skybake.image.sensor import Sensor
from tests.baking.test_spectral import COLUMNS, channels, quick
from tests.cli.runs import invoke, listing


@pytest.fixture
def observer(tmp_path):
    """A camera whose channels are those of the observer."""
    nodes, xyz_bar = load_observer()
    lines = [f"{w:g},{x},{y},{z}" for w, (x, y, z) in zip(nodes, xyz_bar, strict=True)]
    path = tmp_path / "observer.csv"
    path.write_text(COLUMNS + "\n".join(lines))
    return path


def test_a_camera_with_the_eyes_response_sees_the_eyes_luminance(observer, tmp_path):
    camera = Sensor(response=load_camera(observer, "none"))
    skybake.bake("earth", tmp_path / "camera.exr", quick(sensor=camera, pixel="float"))
    eye = quick(sensor=Sensor(), pixel="float", colorspace="xyz")
    skybake.bake("earth", tmp_path / "eye.exr", eye)
    by_camera, header = channels(tmp_path / "camera.exr")
    by_eye, _ = channels(tmp_path / "eye.exr")
    for name in "RGB":
        assert by_camera[name] == pytest.approx(by_eye[name], rel=1e-3)
    assert header["skybake:camera"].startswith("observer.csv sha256:")
    assert header["colorInteropID"] == "unknown"
    assert "chromaticities" not in header


def test_daylight_is_white_to_a_camera_unless_it_keeps_its_ratios(observer):
    import colour

    d65 = colour.SDS_ILLUMINANTS["D65"]
    nodes = np.arange(360.0, 831.0, 5.0)
    light = np.array([d65[each] for each in nodes])
    wavelengths = np.linspace(380.0, 720.0, 16)
    whole = load_camera(observer).weights(wavelengths, nodes, light).sum(axis=0)
    assert whole == pytest.approx(np.full(3, whole[1]), rel=1e-4)
    own = load_camera(observer, "none").weights(wavelengths, nodes, light).sum(axis=0)
    # CIE 015: XYZ of D65.
    assert own / own[1] == pytest.approx([0.95047, 1.0, 1.08883], abs=1e-3)
    assert own[1] == pytest.approx(whole[1], rel=1e-4)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "columns must be wavelength_nm,R,G,B"),
        ("wavelength_nm,R,G\n400,1,1\n", "columns must be"),
        (COLUMNS + "400,1,1,1\n", "must have at least 2 wavelengths, got 1"),
        (COLUMNS + "400,1,1,1\n400,1,1,1\n700,1,1,1\n", "wavelengths must ascend"),
        (COLUMNS + "450,1,1,1\n700,1,1,1\n", "must cover 400 to 700 nm, got 450 to 700 nm"),
        (COLUMNS + "400,1,1,nan\n700,1,1,1\n", "a row must be four finite numbers"),
        (COLUMNS + "400,1,1,-1\n700,1,1,1\n", "B must be at least 0"),
        (COLUMNS + "400,0,1,1\n700,0,1,1\n", "R must be at least 0, and greater than 1e-30"),
        (COLUMNS + "400,1e-320,1,1\n700,1e-320,1,1\n", "R must be at least 0, and greater than"),
        (COLUMNS + "-5,1,1,1\n700,1,1,1\n", "a wavelength must be greater than 0 nm"),
    ],
)
def test_a_faulty_response_is_refused_in_a_line(tmp_path, monkeypatch, text, problem):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "camera.csv").write_text(text)
    result = invoke("render", "--size", "64", "--camera", "camera.csv", "-q")
    assert result.exit_code == 1
    assert problem in result.stderr
    assert result.stderr.count("\n") == 1
    assert listing(tmp_path) == ["camera.csv"]


def test_a_camera_that_sees_what_the_map_has_not_is_refused(tmp_path):
    (tmp_path / "infrared.csv").write_text(COLUMNS + "400,1,1,1\n830,1,1,1\n")
    sensor = Sensor(response=load_camera(tmp_path / "infrared.csv"))
    with pytest.raises(skybake.InputError, match="response must lie within the map's wavelengths"):
        skybake.bake("earth", tmp_path / "a.exr", quick(sensor=sensor))


def test_a_cameras_map_is_fine_but_not_converted(observer, tmp_path):
    camera = Sensor(response=load_camera(observer))
    skybake.bake("earth", tmp_path / "camera.exr", quick(sensor=camera))
    assert invoke("check", tmp_path / "camera.exr").exit_code == 0
    result = invoke("convert", tmp_path / "camera.exr", tmp_path / "b.exr")
    assert result.exit_code == 1
    assert "colours must be those of an eye, got a camera's" in result.stderr
    assert not (tmp_path / "b.exr").exists()


@pytest.mark.parametrize(
    "options",
    [
        ("--spectral", "-o", "a.hdr"),
        ("--spectral", "--mips"),
        ("--spectral", "--sun-disc", "separate"),
        ("--camera-white", "none"),
        ("--camera", "observer.csv", "--colorspace", "acescg"),
        ("--camera", "observer.csv", "--lights", "a.usda"),
    ],
)
def test_options_that_contradict_a_spectrum_or_a_camera_are_wrong_usage(
    observer, tmp_path, monkeypatch, options
):
    monkeypatch.chdir(tmp_path)
    result = invoke("render", "--size", "64", *options)
    assert result.exit_code == 2, result.output
    assert result.stderr.count("\n") == 1
    assert listing(tmp_path) == ["observer.csv"]
