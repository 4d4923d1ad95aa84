"""Each promise of docs/security.md names tests that exist."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
PROMISE = re.compile(r"^\| (?!promise|---)(.+) \| (.+) \|$", re.MULTILINE)
PLACE = re.compile(r"`(tests/[\w/]+\.py)`(?:: ((?:`[\w ]+`(?:, )?)+))?")


def test_every_promise_names_tests_that_exist():
    promises = PROMISE.findall((ROOT / "docs" / "security.md").read_text())
    assert len(promises) > 15
    for promise, tests in promises:
        places = PLACE.findall(tests)
        assert places, promise
        named = [f"`{file}`: {words}" if words else f"`{file}`" for file, words in places]
        assert "; ".join(named) == tests
        for file, words in places:
            names = re.findall(r"^def (test_\w+)", (ROOT / file).read_text(), re.MULTILINE)
            assert names, file
            for word in re.findall(r"\w+", words):
                assert word == "or" or any(word in name for name in names), (promise, word)
