"""What a map file holds besides its pixels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, Protocol

from skybake.errors import InputError

Attribute = str | int | float | tuple[float, ...]
"""Value of an attribute; three floats are a direction, other tuples a plain array."""

HALF_MAX = 65504.0
"""Largest finite half float."""

CAMERA = "skybake:camera"
"""Attribute of a map in the channels of a camera, which are in no space of an eye."""

POLARIZER = "skybake:polarizer"
"""Attribute of a map through a polarising filter: angle of its axis from the vertical. [deg]"""

PIXELS = ("half", "float", "rgb9e5", "r11g11b10")
"""Types of stored values."""

UNDATED = "1970:01:01 00:00:00"
"""Date of a map without a date. OpenImageIO would write the present time, and the
same map would have different bytes in every run."""


def attribute_text(value: Attribute) -> str:
    """Return an attribute as formats have it that know only texts."""
    if isinstance(value, tuple):
        return " ".join(f"{component:.9g}" for component in value)
    return f"{value:.9g}" if isinstance(value, float) else str(value)


class Tagged(Protocol):
    """A colour space as files name it, see `skybake.colour.space.ColourSpace`."""

    @property
    def interop_id(self) -> str:
        """Name by the Color Interop Forum."""

    @property
    def chromaticities(self) -> tuple[float, ...]:
        """CIE xy of red, green, blue and white; none of a camera's own channels."""

    @property
    def neutral(self) -> tuple[float, float]:
        """CIE xy of what looks neutral."""


@dataclass(frozen=True)
class MapSpec:
    """What a map file holds besides its pixels.

    Attributes
    ----------
    width, height : int
        Size of the whole file. [pixel]
    colour_space : Tagged
        Space of the pixels.
    white_luminance : float or None
        Luminance of RGB (1, 1, 1); None of a file that does not state it. [cd m⁻²]
    pixel : {"half", "float", "rgb9e5", "r11g11b10"}
        Stored type; Radiance files hold RGBE regardless, and OpenEXR has only the first two.
    compression : str
        One of `skybake.formats.compression.COMPRESSIONS`, with an optional level
        after a colon. Radiance files have one compression of their own.
    envmap : {"latlong", "cube", None}
        How directions map to pixels, as OpenEXR's `envmap` attribute has it.
    channels : tuple of str
        Names in the order of the arrays' last axis.
    states_exposure : bool
        Whether a Radiance header gives the scale as EXPOSURE too, by which some programs divide.
    attributes : mapping of str to Attribute
        Anything else, as ``{"skybake:sunDirection": (0.0, 0.5, 0.866)}``. `DateTime`
        and `Software` become the standard attributes of each format.
    """

    width: int
    height: int
    colour_space: Tagged
    white_luminance: float | None
    pixel: str = "half"
    compression: str = "zip"
    envmap: Literal["latlong", "cube"] | None = None
    channels: tuple[str, ...] = ("R", "G", "B")
    states_exposure: bool = True
    attributes: Mapping[str, Attribute] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Refuse what no file can hold."""
        if self.width < 1 or self.height < 1:
            raise InputError(
                f"size: width and height must be at least 1, got {self.width}x{self.height}"
            )
        if self.pixel not in PIXELS:
            raise InputError(f"pixel: must be one of {', '.join(PIXELS)}, got {self.pixel!r}")
        if self.white_luminance is not None and not 0.0 < self.white_luminance < float("inf"):
            raise InputError(
                f"white_luminance: must be positive, got {self.white_luminance:g} cd/m2"
            )
