"""Pictures to look at: the ACES display transforms, as eight-bit PNG."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np
import numpy.typing as npt
import OpenImageIO

from skybake.errors import InputError
from skybake.formats.shrink import shrunk
from skybake.formats.spec import Tagged
from skybake.formats.targets import check_target, faults_of, write_error
from skybake.formats.whole_files import WholeFiles, replace_when_whole
from skybake.jit.workers import ALL_CPUS

# Named, because the defaults of OpenColorIO follow $OCIO and the version of the library.
_VIEWS = {
    "aces1": ("ocio://cg-config-v2.2.0_aces-v1.3_ocio-v2.4", "ACES 1.0 - SDR Video"),
    "aces2": (
        "ocio://cg-config-v4.0.0_aces-v2.0_ocio-v2.5",
        "ACES 2.0 - SDR 100 nits (Rec.709)",
    ),
}
VIEWS = tuple(_VIEWS)
"""Display transforms by name; the first is the default."""

DEFAULT_VIEW = VIEWS[0]
"""Chosen by looking at skies: ACES 2 makes the blue of noon a slate grey, see docs/formats.md."""

Show = Callable[[npt.NDArray[np.float32], Tagged, float], None]

_WHITE = np.float32(1e30)

PNG_LEVEL = 4
"""Of a sky it makes files a tenth larger than the library's level 6 in half the time."""

PIXELS_AT_ONCE = 500_000
"""Whose colours are found while those before them are compressed."""

_END_OF_PNG = b"IEND\xaeB`\x82"


def write_preview(
    path: Path,
    pixels: npt.NDArray[np.float32],
    colour_space: Tagged,
    *,
    gain: float,
    view: str = DEFAULT_VIEW,
    max_width: int = 1024,
    texts: Mapping[str, str] | None = None,
) -> None:
    """Write a display-referred sRGB picture of a map.

    Parameters
    ----------
    path : Path
        ``.png``.
    pixels : ndarray of float32, shape (row, column, 3)
        Scene-linear and finite.
    colour_space : Tagged
        Their space.
    gain : float
        Exposure: factor from pixels to the scene-linear values of ACES, where 0.18
        is middle grey.
    view : {"aces1", "aces2"}
        Display transform: that of ACES 1.3, or ACES 2.0.
    max_width : int
        Larger maps are reduced before the display transform. [pixel]
    texts : mapping of str to str, optional
        What the file is to hold besides the picture.

    Raises
    ------
    InputError
        If the suffix or the view is not known.
    OutputError
        If the file cannot be written.
    """
    with open_preview(path, view=view, max_width=max_width, texts=texts) as show:
        show(pixels, colour_space, gain)


def write_picture(
    path: Path,
    width: int,
    height: int,
    bands: Iterable[npt.NDArray[np.uint8]],
    *,
    texts: Mapping[str, str] | None = None,
    files: WholeFiles | None = None,
) -> None:
    """Write code values of sRGB as PNG.

    Parameters
    ----------
    path : Path
        ``.png``.
    width, height : int
        Size of the picture. [pixel]
    bands : iterable of ndarray of uint8, shape (row, width, 3)
        Rows after rows, from top to bottom.
    texts : mapping of str to str, optional
        What the file is to hold besides the picture.
    files : WholeFiles, optional
        The files that it is to appear with; by default it appears when it is written.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    if files is not None:
        _write_png(path, files.add(path), (width, height), bands, texts)
        return
    with replace_when_whole(path) as temporary:
        _write_png(path, temporary, (width, height), bands, texts)


@contextmanager
def open_preview(
    path: Path,
    *,
    view: str = DEFAULT_VIEW,
    max_width: int = 1024,
    texts: Mapping[str, str] | None = None,
    files: WholeFiles | None = None,
) -> Iterator[Show]:
    """Yield ``show(pixels, colour_space, gain)``; the picture appears when the block ends.

    Parameters and errors are those of `write_preview`, and the files that it is to
    appear with.
    """
    check_preview(path)
    check_view(view)
    with ExitStack() as stack:
        whole_files = stack.enter_context(WholeFiles()) if files is None else files
        temporary = whole_files.add(path)

        def show(pixels: npt.NDArray[np.float32], colour_space: Tagged, gain: float) -> None:
            small = shrunk(pixels, max_width)
            height, width = small.shape[:2]
            rows = -(-height // max(1, width * height // PIXELS_AT_ONCE))

            def display(first: int) -> npt.NDArray[np.float32]:
                # Beyond that all is white, and infinity would become anything.
                with np.errstate(over="ignore"):
                    exposed = small[first : first + rows] * np.float32(gain)
                return display_values(np.clip(exposed, -_WHITE, _WHITE), colour_space, view)

            with faults_of(path):
                shown = ALL_CPUS.ahead(display, range(0, height, rows))
                _write_png(path, temporary, (width, height), shown, texts)

        yield show


def check_preview(path: Path) -> None:
    """Raise the errors of a preview that can be found before anything is computed.

    Raises
    ------
    InputError
        If the suffix is not known.
    OutputError
        If a file cannot be written under that name.
    """
    if path.suffix.lower() != ".png":
        raise InputError(f"{path}: suffix of a preview must be .png, got {path.suffix!r}")
    check_target(path)


def check_view(view: str) -> None:
    """Raise an `InputError` if there is no such display transform."""
    if view not in _VIEWS:
        raise InputError(f"view: must be one of {', '.join(VIEWS)}, got {view!r}")


def display_values(
    pixels: npt.NDArray[np.float32], colour_space: Tagged, view: str
) -> npt.NDArray[np.float32]:
    """Display-referred sRGB code values in [0, 1] of scene-linear pixels."""
    config, view_name = _VIEWS[view]
    source = OpenImageIO.ImageBuf(np.ascontiguousarray(pixels))
    shown = OpenImageIO.ImageBufAlgo.ociodisplay(
        source,
        display="sRGB - Display",
        view=view_name,
        fromspace=colour_space.interop_id,
        colorconfig=config,
    )
    if shown.has_error:
        raise RuntimeError(f"{config} must know {view_name}, got {shown.geterror()}")
    # The ACES 1 view leaves values outside of the display, down to -1.
    values: npt.NDArray[np.float32] = np.clip(_pixels(shown), 0.0, 1.0)
    return values


def _write_png(
    path: Path,
    temporary: Path,
    size: tuple[int, int],
    bands: Iterable[npt.NDArray[np.float32]] | Iterable[npt.NDArray[np.uint8]],
    texts: Mapping[str, str] | None = None,
) -> None:
    spec = OpenImageIO.ImageSpec(*size, 3, "uint8")
    for name, text in (texts or {}).items():
        spec[name] = text
    spec["oiio:ColorSpace"] = "srgb_rec709_display"
    spec["oiio:dither"] = 1
    spec["png:compressionLevel"] = PNG_LEVEL
    output = OpenImageIO.ImageOutput.create(str(temporary))
    if output is None:
        raise write_error(path, temporary, OpenImageIO.geterror())
    written, row = output.open(str(temporary), spec), 0
    for band in bands:
        last = row + len(band)
        written = written and output.write_scanlines(row, last, 0, np.ascontiguousarray(band))
        row = last
    output.close()
    message = output.geterror()
    # Writing the library's last block to a full disk can fail silently.
    if not written or message or not temporary.read_bytes().endswith(_END_OF_PNG):
        raise write_error(path, temporary, message)


def _pixels(image: OpenImageIO.ImageBuf) -> npt.NDArray[np.float32]:
    return np.asarray(image.get_pixels(OpenImageIO.FLOAT), np.float32)


def png_bytes(pixels: npt.NDArray[np.uint8]) -> bytes:
    """Return the content of a PNG file of code values of sRGB, shape (row, column, 3)."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.png"
        height, width = pixels.shape[:2]
        _write_png(path, path, (width, height), [np.ascontiguousarray(pixels)])
        return path.read_bytes()
