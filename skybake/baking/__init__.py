"""From a preset and a view to files: the one place that joins all stages."""

from skybake.baking.paths import default_path
from skybake.baking.write import Baked, bake

__all__ = ["Baked", "bake", "default_path"]
