"""Where presets are: in the wheel beside the code, or at the top of the repository."""

from __future__ import annotations

from pathlib import Path

from skybake import input_files
from skybake.errors import InputError, PresetError
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
    return read_preset(find_preset(name), name)


def find_preset(name_or_path: str | Path) -> Path:
    """Return the file of a preset.

    Parameters
    ----------
    name_or_path : str or Path
        A name out of `preset_names`, or a file of the user's: a Path, or a text
        that ends in ``.toml``, in any case, or has a path separator.

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
            "your own file must end in .toml"
        )
    return _folder() / f"{name_or_path}.toml"


def is_path(text: str) -> bool:
    """Whether a text is the path of a user's file rather than the name of a preset."""
    return text.lower().endswith(".toml") or "/" in text or "\\" in text


def display_name(path: Path) -> str:
    """Name of a preset in messages: bare name if it comes with skybake, else the path as given."""
    return path.name if path.parent == _folder() else str(path)


def read_preset(path: Path, where: str) -> str:
    """Read the text of a preset; raises a PresetError of one line that starts with `where`."""
    try:
        return input_files.read_text(path, where, input_files.LARGEST_PRESET)
    except InputError as error:
        raise PresetError(str(error)) from error


def _folder() -> Path:
    installed = _PACKAGE / "presets"
    return installed if installed.is_dir() else _PACKAGE.parent / "presets"
