"""``python -m skybake``."""

from skybake.cli import run

run()
