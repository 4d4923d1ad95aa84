"""What is written as TOML is read as the same data by Python's own reader."""

import tomllib

from hypothesis import given
from hypothesis import strategies as st

from skybake.preset import load_document, preset_names
from skybake.preset.toml import toml_text, toml_value

TEXTS = st.text(st.characters(exclude_categories=["Cs"]))
LEAVES = st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False) | TEXTS
VALUES = st.recursive(
    LEAVES, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXTS, inner, max_size=3)
)


@given(VALUES)
def test_any_value_survives(value):
    assert tomllib.loads(f"value = {toml_value(value)}") == {"value": value}


@given(st.dictionaries(TEXTS | st.sampled_from(["planet", "constituents"]), VALUES, max_size=4))
def test_any_document_survives(data):
    assert tomllib.loads(toml_text(data)) == data


def test_every_preset_survives_in_its_order():
    for name in preset_names():
        data = load_document(name).data
        again = tomllib.loads(toml_text(data))
        assert again == data
        assert list(again["constituents"]) == list(data["constituents"])
