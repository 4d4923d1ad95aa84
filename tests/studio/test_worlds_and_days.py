"""What the page is told of worlds and of days."""

import pytest

from skybake.commands.render_reader import RenderReader
from skybake.errors import SkybakeError
from skybake.preset import load_preset, preset_names
from skybake.studio.day import day_of
from skybake.studio.presets import preset_list, preset_picture
from skybake.studio.state import State
from skybake.studio.world import comments_of, world_of

PARIS = {"lat": "48.86", "lon": "2.35", "tz": "Europe/Paris", "date": "2026-06-21"}
GALE = {"preset": "mars", "site": "gale", "ls": "90"}


@pytest.fixture
def reader(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return RenderReader(tmp_path)


@pytest.mark.parametrize("name", preset_names())
def test_every_number_of_a_world_can_be_set_by_its_key(name):
    values = {one["key"]: one for one in world_of(name)["values"]}
    assert len(values) >= 4
    for key, one in values.items():
        assert one["min"] <= one["default"] <= one["max"], key
        assert one["source"].partition(":")[0].endswith(".toml")
    changes = {key: one["default"] for key, one in values.items()}
    recipe = load_preset(name, changes).recipe
    assert recipe.pop("set")
    assert recipe == load_preset(name).recipe


def test_a_value_has_the_source_that_its_preset_states():
    values = {one["key"]: one for one in world_of("mars")["values"]}
    height = values["dust.profile.scale_height_km"]
    assert "Spirit 11.9 km, Curiosity 13.9 km" in height["source"]
    assert (height["unit"], height["scale"], height["default"]) == ("km", "log", 11.5)
    assert values["gas.pressure_pa"]["source"].startswith("mars.toml: mean at the datum")


def test_an_inherited_value_names_the_preset_that_it_comes_from():
    values = {one["key"]: one for one in world_of("mars-dusty")["values"]}
    assert values["dust.optical_depth"]["source"].startswith("mars-dusty.toml")
    assert values["gas.pressure_pa"]["source"].startswith("mars.toml")


def test_comments_belong_to_the_line_that_follows_or_holds_them():
    text = "# of all\na = 1 # beside\n\n[b.c]\n# above\n# both\nd = 2\ne = 3\n"
    assert comments_of(text) == {"a": "beside of all", "b.c.d": "above both"}


def test_a_day_has_its_events_in_order_and_a_curve_through_them(reader):
    day = day_of(reader.day(PARIS))
    assert (day["date"], day["zone"]) == ("2026-06-21", "Europe/Paris")
    names = [event["name"] for event in day["events"]]
    assert names.index("sunrise") < names.index("noon") < names.index("sunset")
    events = {event["name"]: event for event in day["events"]}
    assert (events["sunrise"]["label"], events["sunset"]["label"]) == ("05:46", "21:57")
    assert "astronomical-dusk" not in events  # the sun stays above -18 degrees
    assert len(day["curve"]) == 145
    assert max(one["elevation_deg"] for one in day["curve"]) == pytest.approx(64.6, abs=0.1)


@pytest.mark.parametrize("options", [PARIS, GALE])
def test_the_times_of_a_curve_are_what_the_option_takes(reader, options):
    day = day_of(reader.day(options))
    for point in (day["curve"][0], day["curve"][50], day["curve"][-1], *day["events"]):
        request = reader.read(State({**options, "time": point["time"]}))
        elevation = request.settings.lighting.sun_elevation
        assert elevation * 57.29577951 == pytest.approx(point["elevation_deg"], abs=1e-3)


def test_a_day_without_a_date_is_today(reader):
    day = day_of(reader.day({"lat": "-33", "lon": "151"}))
    assert day["zone"] == "mean solar time"
    assert day["date"] is not None


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "needs --lat and --lon"),
        ({"lat": "91", "lon": "0"}, "must be from -90deg to 90deg"),
        ({**PARIS, "tz": "Europe/Atlantis"}, "--tz"),
        ({**PARIS, "preset": "titan"}, "--lat"),
    ],
)
def test_a_faulty_place_has_the_message_of_the_command_line(reader, options, message):
    with pytest.raises(SkybakeError, match=message):
        day_of(reader.day(options))


def test_presets_have_titles_and_pictures():
    presets = {one["name"]: one for one in preset_list()}
    assert set(presets) == set(preset_names())
    assert presets["mars"]["title"] == "Mars"
    assert presets["mars"]["summary"] == "moderate dust over bright Arabia"
    pictures = {name: preset_picture(name) for name in presets}
    assert all(picture.startswith(b"\xff\xd8\xff") for picture in pictures.values())
    assert len(set(pictures.values())) == len(presets)
    assert preset_picture("vulcan") is None
