"""What a sequence consists of, before anything is computed."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from skybake.baking.checks import check_targets
from skybake.baking.paths import map_paths
from skybake.errors import ArgumentError, OutputError
from skybake.formats.spec import Attribute
from skybake.image.settings import MapSettings
from skybake.preset import Planet
from skybake.sequence.exposure_curve import ExposureCurve


@dataclass(frozen=True)
class Frame:
    """One map of a sequence.

    Attributes
    ----------
    number : int
        Its frame number.
    world : int
        Which of the plan's planets it shows.
    settings : MapSettings
        Sun, observer and map.
    output : Path
        As `skybake.baking.bake` takes it.
    preview : Path or None
        The display-referred picture.
    label : str or None
        Human-readable time.
    attributes : mapping of str to Attribute
        Of time and place, for its files.
    """

    number: int
    world: int
    settings: MapSettings
    output: Path
    preview: Path | None = None
    label: str | None = None
    attributes: Mapping[str, Attribute] = field(default_factory=dict)

    def files(self) -> tuple[Path, ...]:
        """Return the map, one file or six, and the preview if there is one."""
        preview = () if self.preview is None else (self.preview,)
        return (*map_paths(self.output, self.settings), *preview)


@dataclass(frozen=True)
class Plan:
    """All maps of a sequence.

    Attributes
    ----------
    planets : tuple of Planet
        The worlds; one, unless something of the world changes over time.
    frames : tuple of Frame
        By ascending number.
    output : Path or None
        Pattern of the names of the maps, as ``sky.####.exr``.
    exposure_curve : ExposureCurve or None
        What has set the exposure of each frame.
    """

    planets: tuple[Planet, ...]
    frames: tuple[Frame, ...]
    output: Path | None = None
    exposure_curve: ExposureCurve | None = None

    def planet(self, frame: Frame) -> Planet:
        """World of a frame."""
        return self.planets[frame.world]

    def only(self, numbers: Sequence[int]) -> Plan:
        """Return the plan with some of its frames.

        Numbers between the plan's frames are ignored: some farms name ranges without steps.

        Raises
        ------
        ArgumentError
            If there is none of them, or one is before or beyond all frames.
        """
        wanted = set(numbers)
        frames = tuple(one for one in self.frames if one.number in wanted)
        first, last = self.frames[0].number, self.frames[-1].number
        outside = next((number for number in numbers if not first <= number <= last), None)
        if outside is not None or not frames:
            raise ArgumentError(
                "{only}: must name frames of {first}-{last}, got {found}",
                first=first,
                last=last,
                found=", ".join(map(str, numbers[:1])) if outside is None else outside,
            )
        return replace(self, frames=frames)

    def check(self, others: Iterable[Path] = ()) -> None:
        """Raise the errors of all targets that can be found before anything is computed.

        Parameters
        ----------
        others : iterable of Path, optional
            What else is written.

        Raises
        ------
        SkybakeError
            If a file cannot be written under its name, or would be written twice.
        """
        for frame in self.frames:
            check_targets(frame.output, frame.settings, frame.preview)
        taken: set[str] = set()
        for path in (*(path for frame in self.frames for path in frame.files()), *others):
            target = os.path.realpath(path)
            if target in taken:
                raise OutputError(f"{path}: two files would be written under this name")
            taken.add(target)

    def highest_sun(self) -> Frame:
        """Frame with the highest sun; of several the first."""
        return max(self.frames, key=lambda frame: frame.settings.lighting.sun_elevation)

    def summary(self) -> list[dict[str, Any]]:
        """Return the frames in human-readable units, fit for JSON."""
        return [
            {
                "frame": frame.number,
                "label": frame.label,
                "file": str(frame.output),
                "preview": None if frame.preview is None else str(frame.preview),
                **frame.settings.recipe(has_clouds=bool(self.planet(frame).clouds)),
                "set": self.planet(frame).recipe.get("set", {}),
                **frame.attributes,
            }
            for frame in self.frames
        ]
