"""Files of renderers, as they are read."""

import numpy as np
import pytest

from skybake.aerial import source
from skybake.formats import exr_layers
from tests.aerial.pictures import beauty, write_exr


@pytest.mark.parametrize("given", ["none", "same", "link", "other"])
def test_a_file_that_holds_light_and_depth_is_read_once(tmp_path, monkeypatch, given):
    picture = tmp_path / "in.exr"
    write_exr(picture, beauty(np.full((4, 6), 50.0)), kinds={"Z": "float"})
    (tmp_path / "link.exr").symlink_to(picture)
    (tmp_path / "other.exr").write_bytes(picture.read_bytes())
    read = []

    def read_exr(path):
        read.append(path)
        return exr_layers.read_exr(path)

    monkeypatch.setattr(source, "read_exr", read_exr)
    depth = {"none": None, "same": picture}.get(given, tmp_path / f"{given}.exr")
    found = source.read_source(picture, depth, source.Reading())
    assert (found.depths.values == 50.0).all()
    assert len(read) == (2 if given == "other" else 1)
