"""Radiances as CSV: what is asked, what is answered, and what is refused."""

import csv
import io

import numpy as np
import pytest

from tests.cli.runs import invoke, listing, run

FEW = ("--wavelengths", "680,550,440", "--per-irradiance")
HILLAIRE = ("--preset", "earth-hillaire2020", "--method", "hillaire")
VIEWS = "view_zenith_deg,relative_azimuth_deg\n0,0\n60.50,-90\n95,180\n"


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def numbers(rows, column):
    return np.array([float(row[column]) for row in rows])


@pytest.fixture
def views(tmp_path):
    path = tmp_path / "views.csv"
    path.write_text(VIEWS)
    return path


def test_without_directions_it_looks_around_and_through_the_suns_plane():
    rows = rows_of(invoke("probe", *HILLAIRE, *FEW, "--sun", "20deg").stdout)
    directions = [
        (float(row["view_zenith_deg"]), float(row["relative_azimuth_deg"])) for row in rows
    ]
    assert directions[:13] == [(70.0, azimuth) for azimuth in range(0, 181, 15)]
    assert {azimuth for _, azimuth in directions[13:]} == {0.0, 180.0}
    assert {zenith for zenith, _ in directions[13:]} == set(range(0, 86, 5))
    assert (numbers(rows, "radiance_550nm") > 0.0).all()


def test_directions_are_repeated_as_they_were_given(views):
    rows = rows_of(invoke("probe", *HILLAIRE, *FEW, "--directions", views).stdout)
    given = [(row["view_zenith_deg"], row["relative_azimuth_deg"]) for row in rows]
    assert given == [("0", "0"), ("60.50", "-90"), ("95", "180")]


def test_per_irradiance_leaves_out_what_is_for_eyes(views):
    rows = rows_of(invoke("probe", *HILLAIRE, *FEW, "--directions", views).stdout)
    assert list(rows[0])[2:] == ["radiance_680nm", "radiance_550nm", "radiance_440nm"]


def test_radiance_is_that_per_irradiance_times_the_stars(views):
    common = ("--preset", "earth", "--method", "hillaire", "--directions", views)
    relative = rows_of(invoke("probe", *common, *FEW).stdout)
    absolute = rows_of(invoke("probe", *common, *FEW[:2]).stdout)
    assert list(absolute[0])[-3:] == ["luminance_cd_m2", "chromaticity_x", "chromaticity_y"]
    # ASTM G173-03 has 1.86 and 1.83 W/m2/nm there.
    for wavelength, low, high in ((550, 1.8, 1.95), (440, 1.7, 1.95)):
        column = f"radiance_{wavelength}nm"
        share = numbers(absolute, column) / numbers(relative, column)
        assert np.ptp(share) < 1e-5
        assert low < share[0] < high


def test_a_blue_sky_is_blue(views):
    rows = rows_of(invoke("probe", "--preset", "earth", "--directions", views).stdout)
    assert float(rows[0]["chromaticity_x"]) < 0.30
    assert 500.0 < float(rows[0]["luminance_cd_m2"]) < 10_000.0


def test_a_clear_sky_is_the_same_from_every_bearing_of_the_sun(views):
    south, east = (
        invoke("probe", *HILLAIRE, *FEW, "--directions", views, *azimuth).stdout
        for azimuth in ((), ("--sun-azimuth", "90deg"))
    )
    assert south == east


def test_standard_input_and_a_file_give_the_same(views, tmp_path):
    target = tmp_path / "out.csv"
    with views.open() as stdin:
        status, output, errors = run("probe", *HILLAIRE, *FEW, "--directions", "-", stdin=stdin)
    assert (status, errors) == (0, "")
    result = invoke("probe", *HILLAIRE, *FEW, "--directions", views, "-o", target)
    assert (result.exit_code, result.output) == (0, "")
    assert target.read_text() == output
    assert listing(tmp_path) == ["out.csv", "views.csv"]


def test_illuminances_stand_in_every_row(views):
    # 89.3 klx of a sun at 60 deg on the horizontal and 15 klx of sky, within a fifth.
    common = ("--preset", "earth", "--sun", "60deg", "--illuminance", "--directions", views)
    rows = rows_of(invoke("probe", *common, *FEW[:2]).stdout)
    assert len({tuple(row.items())[-3:] for row in rows}) == 1
    normal, horizontal, sky = (
        float(rows[0][f"{name}_illuminance_lux"]) for name in ("direct_normal", "direct", "sky")
    )
    assert horizontal == pytest.approx(normal * np.sin(np.radians(60.0)), rel=1e-3)
    assert horizontal == pytest.approx(89_300.0, rel=0.2)
    assert sky == pytest.approx(15_000.0, rel=0.2)


@pytest.mark.parametrize("place", [("10deg", "0m"), ("-3deg", "10km")])
def test_reference_and_the_full_solution_agree_within_its_errors(place, views):
    common = ("--preset", "earth-hillaire2020", "--sun", place[0], "--altitude", place[1])
    common += ("--directions", views, *FEW)
    full = rows_of(invoke("probe", *common).stdout)
    traced = rows_of(invoke("probe", *common, "--method", "reference", "--samples", 3000).stdout)
    for wavelength in (680, 550, 440):
        expected = numbers(full, f"radiance_{wavelength}nm")
        error = numbers(traced, f"stderr_{wavelength}nm")
        off = np.abs(numbers(traced, f"radiance_{wavelength}nm") - expected)
        assert (error > 0.0).all()
        assert (error < 0.1 * expected).all()
        assert (off < 4.0 * error + 0.01 * expected).all()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "zenith,view_zenith_deg\n1,2\n",
            "must have the columns view_zenith_deg, relative_azimuth_deg, "
            "got zenith, view_zenith_deg",
        ),
        ("", "must have the columns view_zenith_deg, relative_azimuth_deg, got nothing"),
        ("view_zenith_deg,relative_azimuth_deg\n", "must hold at least one direction, got none"),
        (f"{VIEWS}190,0\n", "line 5: view_zenith_deg: must be from 0 to 180, got 190"),
        (f"{VIEWS}-1,0\n", "line 5: view_zenith_deg: must be from 0 to 180, got -1"),
        (f"{VIEWS}nan,0\n", "line 5: view_zenith_deg: must be a number, got 'nan'"),
        (f"{VIEWS}5,inf\n", "line 5: relative_azimuth_deg: must be a number, got 'inf'"),
        (f"{VIEWS}5,east\n", "line 5: relative_azimuth_deg: must be a number, got 'east'"),
        (
            f"{VIEWS}{'1' * 200_000},0\n",
            "line 5: must be CSV, got field larger than field limit (131072)",
        ),
        (f"{VIEWS}5\n", "line 5: relative_azimuth_deg: must be a number, got ''"),
    ],
)
def test_faulty_directions_are_one_line_with_their_place(text, message, tmp_path):
    path = tmp_path / "faulty.csv"
    path.write_text(text)
    result = invoke("probe", *HILLAIRE, "--directions", path, "-o", tmp_path / "out.csv")
    assert result.exit_code == 1
    assert result.stderr.strip().endswith(f"{path}: {message}")
    assert len(result.stderr.splitlines()) == 1
    assert listing(tmp_path) == ["faulty.csv"]


@pytest.mark.parametrize(
    ("status", "arguments", "message"),
    [
        (
            1,
            ("--directions", "nowhere.csv"),
            "nowhere.csv: cannot be read: No such file",
        ),
        (1, ("--directions", "."), ".: must be a regular file, got a folder"),
        (1, ("--wavelengths", "680,200"), "got 200"),
        (2, ("--wavelengths", ",".join(map(str, range(400, 529)))), "must be at most 128, got 129"),
        (2, ("--output", "sky.exr"), "sky.exr: suffix must be .csv, got '.exr'"),
        (2, ("--wavelengths", "red"), "must be wavelengths in nm such as 680,550,440, got 'red'"),
        (2, ("--wavelengths", "-550"), "must be wavelengths in nm such as 680,550,440, got '-550'"),
        (2, ("--wavelengths", "nan"), "must be wavelengths in nm such as 680,550,440, got 'nan'"),
        (2, ("--sun", "nan"), "must be an angle such as 5deg"),
        (2, ("--sun-azimuth", "south"), "must be an angle"),
        (2, ("--time", "2026-06-21T12:00Z", "--sun-azimuth", "0deg"), "cannot be combined with"),
        (2, ("--altitude", "-1m"), "must be at least 0m"),
        (2, ("--samples", "0"), "--samples"),
    ],
)
def test_faulty_options_are_refused_with_their_value(status, arguments, message):
    result = invoke("probe", "--preset", "earth-hillaire2020", *arguments)
    assert result.exit_code == status
    assert message in result.stderr
    assert "Traceback" not in result.output
    assert result.stdout == ""


def test_a_file_that_is_no_text_is_refused(tmp_path):
    path = tmp_path / "binary.csv"
    path.write_bytes(b"\xff\xfe\x00")
    result = invoke("probe", *HILLAIRE, "--directions", path)
    assert result.exit_code == 1
    assert result.stderr.strip().endswith(f"{path}: must be UTF-8 text")
