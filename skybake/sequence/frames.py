"""Frame ranges as users and farms write them, and file names with a frame number."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from skybake.errors import InputError

MOST_FRAMES = 1_000_000

# Longer numbers are typing errors, and Python reads only 4300 digits.
_NUMBER = "-?[0-9]{1,9}"
_PART = re.compile(f"({_NUMBER})(?:-({_NUMBER})(?:x([0-9]{{1,9}}))?)?")

_TOKEN = re.compile(
    r"""(?P<hashes>\#+) | (?P<ats>@+) | %(?:0(?P<printf>[1-9][0-9]?))?d
    | \$F(?P<houdini>[1-9]?)(?![A-Za-z0-9_]) | \{frame(?::0(?P<format>[1-9][0-9]?)d)?\}""",
    re.VERBOSE,
)
_FACE = "{face}"
_EXAMPLE = "sky.####.exr"


def parse_frames(text: str) -> tuple[int, ...]:
    """Read a frame range.

    Parameters
    ----------
    text : str
        Frames and ranges with commas between, as ``1-100x5,150,200-210``. A range
        includes both ends, ``x5`` selects every fifth. Numbers may be negative and may
        have leading zeros.

    Returns
    -------
    tuple of int
        Each frame once, ascending.

    Raises
    ------
    InputError
        If the text is no frame range, or one of more than `MOST_FRAMES`.
    """
    if ":" in text:
        raise InputError(
            f"frames: must have a step as in 1-100x5, got {text!r}; a colon is a step to some "
            "programs and a stagger to others"
        )
    frames: set[int] = set()
    for part in text.split(","):
        frames.update(_parse_part(part.strip(), text))
        if len(frames) > MOST_FRAMES:
            raise _too_many(text)
    return tuple(sorted(frames))


def _parse_part(part: str, text: str) -> range:
    found = _PART.fullmatch(part)
    if found is None:
        raise InputError(f"frames: must be such as 1-100x5,150 or -10--1, got {part!r} in {text!r}")
    first = int(found[1])
    last = first if found[2] is None else int(found[2])
    step = 1 if found[3] is None else int(found[3])
    if last < first:
        raise InputError(f"frames: a range must ascend, got {part!r} in {text!r}")
    if step == 0:
        raise InputError(f"frames: a step must be at least 1, got {part!r} in {text!r}")
    frames = range(first, last + 1, step)
    if len(frames) > MOST_FRAMES:
        raise _too_many(text)
    return frames


def _too_many(text: str) -> InputError:
    return InputError(f"frames: must be at most {MOST_FRAMES}, got more in {text!r}")


def format_frames(frames: Iterable[int]) -> str:
    """Write frames as `parse_frames` reads them, as ``1-9x2,20``.

    Each range is as long as it can be from where the one before it ends.
    """
    return ",".join(_format_run(run) for run in _runs(sorted(set(frames))))


def _runs(frames: list[int]) -> Iterator[list[int]]:
    """Split ascending frames into runs of one step."""
    first = 0
    while first < len(frames):
        end = first + 2
        while (
            end < len(frames) and frames[end] - frames[end - 1] == frames[end - 1] - frames[end - 2]
        ):
            end += 1
        # Two frames that are apart do not define a step; the second may begin a run.
        if end == first + 2 and end <= len(frames) and frames[first + 1] - frames[first] > 1:
            end = first + 1
        yield frames[first:end]
        first = end


def _format_run(run: list[int]) -> str:
    if len(run) == 1:
        return str(run[0])
    step = run[1] - run[0]
    return f"{run[0]}-{run[-1]}" + (f"x{step}" if step > 1 else "")


def chunks(frames: Sequence[int], size: int) -> list[tuple[int, ...]]:
    """Split frames into chunks of a size; the last one holds what is left.

    Raises
    ------
    InputError
        If the size is less than 1.
    """
    if size < 1:
        raise InputError(f"chunk: must be at least 1 frame, got {size}")
    return [tuple(frames[first : first + size]) for first in range(0, len(frames), size)]


@dataclass(frozen=True)
class FramePattern:
    """A file name with a place for the frame number.

    Attributes
    ----------
    folder : Path
        Where the files are.
    before, after : str
        The file's name around the number; ``{face}`` stays as it is.
    digits : int or None
        Least digits of the number, with its sign as in C's printf: -5 in four is
        ``-005``. None if there is no place for a number, and all is in `before`.
    """

    folder: Path
    before: str
    after: str
    digits: int | None

    @classmethod
    def parse(cls, text: str) -> FramePattern:
        """Read a pattern.

        Parameters
        ----------
        text : str
            A path whose file name holds at most one of ``####`` (n digits, but four
            for a single one), ``@@@@`` (n digits), ``%04d``, ``%d``, ``$F4``, ``$F``,
            ``{frame:04d}`` and ``{frame}``.

        Raises
        ------
        InputError
            If there are several places for the number, one in a folder's name, or
            what only looks like one.
        """
        path = Path(text)
        if not path.name:
            raise InputError(f"{text or 'pattern'}: must name a file, as {_EXAMPLE}")
        tokens = list(_TOKEN.finditer(path.name))
        # One # or @ is part of many a folder's name.
        if any(len(token[0]) > 1 for token in _TOKEN.finditer(str(path.parent))):
            raise InputError(
                f"{text}: the frame number belongs in the name of the file, not of a folder"
            )
        if len(tokens) > 1:
            found = " and ".join(token[0] for token in tokens)
            raise InputError(f"{text}: must have one frame number, as {_EXAMPLE}, got {found}")
        if not tokens:
            pattern = cls(path.parent, path.name, "", None)
        else:
            token = tokens[0]
            before, after = path.name[: token.start()], path.name[token.end() :]
            pattern = cls(path.parent, before, after, _digits(token))
        junk = re.search("[%{}]", (pattern.before + pattern.after).replace(_FACE, ""))
        if junk:
            raise InputError(
                f"{text}: frame number must be as ####, %04d, $F4, @@@@ or {{frame:04d}}, "
                f"got a {junk[0]} that belongs to none"
            )
        return pattern

    def check(self, frames: Sequence[int]) -> None:
        """Raise an InputError if several frames would share one file."""
        if self.digits is None and len(frames) > 1:
            stem, suffix = Path(self.before).stem, Path(self.before).suffix
            raise InputError(
                f"{self.folder / self.before}: must have a place for the frame number, "
                f"as {self.folder / f'{stem}.####{suffix}'}, for {len(frames)} frames"
            )

    def path(self, frame: int) -> Path:
        """File of a frame."""
        number = "" if self.digits is None else f"{frame:0{self.digits}d}"
        return self.folder / f"{self.before}{number}{self.after}"


def _digits(token: re.Match[str]) -> int:
    if token["hashes"]:
        return len(token["hashes"]) if len(token["hashes"]) > 1 else 4
    if token["ats"]:
        return len(token["ats"])
    return int(token["printf"] or token["houdini"] or token["format"] or 1)
