"""The folder in which compiled kernels and tables are kept between runs."""

from __future__ import annotations

import errno
import functools
import hashlib
import os
import shutil
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from skybake.errors import OutputError
from skybake.jit.private_folder import NotPrivateError, PrivateFolder, open_private_folder
from skybake.version import __version__

UNUSED_AFTER = 30 * 86400.0
"""Age after which the folder of another version is removed if it was not used. [s]"""

KERNEL_SUFFIX = ".kernel"
TABLES_FOLDER = "atmospheres"
TABLES_SUFFIX = ".tables"

CLOUDS_PREFIX = "clouds-"
"""Of the names of tables that hold a tile of clouds."""

CLOUD_LIGHT_PREFIX = "cloudlight-"
"""Of the names of tables that hold the light of clouds; all others hold an atmosphere."""

KERNEL_SOURCES = (
    "jit", "optics", "transport", "cloud_fields", "scattering", "reference", "sky", "clouds",
    "eclipse", "environment", "ibl", "luts", "aerial", "formats/half.py", "image/eclipsed.py",
    "night/dome_pixels.py",
)  # fmt: skip
"""Packages and modules that hold kernels, or what kernels are made from."""

_PREFIX = "kernels-"
_DAY = 86400.0
_LONGEST_NAME = 200


def cache_folder() -> PrivateFolder | None:
    """Open the folder of this version's kernels and tables; None where there can be none.

    It is named by a digest of the kernels' sources and of what compiles them.
    SKYBAKE_CACHE_DIR and NUMBA_CACHE_DIR take precedence over the user's cache folder.
    A folder that other users can write to is not used, since a compiled kernel is a
    program; one that only root can write to, as in a container image, is.
    """
    folder = _open_folder()
    if folder is not None and not folder.is_open():
        # Another process has removed it meanwhile.
        _open_folder.cache_clear()
        folder = _open_folder()
    return folder


@functools.cache
def _open_folder() -> PrivateFolder | None:
    directory = version_directory()
    if directory is None:
        warn_of_no_cache("SKYBAKE_CACHE_DIR: must be set where there is no home folder")
        return None
    try:
        is_new = not _exists(directory)
        folder = open_private_folder(directory)
    except NotPrivateError as error:
        warn_of_no_cache(
            f"{shortened(directory)}: kernel cache must be writable for its owner only, got {error}"
        )
        return None
    except OSError as error:
        reason = error.strerror or error
        warn_of_no_cache(f"{shortened(directory)}: kernel cache must be writable, got {reason}")
        return None
    if is_new:
        _remove_unused(directory.parent)
    with suppress(OSError):
        if time.time() - directory.stat().st_mtime > _DAY:
            folder.mark_used()
    return folder


def check_cache() -> None:
    """Refuse a folder in which nothing can be kept.

    Raises
    ------
    OutputError
        If it cannot be written to, or `cache_folder` does not use it.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        folder = cache_folder()
    if folder is None or not os.access(folder.path, os.W_OK | os.X_OK):
        root = folder.path if folder else cache_root()
        raise OutputError(
            f"{shortened(root)}: kernel cache must be a folder that is writable for its "
            "owner only, got another; SKYBAKE_CACHE_DIR sets a different one"
        )


def share_cache() -> None:
    """Let all users read this version's kernels and tables, as in a container image."""
    folder = cache_folder()
    if folder is not None:
        folder.path.parent.chmod(0o755)
        folder.share()
        folder.within(TABLES_FOLDER).share()


def cache_root() -> Path | None:
    """Folder that holds those of all versions; None without a home."""
    configured = os.environ.get("SKYBAKE_CACHE_DIR") or os.environ.get("NUMBA_CACHE_DIR")
    return Path(configured) if configured else _user_cache()


def version_directory() -> Path | None:
    """Folder of this version, which need not exist; None without a home."""
    parent = cache_root()
    return None if parent is None else parent / f"{_PREFIX}{source_hash(*KERNEL_SOURCES)}"


def is_warm() -> bool:
    """Whether compiled kernels of this version are stored."""
    folder = cache_folder()
    return folder is not None and any(name.endswith(KERNEL_SUFFIX) for name in folder.names())


@dataclass(frozen=True)
class Usage:
    """What a version's folder holds.

    Attributes
    ----------
    folder : Path
        Where.
    kernels, atmospheres, cloud_tiles, cloud_lights : int
        How many files of each kind.
    kernel_bytes, atmosphere_bytes, cloud_tile_bytes, cloud_light_bytes : int
        Their sizes. [byte]
    """

    folder: Path
    kernels: int
    kernel_bytes: int
    atmospheres: int
    atmosphere_bytes: int
    cloud_tiles: int
    cloud_tile_bytes: int
    cloud_lights: int
    cloud_light_bytes: int

    @property
    def total_bytes(self) -> int:
        """Size of all files. [byte]"""
        of_clouds = self.cloud_tile_bytes + self.cloud_light_bytes
        return self.kernel_bytes + self.atmosphere_bytes + of_clouds


def cache_usage() -> list[Usage]:
    """Return what the folders of all versions hold."""
    return [_usage(folder) for folder in _folders(cache_root())]


def clear_cache() -> None:
    """Remove the folders of all versions, and nothing else."""
    for folder in _folders(cache_root()):
        shutil.rmtree(folder, ignore_errors=True)


def warn_of_loss(directory: Path, error: OSError) -> None:
    """Warn once that compiled kernels could not be kept."""
    is_full = error.errno in {errno.ENOSPC, errno.EDQUOT}
    _warn_once(f"{directory}: kernel cache must {'have room' if is_full else 'be writable'}")


@functools.cache
def _warn_once(fault: str) -> None:
    warn_of_no_cache(fault)


def warn_of_no_cache(fault: str) -> None:
    """Warn that every process compiles by itself."""
    warnings.warn(f"{fault}; every process compiles anew", RuntimeWarning, stacklevel=3)


def _usage(folder: Path) -> Usage:
    kernels = _sizes(folder, f"*{KERNEL_SUFFIX}")
    tables = folder / TABLES_FOLDER
    tiles = _sizes(tables, f"{CLOUDS_PREFIX}*{TABLES_SUFFIX}")
    lights = _sizes(tables, f"{CLOUD_LIGHT_PREFIX}*{TABLES_SUFFIX}")
    of_clouds = CLOUDS_PREFIX, CLOUD_LIGHT_PREFIX
    others = _sizes(tables, f"*{TABLES_SUFFIX}", besides=of_clouds)
    kinds = kernels, others, tiles, lights
    return Usage(folder, *(number for sizes in kinds for number in (len(sizes), sum(sizes))))


def _sizes(folder: Path, pattern: str, besides: tuple[str, ...] = ()) -> list[int]:
    """Return sizes of files, but of those whose names begin with one of `besides`. [byte]"""
    sizes = []
    for path in folder.glob(pattern):
        if path.name.startswith(besides):
            continue
        # Another process may have removed it.
        with suppress(FileNotFoundError):
            sizes.append(path.stat().st_size)
    return sizes


def _folders(parent: Path | None) -> Iterator[Path]:
    if parent is None:
        return
    try:
        folders = sorted(path for path in parent.iterdir() if path.name.startswith(_PREFIX))
    except (FileNotFoundError, NotADirectoryError):
        return
    except OSError as error:
        reason = error.strerror or error
        raise OutputError(f"{shortened(parent)}: cache must be readable, got {reason}") from error
    yield from (folder for folder in folders if folder.is_dir())


def shortened(path: Path | None) -> str:
    """Return a path for a message, shortened if it is very long."""
    text = str(path)
    return text if len(text) <= _LONGEST_NAME else f"{text[:_LONGEST_NAME]}..."


def _exists(directory: Path) -> bool:
    try:
        directory.stat()
    except FileNotFoundError:
        return False
    return True


def _remove_unused(parent: Path) -> None:
    """Remove what other versions left and no process has used for a long time."""
    for folder in _folders(parent):
        with suppress(OSError):
            if time.time() - folder.stat().st_mtime > UNUSED_AFTER:
                shutil.rmtree(folder, ignore_errors=True)


@functools.cache
def source_hash(*sources: str) -> str:
    """Digest of what compiled kernels depend on besides the processor.

    That is what compiles them and some of our packages and modules, because numba does
    not notice an edit to a kernel that another file's kernel calls (numba issue 9483).
    """
    made_by = (__version__, *_installed("numba"), *_installed("llvmlite"))
    digest = hashlib.sha256(" ".join((*made_by, sys.implementation.cache_tag)).encode())
    for path in (Path(__file__).parent.parent / source for source in sources):
        for file in sorted(path.rglob("*.py")) if path.is_dir() else [path]:
            digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def _installed(package: str) -> list[str]:
    """Names of the folders of a package's metadata, which contain its version.

    Neither the package nor importlib.metadata, which needs a parser of mail, is imported:
    that would take a fiftieth of a render.
    """
    spec = find_spec(package)
    if spec is None or spec.origin is None:
        return []
    return sorted(path.name for path in Path(spec.origin).parent.parent.glob(f"{package}-*"))


def _user_cache() -> Path | None:
    """Folder for this program's files by the platform's convention; None without a home."""
    configured = os.environ.get("LOCALAPPDATA" if sys.platform == "win32" else "XDG_CACHE_HOME")
    if configured:
        return Path(configured) / "skybake"
    try:
        home = Path.home()
    except RuntimeError:
        return None
    within = {"win32": "AppData/Local", "darwin": "Library/Caches"}.get(sys.platform, ".cache")
    return home / within / "skybake"
