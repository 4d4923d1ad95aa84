"""Changes of a preset in everyday terms: ozone by its column, haze by its visibility."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from skybake.errors import ArgumentError, PresetError, PresetWarning
from skybake.optics.haze import haze_for_turbidity, haze_for_visibility
from skybake.preset import Absorber, Override, Planet, load_document, load_preset

OZONE = "ozone"


@dataclass(frozen=True)
class PresetChanges:
    """Changes of a preset.

    Attributes
    ----------
    clouds : tuple of mapping
        Layers of clouds to add, each as the table of one in a preset and named after its
        kind; first of all, so that values may change them.
    keep_clouds : bool
        Whether the preset keeps its own.
    values : tuple of (str, value)
        Keys of the preset, dotted, and what they are set to, as parsed from TOML, in this order.
    ground_albedo : float, str or None
        Of the ground: a number, a name of a spectrum, or a file.
    ozone : float or None
        Column of the absorber of this name. [DU]
    visibility : float or None
        At the ground; the optical depths of aerosols follow, see
        `skybake.optics.haze.haze_for_visibility`. [km]
    turbidity : float or None
        Instead, see `skybake.optics.haze.haze_for_turbidity`.
    sources : mapping of str to str
        Where changes were written, for messages; by the names of these attributes.

    Raises
    ------
    ArgumentError
        If both `visibility` and `turbidity` are given.
    """

    values: tuple[tuple[str, Any], ...] = ()
    ground_albedo: float | str | None = None
    ozone: float | None = None
    visibility: float | None = None
    turbidity: float | None = None
    sources: Mapping[str, str] = field(default_factory=dict)
    clouds: tuple[Mapping[str, Any], ...] = ()
    keep_clouds: bool = True

    def __post_init__(self) -> None:
        """Refuse visibility and turbidity together."""
        if self.visibility is not None and self.turbidity is not None:
            raise ArgumentError("{turbidity}: cannot be combined with {visibility}")

    def load(self, preset: str | Path) -> Planet:
        """Load a preset with these changes.

        Raises
        ------
        PresetError
            If the preset is faulty, or has nothing that could be changed like this.
        """
        return load_preset(preset, self.overrides(preset))

    def overrides(self, preset: str | Path) -> list[Override]:
        """Return the values that are laid over a preset.

        Raises
        ------
        PresetError
            As `load`.
        """
        found = self._cloud_layers(preset)
        found += [Override(key, value, self._source("values")) for key, value in self.values]
        if self.ground_albedo is not None:
            source = self._source("ground_albedo")
            found.append(Override("ground.albedo", self.ground_albedo, source))
        if self.ozone is not None:
            found.append(self._ozone(_load_quietly(preset, found), self.ozone))
        if self.visibility is not None:
            planet = _load_quietly(preset, found)
            found += self._haze("visibility", planet, haze_for_visibility, self.visibility)
        if self.turbidity is not None:
            planet = _load_quietly(preset, found)
            found += self._haze("turbidity", planet, haze_for_turbidity, self.turbidity)
        return found

    def _cloud_layers(self, preset: str | Path) -> list[Override]:
        if self.keep_clouds and not self.clouds:
            return []
        source = self._source("clouds")
        own = load_document(preset).data.get("clouds")
        found = []
        if own is not None and not self.keep_clouds:
            found.append(Override("clouds", "none", source))
        taken = set(own) if isinstance(own, dict) and self.keep_clouds else set()
        for table in self.clouds:
            kind = str(table.get("kind", "tile"))
            names = (kind, *(f"{kind}-{n}" for n in range(2, len(taken) + 3)))
            name = next(name for name in names if name not in taken)
            taken.add(name)
            found.append(Override(f"clouds.{name}", dict(table), source))
        return found

    def _ozone(self, planet: Planet, column: float) -> Override:
        source = self._source("ozone")
        absorbers = [one.name for one in planet.constituents if isinstance(one, Absorber)]
        if OZONE not in absorbers:
            raise PresetError(
                f"{source}: needs an absorber of the name {OZONE}, {planet.name} has "
                f"{', '.join(absorbers) or 'no absorber'}"
            )
        return Override(f"constituents.{OZONE}.column_du", column, source)

    def _haze(
        self,
        name: str,
        planet: Planet,
        solve: Callable[[Planet, float], dict[str, float]],
        value: float,
    ) -> list[Override]:
        source = self._source(name)
        try:
            depths = solve(planet, value)
        except PresetError as error:
            raise PresetError(f"{source}: {error}") from error
        return [
            Override(f"constituents.{aerosol}.optical_depth", depth, source)
            for aerosol, depth in depths.items()
        ]

    def _source(self, name: str) -> str:
        return self.sources.get(name, name)


def _load_quietly(preset: str | Path, overrides: list[Override]) -> Planet:
    """Load a planet without warnings, which its final load will give."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PresetWarning)
        return load_preset(preset, overrides)
