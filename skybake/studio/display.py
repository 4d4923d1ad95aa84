"""The display transforms of previews as tables, which graphics hardware looks up."""

from __future__ import annotations

import numpy as np

from skybake.colour.space import find_colour_space, rgb_from_xyz
from skybake.errors import InputError
from skybake.formats.preview import VIEWS, check_view, display_values
from skybake.studio.frames import message

SIZE = 64
LEAST_EV, MOST_EV = -10.0, 8.0
"""Stops from middle grey that the table covers; beyond, displays show black and white."""

MIDDLE = 0.18
SPACE = "acescg"
"""Space of the table, in which no sky has negative components, as blue ones have in Rec. 709."""


def display_message(view: str) -> bytes:
    """Return the table of a display transform, see `skybake.studio.frames.message`.

    Parameters
    ----------
    view : str
        One of `skybake.formats.preview.VIEWS`.

    Returns
    -------
    bytes
        Header with ``matrix`` from exposed linear Rec. 709 to the space of the table, and with the
        ends of the shaper log2(x / middle). Texels are code values of sRGB from 0 to 1,
        red fastest.

    Raises
    ------
    InputError
        If there is no such transform.
    """
    try:
        check_view(view)
    except InputError as error:
        raise InputError(f"view: must be one of {', '.join(VIEWS)}, got {view!r}") from error
    space, rec709 = find_colour_space(SPACE), find_colour_space("lin_rec709")
    matrix = rgb_from_xyz(space) @ np.linalg.inv(rgb_from_xyz(rec709))
    steps = np.linspace(LEAST_EV, MOST_EV, SIZE)
    values = (MIDDLE * 2.0**steps).astype(np.float32)
    blue, green, red = np.meshgrid(values, values, values, indexing="ij")
    lattice = np.stack([red, green, blue], axis=-1).reshape(SIZE * SIZE, SIZE, 3)
    header = {
        "view": view,
        "size": SIZE,
        "type": "float16",
        "channels": 3,
        "middle": MIDDLE,
        "min_ev": LEAST_EV,
        "max_ev": MOST_EV,
        "matrix": matrix.ravel().tolist(),
    }
    return message(header, display_values(lattice, space, view).astype("<f2").tobytes())
