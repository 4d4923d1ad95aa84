"""Commands that a sequence prints for other machines to run."""

from datetime import datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

from tests.cli.runs import invoke
from tests.cli.sequences import DAY


def emitted(*arguments):
    result = invoke("sequence", "--emit-commands", *arguments)
    assert result.exit_code == 0, result.output
    return result.stdout.splitlines()


def test_emitted_commands_have_what_makes_the_frames_and_nothing_else(folder):
    Path("own.toml").write_text('extends = "earth"\n', encoding="utf-8")
    Path("ev.csv").write_text("frame,ev\n1,15\n", encoding="utf-8")
    Path("flat.csv").write_text("wavelength_nm,albedo\n300,0.2\n900,0.2\n", encoding="utf-8")
    lines = emitted(
        *("--preset", "own.toml", "--set", "aerosol.optical_depth=0.1..0.3", *DAY),
        *("--set", "ground.albedo=flat.csv", "--frames", "1-4", "--chunk-size", "3"),
        *("-o", "out dir/a.#.exr", "--workers", "1", "--skip-existing", "--retry", "2"),
        *("--contact-sheet", "s.png", "--preview-ev", "3", "--view", "aces2"),
        *("--white-balance", "auto", "--shot", "180,0,50"),
        *("--exposure-curve", "ev.csv", "--manifest", "m.json", "--dask", "tcp://a:1", "-q"),
    )
    first = (
        f"skybake sequence --preset={folder}/own.toml --set=aerosol.optical_depth=0.1..0.3 "
        f"--set=ground.albedo={folder}/flat.csv --sun=20deg..60deg --frames=1-4 "
        f"--exposure-curve={folder}/ev.csv '--output={folder}/out dir/a.#.exr' "
        "--skip-existing --retry=2 --workers=1 --only "
    )
    assert lines == [f"{first}1-3", f"{first}4"]


def test_emitted_commands_of_a_part_are_of_that_part():
    lines = emitted(*DAY, "--frames", "1-9", "--only", "2-4,9", "--chunk-size", "2", "--preview")
    assert [line.partition(" --only ")[2] for line in lines] == ["2-3", "4,9"]
    assert all(" --preview " in line and "earth.####.exr" in line for line in lines)


def test_emitted_commands_name_the_date_that_today_is():
    place = ("--lat", "48.8566", "--lon", "2.3522", "--tz", "Europe/Paris", "--date", "today")
    span = ("--from", "sunset", "--to", "civil-dusk", "--frames", "1-2", "--no-refraction")
    before = datetime.now(ZoneInfo("Europe/Paris")).date()
    command = invoke("sequence", *place, *span, "--emit-commands").stdout
    # Midnight may pass meanwhile.
    assert any(f"--date={before + timedelta(days=days)}" in command for days in (0, 1))
    assert "--no-refraction" in command.split()
    assert "today" not in command
