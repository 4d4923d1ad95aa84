"""Whatever is typed: a map, or one line that says why not."""

from contextlib import chdir

import click
import pytest
from hypothesis import HealthCheck, given, note, settings
from hypothesis import strategies as st

from skybake.cli import main
from skybake.preset import preset_text
from tests.cli.runs import invoke, run

# Long runs are no fault, so what decides on the cost of a run is never mutated.
COSTLY = {
    "samples": ["1", "0", "x"],
    "frames": ["1-3", "5", "3-1", "1-9:2", "1,,2", ""],
    "transmittance_size": ["8x4", "1x4", "x"],
    "multiple_scattering_size": ["4x4", "4", "4x4x4"],
    "sky_view_size": ["8x6", "8x7", "0x2", "9999x2"],
    "aerial_size": ["3x2x5", "2x2x2", "3x2", "2x2x9999", ""],
}
PATHS = [
    "a.exr",
    "a.hdr",
    "a.ktx2",
    "a.usda",
    "a.png",
    "no/such/a.exr",
    ".",
    "a b.exr",
    "ü.exr",
    f"{'x' * 300}.exr",
]
EXAMPLES = {
    "preset": ["earth", "mars", "earth-hillaire2020", "own.toml", "nowhere", "a/b.toml"],
    "changes": ["ozone.column_du=250", "ground.albedo=snow", "aerosol=none", "a.b=[1, 2", "x", "="],
    "clouds": ["none", "cumulus:1.4", "fog", "cirrus,base=1", "tile=no.npz,base=1km", "=", ","],
    "cloud_time": ["0s", "3min", "-1s", "0s..1h"],
    "visibility": ["20km", "1m", "1e9km"],
    "turbidity": ["3", "1", "0.5"],
    "ozone": ["320DU", "0", "-1DU"],
    "ground_albedo": ["0.3", "sand", "2"],
    "sun_elevation": ["5deg", "-18deg", "90deg", "0.1rad", "91deg", "-6deg..90deg"],
    "sun_azimuth": ["0deg", "270deg", "1e9deg"],
    "altitude": ["0m", "12km", "400km", "-1m", "1e30km", "0m..400km"],
    "size": ["16x8", "16", "0x0", "16x9", "4x2"],
    "fov": ["40deg", "180deg", "0deg", "300deg"],
    "look": ["180,-18", "90deg,0.1rad", "0,91", "180", "x,y"],
    "aspect": ["16:9", "1.5", "0", "1:0", "a:b", "1e400"],
    "far": ["64km", "1m", "0m", "1e30km", "-1km"],
    "face_names": ["px", "right", "a,b,c,d,e,f", "a,b", "a,a,b,c,d,e", "../px"],
    "rotate": ["0deg", "-90", "1e9deg", "north"],
    "sun_size": ["2deg", "0.1rad", "0", "21deg"],
    "sun_strength": ["0.5", "3", "0", "inf"],
    "ev": ["15", "-40", "1e400"],
    "compression": ["zip:4", "piz", "dwaa:45", "lzw", "zip:x"],
    "preview_ev": ["auto", "12", "adapt"],
    "white_balance": ["auto", "none", "5500K", "4000", "9", "warm"],
    "shot": ["180,10,50", "90deg,0.1rad,1rad", "0,91,20", "0,0,175", "0,0,0", "180", "x,y,z"],
    "stars": ["include", "exclude", "only", "4.5", "9", "bright"],
    "airglow": ["0.75", "0", "-1", "dim"],
    "zodiacal": ["2", "0", "1e9", "nan"],
    "sidereal_time": ["5h", "18:36", "279deg", "25h", "361"],
    "moon": [
        "include",
        "only",
        "180deg,30deg",
        "180,30,0.5deg",
        "180,30,0.5deg,inf",
        "0,91",
        "180",
        "a,b",
    ],
    "moon_elevation": ["30deg", "-5", "91"],
    "moon_azimuth": ["120deg", "1e9"],
    "moon_phase": ["full", "quarter", "40deg", "181", "blue"],
    "light_pollution": ["20mag", "1.5mcd,90deg", "off", "-1mcd", "30mag", "bright"],
    "spectral": ["450,550", "400:700:100", "300", "700:400", "x"],
    "camera": ["own.csv", "no.csv"],
    "polarizer": ["30deg", "1e9deg", "up"],
    "latitude": ["48.85", "90N", "91"],
    "longitude": ["2.35", "200W", "E"],
    "zone": ["Europe/Paris", "UTC", "Mars/Gale"],
    "day": ["2026-06-21", "2026-02-30", "today"],
    "time": ["2026-06-21T04:00Z", "sunset-20min", "16:30", "noon", "dawn"],
    "start": ["2026-06-21T04:00Z", "sunrise-1h", "04:00"],
    "end": ["2026-06-21T22:00Z", "civil-dusk", "20:00"],
    "every": ["1h", "0s", "10"],
    "solar_longitude": ["180", "361"],
    "sun_distance": ["mean", "date", "0.98", "1.5au", "0"],
    "only": ["1-2", "9"],
    "fps": ["24", "0", "nan"],
    "retry": ["1", "-1"],
    "workers": ["1", "0"],
    "chunk_size": ["2", "0"],
    "wavelengths": ["550", "680,440", "0", "a,b"],
    "directions": ["own.csv", "no.csv"],
    "dask": ["tcp://127.0.0.1:1"],
    "exposure_curve": ["own.csv", "no.csv"],
}
PATH_OPTIONS = {
    *("output", "preview", "lights", "manifests", "contact_sheet", "animate", "emit_openjd"),
}
ALWAYS = {
    "render": ("--method", "hillaire", "--size", "16x8"),
    "sequence": ("--method", "hillaire", "--dry-run"),
    "probe": ("--method", "hillaire", "--samples", "1"),
    "luts": ("--method", "hillaire", "--aerial-size", "3x2x4", "-o", "tables"),
}
COMMANDS = {
    name: main.get_command(click.Context(main), name)
    for name in ("render", "sequence", "probe", "preview", "luts")
}

mutations = st.one_of(
    st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=8),
    st.sampled_from(
        ["nan", "inf", "-inf", "1e999", "-0", "\uff11\uff12", "5 deg", "0x10", "--", "-"]
    ),
)


@st.composite
def mutated(draw, text):
    """A text with one piece cut out and another put in."""
    first = draw(st.integers(0, len(text)))
    last = draw(st.integers(first, len(text)))
    return text[:first] + draw(mutations) + text[last:]


@st.composite
def words(draw, option):
    """An option with a value, mostly one that is near to what it wants."""
    name = max(option.opts, key=len)
    if option.is_flag:
        return [name]
    if option.name in PATH_OPTIONS:
        return [f"{name}={draw(st.sampled_from(PATHS))}"]
    if option.name in COSTLY:
        return [f"{name}={draw(st.sampled_from(COSTLY[option.name]))}"]
    choices = list(option.type.choices) if isinstance(option.type, click.Choice) else None
    value = draw(st.sampled_from(choices or EXAMPLES[option.name]))
    if draw(st.integers(0, 2)) == 0 and option.name not in {"size", "dask"}:
        value = draw(mutated(value))
    return [f"{name}={value}"]


@st.composite
def command_lines(draw):
    name = draw(st.sampled_from(sorted(COMMANDS)))
    known = [one for one in COMMANDS[name].params if isinstance(one, click.Option)]
    chosen = draw(st.lists(st.sampled_from(known), max_size=4, unique_by=id))
    line = [name, *ALWAYS.get(name, ())]
    for option in chosen:
        line += draw(words(option))
    if name == "preview":
        line.append(draw(st.sampled_from(["map.exr", "own.csv", "no.exr", "."])))
    return line


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Holds a map, a preset and a table of one's own."""
    folder = tmp_path_factory.mktemp("fuzz")
    (folder / "own.toml").write_text('extends = "mars"\n[constituents.dust]\noptical_depth = 0.1\n')
    (folder / "own.csv").write_text("view_zenith_deg,relative_azimuth_deg,frame,ev\n5,10,1,12\n")
    status, _, errors = run("render", "--size", "16x8", "-q", "-o", folder / "map.exr")
    assert (status, errors) == (0, "")
    return folder


def check(folder, line):
    note(" ".join(line))
    with chdir(folder):
        result = invoke(*line)
    assert result.exception is None or isinstance(result.exception, SystemExit)
    assert result.exit_code in {0, 1, 2}
    errors = result.stderr.splitlines()
    faults = [one for one in errors if one.startswith("skybake: ") and "warning: " not in one]
    if result.exit_code:
        assert result.stdout == ""
        assert faults
        assert errors[-1] == faults[-1]
    assert all(one.startswith("skybake: ") for one in errors)
    assert not list(folder.rglob(".skybake-*"))


LENIENT = [HealthCheck.function_scoped_fixture, HealthCheck.too_slow]


@given(line=command_lines())
@settings(max_examples=300, deadline=None, suppress_health_check=LENIENT)
def test_any_options_end_in_a_map_or_one_line(folder, line):
    check(folder, line)


@pytest.mark.nightly
@given(line=command_lines())
@settings(max_examples=10_000, deadline=None, suppress_health_check=LENIENT)
def test_any_options_end_in_a_map_or_one_line_all_night(folder, line):
    check(folder, line)


def test_every_option_is_typed_in():
    """An option without examples would never be tried."""
    for name, command in COMMANDS.items():
        for option in command.params:
            known = EXAMPLES.keys() | COSTLY.keys() | PATH_OPTIONS
            plain = option.is_flag if isinstance(option, click.Option) else True
            chosen = isinstance(option.type, click.Choice)
            assert plain or chosen or option.name in known, (name, option.name)


PRESETS = [preset_text(name).encode() for name in ("earth", "mars", "earth-hillaire2020")]
PIECES = [
    b"=",
    b"[",
    b"]]",
    b"\xff",
    b"\0",
    b'"""',
    b"{",
    b"1e999",
    b"nan",
    b"-",
    b"[a]\n",
    b"\r",
    b"#",
]


@st.composite
def damaged_presets(draw):
    """Bytes of a preset with some of them cut out, doubled or replaced."""
    content = draw(st.sampled_from(PRESETS))
    for _ in range(draw(st.integers(1, 3))):
        first = draw(st.integers(0, len(content)))
        last = draw(st.integers(first, min(len(content), first + 40)))
        piece = st.one_of(st.sampled_from(PIECES), st.just(content[first:last] * 2), st.binary())
        content = content[:first] + draw(piece) + content[last:]
    return content


def check_preset(folder, content):
    (folder / "damaged.toml").write_bytes(content)
    with chdir(folder):
        result = invoke("presets", "check", "damaged.toml")
    assert result.exception is None or isinstance(result.exception, SystemExit)
    assert result.exit_code in {0, 1}
    assert bool(result.exit_code) == bool(result.stdout == "")
    lines = result.stderr.splitlines()
    assert all(one.startswith("skybake: ") for one in lines)
    assert lines or not result.exit_code


@given(content=damaged_presets())
@settings(max_examples=100, deadline=None, suppress_health_check=LENIENT)
def test_any_bytes_of_a_preset_are_checked_or_refused_in_lines(folder, content):
    check_preset(folder, content)


@pytest.mark.nightly
@given(content=damaged_presets())
@settings(max_examples=10_000, deadline=None, suppress_health_check=LENIENT)
def test_any_bytes_of_a_preset_are_checked_or_refused_in_lines_all_night(folder, content):
    check_preset(folder, content)
