"""Each promise of docs/security.md names tests that exist."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
DOCUMENT = (ROOT / "docs" / "security.md").read_text()
PROMISE = re.compile(r"^\| (?!promise|---)(.+) \| (.+) \|$", re.MULTILINE)
PLACE = re.compile(r"`(tests/[\w/]+\.py)`(?:: ((?:`[\w ]+`(?:, )?)+))?")


def names_in(file):
    return re.findall(r"^def (test_\w+)", (ROOT / file).read_text(), re.MULTILINE)


def test_every_promise_of_a_table_names_tests_that_exist():
    promises = PROMISE.findall(DOCUMENT)
    assert promises
    for promise, tests in promises:
        places = PLACE.findall(tests)
        assert places, promise
        named = [f"`{file}`: {words}" if words else f"`{file}`" for file, words in places]
        assert "; ".join(named) == tests
        for file, words in places:
            names = names_in(file)
            assert names, file
            for word in re.findall(r"\w+", words):
                assert word == "or" or any(word in name for name in names), (promise, word)


def test_every_promise_of_a_list_names_tests_that_exist():
    items = re.findall(r"^\* (.+(?:\n  .+)*)", DOCUMENT, re.MULTILINE)
    everywhere = {name for file in (ROOT / "tests").rglob("test_*.py") for name in names_in(file)}
    assert items
    for item in items:
        named = re.findall(r"`(?:(tests/[\w/]+\.py)(?:::)?)?(test_\w+)?`", item)
        places = [(file, name) for file, name in named if file or name]
        assert places, item
        for file, name in places:
            assert not file or names_in(file), item
            assert not name or name in (names_in(file) if file else everywhere), (item, name)
