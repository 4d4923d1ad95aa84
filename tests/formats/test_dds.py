import numpy as np
import pytest

from skybake.errors import OutputError
from skybake.formats.dds import write_dds
from tests.formats.cubes import cube_levels, read_dds
from tests.formats.maps import listing


@pytest.mark.parametrize("count", [1, 5])
def test_faces_follow_each_other_each_with_all_its_levels(tmp_path, count):
    levels = cube_levels(16, count)
    write_dds(tmp_path / "a.dds", levels)
    faces = read_dds(tmp_path / "a.dds")

    for i, face in enumerate(faces):
        assert len(face) == count
        for level, found in zip(levels, face, strict=True):
            np.testing.assert_array_equal(found, level[i].astype(np.float16))


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (70000.0, "a.dds: radiance in half must be at most 65504, got 70000"),
        (np.nan, "a.dds: radiance must be finite, got nan"),
    ],
)
def test_a_value_that_half_does_not_hold_is_refused(tmp_path, value, message):
    levels = cube_levels()
    levels[2][4, 1, 1, 1] = value

    with pytest.raises(OutputError, match=message):
        write_dds(tmp_path / "a.dds", levels)
    assert listing(tmp_path) == []
