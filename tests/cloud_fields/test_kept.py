"""Fields that are kept on disk."""

from skybake.cloud_fields.empty import empty_field
from skybake.cloud_fields.kept import kept_field
from skybake.jit.arguments import flatten


def test_a_field_that_is_read_is_to_kernels_of_the_type_of_one_that_was_built(
    tmp_path, monkeypatch
):
    monkeypatch.setenv("SKYBAKE_CACHE_DIR", str(tmp_path))
    made = []

    def build(cover):
        made.append(cover)
        return empty_field()

    built = kept_field("none", (0.5,), build)
    read = kept_field("none", (0.5,), build)
    assert made == [0.5]
    assert flatten(read).kinds == flatten(built).kinds
