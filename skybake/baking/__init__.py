"""From a preset and settings to files: joins all stages."""

from skybake.baking.paths import default_path
from skybake.baking.write import Baked, bake

__all__ = ["Baked", "bake", "default_path"]
