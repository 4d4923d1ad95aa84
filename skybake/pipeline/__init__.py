"""Stages from a planet to pixels that stay hot: only what a change affects is computed anew."""

from skybake.pipeline.pipeline import Pipeline
from skybake.pipeline.sky import Sky

__all__ = ["Pipeline", "Sky"]
