"""Radiance pictures: RGBE pixels under a header of text lines."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import numpy.typing as npt
import OpenImageIO

from skybake.errors import InputError, OutputError
from skybake.formats.scanlines import Rows, ScanlineWriter
from skybake.formats.spec import Attribute, MapSpec, attribute_text
from skybake.jit.workers import ALL_CPUS, Workers

RADIANCE_EFFICACY = 179.0
"""Luminous efficacy by which Radiance converts between its own radiance and luminance,
equal energy white, for all light. [lm W⁻¹]"""

WHITE_LUMINANCE = "whiteLuminance"

_LARGEST = 2.0**126
_EXPONENT_BITS = 0x7F800000
_HALF_STEP_BITS = 0x8000
_COMMENT_LENGTH = 72
# OpenImageIO refuses a header of more than a hundred lines, and writes some itself.
_MOST_LINES = 90
_SMALLEST_STEP = np.float32(2.0**-120)


class HdrWriter(ScanlineWriter):
    """Writes a Radiance picture row by row.

    Parameters
    ----------
    path, temporary : Path
        The target, for messages, and the file to write.
    spec : MapSpec
        What it holds; `pixel`, `compression` and `envmap` do not exist in the format.

    Attributes
    ----------
    clamped : int
        Negative values so far, stored as 0 because RGBE has no sign. Narrow RGB
        spaces have them where the sky is very saturated.

    Raises
    ------
    InputError
        If the format cannot hold the space.
    OutputError
        If the file cannot be written, or a value is not finite.
    """

    def __init__(self, path: Path, temporary: Path, spec: MapSpec) -> None:
        if len(spec.channels) != 3 or spec.colour_space.interop_id == "lin_ciexyzd65_scene":
            raise InputError(f"{path}: a Radiance picture must hold RGB, got other channels")
        self._header = header_lines(spec)
        count = self._header.count(b"\n")
        if count > _MOST_LINES:
            raise InputError(
                f"{path}: attributes must fit into {_MOST_LINES} lines of a Radiance header, "
                f"got {count}"
            )
        header = OpenImageIO.ImageSpec(spec.width, spec.height, 3, "float")
        super().__init__(path, temporary, header)

    def check_whole(self) -> None:
        """Insert the header lines that OpenImageIO leaves out, and read the last row back."""
        _insert_after_first_line(self._temporary, self._header)
        super().check_whole()

    def ready(self, rows: Rows, _workers: Workers = ALL_CPUS) -> Rows:
        """Check that rows are finite, and round them to what the format holds."""
        low, high = float(rows.min()), float(rows.max())
        if not (low >= -_LARGEST and high <= _LARGEST):
            got = high if low >= -_LARGEST else low
            raise OutputError(f"{self._path}: radiance must be finite, got {got}")
        values = np.asarray(rows, np.float32)
        if low < 0.0:
            self.clamped += int(np.count_nonzero(values < 0.0))
            values = np.maximum(values, np.float32(0.0))
        return round_to_rgbe(values)


def round_to_rgbe(values: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Round to what RGBE holds: eight bits under the exponent of the largest channel.

    OpenImageIO truncates to the same grid, which darkens a map by 0.3 % on average.

    Parameters
    ----------
    values : ndarray of float32, shape (..., 3)
        Not negative, below 2**126.

    Returns
    -------
    ndarray of float32, shape (..., 3)
        Within 1/256 of the largest channel.
    """
    red, green, blue = values[..., 0], values[..., 1], values[..., 2]
    largest = np.maximum(np.maximum(red, green), blue)
    # The exponent is that of the largest after rounding: 255.5 steps become the next power of two.
    bits = (largest.view(np.uint32) + _HALF_STEP_BITS) & _EXPONENT_BITS
    power_of_two = bits.view(np.float32)
    step = np.maximum(power_of_two * np.float32(2.0**-7), _SMALLEST_STEP)
    rounded = np.empty_like(values)
    # Channel by channel: numpy is several times slower along an axis of three.
    for channel in range(3):
        np.rint(values[..., channel] / step, out=rounded[..., channel])
        rounded[..., channel] *= step
    return rounded


def header_lines(spec: MapSpec) -> bytes:
    """Lines for the header of a Radiance picture.

    Notes
    -----
    EXPOSURE is the factor from radiance in W m⁻² sr⁻¹ to the value in the file, and
    Radiance's luminance is 179 times radiance, so 179 / white_luminance makes its
    tools report our luminance. Readers for rendering leave the values as they are, but for some
    that divide by it, as DirectXTex; without it a comment states the white luminance.
    Comments carry the other attributes. A long one continues under the same name in the
    next line, as readers have lines of 128 bytes and more.
    """
    primaries = " ".join(f"{value:.5g}" for value in spec.colour_space.chromaticities)
    attributes = dict(spec.attributes)
    lines = [
        f"SOFTWARE={_one_line(attributes.pop('Software', 'skybake'))}",
        *_scale_lines(spec),
        f"PRIMARIES={primaries}",
        f"# colorInteropID={spec.colour_space.interop_id}",
    ]
    date = attributes.pop("DateTime", None)
    if date is not None:
        lines.append(f"CAPDATE={_one_line(date)}")
    for key, value in attributes.items():
        text = _one_line(value)
        starts = range(0, max(1, len(text)), _COMMENT_LENGTH)
        lines += [f"# {key}={text[start : start + _COMMENT_LENGTH]}" for start in starts]
    return "".join(f"{line}\n" for line in lines).encode()


def _scale_lines(spec: MapSpec) -> tuple[str, ...]:
    if spec.white_luminance is None:
        return ()
    if spec.states_exposure:
        return (f"EXPOSURE={RADIANCE_EFFICACY / spec.white_luminance:.9g}",)
    return (f"# {WHITE_LUMINANCE}={spec.white_luminance:.9g}",)


def read_header(path: Path) -> dict[str, str]:
    """Variables and comments of a Radiance picture's header by name, as text.

    Comments of one name are one text in several lines.

    Raises
    ------
    ValueError
        If an EXPOSURE is not a number; the factors of several are multiplied.
    """
    found: dict[str, str] = {}
    with path.open("rb") as file:
        for raw in iter(lambda: file.readline(1 << 20), b"\n"):
            if not raw:
                break
            key, equals, value = raw.decode("utf-8", "replace").rstrip("\r\n").partition("=")
            if key == "EXPOSURE":
                value = repr(float(value) * float(found.get(key, "1")))
            if key.startswith("#"):
                key = key.lstrip("# ")
                value = found.get(key, "") + value
            if equals:
                found[key] = value
    return found


def _one_line(value: Attribute) -> str:
    """Text of an attribute, line breaks escaped: a bare one would end the header."""
    text = attribute_text(value)
    return text.replace("\\", "\\\\").replace("\r", "\\r").replace("\n", "\\n")


def _insert_after_first_line(path: Path, lines: bytes) -> None:
    """Put lines behind the first of a file, by way of a second file beside it."""
    whole = path.with_name(f"{path.stem}-header{path.suffix}")
    try:
        with path.open("rb") as source, whole.open("wb") as sink:
            sink.write(source.readline())
            sink.write(lines)
            shutil.copyfileobj(source, sink, 1 << 20)
        whole.replace(path)
    finally:
        whole.unlink(missing_ok=True)
