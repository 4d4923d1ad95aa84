"""From a preset and a view to files: the one place that joins all stages."""

from skybake.baking.settings import MapSettings
from skybake.baking.write import Baked, bake, default_path

__all__ = ["Baked", "MapSettings", "bake", "default_path"]
