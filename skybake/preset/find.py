"""Where presets live: in the wheel beside the code, or at the top of the repository."""

from __future__ import annotations

from pathlib import Path

from skybake.errors import PresetError
from skybake.preset.message import shown

_PACKAGE = Path(__file__).resolve().parents[1]


def preset_names() -> list[str]:
    """Names of the presets that come with skybake, sorted."""
    return sorted(path.stem for path in _folder().glob("*.toml"))


def preset_text(name: str) -> str:
    """Return the TOML text of a preset that comes with skybake.

    Raises
    ------
    PresetError
        If there is none of that name; the message lists the known ones.
    """
    return read_text(find_preset(name), name)


def find_preset(name_or_path: str | Path) -> Path:
    """Return the file of a preset.

    Parameters
    ----------
    name_or_path : str or Path
        A name out of `preset_names`, or a file of the user's: a Path, or a text
        that ends in ``.toml`` or has a path separator.

    Raises
    ------
    PresetError
        If no preset has that name; the message lists the known ones.
    """
    if isinstance(name_or_path, Path):
        return name_or_path
    if is_path(name_or_path):
        return Path(name_or_path)
    names = preset_names()
    if name_or_path not in names:
        raise PresetError(
            f"unknown preset {shown(name_or_path)}; known presets: {', '.join(names)}; "
            "a file of your own needs the ending .toml"
        )
    return _folder() / f"{name_or_path}.toml"


def is_path(text: str) -> bool:
    """Whether a text means a file of the user's rather than the name of a preset."""
    return text.endswith(".toml") or "/" in text or "\\" in text


def display_name(path: Path) -> str:
    """How messages call a preset: bare name if it comes with skybake, else the path as given."""
    return path.name if path.parent == _folder() else str(path)


def read_text(path: Path, where: str) -> str:
    """Read a text file; a fault is a PresetError of one line that starts with `where`."""
    try:
        return path.read_text(encoding="utf-8-sig")  # spreadsheets write a byte order mark
    except OSError as error:
        raise PresetError(f"{where}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise PresetError(f"{where}: must be UTF-8 text") from error
    except ValueError as error:
        raise PresetError(f"{where}: cannot be read: {error}") from error


def _folder() -> Path:
    installed = _PACKAGE / "presets"
    return installed if installed.is_dir() else _PACKAGE.parent / "presets"
