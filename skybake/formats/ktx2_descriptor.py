"""The part of a KTX file that tells what the bits of a texel mean.

References
----------
Khronos Data Format Specification 1.4, registry.khronos.org/DataFormat, chapters 4 and 5.
"""

from __future__ import annotations

import struct

from skybake.formats.texels import TexelFormat

_VERSION = 2
_RGBSDA = 1
_LINEAR = 1
_STRAIGHT_ALPHA = 0
_FLOAT, _SIGNED, _EXPONENT = 0x80, 0x40, 0x20
_RED, _GREEN, _BLUE, _ALPHA = 0, 1, 2, 15

_PRIMARIES = {
    "lin_rec709_scene": 1,
    "lin_rec2020_scene": 4,
    "lin_ciexyzd65_scene": 5,
    "lin_ap0_scene": 6,
    "lin_ap1_scene": 7,
    "lin_p3d65_scene": 10,
}
_UNSPECIFIED = 0

_MINUS_ONE, _ZERO, _ONE = (struct.unpack("<I", struct.pack("<f", v))[0] for v in (-1.0, 0.0, 1.0))

# Of a shared exponent: the bias and the largest exponent, and the mantissa of 1 under the bias.
_EXPONENT_RANGE = (15, 31)
_MANTISSA_RANGE = (0, 8448)

Sample = tuple[int, int, int, int, int]
"""First bit, number of bits, channel with its qualifiers, and the values of 0 (or -1) and 1."""


def data_format_descriptor(form: TexelFormat, interop_id: str | None) -> bytes:
    """Return the descriptor of linear texels.

    Parameters
    ----------
    form : TexelFormat
        How they are stored.
    interop_id : str or None
        Their colour space, as the Color Interop Forum names it; another than those of this
        program, or None, leaves the primaries unspecified.
    """
    samples = _samples(form)
    size = 24 + 16 * len(samples)
    primaries = _PRIMARIES.get(interop_id or "", _UNSPECIFIED)
    block = struct.pack("<IHH", 0, _VERSION, size)
    block += struct.pack("<4B", _RGBSDA, primaries, _LINEAR, _STRAIGHT_ALPHA)
    block += struct.pack("<4B8B", 0, 0, 0, 0, form.size, *[0] * 7)
    for first, bits, channel, lower, upper in samples:
        block += struct.pack("<HBBIII", first, bits - 1, channel, 0, lower, upper)
    return struct.pack("<I", 4 + size) + block


def _samples(form: TexelFormat) -> list[Sample]:
    if form.name in {"half", "float"}:
        bits, kind = 8 * form.unit, _FLOAT | _SIGNED
        channels = enumerate((_RED, _GREEN, _BLUE, _ALPHA))
        return [(bits * i, bits, channel | kind, _MINUS_ONE, _ONE) for i, channel in channels]
    if form.name == "r11g11b10":
        places = ((0, 11, _RED), (11, 11, _GREEN), (22, 10, _BLUE))
        return [(first, bits, channel | _FLOAT, _ZERO, _ONE) for first, bits, channel in places]
    return [
        sample
        for i, channel in enumerate((_RED, _GREEN, _BLUE))
        for sample in (
            (9 * i, 9, channel, *_MANTISSA_RANGE),
            (27, 5, channel | _EXPONENT, *_EXPONENT_RANGE),
        )
    ]
