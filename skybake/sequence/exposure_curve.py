"""Exposure that changes over the frames of a sequence."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from skybake import input_files
from skybake.errors import InputError

_LOWEST, _HIGHEST = -30.0, 40.0


@dataclass(frozen=True)
class ExposureCurve:
    """Exposure values by frames, linear between points and constant beyond them.

    Attributes
    ----------
    points : tuple of (float, float)
        Frames, ascending, and the exposure value of each, from -30 to 40; at least one.
    path : Path or None
        File that they were read from.

    Raises
    ------
    InputError
        If the points are invalid.
    """

    points: tuple[tuple[float, float], ...]
    path: Path | None = None

    def __post_init__(self) -> None:
        """Refuse an invalid curve."""
        if not self.points:
            raise InputError("exposure curve: must hold at least one frame and its ev, got none")
        for frame, ev in self.points:
            _check_point("exposure curve", frame, ev)
        for (before, _), (frame, _) in pairwise(self.points):
            if frame <= before:
                raise InputError(f"exposure curve: frames must ascend, got {frame:g}")

    @classmethod
    def read(cls, path: Path) -> ExposureCurve:
        """Read a CSV file with the columns ``frame`` and ``ev``.

        Raises
        ------
        InputError
            If it cannot be read, with the line that is faulty.
        """
        rows = _rows(path)
        points: list[tuple[float, float]] = []
        for line, row in enumerate(rows, start=2):
            where = f"{path}: line {line}"
            try:
                frame, ev = float(row["frame"] or ""), float(row["ev"] or "")
            except ValueError as error:
                raise InputError(
                    f"{where}: must hold numbers under frame and ev, got {dict(row)}"
                ) from error
            _check_point(where, frame, ev)
            if points and frame <= points[-1][0]:
                raise InputError(f"{where}: frames must ascend, got {frame:g}")
            points.append((frame, ev))
        if not points:
            raise InputError(f"{path}: must hold at least one frame and its ev, got none")
        return cls(tuple(points), path)

    def at(self, frame: float) -> float:
        """Exposure value of a frame."""
        for (first, low), (last, high) in pairwise(self.points):
            if first <= frame <= last:
                return low + (high - low) * (frame - first) / (last - first)
        return self.points[0][1] if frame < self.points[0][0] else self.points[-1][1]


def _rows(path: Path) -> list[Mapping[str, str | None]]:
    text = input_files.read_text(path, str(path), input_files.LARGEST_TABLE)
    try:
        reader = csv.DictReader(io.StringIO(text, newline=""))
        columns, rows = list(reader.fieldnames or ()), list(reader)
    except csv.Error as error:
        raise InputError(f"{path}: cannot be read as a CSV file ({error})") from error
    if columns.count("frame") != 1 or columns.count("ev") != 1:
        found = ", ".join(columns) or "nothing"
        raise InputError(f"{path}: must hold the columns frame and ev, got {found}")
    return list(rows)


def _check_point(where: str, frame: float, ev: float) -> None:
    if not math.isfinite(frame):
        raise InputError(f"{where}: frame must be finite, got {frame:g}")
    if not _LOWEST <= ev <= _HIGHEST:
        raise InputError(f"{where}: ev must be from {_LOWEST:g} to {_HIGHEST:g}, got {ev:g}")
