"""What is written about a sequence can be read and is all there."""

import csv
import json
import re
from pathlib import Path

import pytest

import skybake
from skybake.errors import OutputError
from skybake.sequence.frames import parse_frames
from skybake.sequence.manifest import FrameRecord, write_csv, write_manifest
from skybake.sidecar.dome_and_sun import DistantLight
from tests.sequence.records import HEADER, record

DOCUMENT = Path(__file__).parents[2] / "docs" / "sequences.md"

CUBE = {
    "files": tuple(f"sky.0003_{face}.exr" for face in ("px", "nx", "py", "ny", "pz", "nz")),
    "sha256": tuple(f"{digit}" * 64 for digit in range(6)),
    "time": None,
    "label": None,
    "exposure_ev": None,
}


def test_a_manifest_holds_header_and_records_by_frame(tmp_path):
    records = [record(3), record(-1, elevation=-2.5), record(1, preview="sky.0001.png")]
    write_manifest(tmp_path / "sky.sequence.json", HEADER, records)
    read = json.loads((tmp_path / "sky.sequence.json").read_text("utf-8"))
    assert read["schema"] == 1
    assert read["skybake"] == skybake.__version__
    assert parse_frames(read["frames"]) == (-1, 1, 3)
    assert read["recipe"] == HEADER.recipe
    assert read["fps"] == 24.0
    by_frame = {one.frame: one for one in records}
    for row in read["records"]:
        tuples = {key: tuple(v) if isinstance(v, list) else v for key, v in row.items()}
        assert FrameRecord(**tuples) == by_frame[row["frame"]]
    assert [row["frame"] for row in read["records"]] == [-1, 1, 3]


def test_every_key_of_a_manifest_is_documented_and_every_documented_one_exists(tmp_path):
    moon = DistantLight(
        elevation_deg=30.0,
        azimuth_deg=120.0,
        angular_diameter_deg=0.52,
        colour=(1.0, 1.0, 1.0),
        illuminance_lux=0.2,
    )
    write_manifest(tmp_path / "a.json", HEADER, [record(1, moon=moon)])
    read = json.loads((tmp_path / "a.json").read_text("utf-8"))
    section = DOCUMENT.read_text("utf-8").partition("### Manifest\n")[2].partition("\n### ")[0]
    rows = re.findall(r"^\| (`.*?) \|", section, re.MULTILINE)
    documented = re.findall(r"`(\w+)`", " ".join(rows))
    (row,) = read["records"]
    assert sorted(documented) == sorted([*read, *row])


def test_a_manifest_has_no_number_that_json_lacks(tmp_path):
    with pytest.raises(ValueError, match="JSON"):
        write_manifest(tmp_path / "a.json", HEADER, [record(1, sky_illuminance_lux=float("nan"))])
    assert not list(tmp_path.iterdir())


def test_csv_has_a_row_for_each_frame_and_a_column_for_each_number(tmp_path):
    path = tmp_path / "sky.csv"
    write_csv(path, [record(3, **CUBE), record(2, elevation=12.5, azimuth=90.0)])
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["frame"] for row in rows] == ["2", "3"]
    first, second = rows
    assert first["time"] == "2026-06-21T12:02:00Z"
    assert float(first["sun_elevation_deg"]) == 12.5
    assert float(first["sun_direction_x"]) == pytest.approx(0.976296, abs=1e-6)
    assert [first[f"sun_colour_{axis}"] for axis in "rgb"] == ["1.2", "0.98", "0.61"]
    assert float(first["sky_illuminance_lux"]) == 12345.678
    assert first["files"] == "sky.0002.exr"
    assert tuple(second["files"].split(";")) == CUBE["files"]
    assert second["time"] == second["label"] == second["exposure_ev"] == second["preview"] == ""


@pytest.mark.parametrize(
    "write", [lambda p: write_csv(p, []), lambda p: write_manifest(p, HEADER, [])]
)
def test_a_folder_that_is_absent_is_an_error_of_one_line(tmp_path, write):
    with pytest.raises(OutputError, match="folder must exist"):
        write(tmp_path / "absent" / "sky.json")
