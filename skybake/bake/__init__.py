"""From a preset and a view to files: the one place that joins all stages."""

from skybake.bake.settings import MapSettings
from skybake.bake.write import Baked, bake, default_path

__all__ = ["Baked", "MapSettings", "bake", "default_path"]
