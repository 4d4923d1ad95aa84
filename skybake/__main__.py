"""``python -m skybake``."""

from skybake.cli import main

main()
