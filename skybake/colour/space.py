"""Linear RGB spaces: their primaries, their names in files, and conversion from XYZ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError

Array = npt.NDArray[np.float64]

D65 = (0.3127, 0.3290)
ACES_WHITE = (0.32168, 0.33767)

BRADFORD = np.array(
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
)
"""From XYZ to the responses of receptors, whose gains an adaptation changes (Lam 1985)."""


@dataclass(frozen=True)
class ColourSpace:
    """A linear, scene-referred RGB space.

    Attributes
    ----------
    name : str
        As typed on the command line.
    interop_id : str
        Name by the Color Interop Forum, as OpenEXR's `colorInteropID` holds it and
        OpenColorIO configurations know it.
    chromaticities : tuple of 8 float
        CIE xy of red, green, blue and of RGB (1, 1, 1).
    neutral : tuple of 2 float
        CIE xy, in this space, of what appears neutral as D65 does.
    """

    name: str
    interop_id: str
    chromaticities: tuple[float, ...]
    neutral: tuple[float, float]


_SPACES = (
    ColourSpace("lin_rec709", "lin_rec709_scene", (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, *D65), D65),
    ColourSpace(
        "acescg",
        "lin_ap1_scene",
        (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, *ACES_WHITE),
        ACES_WHITE,
    ),
    ColourSpace(
        "lin_rec2020",
        "lin_rec2020_scene",
        (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, *D65),
        D65,
    ),
    ColourSpace(
        "lin_p3d65", "lin_p3d65_scene", (0.680, 0.320, 0.265, 0.690, 0.150, 0.060, *D65), D65
    ),
    ColourSpace(
        "aces2065-1",
        "lin_ap0_scene",
        (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.0770, *ACES_WHITE),
        ACES_WHITE,
    ),
    ColourSpace("xyz", "lin_ciexyzd65_scene", (1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1 / 3, 1 / 3), D65),
)

COLOUR_SPACES = {space.name: space for space in _SPACES}
"""Every space by its name; the first is the default."""


def find_colour_space(name: str) -> ColourSpace:
    """Return the space of a name.

    Raises
    ------
    InputError
        If there is none; the message lists the known names.
    """
    if name not in COLOUR_SPACES:
        known = ", ".join(COLOUR_SPACES)
        raise InputError(f"colorspace: must be one of {known}, got {name!r}")
    return COLOUR_SPACES[name]


def colour_space_from_tags(
    where: str, interop_id: str | None, chromaticities: tuple[float, ...] | None
) -> ColourSpace:
    """Return the space that an image file declares.

    Parameters
    ----------
    where : str
        The file's name, for messages.
    interop_id : str or None
        The file's `colorInteropID`; decides where it names a known space.
    chromaticities : tuple of 8 float or None
        The file's `chromaticities`. Without either tag the space is Rec. 709, as
        the OpenEXR standard has it.

    Raises
    ------
    InputError
        If the tags name a space that is not known here.
    """
    for space in _SPACES:
        if interop_id == space.interop_id:
            return space
    if chromaticities is not None:
        for space in _SPACES:
            if np.allclose(chromaticities, space.chromaticities, rtol=0.0, atol=2e-3):
                return space
    elif interop_id in {None, "unknown"}:
        return _SPACES[0]
    known = ", ".join(space.interop_id for space in _SPACES)
    raise InputError(
        f"{where}: colour space must be one of {known}, "
        f"got {interop_id or 'chromaticities ' + ' '.join(f'{c:g}' for c in chromaticities or ())}"
    )


def rgb_from_xyz(space: ColourSpace) -> Array:
    """Matrix from XYZ to the linear RGB of a space.

    Parameters
    ----------
    space : ColourSpace
        Target.

    Returns
    -------
    ndarray of float64, shape (3, 3)
        ``rgb = matrix @ xyz``. D65 of luminance 1 becomes (1, 1, 1) in every RGB
        space; spaces with another white are reached by Bradford adaptation, as in
        the ACES configurations of OpenColorIO. For `xyz` it is the identity.

    References
    ----------
    SMPTE RP 177-1993 (primaries to matrix); K. Lam, "Metamerism and Colour
    Constancy", 1985 (Bradford); ACES TB-2014-004 and S-2014-004 (AP0, AP1, white).
    """
    if space.name == "xyz":
        return np.eye(3)
    *primaries, white = (xyz_from_xy(*space.chromaticities[i : i + 2]) for i in (0, 2, 4, 6))
    directions = np.stack(primaries, axis=1)
    xyz_from_rgb = directions * np.linalg.solve(directions, white)
    adaptation = bradford(xyz_from_xy(*D65), white)
    matrix: Array = np.asarray(np.linalg.solve(xyz_from_rgb, adaptation), np.float64)
    return matrix


def bradford(white: Array, adapted_white: Array) -> Array:
    """Matrix by which XYZ of one white looks in another as it did.

    Parameters
    ----------
    white, adapted_white : ndarray of float64, shape (3,)
        XYZ of both. Their luminances should be equal, since the matrix takes one to the other.

    Returns
    -------
    ndarray of float64, shape (3, 3)
        ``adapted = matrix @ xyz``.

    References
    ----------
    K. Lam, "Metamerism and Colour Constancy", 1985.
    """
    cone_gain = (BRADFORD @ adapted_white) / (BRADFORD @ white)
    matrix: Array = np.linalg.solve(BRADFORD, cone_gain[:, None] * BRADFORD)
    return matrix


def luminance_weights(space: ColourSpace) -> Array:
    """Luminance of red, green and blue, shape (3,): ``rgb @ weights`` is Y."""
    weights: Array = np.linalg.inv(rgb_from_xyz(space))[1]
    return weights


def xyz_from_xy(x: float, y: float) -> Array:
    """Tristimulus values of chromaticity xy at luminance 1."""
    return np.array([x / y, 1.0, (1.0 - x - y) / y])
