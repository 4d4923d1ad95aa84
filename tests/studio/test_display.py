"""The tables of the page show skies as previews do."""

import json
import math

import numpy as np
import pytest

import skybake
from skybake.errors import InputError
from skybake.formats.preview import VIEWS
from skybake.studio.display import display_message


@pytest.fixture(scope="module", params=VIEWS)
def table(request):
    message = display_message(request.param)
    length = int.from_bytes(message[:4], "little")
    size = read_header(message)["size"]
    texels = np.frombuffer(message[4 + length :], "<f2").astype(float)
    return request.param, read_header(message), texels.reshape(size, size, size, 3)


def read_header(message):
    return json.loads(message[4 : 4 + int.from_bytes(message[:4], "little")])


def shown_by(header, lattice, rgb):
    """Code values by the table as graphics hardware interpolates it, trilinearly."""
    exposed = np.maximum(rgb @ np.reshape(header["matrix"], (3, 3)).T, 1e-30)
    stops = np.log2(exposed / header["middle"])
    share = (stops - header["min_ev"]) / (header["max_ev"] - header["min_ev"])
    place = np.clip(share, 0.0, 1.0) * (header["size"] - 1)
    low = np.minimum(place.astype(int), header["size"] - 2)
    part = place - low
    total = 0.0
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(corner, part, 1.0 - part), axis=-1, keepdims=True)
        red, green, blue = np.moveaxis(low + corner, -1, 0)
        total = total + weight * lattice[blue, green, red]
    return 255.0 * np.clip(total, 0.0, 1.0)


@pytest.mark.parametrize(
    ("preset", "elevation"), [("earth", 20.0), ("earth", 2.0), ("earth", -6.0)]
)
def test_a_sky_looks_as_its_preview_does(table, preset, elevation):
    view, header, lattice = table
    image = skybake.Sky(preset, sun_elevation=math.radians(elevation)).image(width=128)
    picture = image.picture(ev=12.0, view=view).astype(float)
    gain = image.encoding.white_luminance / (1.2 * 2.0**12)
    seen = shown_by(header, lattice, image.pixels.astype(float) * gain)
    difference = np.abs(seen - picture)
    assert difference.mean() < 0.5
    assert np.percentile(difference, 99.9) < 2.0


def test_an_unknown_display_transform_is_refused():
    with pytest.raises(InputError, match="view: must be one of aces1, aces2, got 'film'"):
        display_message("film")
