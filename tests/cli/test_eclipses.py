"""Options of moons in front of the sun."""

import pytest
from click.testing import CliRunner

from skybake.cli import main


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("--moon 1", "must be include, exclude, only or AZIMUTH,ELEVATION[,DIAMETER[,DISTANCE]]"),
        ("--moon 180,95", "must be from -90deg to 90deg, got 95"),
        ("--moon 180,40,0", "moon diameter: must be greater than 0deg"),
        ("--moon 180,40,1deg,-5km", "moon distance: must be greater than 0 km, got -5 km"),
        ("--moon 180,30,1deg,5", "needs a unit"),
        ("--eclipse off", "--eclipse: needs --time"),
        (
            "--moon 180,30 --eclipse off --time 2026-08-12T18:00Z --lat 1 --lon 1",
            "--eclipse: cannot be combined with --moon",
        ),
        ("--moon 180,30 --method march", "eclipse: method must be full or hillaire, got march"),
    ],
)
def test_moons_that_have_no_effect_or_do_not_exist_are_refused_in_one_line(
    options, message, tmp_path
):
    output = tmp_path / "sky.exr"
    result = CliRunner().invoke(main, ["render", *options.split(), "-q", "-o", str(output)])
    assert result.exit_code in (1, 2)
    assert message in result.output + str(result.exception)
    assert not list(tmp_path.iterdir())
