"""What docs/engines.md says of targets is so."""

import re
import shlex
from pathlib import Path

import pytest

from skybake.image.target import TARGETS
from tests.cli.runs import invoke

TEXT = (Path(__file__).parents[1] / "docs" / "engines.md").read_text("utf-8")
SECTIONS = dict(re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", TEXT, re.MULTILINE | re.DOTALL))
ROWS = {
    name: (heading, [cell.strip() for cell in cells.split("|")])
    for name, heading, cells in re.findall(
        r"^\| \[`([a-z]+)`\]\(#([a-z-]+)\) \| (.*) \|$", TEXT, re.MULTILINE
    )
}
DOCUMENTATION = "by documentation only"


def section(name):
    """Text of a target, which the table links to."""
    anchors = {
        re.sub(r"[^a-z -]", "", title.lower()).replace(" ", "-"): title for title in SECTIONS
    }
    return SECTIONS[anchors[ROWS[name][0]]]


def test_every_target_has_a_row_and_a_page_of_at_most_ten_lines():
    assert list(ROWS) == list(TARGETS)
    for name in TARGETS:
        lines = [line for line in section(name).splitlines() if line and "```" not in line]
        assert len(lines) <= 10, name
        assert f"--target {name}" in lines[0]


@pytest.mark.parametrize("target", TARGETS.values(), ids=lambda target: target.name)
def test_a_row_tells_what_the_table_of_the_code_holds(target):
    axes, maps, scale, disc, verified = ROWS[target.name][1]
    assert axes == ", ".join(target.axes)
    assert maps.startswith({"equirect": "equirect", "cubemap": "cube"}[target.projection])
    assert ("poles" in maps) == (target.equirect_rows == "poles")
    assert scale == {"ev15": "EV 15", "nits": "1 cd/m2"}[target.units]
    assert disc == {"include": "in the map", "exclude": "left out"}[target.sun_disc]
    if target.verified == DOCUMENTATION:
        assert verified == ""
        assert DOCUMENTATION in " ".join(section(target.name).split()).lower()
    else:
        assert re.findall(r"[\d.]+", verified)[0][:3] in target.verified
        assert f"verified with {verified}" in " ".join(section(target.name).split()).replace(
            "V", "v"
        )


@pytest.mark.parametrize("name", TARGETS)
def test_its_commands_run(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    commands = re.findall(r"^    (skybake .*)$", section(name), re.MULTILINE)
    assert commands
    for command in commands:
        _, *words = shlex.split(command)
        result = invoke(*words, "--size", "16", "--method", "hillaire", "--quiet")
        assert result.exit_code == 0, result.output
        assert Path(words[words.index("-o") + 1]).is_file()
